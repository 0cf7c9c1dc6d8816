"""Mistakes of spot welds: members that do not exist, places outside them, sections without lines of welds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

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
        if len(welds.members) == 1 and has_weld_lines(structure, first) is False:
            what = f"the section of member '{first}' has no lines of spot welds"
            welded = [other for other in structure.members if has_weld_lines(structure, other)]
            todo = "name the member that it is welded to as well, or give its section 'welds'"
            yield Problem(what, structure.members[first].section, one_of(welded), todo, f"{where}.members")


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
