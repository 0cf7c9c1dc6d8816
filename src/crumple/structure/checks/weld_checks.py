"""Mistakes of spot welds: members that do not exist, places outside them, sections without lines of welds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from crumple.errors import Problem
from crumple.structure.parts import StructureParts
from crumple.structure.schema.problems import Names, one_of, outside, unknown
from crumple.structure.weld_room import spot_places, widest_spot


def spot_weld_problems(structure: StructureParts, known: Mapping[str, Names]) -> Iterator[Problem]:
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
        yield from _crowded(structure, name)
        if _placed(structure, name):
            yield from _too_wide(structure, name)
        if len(welds.members) == 1 and has_weld_lines(structure, first) is False:
            what = f"the section of member '{first}' has no lines of spot welds"
            welded = [other for other in structure.members if has_weld_lines(structure, other)]
            todo = "give the other member too, or give its section 'welds'"
            yield Problem(what, structure.members[first].section, one_of(welded), todo, f"{where}.members")
    yield from _twice_welded(structure)


def _crowded(structure: StructureParts, name: str) -> Iterator[Problem]:
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
            came, key, todo = f"{1e3 * apart:.3g} mm", f"points[{i}]", "remove one of them"
            break
    if came:
        yield Problem(
            "the distance of the spot welds is too small", came, allowed, todo, f"spot_welds.{name}.{key}"
        )


def _too_wide(structure: StructureParts, name: str) -> Iterator[Problem]:
    """A diameter that the walls have no room for."""
    welds = structure.spot_welds[name]
    if not welds.diameter:
        return
    widest, member = widest_spot(structure, name)
    # a spot that reaches an edge, or a bend drawn sharp, still lies on its wall
    if welds.diameter > widest + structure.section_of(member).thickness:
        what, came = (
            "the diameter of the spot welds is larger than the wall allows",
            f"{1e3 * welds.diameter:.4g} mm",
        )
        allowed = (
            f"at most {1e3 * widest:.3g} mm, twice the distance to the nearer wall edge of member '{member}'"
        )
        todo = "give the diameter of a spot, or place the spots farther inside"
        yield Problem(what, came, allowed, todo, f"spot_welds.{name}.diameter")


def _placed(structure: StructureParts, name: str) -> bool:
    """Whether the spots of an entry have places: its members, their sections and weld lines are there."""
    members = structure.spot_welds[name].members
    if not all(structure.has_line(member) for member in members):
        return False
    lines = [has_weld_lines(structure, member) for member in members]
    return None not in lines and (len(members) > 1 or lines[0] is True)


def _twice_welded(structure: StructureParts) -> Iterator[Problem]:
    """Spots of two entries that tie the same walls at one place."""
    entries = [(name, welds) for name, welds in structure.spot_welds.items() if _placed(structure, name)]
    places = {name: spot_places(structure, name) for name, _ in entries}
    for i, (name, welds) in enumerate(entries):
        least = min(structure.section_of(member).thickness for member in welds.members)
        for other, others in entries[:i]:
            if set(welds.members) != set(others.members):
                continue
            apart = [float(np.linalg.norm(places[other] - place, axis=1).min()) for place in places[name]]
            near = [k for k, distance in enumerate(apart) if distance < least]
            if not near:
                continue
            x, y, z = 1e3 * places[name][near[0]]
            many = f"{len(near)} of its {len(apart)} spots lie"
            what = f"{many} where spots of '{other}' tie the same members already"
            came = f"{1e3 * apart[near[0]]:.3g} mm apart at ({x:.6g}, {y:.6g}, {z:.6g}) mm"
            allowed = f"at least {1e3 * least:.3g} mm apart, the thickness of the wall"
            yield Problem(what, came, allowed, "remove one of them", f"spot_welds.{name}")


def pitch_problems(structure: StructureParts) -> Iterator[Problem]:
    """A pitch of the shell settings that no line of spots takes."""
    own = {welds.members[0] for welds in structure.spot_welds.values() if len(welds.members) == 1}
    found = {name: has_weld_lines(structure, name) for name in structure.members}
    if None in found.values() or any(lines and name not in own for name, lines in found.items()):
        return
    what = "there is no line of spot welds for this pitch"
    allowed = "sections with lines of welds, of members that have no 'spot_welds' of their own"
    todo = "remove it; spots between members have a pitch in 'spot_welds'"
    yield Problem(what, "", allowed, todo, "analysis.shell.weld_pitch")


def has_weld_lines(structure: StructureParts, member: str) -> bool | None:
    """Whether a member's section has lines of spot welds; None where there is no such section."""
    spec = structure.sections.get(structure.members[member].section)
    return None if spec is None else bool(getattr(spec.section(), "welds", ()))
