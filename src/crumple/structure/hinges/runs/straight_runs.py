"""Straight runs: members in line that are one tube, divided by nodes at which nothing else happens.

A fold does not know of such a node.  Candidates on both sides of it would each take the rotation that a fold
takes before it softens, and with it the work of two folds where the shells have one.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Mapping
from dataclasses import dataclass

from crumple.structure.hinges.asked import automatic_of
from crumple.structure.hinges.corners import continues
from crumple.structure.parts import StructureParts


@dataclass(frozen=True)
class Stretch:
    """A member's part of a straight run.

    Attributes
    ----------
    start
        Distance of its near end from the start of the run [m].
    length
        [m].
    forward
        Whether it leads along the run.
    """

    start: float
    length: float
    forward: bool

    def along(self, station: float) -> float:
        """Distance from the start of the run [m] of a place at a distance from the member's first node."""
        return self.start + (station if self.forward else self.length - station)

    def station(self, along: float) -> float:
        """Distance from the member's first node [m] of a place at a distance from the start of the run."""
        return along - self.start if self.forward else self.start + self.length - along


@dataclass(frozen=True)
class StraightRun:
    """Members in line that are one tube, in their order along it.

    Attributes
    ----------
    stretches
        Their parts of it, by name.
    nodes
        At its ends.
    between
        Nodes inside, by their distance from its start [m].
    first, length
        Its first member, whose section and materials all have, and the length of all [m].
    """

    stretches: Mapping[str, Stretch]
    nodes: tuple[str, str]
    between: Mapping[str, float]
    first: str
    length: float

    @property
    def ends(self) -> tuple[tuple[str, str], tuple[str, str]]:
        """Member and node at its start and at its end."""
        names = list(self.stretches)
        return (names[0], self.nodes[0]), (names[-1], self.nodes[1])

    def member_at(self, along: float) -> str:
        """Member at a distance from the start [m]; at a node the one before."""
        return list(self.stretches)[bisect_left(list(self.between.values()), along)]


def straight_run(structure: StructureParts, member: str) -> StraightRun:
    """The run that a member is part of; often its only member.

    Members of a run have automatic hinges, asked for alike.  The run leads along its first member in the
    order of the structure.
    """
    return structure.kept.once("straight runs", "", lambda: _straight_runs(structure))[member]


def _straight_runs(structure: StructureParts) -> Mapping[str, StraightRun]:
    found: dict[str, StraightRun] = {}
    for member, spec in structure.members.items():
        if member in found or not structure.has_line(member):
            continue
        before, first = _onwards(structure, [member], spec.nodes[0])
        # a ring of small kinks is all before
        after, last = _onwards(structure, [*reversed(before), member], spec.nodes[1])
        names = [*reversed(before), member, *after]
        run = _run(structure, names, (first, last))
        found |= dict.fromkeys(run.stretches, run)
    return found


def _onwards(structure: StructureParts, so_far: list[str], node: str) -> tuple[list[str], str]:
    """Further members of a run beyond a node at the end of its last one, and the node at which it ends."""
    last, found = so_far[-1], dict.fromkeys(so_far)
    while True:
        further = [name for name in structure.members_at[node] if name != last]
        if len(further) != 1 or further[0] in found or not _is_one_tube(structure, node, last, further[0]):
            return list(found)[len(so_far) :], node
        last = further[0]
        found[last] = None
        first, second = structure.members[last].nodes
        node = second if node == first else first


def _is_one_tube(structure: StructureParts, node: str, one: str, other: str) -> bool:
    asked = automatic_of(structure, one)
    if asked is None or asked != automatic_of(structure, other):
        return False
    alike = bool(structure.members[one].elastic) == bool(structure.members[other].elastic)
    return alike and continues(structure, node)


def _run(structure: StructureParts, names: list[str], nodes: tuple[str, str]) -> StraightRun:
    stretches: dict[str, Stretch] = {}
    between: dict[str, float] = {}
    node, place = nodes[0], 0.0
    for name in names:
        first, second = structure.members[name].nodes
        stretches[name] = Stretch(place, structure.frame_of(name).length, node == first)
        place += stretches[name].length
        node = second if node == first else first
        between[node] = place
    between.pop(nodes[1])
    return StraightRun(stretches, nodes, between, names[0], place)
