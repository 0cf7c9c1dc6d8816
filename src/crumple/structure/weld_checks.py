"""Mistakes of spot welds: members that do not exist, places outside them, sections without lines of welds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from crumple.errors import Problem
from crumple.structure.problems import one_of, outside, unknown
from crumple.structure.spot_welds import MOST_SPOTS
from crumple.structure.structure import Structure


def spot_weld_problems(structure: Structure, known: Mapping[str, set[str]]) -> Iterator[Problem]:
    """Mistakes of a structure's spot welds."""
    for name, welds in structure.spot_welds.items():
        where = f"spot_welds.{name}"
        for i, member in enumerate(welds.members):
            yield from unknown("member", member, known["members"], f"{where}.members[{i}]")
        first = welds.members[0]
        if not structure.has_line(first):
            continue
        length = structure.frame_of(first).length
        for key, station in (("from", welds.start), ("to", welds.end)):
            if station is not None and station > length * (1.0 + 1e-9):
                yield outside(f"{where}.{key}", station, length)
        if welds.start >= length and welds.end is None:
            yield outside(f"{where}.from", welds.start, length)
        if welds.pitch is not None and (welds.end or length) - welds.start > MOST_SPOTS * welds.pitch:
            came, todo = f"{1e3 * welds.pitch:g} mm", "give a larger pitch"
            what, allowed = "the line has too many spots", f"at most {MOST_SPOTS}"
            yield Problem(what, came, allowed, todo, f"{where}.pitch")
        else:
            yield from _crowded(structure, name)
        if len(welds.members) == 1 and has_weld_lines(structure, first) is False:
            what = f"the section of member '{first}' has no lines of spot welds"
            welded = [other for other in structure.members if has_weld_lines(structure, other)]
            todo = "name the member that it is welded to as well, or give its section 'welds'"
            yield Problem(what, structure.members[first].section, one_of(welded), todo, f"{where}.members")


def _crowded(structure: Structure, name: str) -> Iterator[Problem]:
    """Spots of an entry nearer to each other than the wall is thick: one would carry all until it fails."""
    welds = structure.spot_welds[name]
    members = [structure.members[member] for member in welds.members if member in structure.members]
    specs = [structure.sections[member.section] for member in members if member.section in structure.sections]
    least = min((spec.section().thickness for spec in specs), default=0.0)
    allowed, came = f"at least {1e3 * least:.3g} mm apart, the thickness of the wall", ""
    if not welds.points:
        stations = welds.stations(structure.frame_of(welds.members[0]).length)
        if len(stations) > 1 and stations[1] - stations[0] < least:
            came, key, todo = f"{1e3 * (stations[1] - stations[0]):.3g} mm", "pitch", "give a larger pitch"
    points = np.array(welds.points, float).reshape(-1, 3)
    for i, point in enumerate(points[1:], 1):
        apart = float(np.linalg.norm(points[:i] - point, axis=1).min())
        if apart < least:
            came, key, todo = f"{1e3 * apart:.3g} mm", f"points[{i}]", "leave one of them out"
            break
    if came:
        yield Problem("spots lie nearer than two can", came, allowed, todo, f"spot_welds.{name}.{key}")


def pitch_problems(structure: Structure) -> Iterator[Problem]:
    """A pitch of the shell settings that no line of spots takes."""
    own = {welds.members[0] for welds in structure.spot_welds.values() if len(welds.members) == 1}
    found = {name: has_weld_lines(structure, name) for name in structure.members}
    if None in found.values() or any(lines and name not in own for name, lines in found.items()):
        return
    what = "there is no line of spot welds that would take this pitch"
    allowed = "sections with lines of welds, of members that have no 'spot_welds' of their own"
    todo = "take it away; spots between members have a pitch in 'spot_welds'"
    yield Problem(what, "", allowed, todo, "analysis.shell.weld_pitch")


def has_weld_lines(structure: Structure, member: str) -> bool | None:
    """Whether a member's section has lines of spot welds; None where there is no such section."""
    spec = structure.sections.get(structure.members[member].section)
    return None if spec is None else bool(getattr(spec.section(), "welds", ()))
