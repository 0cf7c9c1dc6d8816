"""Key figures and tables of the comparison page."""

from __future__ import annotations

import math
from collections.abc import Iterator

from crumple.comparison import (
    EDITION,
    SAMPLING_RATE,
    Comparison,
    HingeComparison,
    HingeMetrics,
    Pair,
)
from crumple.comparison.measure.metrics import signed
from crumple.numeric.ranking import largest_first
from crumple.report.drawing.scales import display_unit
from crumple.report.wording.wording import Table, degrees, number
from crumple.units import format_quantity

MOST_HINGES = 8
"""Number of hinges with a table, those that absorbed most energy."""

BUSY = 0.8
"""Share of busy time of the threads of a solve below which the page reports that they waited."""
LONG = 5.0
"""Solve time [s] from which it does: in short solves the serial parts before and after stepping dominate."""

NO_ROTATION = 1e-9
"""Rotation [rad] below which it is rounding."""

_PARTS = ("corridor", "phase", "magnitude", "slope")


def signed_percent(error: float | None) -> str:
    """A relative error in per cent with its sign, or a dash."""
    return "—" if error is None or not math.isfinite(error) else signed(error)


def ranked(comparison: Comparison) -> list[HingeComparison]:
    """Hinges, those that absorbed most energy in the reference first."""

    def absorbed(hinge: HingeComparison) -> float:
        return max((m.plastic_energy for m in (hinge.second, hinge.first) if m is not None), default=0.0)

    order = largest_first({i: absorbed(hinge) for i, hinge in enumerate(comparison.hinges)})
    return [comparison.hinges[i] for i in order]


def pair_of(comparison: Comparison, channel: str, candidate: str, reference: str) -> Pair | None:
    """The rated pair of a channel between two sources."""
    wanted = (channel, candidate, reference)
    return next((p for p in comparison.pairs if (p.channel, p.candidate, p.reference) == wanted), None)


def key_figures(comparison: Comparison) -> list[tuple[str, str, str]]:
    """Key figures: name, value, note."""
    first, second = comparison.candidate.name, comparison.reference.name
    hinges = ranked(comparison)
    figures = []
    if hinges:
        hinge = hinges[0]
        worst = max((abs(e) for e in hinge.energy_errors() if e is not None), default=None)
        figures.append(
            ("Largest rotation", signed_percent(hinge.error("rotation_max")), f"hinge {hinge.name}")
        )
        if worst is not None:
            figures.append(("Plastic energy", f"±{100 * worst:.1f} %", "at equal plastic rotations, at most"))
        for word, channel, where in (
            ("Rating, rotation", f"hinge.{hinge.name}.rotation", f"hinge {hinge.name}"),
            ("Rating, velocity", f"hinge.{hinge.name}.rotation_rate", f"hinge {hinge.name}"),
            ("Rating, velocity", f"member.{hinge.member}.chord_rotation_rate", "far end"),
        ):
            pair = pair_of(comparison, channel, first, second)
            if pair is not None and pair.rating is not None:
                figures.append((word, f"{pair.rating.overall:.2f}", f"{pair.rating.grade}, {where}"))
    if comparison.speed_ratio is not None:
        once = times_faster(comparison, comparison.candidate.result.solve_seconds)
        note, timing = f"{first} than {comparison.reference.with_threads}", comparison.timings.get(first)
        if timing is None:
            figures.append(("Faster", f"{once} ×", note))
        else:
            note = f"{note}, shortest of several solves; first solve {once} ×"
            figures.append(("Faster", f"{times_faster(comparison, timing.again)} ×", note))
    return figures


def times_faster(comparison: Comparison, seconds: float | None) -> str:
    """Solve time of the reference over a time [s], rounded to the repeatability of the clock."""
    ratio = comparison.times_faster(seconds)
    return "—" if ratio is None else number(float(f"{ratio:.3g}"), 3)


def hinge_tables(comparison: Comparison) -> list[Table]:
    """One table per hinge: each figure in both results and the difference."""
    return [_hinge_table(comparison, hinge) for hinge in ranked(comparison)[:MOST_HINGES]]


def _hinge_table(comparison: Comparison, hinge: HingeComparison) -> Table:
    first, second = comparison.candidate.name, comparison.reference.name
    rows = list(_hinge_rows(hinge))
    place = f"{hinge.station * 1e3:.0f} mm along member {hinge.member}"
    caption = f"Hinge {hinge.name}, {place}."
    if hinge.fold_station is not None and hinge.fold_extent is not None:
        low, high = hinge.fold_extent
        caption += (
            f" The {second} fold: centre at {hinge.fold_station * 1e3:.0f} mm, from {low * 1e3:.0f} to "
            f"{high * 1e3:.0f} mm."
        )
    if hinge.how:
        caption += f" {second.capitalize()}: {hinge.how[:1].lower()}{hinge.how[1:]}"
    return Table(caption, ("", first.capitalize(), second.capitalize(), "Difference"), rows)


def _hinge_rows(hinge: HingeComparison) -> Iterator[tuple[str, str, str, str]]:
    a, b = hinge.first, hinge.second

    def row(name: str, key: str, unit: str) -> tuple[str, str, str, str]:
        first, second = (None if m is None else getattr(m, key) for m in (a, b))
        return name, _value(first, unit), _value(second, unit), signed_percent(hinge.error(key))

    yield row("Largest rotation", "rotation_max", "rad")
    yield row("Largest rotation, seen from the far end", "far_rotation_max", "rad")
    yield row("Largest plastic rotation", "plastic_rotation", "rad")
    yield _times("Time of the largest rotation", a, b, "time_of_peak")
    yield _times("Opened (0.5° of plastic rotation)", a, b, "opened")
    yield row("Peak moment", "moment_peak", "N*m")
    yield row("Mean moment (plastic energy over plastic rotation)", "moment_mean", "N*m")
    yield row("Plastic energy at the end", "plastic_energy", "J")
    for i, (level, error) in enumerate(zip(hinge.levels, hinge.energy_errors(), strict=True)):
        values = [None if m is None else m.energy_at[i] for m in (a, b)]
        name = f"Plastic energy at {degrees(level, 3)}°"
        yield (name, _value(values[0], "J"), _value(values[1], "J"), signed_percent(error))


def crush_table(comparison: Comparison) -> Table:
    """Members that can shorten: crush length, mean force and energy in both results."""
    rows = []
    for crush in comparison.crushes:
        figures = (
            ("crush length", "length", "m"),
            ("stroke efficiency", "efficiency", "1"),
            ("mean force", "mean_force", "N"),
            ("energy", "energy", "J"),
        )
        for name, key, unit in figures:
            values = [None if side is None else getattr(side, key) for side in (crush.first, crush.second)]
            cells = [_value(value, unit) for value in values]
            rows.append((f"{crush.member}: {name}", *cells, signed_percent(crush.error(key))))
    first, second = comparison.candidate.name, comparison.reference.name
    caption = (
        "Axial crushing. Crush length: loss of distance between the ends of the member; mean force: energy "
        "over crush length; stroke efficiency: crush length over the length of the member."
    )
    return Table(caption, ("", first.capitalize(), second.capitalize(), "Difference"), rows)


CONTACT_UNITS = {"impulse": "N*s", "peak force": "N", "dissipation at contact": "J"}


def contact_table(comparison: Comparison) -> Table:
    """Contacts of obstacles: impulse, peak force, dissipation at the contact; and what contact took."""
    rows = []
    for kind, unit in CONTACT_UNITS.items():
        for figure in comparison.figures.get(kind, ()):
            values = [_value(value, unit) for value in (figure.model, figure.shell)]
            judged = "" if figure.right else ", beyond its target"
            off = signed_percent((figure.model - figure.shell) / figure.shell if figure.shell else None)
            allowed = f"{100 * figure.allowed:.0f} %"
            filtered = " (CFC 60)" if kind == "peak force" else ""
            rows.append((f"{figure.name}: {kind}{filtered}", *values, f"{off}{judged}", allowed))
    if rows:
        results = (comparison.candidate.result, comparison.reference.result)
        for name, key in (("Taken by contact", "energy.contact"), ("Taken by friction", "energy.friction")):
            taken = [float(r[key][-1]) if key in r.channels else None for r in results]
            rows.append((name, *(_value(energy, "J") for energy in taken), "—", "—"))
    first, second = comparison.candidate.name, comparison.reference.name
    caption = (
        "Contacts of obstacles. Peak force: through the filter CFC 60, which lowers short peaks; histories "
        "have it unfiltered. Dissipation: plastic work within one side of the section of where a member "
        "touches the obstacle, with what contact and friction take if only one obstacle presses; its target "
        "is at least 3 % of the energy put in. Taken by contact: in a multibody run, what impacts between "
        "rigid bodies take; in shells, what contact springs store and damp, and friction."
    )
    return Table(caption, ("", first.capitalize(), second.capitalize(), "Difference", "Target"), rows)


def _times(name: str, a: HingeMetrics | None, b: HingeMetrics | None, key: str) -> tuple[str, str, str, str]:
    """A row of two times; the difference is a time too."""
    values = [None if m is None else getattr(m, key) for m in (a, b)]
    difference = "—"
    if values[0] is not None and values[1] is not None:
        # zero has no sign
        late = round(1e3 * (values[0] - values[1]), 2) + 0.0
        difference = f"{late:+.2f} ms".replace("-", "−") if late else "0.00 ms"
    return (name, _value(values[0], "s"), _value(values[1], "s"), difference)


def _value(value: float | None, unit: str) -> str:
    if value is None or not math.isfinite(value):
        return "—"
    if unit == "rad" and abs(value) < NO_ROTATION:
        return "0°"
    if unit == "rad":
        return f"{degrees(value)}° ({number(value)} rad)"
    if unit == "s":
        return f"{1e3 * value:.2f} ms"
    return format_quantity(value, unit).replace("-", "−")


def rating_note(comparison: Comparison) -> str:
    """Edition, sampling, interval and reference of the ratings."""
    rated = [p.rating for p in comparison.pairs if p.rating is not None]
    if not rated:
        return "No pair of histories could be rated."
    starts, ends = {r.start for r in rated}, {r.end for r in rated}
    interval = (
        f"over {1e3 * min(starts):g} to {1e3 * max(ends):.4g} ms"
        if len(starts) == len(ends) == 1
        else "each over the common interval of both histories"
    )
    return (
        f"Rated after {EDITION}, both histories interpolated linearly at {SAMPLING_RATE / 1e3:g} kHz, "
        f"{interval}, "
        "unfiltered. 1 is full agreement; above 0.94 excellent, above 0.80 good, above 0.58 fair. Overall "
        "= 0.4 "
        "corridor + 0.2 phase + 0.2 magnitude + 0.2 slope."
    )


def rating_table(comparison: Comparison) -> Table:
    """Every rated pair."""
    rows = []
    for pair in comparison.pairs:
        rated = pair.rating
        unit, factor = display_unit(pair.unit, max(abs(pair.peak), abs(pair.reference_peak)))
        peaks = [f"{number(value / factor)} {unit}".strip() for value in (pair.peak, pair.reference_peak)]
        if rated is None:
            rows.append((pair.channel, pair.candidate, pair.reference, pair.why_not, "", *("—",) * 5, *peaks))
            continue
        parts = [f"{getattr(rated, part):.2f}" for part in _PARTS]
        shift = f"{1e3 * rated.shift:+.1f}".replace("-", "−")
        rows.append(
            (
                pair.channel,
                pair.candidate,
                pair.reference,
                f"{rated.overall:.3f}",
                rated.grade,
                *parts,
                shift,
                *peaks,
            )
        )
    heads = (
        "History", "Rated", "Against", "Overall", "Grade", "Corridor", "Phase", "Magnitude", "Slope",
        "Late by, ms", "Peak", "Peak of reference",
    )  # fmt: skip
    return Table(rating_note(comparison), heads, rows, frozenset({1, 2, 4}))


def opening_table(comparison: Comparison) -> Table:
    """Hinges that opened in either result: order, time, position."""
    rows = []
    both = {
        name: list(comparison.opened[name]) for name in (comparison.candidate.name, comparison.reference.name)
    }
    names = dict.fromkeys(o.name for opened in both.values() for o in opened)
    for name in names:
        cells = [name]
        for opened in both.values():
            place = next((i for i, o in enumerate(opened) if o.name == name), None)
            if place is None:
                cells += ["—", "—", "—"]
            else:
                o = opened[place]
                cells += [str(place + 1), f"{1e3 * o.time:.2f} ms", f"{o.member}, {1e3 * o.station:.0f} mm"]
        rows.append(tuple(cells))
    heads = ["Hinge or fold"]
    for source in both:
        heads += [f"Order, {source}", "Opened at", "Where"]
    return Table("Hinges that opened (0.5° of plastic rotation).", tuple(heads), rows, frozenset({3, 6}))


def model_table(comparison: Comparison) -> Table:
    """Every model against the reference: errors, ratings, solve time and ratio."""
    rows, second = [], comparison.reference
    hinge = ranked(comparison)[0] if comparison.hinges else None
    for source in comparison.sources:
        tables = {comparison.candidate.name: comparison.hinges, **comparison.variant_hinges}
        own = next(
            (h for h in tables.get(source.name, ()) if hinge is not None and h.name == hinge.name), None
        )
        cells = [source.name]
        for key in ("rotation_max", "far_rotation_max", "plastic_rotation"):
            cells.append("reference" if source is second else signed_percent(own.error(key) if own else None))
        errors = [abs(e) for e in (own.energy_errors() if own else ()) if e is not None]
        cells.append("reference" if source is second else f"{100 * max(errors):.1f} %" if errors else "—")
        for key in ("rotation", "rotation_rate"):
            pair = (
                pair_of(comparison, f"hinge.{hinge.name}.{key}", source.name, second.name) if hinge else None
            )
            cells.append("—" if pair is None or pair.rating is None else f"{pair.rating.overall:.3f}")
        chord = f"member.{hinge.member}.chord_rotation" if hinge else ""
        for key in ("", "_rate"):
            pair = pair_of(comparison, chord + key, source.name, second.name)
            cells.append("—" if pair is None or pair.rating is None else f"{pair.rating.overall:.3f}")
        rows.append(tuple(cells))
    of = f" of hinge {hinge.name}" if hinge else ""
    heads = (
        "Model", "Largest rotation", "at the far end", "Plastic rotation", "Plastic energy, largest error",
        "Rating, rotation", "velocity", "Rating, far end", "velocity",
    )  # fmt: skip
    return Table(f"Every model against the {second.name} run: errors{of} and ratings.", heads, rows)


def busy_note(comparison: Comparison) -> str:
    """Note that the threads of the reference waited, so that its solve time is too long; else empty."""
    share = comparison.busy_share
    if share is None or share > BUSY or comparison.reference.result.solve_seconds < LONG:
        return ""
    return (
        f"The threads of the {comparison.reference.name} run were busy for {100 * share:.0f} % of its solve "
        "time: other programs used the machine, or the mesh is too small for so many threads. The ratios of "
        "solve times are therefore too large."
    )


def speed_table(comparison: Comparison) -> Table:
    """Solve times of every model, and their ratios to the reference."""
    rows = []
    for source in comparison.sources:
        timing = comparison.timings.get(source.name)
        repeated = (None, None) if timing is None else (timing.again, timing.stepping)
        cells = [source.name, str(source.result.provenance.threads)]
        for seconds in (source.result.solve_seconds, *repeated):
            known = bool(seconds) and source is not comparison.reference
            cells.append(_seconds(seconds) if seconds else "—")
            cells.append(times_faster(comparison, seconds) if known else "—")
        rows.append(tuple(cells))
    waited = busy_note(comparison)
    caption = (
        "Wall time of every solve, and how many times faster it is than the "
        f"{comparison.reference.with_threads}. The first solve gives the result, in a process that has just "
        "been started; repeated solve is the shortest of several, with laws sampled again. Stepping only is "
        "the part that a sweep repeats, at the requested accuracy, without the run that checks the accuracy."
        + (f" {waited}" if waited else "")
    )
    heads = ("Model", "Threads", "First solve", "times", "Repeated solve", "times", "Stepping only", "times")
    return Table(caption, heads, rows)


def _seconds(seconds: float) -> str:
    return format_quantity(seconds, "s", 3)
