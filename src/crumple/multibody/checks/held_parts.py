"""Warnings for moving obstacles that pass through held parts of members with which they have no contact.

A held part is the ground, and a driven obstacle is given: no force between them could change anything.  Those
with a mass are stopped by held parts, except those that fold along the member.  What hangs on the held part
may then be pressed where it cannot give way, at the axis of its hinge.  Looked at is translation at the
output times; planes with an edge and obstacles that turn are left out.
"""

from __future__ import annotations

import numpy as np

from crumple._core.outcome import Outcome
from crumple._core.spatial.model import SpatialCapsule
from crumple.multibody.answer.solved import Solved
from crumple.multibody.bodies.capsules import member_capsules, pieces_by_length
from crumple.multibody.bodies.crossing import segment_distance
from crumple.multibody.bodies.linkage import link
from crumple.numeric.arrays import Floats
from crumple.structure import CylinderObstacle, Obstacle, PlaneObstacle, SphereObstacle, Structure
from crumple.units import format_quantity

DEPTH = 1e-6
"""Depth [m] up to which an obstacle counts as touching only."""
LONG = 1e3
"""Half-length [m] used for a cylinder without ends."""


def held_part_warnings(structure: Structure, solved: Solved) -> list[str]:
    """A sentence for every moving obstacle that passes through held parts while it presses on other parts."""
    channels = {channel.name: channel.values for channel in solved.further}
    found = []
    # pressing on it may end the run as soon as the surfaces meet, before there is a force
    ended, last = solved.outcome is not Outcome.COMPLETE, len(solved.time) - 1
    deepest = np.full(len(solved.time), -DEPTH)
    if ended:
        deepest[last] = DEPTH
    all_parts = member_capsules(structure, solved.poses.pieces, held=True)
    folding = pieces_by_length(link(structure), fixed=False)
    passed_by_masses = member_capsules(structure, folding, held=True)
    for name, obstacle in structure.obstacles.items():
        if f"obstacle.{name}.displacement.x" not in channels or obstacle.turning is not None:
            continue
        travel = np.stack([channels[f"obstacle.{name}.displacement.{axis}"] for axis in "xyz"], axis=1)
        force = np.stack([channels[f"obstacle.{name}.force.{axis}"] for axis in "xyz"], axis=1)
        met: dict[str, int] = {}  # output at which it is first inside a member's held part
        parts_met = all_parts if obstacle.mass is None else passed_by_masses
        for capsule, member in zip(*parts_met, strict=True):
            if obstacle.members is not None and member not in obstacle.members:
                continue
            gaps = _gaps(obstacle, travel, capsule)
            inside = np.flatnonzero(gaps < deepest[: len(gaps)])
            if inside.size and (force[inside[0] :].any() or (ended and inside[0] == last)):
                met[member] = min(int(inside[0]), met.get(member, len(travel)))
        if met:
            since = format_quantity(float(solved.time[min(met.values())]), "s", 3)
            parts = f"held parts of {', '.join(f'member {m}' for m in met)}"
            only_met = min(met.values()) == last
            how = f"meets {parts} at {since}" if only_met else f"passes through {parts} from {since} on"
            found.append(
                f"Obstacle {name} {how}: "
                "held parts have no contact, so it loads only the moving parts, perhaps where these "
                "cannot move. Use a sphere or cylinder that reaches the moving parts only, or a shorter run."
            )
    return found


def _gaps(obstacle: Obstacle, travel: Floats, capsule: SpatialCapsule) -> Floats:
    """Distance of the surfaces [m] at every output; none for a plane with an edge."""
    ends = np.asarray(capsule.first, float), np.asarray(capsule.second, float)
    if isinstance(obstacle, PlaneObstacle):
        if obstacle.edge is not None:
            return np.zeros(0)
        normal = np.asarray(obstacle.normal, float) / np.linalg.norm(obstacle.normal)
        nearest = min(float(normal @ (end - np.asarray(obstacle.point))) for end in ends)
        return np.asarray(nearest - capsule.radius - travel @ normal)
    assert isinstance(obstacle, CylinderObstacle | SphereObstacle)
    half = np.zeros(3)
    if isinstance(obstacle, CylinderObstacle):
        axis = np.asarray(obstacle.axis, float)
        half = axis / np.linalg.norm(axis) * (obstacle.length / 2.0 if obstacle.length else LONG)
    centre = np.asarray(obstacle.point, float) + travel
    apart = segment_distance((centre - half, centre + half), ends)
    return np.asarray(apart - obstacle.radius - capsule.radius)
