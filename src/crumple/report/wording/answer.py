"""What the page says first: three sentences, and cautions with alike ones in one line."""

from __future__ import annotations

import re
from collections.abc import Sequence

from crumple.numeric.ranking import largest_first
from crumple.report.wording.key_figures import ROUNDING, between_hinges, crush_matters, rounding
from crumple.report.wording.wording import Verdict, degrees, percent
from crumple.result import Result
from crumple.units import format_quantity

MOST_CAUTIONS = 5
"""Lines of cautions before the pictures; the others are folded."""
_NUMBER = re.compile(r"[-−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def three_sentences(result: Result, verdict: Verdict) -> list[str]:
    """What was absorbed and where; how far it went; whether it can be trusted."""
    absorbed = " ".join(part for part in (_absorbed(result), _dented(result), _crumpled(result)) if part)
    return [part for part in (absorbed, _reached(result), " ".join(verdict.reasons)) if part]


def one_mode(result: Result) -> list[str]:
    """A sentence if an impact takes one mode alone; several are a caution."""
    return [result.modes.sentence] if result.modes is not None and result.modes.unique else []


def _absorbed(result: Result) -> str:
    channel = result.channels.get("energy.dissipated")
    if channel is None or not len(channel.values) or not channel.values[-1] > rounding(result):
        return ""
    absorbed = float(channel.values[-1])
    total = format_quantity(absorbed, "J")
    if not result.hinges:
        return f"The structure absorbed {total}."
    name = largest_first({name: hinge.energy for name, hinge in result.hinges.items()})[0]
    most = result.hinges[name]
    rest = between_hinges(result)
    if not most.energy > 0.0 or (len(result.hinges) == 1 and not rest > 0.0):
        return f"The structure absorbed {total}."
    folded = sum(hinge.energy for hinge in result.hinges.values()) + sum(dent.energy for dent in result.dents)
    dents = " and dents" if result.dents else ""
    where, share = f"{len(result.hinges)} hinges{dents}", f"{percent(most.energy / folded)} of it in {name}"
    if not rest > 0.0 and folded <= (1.0 + ROUNDING) * absorbed:
        return f"The structure absorbed {total} in {where}, {share}."
    one = len(result.hinges) == 1
    parts = f"{format_quantity(folded, 'J')} in {f'hinge {name}{dents}' if one else f'{where} ({share})'}"
    if not rest > 0.0:
        return f"The structure absorbed {parts}."
    more = format_quantity(rest, "J")
    return f"The structure absorbed {total}: {parts} and {more} along members that yield between hinges."


def _dented(result: Result) -> str:
    dents = result.dents
    if not dents:
        return ""
    energy = format_quantity(sum(dent.energy for dent in dents), "J")
    depth = format_quantity(max(dent.depth for dent in dents), "m", 3)
    what = f"A dent in {dents[0].member}" if len(dents) == 1 else f"{len(dents)} dents"
    return f"{what} of up to {depth} took {energy} of it."


def _crumpled(result: Result) -> str:
    ends = result.crumpled_ends
    if not ends:
        return ""
    energy = format_quantity(sum(end.energy for end in ends), "J")
    what = f"end {ends[0].node}" if len(ends) == 1 else f"{len(ends)} ends"
    return f"A further {energy} crumpled {what} of members at obstacles."


def _reached(result: Result) -> str:
    zones = {
        name: hinge.crush
        for name, hinge in result.hinges.items()
        if hinge.crush is not None and crush_matters(result)
    }
    crushed = largest_first({name: zone.length for name, zone in zones.items() if zone.length > 0.0})
    if crushed:
        name, zone = crushed[0], zones[crushed[0]]
        length, mean, peak = (
            format_quantity(value, unit)
            for value, unit in ((zone.length, "m"), (zone.mean_force, "N"), (zone.peak_force, "N"))
        )
        closed = ", until its folds were closed" if zone.bottomed_out else ""
        return f"{name} was crushed by {length}{closed}, at a mean force of {mean} and a peak of {peak}."
    bending = {name: hinge for name, hinge in result.hinges.items() if hinge.bends}
    if not bending:
        return ""
    name = largest_first({name: hinge.rotation_max for name, hinge in bending.items()})[0]
    most = bending[name]
    rest = "still turning at the end"
    if most.time_of_rest is not None:
        rest = f"at rest after {format_quantity(most.time_of_rest, 's')}"
    moment = format_quantity(most.moment_max, "N*m")
    return f"{name} turned farthest, by {degrees(most.rotation_max)}°, at up to {moment}, {rest}."


def members_of(result: Result) -> list[str]:
    """Names of the members of which the result knows."""
    return list(result.states.member_names) if result.states is not None else []


def grouped(warnings: Sequence[str], names: Sequence[str]) -> list[str]:
    """Warnings, those that differ in a name and in numbers only as one line with the other names.

    Parameters
    ----------
    warnings
        Sentences, the most important first.
    names
        Of hinges and members.
    """
    listed = sorted(filter(None, set(names)), key=len, reverse=True)
    pattern = re.compile("|".join(rf"(?<![\w-]){re.escape(n)}(?![\w-])" for n in listed)) if listed else None
    groups: dict[str, list[tuple[str, str]]] = {}
    for warning in warnings:
        found = pattern.search(warning) if pattern else None
        bare = pattern.sub("\0", warning) if pattern else warning
        key = _NUMBER.sub("#", bare) if found else warning
        groups.setdefault(key, []).append((warning, found[0] if found else ""))
    lines = []
    for members in groups.values():
        first, *others = members
        also = [name for _, name in others if name and name != first[1]]
        lines.append(first[0] + (f" The same of {', '.join(dict.fromkeys(also))}." if also else ""))
        # alike ones without a further name are repetitions with other numbers: they stay
        lines += [text for text, name in others if name == first[1] and text != first[0]]
    return lines
