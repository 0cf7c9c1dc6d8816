"""Sentences and tables of the report, made from the numbers of the result only."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from crumple.hinge.law import BEYOND_RANGE, left_range
from crumple.hinge.law_use import INPUT
from crumple.numeric.ranking import largest_first
from crumple.report.drawing.scales import display_unit, output_groups
from crumple.result import HingeSummary, Result
from crumple.text.names import listed

_DEGREES = math.degrees(1.0)
_FALL = 0.05  # work of gravity over the largest energy, from which the energy of the fall is tabulated

BEYOND_LAWS = frozenset(
    {
        "beyond_jamming",
        "bottomed_out",
        "crumpled_end",
        "crushed_beyond",
        "deep_dent",
        "stretched_beyond",
    }
)
"""Cautions that say that a law of a hinge, a crush zone, a dent or a crumpled end left its range."""


@dataclass(frozen=True)
class Table:
    """A table: caption, column heads with units, rows of cells; the first column names the row."""

    caption: str
    heads: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]
    text_columns: frozenset[int] = field(default_factory=frozenset)


@dataclass(frozen=True)
class Verdict:
    """Trust in the result: level ``good``, ``caution`` or ``bad``, a headline, and the reasons."""

    level: str
    headline: str
    reasons: tuple[str, ...]
    warnings: tuple[str, ...]


def verdict(result: Result, bound: float | None, accuracy: float | None) -> Verdict:
    """Trust statement.

    Parameters
    ----------
    result
        Status, reason, residual, hinges and warnings are used.
    bound
        Largest relative energy residual allowed [-], or None.
    accuracy
        Accuracy requested from the stepper [-], or None.
    """
    outside = {name: sentence for name in result.hinges if (sentence := outside_range(result, name))}
    # the solver may have reported it already, in more detail
    unreported = [
        sentence
        for name, sentence in outside.items()
        if not any(_tells_of_range(warning, name) for warning in result.warnings)
    ]
    warnings = (*result.warnings, *unreported)
    reasons = [_balance(result, bound)]
    if accuracy is not None:
        reasons.append(f"Requested accuracy: {percent(accuracy)}.{_error(result)}")
    if not outside and not any(caution.code in BEYOND_LAWS for caution in result.cautions):
        reasons += _inside(result)
    if not result.status.ok:
        headline = sentence_case(result.status.value)
        if result.reason:
            reasons.insert(0, sentence_case(result.reason))
        return Verdict("bad", headline, tuple(reasons), warnings)
    if warnings:
        return Verdict("caution", "Complete, with reservations.", tuple(reasons), warnings)
    return Verdict("good", "Complete.", tuple(reasons), ())


def _inside(result: Result) -> list[str]:
    """One sentence on all laws with a range, whose limits were not passed; none without such a law."""
    numbers = {
        "hinge": sum(hinge.validity_rotation is not None for hinge in result.hinges.values()),
        "crush zone": sum(
            hinge.crush is not None and hinge.crush.stroke is not None for hinge in result.hinges.values()
        ),
        "dent": len(result.dents),
        "crumpled end": len(result.crumpled_ends),
    }
    of = listed(f"{number} {what}{'s' if number > 1 else ''}" for what, number in numbers.items() if number)
    return [f"All laws stayed inside their ranges of validity: those of {of}."] if of else []


def _tells_of_range(warning: str, hinge: str) -> bool:
    """Whether a sentence of the solver says that a hinge, or many with it, left the range of its law."""
    if warning.startswith(f"Hinge {hinge} turned"):
        return True
    head, _, rest = warning.partition(": ")
    named = re.search(rf"(?<![\w-]){re.escape(hinge)}(?![\w-])", head) is not None or head.endswith(" more")
    return named and ("the law is valid up to" in rest or "the law has no range" in rest)


def outside_range(result: Result, name: str) -> str:
    """One sentence if a hinge rotated beyond the range of validity of its law; else empty."""
    hinge = result.hinges[name]
    limit = hinge.validity_rotation
    reached = _judged_rotation(hinge)
    if limit is None or not left_range(limit, reached):
        return ""
    if limit <= 0.0:
        return f"Hinge {name} turned {angle(reached)}; its law has no range of validity. {BEYOND_RANGE}"
    return (
        f"Hinge {name} turned {angle(reached)}, beyond the range of validity of its law, {angle(limit)}. "
        f"{BEYOND_RANGE}"
    )


def _judged_rotation(hinge: HingeSummary) -> float:
    """Rotation by which the law of a hinge is judged [rad]; earlier versions stored the whole one."""
    return hinge.rotation_max if hinge.law_rotation is None else hinge.law_rotation


def _balance(result: Result, bound: float | None) -> str:
    residual = result.energy_residual
    if not math.isfinite(residual):
        return "The energy balance is not available."
    allowed = ""
    if bound is not None:
        allowed = f", {'within' if residual <= bound else 'beyond'} its bound of {percent(bound)}"
    return f"Energy balance: residual {percent(residual)} of the energy input{allowed}."


def _error(result: Result) -> str:
    bending = {name: hinge.rotation_max for name, hinge in result.hinges.items() if hinge.bends}
    if not bending:
        return ""
    hinge = result.hinges[largest_first(bending)[0]]
    error = hinge.rotation_error
    if error is None:
        return ""
    share = f" ({percent(error / hinge.rotation_max)})" if hinge.rotation_max > 0 else ""
    return f" Estimated error of the largest rotation: {degrees(error, 2)}°{share}."


def hinge_table(result: Result) -> Table:
    """Rotation, rest, energy and moment per hinge, each column in one unit."""
    bending = {name: hinge for name, hinge in result.hinges.items() if hinge.bends}
    names, hinges = list(bending), list(bending.values())
    energy_unit, energies = column([h.energy for h in hinges], "J")
    moment_unit, moments = column([h.moment_max for h in hinges], "N*m")
    total = sum(h.energy for h in hinges)
    _, largest_degrees = column([h.rotation_max * _DEGREES for h in hinges], "1")
    _, largest = column([h.rotation_max for h in hinges], "1")
    _, final_degrees = column([h.rotation_final * _DEGREES for h in hinges], "1")
    _, final = column([h.rotation_final for h in hinges], "1")
    time_unit, rests = column([math.nan if h.time_of_rest is None else h.time_of_rest for h in hinges], "s")
    shares = [f"{100 * h.energy / total:z.1f} %" if total > 0 else "—" for h in hinges]
    heads = (
        "Hinge", "Largest rotation, deg", "rad", "Final rotation, deg", "rad", f"At rest after, {time_unit}",
        f"Energy absorbed, {energy_unit}", "Share of hinges", f"Peak moment, {moment_unit}",
    )  # fmt: skip
    rows = list(
        zip(
            names,
            largest_degrees,
            largest,
            final_degrees,
            final,
            rests,
            energies,
            shares,
            moments,
            strict=True,
        )
    )
    dash = " A dash: still rotating at the end." if any(h.time_of_rest is None for h in hinges) else ""
    return Table(f"Rotation, time of rest, energy and moment of each hinge.{dash}", heads, rows)


def collapse_table(result: Result) -> Table:
    """Hinges that opened, in order, with the time, their plastic rotation and absorbed energy."""
    openings = result.collapse
    time_unit, times = column([opening.time for opening in openings], "s")
    energy_unit, energies = column([opening.energy for opening in openings], "J")
    _, turned = column([opening.rotation * _DEGREES for opening in openings], "1")
    heads: tuple[str, ...] = (
        "",
        "Hinge",
        f"Opened at, {time_unit}",
        "Plastic rotation at the end, deg",
        f"Energy, {energy_unit}",
    )
    columns = [times, turned, energies]
    if any(opening.broke is not None for opening in openings):
        unit, broke = column([math.nan if o.broke is None else o.broke for o in openings], "s")
        heads, columns = (*heads, f"Broke at, {unit}"), [*columns, broke]
    rows = [
        (str(i), opening.hinge, *cells)
        for i, (opening, *cells) in enumerate(zip(openings, *columns, strict=True), 1)
    ]
    caption = (
        "Sequence of collapse: hinges in the order in which they opened, that is, exceeded "
        f"{result.collapse_threshold * _DEGREES:.2g} deg of plastic rotation."
    )
    return Table(caption, heads, rows, frozenset({1}))


def stage_table(result: Result) -> Table:
    """Stages with their times and the reason of their end."""
    time_unit, times = column([t for stage in result.stages for t in (stage.start, stage.end)], "s")
    rows = [
        (stage.name, times[2 * i], times[2 * i + 1], stage.ended_by) for i, stage in enumerate(result.stages)
    ]
    heads = ("Stage", f"Start, {time_unit}", f"End, {time_unit}", "Ended by")
    return Table("Stages.", heads, rows, frozenset({3}))


def output_table(result: Result) -> Table:
    """Requested outputs: last value, value of largest magnitude, and when."""
    groups, still = output_groups(result)
    names = [channel.name for group in groups for _, channel in group.channels]
    shown = [(name, result.outputs[name]) for name in names if name in result.outputs]
    time_unit, times = column([output.time_of_max for _, output in shown], "s")
    rows = []
    for (name, output), time in zip(shown, times, strict=True):
        unit, numbers = column([output.final, output.max], output.unit)
        rows.append((name, *(f"{text} {unit}".strip() for text in numbers), time))
    heads = ("Output", "Final", "Largest magnitude", f"reached at, {time_unit}")
    caption = "Last value of each requested output, and its value of largest magnitude."
    if still:
        caption += f" Zero throughout: {', '.join(still)}."
    return Table(caption, heads, rows)


def fall_table(result: Result) -> Table:
    """Work of gravity from the highest position of the centre of mass to the end, and where it went."""
    work = result.channels.get("energy.gravity")
    empty = Table("", (), [])
    if work is None or not len(work.values):
        return empty
    highest = int(np.argmin(work.values))
    fall = float(work.values[-1] - work.values[highest])
    put_in = max(float(np.max(np.abs(result["energy.kinetic"]))), float(np.max(np.abs(work.values))))
    if not fall > _FALL * put_in:
        return empty
    rows = [("M g Δh, from the highest position of the centre of mass to the end", fall)]
    rows += [("0.75 M g Δh, the reference energy of UN R66 for calculations", 0.75 * fall)]
    taken = {
        "Absorbed by the structure": "energy.dissipated",
        "By contact": "energy.contact",
        "By friction": "energy.friction",
        "Kinetic at the end": "energy.kinetic",
    }
    rows += [(name, float(result[key][-1])) for name, key in taken.items() if key in result.channels]
    unit, cells = column([value for _, value in rows], "J")
    shares = [percent(value / fall) for _, value in rows]
    named = [(name, cell, share) for (name, _), cell, share in zip(rows, cells, shares, strict=True)]
    return Table("Energy of the fall.", ("Energy", f"{unit}", "of M g Δh"), named)


def law_table(result: Result, file: str = INPUT) -> Table:
    """Law, origin, source and range of every hinge, and whether the run stayed inside; equal rows are merged.

    Parameters
    ----------
    result
        Of any run.
    file
        Name of the input file, for the commands that give better laws.
    """
    groups: dict[tuple[str, ...], list[str]] = {}
    for name, hinge in result.hinges.items():
        if not hinge.law:
            continue  # measured, not computed by a law
        law = f"{hinge.law} ({hinge.form})" if hinge.form else hinge.law
        use = "—" if hinge.law_use is None else hinge.law_use.sentence(file)
        groups.setdefault((law, use, hinge.source, hinge.validity_basis, _range(hinge)), []).append(name)
    rows = []
    for (law, use, source, basis, limit), names in groups.items():
        reached = f"{degrees(max(_judged_rotation(result.hinges[name]) for name in names))}°"
        inside = "no" if any(outside_range(result, name) for name in names) else "yes"
        inside = inside if limit else "—"
        rows.append((", ".join(names), law, use, source, basis, limit or "—", reached, inside))
    heads = ("Hinge", "Law and form", "Origin", "Source", "Range supported by", "up to", "Reached", "Inside")
    return Table("Hinge laws, their sources and ranges of validity.", heads, rows, frozenset({1, 2, 3, 4}))


def _range(hinge: HingeSummary) -> str:
    limit = hinge.validity_rotation
    if limit is None:
        return ""
    if limit <= 0.0:
        return "none"
    return f"{degrees(limit)}°" if math.isfinite(limit) else "any rotation"


def column(values: Sequence[float], unit: str) -> tuple[str, tuple[str, ...]]:
    """A column in one unit and with equally many decimals: four digits for its largest number.

    Parameters
    ----------
    values
        In SI; NaN becomes a dash.
    unit
        SI unit; ``"1"`` where the values are in their display unit already.

    Returns
    -------
    unit, cells
        Unit to write in the head, and the numbers as text.
    """
    finite = [abs(value) for value in values if math.isfinite(value)]
    most = max(finite, default=0.0)
    name, factor = display_unit(unit, most) if unit != "1" else ("", 1.0)
    decimals = _decimals(most / factor)
    return name, tuple(_fixed(value / factor, decimals) for value in values)


def _decimals(largest: float, digits: int = 4) -> int:
    if largest <= 0:
        return 0
    return min(max(digits - 1 - math.floor(math.log10(largest)), 0), 9)


def _fixed(value: float, decimals: int) -> str:
    if not math.isfinite(value):
        return "—"
    text = f"{value:.{decimals}f}"
    # neither a negative zero nor a hyphen for a minus
    return text.lstrip("-") if float(text) == 0 else text.replace("-", "−")


def number(value: float, digits: int = 4) -> str:
    """A number with significant digits, written out, minus as a minus."""
    return _fixed(value, _decimals(abs(value), digits)) if math.isfinite(value) else "—"


def degrees(value: float, digits: int = 4) -> str:
    """An angle [rad] as a number of degrees."""
    return number(value * _DEGREES, digits)


def angle(value: float, digits: int = 4) -> str:
    """An angle [rad] in degrees and radians."""
    return f"{degrees(value, digits)}° ({number(value, digits)} rad)"


def percent(share: float, digits: int = 2) -> str:
    """A share [-] in per cent; tiny ones as a bound, since their digits are not meaningful."""
    if not math.isfinite(share):
        return "not known"
    if abs(share) < 1e-6:
        return "0 %" if share == 0 else "< 0.0001 %"
    text = f"{100 * share:.{digits}g}"
    return f"{float(text):.0f} %" if "e+" in text else f"{text} %".replace("-", "−")


def sentence_case(text: str) -> str:
    """First letter capital, full stop at the end."""
    return text[:1].upper() + text[1:] + ("" if text.endswith((".", "!", "?")) else ".")
