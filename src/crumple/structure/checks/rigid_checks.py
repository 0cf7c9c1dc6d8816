"""Mistakes of rigid members: parts outside them, hinges that could not turn."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from crumple.errors import Problem
from crumple.structure.checks.hinge_checks import sound_members
from crumple.structure.hinges.places import member_hinge_places
from crumple.structure.parts import StructureParts
from crumple.structure.schema.problems import Names, outside

AT_END = 1e-9
"""Share of a member within which a hinge lies at the end of a rigid part, where the next part can fold."""


def rigid_problems(structure: StructureParts, known: Mapping[str, Names]) -> Iterator[Problem]:
    """Rigid parts that are not on their member, and hinges in rigid parts."""
    for name in sound_members(structure):
        member, length = structure.members[name], structure.frame_of(name).length
        if not isinstance(member.rigid, bool):
            for i, part in enumerate(member.rigid):
                if part.end > length * (1.0 + AT_END):
                    yield outside(f"members.{name}.rigid[{i}].to", part.end, length)
        parts = member.rigid_parts(length)
        found = set()
        for place in member_hinge_places(structure, name) if parts else ():
            at, tolerance = place.station, AT_END * length
            inside = any(
                (a < at - tolerance or a == 0.0) and (at + tolerance < b or b >= length) and a <= at <= b
                for a, b in parts
            )
            if inside and place.where not in found:
                found.add(place.where)
                what = f"the hinge '{place.name}' lies in a rigid part of member '{name}'"
                todo = "move the hinge, or let this part deform"
                came, allowed = f"{1e3 * at:.6g} mm", "hinges where the member can fold"
                yield Problem(what, came, allowed, todo, place.where)
