"""Rotation of a hinge at a mitred corner: the folds of both members near the node together.

A multibody hinge at a corner stands for both legs.  In shapes each leg is measured by itself: the fold of the
hinge's own member, and the fold of the other one, which has no hinge there.  Their rotations add up.

The rotation of a hinge that bends about both axes is an angle without a sense.  The other leg's fold then
adds its own angle: both legs of a corner that closes or opens fold in one sense.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from crumple.comparison.measure.motion import HingeMotion, Measured, bends_two_ways
from crumple.structure import PlacedHinge, Structure
from crumple.structure.hinges.corner_laws import corner_laws, corner_name
from crumple.structure.hinges.corners import Corner

SUMMED = ("rotation", "rotation_rate", "plastic_rotation")
"""Histories whose values add up with the sense of the other member's axis; plastic work adds up without."""


def with_corners(seen: Measured, structure: Structure, hinges: Sequence[PlacedHinge]) -> Measured:
    """The same with the folds of both legs added to the hinges at corners.

    Parameters
    ----------
    seen
        Measured in shapes, member by member.
    structure, hinges
        Hinges at corners are known by the structure's stored laws.
    """
    at = {corner_name(node): corner for node, (corner, _) in corner_laws(structure).items()}
    placed = {hinge.name: hinge for hinge in hinges}
    rest, found = list(seen.extra), []
    for motion in seen.hinges:
        corner = at.get(motion.name)
        both = motion
        for fold in [one for one in rest if corner is not None and _beside(structure, corner, one)]:
            assert corner is not None
            both = _sum(both, fold, _sense(structure, corner, placed[motion.name], fold))
            rest.remove(fold)
        found.append(both)
    return replace(seen, hinges=tuple(found), extra=tuple(rest))


def _beside(structure: Structure, corner: Corner, fold: HingeMotion) -> bool:
    """Whether a fold lies in the zone of a corner, in either member."""
    if fold.member not in (corner.first, corner.second):
        return False
    at_start = structure.members[fold.member].nodes[0] == corner.node
    length = structure.frame_of(fold.member).length
    away = fold.station if at_start else length - fold.station
    return away <= corner.zone(structure)


def _sense(structure: Structure, corner: Corner, hinge: PlacedHinge, fold: HingeMotion) -> float:
    """Sense in which the rotation of a fold in either member adds to that of the hinge in the first."""
    if bends_two_ways(hinge):
        return fold.sense
    if fold.member == hinge.member:
        return 1.0
    frame = structure.frame_of(corner.second)
    along = max((float(frame.axis(axis) @ hinge.direction) for axis in ("y", "z")), key=abs)
    ends = structure.members[corner.first].nodes[1] == corner.node
    begins = structure.members[corner.second].nodes[0] == corner.node
    return float(np.sign(along)) * (1.0 if ends == begins else -1.0)


def _sum(motion: HingeMotion, fold: HingeMotion, sense: float) -> HingeMotion:
    added = {key: getattr(motion, key) + sense * getattr(fold, key) for key in SUMMED}
    where = f"Sum of both members at the corner. {motion.how} {fold.how}"
    return replace(
        motion, **added, plastic_work=motion.plastic_work + fold.plastic_work, how=where, fold=True
    )
