"""Rotation of a hinge at a mitred corner, or at a node in a tube: the folds of both members there together.

A multibody hinge at a corner stands for both legs, one at a node in a straight run for the fold on both
sides.  In shapes each member is measured by itself: the fold of the hinge's own member, and the fold of the
other one, which has no hinge there.  Their rotations add up.

The rotation of a hinge that bends about both axes is an angle without a sense.  The other leg's fold then
adds its own angle: both legs of a corner that closes or opens fold in one sense.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from crumple.comparison.measure.motion import HingeMotion, Measured, bends_two_ways
from crumple.section import AXES, half_fold_length
from crumple.structure import PlacedHinge, Structure
from crumple.structure.hinges.corner_laws import corner_laws, corner_name
from crumple.structure.hinges.straight_runs import straight_run

SUMMED = ("rotation", "rotation_rate", "plastic_rotation")
"""Histories whose values add up with the sense of the other member's axis; plastic work adds up without."""


@dataclass(frozen=True)
class _Site:
    """A node where the hinge of the first member stands for folds of both, up to a distance from it [m]."""

    node: str
    first: str
    second: str
    zone: float


def with_corners(seen: Measured, structure: Structure, hinges: Sequence[PlacedHinge]) -> Measured:
    """The same with the folds of both members added to the hinges at corners and at nodes of straight runs.

    Parameters
    ----------
    seen
        Measured in shapes, member by member.
    structure, hinges
        Hinges at corners are known by the structure's stored laws.
    """
    placed = {hinge.name: hinge for hinge in hinges}
    at = {
        corner_name(node): _Site(node, corner.first, corner.second, corner.zone(structure))
        for node, (corner, _) in corner_laws(structure).items()
    }
    at |= {hinge.name: site for hinge in hinges for site in _in_runs(structure, hinge)}
    rest, found = list(seen.extra), []
    for motion in seen.hinges:
        site = at.get(motion.name)
        both = motion
        for fold in [one for one in rest if site is not None and _beside(structure, site, one)]:
            assert site is not None
            both = _sum(both, fold, _sense(structure, site, placed[motion.name], fold))
            rest.remove(fold)
        found.append(both)
    return replace(seen, hinges=tuple(found), extra=tuple(rest))


def _in_runs(structure: Structure, hinge: PlacedHinge) -> Iterator[_Site]:
    """The node of a straight run within one fold of a hinge, if there is one."""
    run = straight_run(structure, hinge.member)
    section = structure.section_of(hinge.member)
    fold = 2.0 * max(half_fold_length(section, axis) for axis in AXES)
    along = run.stretches[hinge.member].along(hinge.station)
    for node, place in run.between.items():
        if abs(place - along) <= fold and node in structure.members[hinge.member].nodes:
            other = next(name for name in structure.members_at[node] if name != hinge.member)
            yield _Site(node, hinge.member, other, fold)


def _beside(structure: Structure, site: _Site, fold: HingeMotion) -> bool:
    """Whether a fold lies in the zone of a node, in either member."""
    if fold.member not in (site.first, site.second):
        return False
    at_start = structure.members[fold.member].nodes[0] == site.node
    length = structure.frame_of(fold.member).length
    away = fold.station if at_start else length - fold.station
    return away <= site.zone


def _sense(structure: Structure, site: _Site, hinge: PlacedHinge, fold: HingeMotion) -> float:
    """Sense in which the rotation of a fold in either member adds to that of the hinge in the first."""
    if bends_two_ways(hinge):
        return fold.sense
    if fold.member == hinge.member:
        return 1.0
    frame = structure.frame_of(site.second)
    along = max((float(frame.axis(axis) @ hinge.direction) for axis in ("y", "z")), key=abs)
    ends = structure.members[site.first].nodes[1] == site.node
    begins = structure.members[site.second].nodes[0] == site.node
    return float(np.sign(along)) * (1.0 if ends == begins else -1.0)


def _sum(motion: HingeMotion, fold: HingeMotion, sense: float) -> HingeMotion:
    added = {key: getattr(motion, key) + sense * getattr(fold, key) for key in SUMMED}
    where = f"Sum of both members at the node. {motion.how} {fold.how}"
    return replace(
        motion, **added, plastic_work=motion.plastic_work + fold.plastic_work, how=where, fold=True
    )
