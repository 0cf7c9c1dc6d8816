"""Stretches of a bar of an open section between which torque acts.

A torque T that acts at the distances a and b from two ends that cannot warp turns both parts against each
other.  The plastic mechanism has bimoments at both ends and at the torque; with the plastic one, B_p, and the
torque T_s of the walls in themselves

    T = 2 B_p (1/a + 1/b) + 2 T_s,

which is that of two members between ends that cannot warp.  Elastically this holds where a = b; else their
stiffness is too large, by 4 (a^3 + b^3)/(a + b)^3 if warping governs (1.75 where a = 3 b).  Derived here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from crumple.hinge.torsion.warping import HeldEnds
from crumple.section import AXES, half_fold_length
from crumple.structure.hinges.flexibility import tributary_lengths
from crumple.structure.hinges.runs.bars import rigid_along
from crumple.structure.hinges.runs.straight_runs import StraightRun
from crumple.structure.hinges.shares import warping_span
from crumple.structure.parts import StructureParts
from crumple.structure.struck_members import places_struck_by_members
from crumple.structure.struck_places import struck_places


@dataclass(frozen=True)
class TwistingStretch:
    """Part of a bar of an open section between its ends and places where something strikes it.

    Attributes
    ----------
    start, end
        Distances from the start of the bar [m].
    rigid
        Rigid parts of the bar, as (start, end) [m].
    held_ends
        Which of its ends cannot warp.
    """

    start: float
    end: float
    rigid: tuple[tuple[float, float], ...]
    held_ends: HeldEnds

    @property
    def span(self) -> float:
        """Length that twists [m]."""
        return self.end - self.start - sum(b - a for a, b in self._inside)

    def shared(self, places: Sequence[float]) -> list[tuple[float, float]]:
        """Places within it with the length that each stands for [m]."""
        inside = tuple((a - self.start, b - self.start) for a, b in self._inside)
        own = [at - self.start for at in places]
        return list(zip(places, tributary_lengths(own, self.end - self.start, inside), strict=True))

    @property
    def _inside(self) -> list[tuple[float, float]]:
        parts = [(max(a, self.start), min(b, self.end)) for a, b in self.rigid]
        return [(a, b) for a, b in parts if b > a]


def twisting_stretches(
    structure: StructureParts, bar: StraightRun, joints: Sequence[float]
) -> list[TwistingStretch]:
    """Stretches of a bar between its ends and the places where something strikes it.

    Torque that acts between the ends turns both parts against each other: its place does not warp where both
    are alike, and in the plastic mechanism of any two.

    Parameters
    ----------
    structure, bar
        As of `bar_of`.
    joints
        Places at which the bar may twist, from its start [m]; each stretch has one.
    """
    rigid, (_, held_ends) = rigid_along(structure, bar), warping_span(structure, bar)
    places: set[float] = set()
    for name, stretch in bar.stretches.items():
        struck = (*struck_places(structure, name), *places_struck_by_members(structure, name))
        places |= {stretch.along(place.station) for place in struck}
    section = structure.section_of(bar.first)
    least = 2.0 * max(half_fold_length(section, axis) for axis in AXES)
    ends = [0.0]
    for at in sorted(places):
        parts = (ends[-1], at), (at, bar.length)
        if all(b - a > least and any(a < joint < b for joint in joints) for a, b in parts):
            ends.append(at)
    ends.append(bar.length)
    if len(ends) == 2:
        return [TwistingStretch(0.0, bar.length, rigid, held_ends)]
    held = [node in structure.loaded_nodes or len(structure.members_at[node]) > 1 for node in bar.nodes]
    free = [not held[0], *([False] * (len(ends) - 2)), not held[1]]
    return [
        TwistingStretch(ends[i], ends[i + 1], rigid, "one" if free[i] or free[i + 1] else "both")
        for i in range(len(ends) - 1)
    ]
