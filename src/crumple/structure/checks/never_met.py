"""Obstacles that no member can come to: the motion before the first contact is known without solving.

A structure on which no load, gravity, impulse or driven support acts stays at rest, or moves with the one
velocity that all of it has at the start, until it meets an obstacle.  If it meets none on this path within
the run, it meets none at all.  Supports that hold only what this velocity does not have change nothing.  In
all other cases nothing is said.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.checks.obstacle_checks import prescribed
from crumple.structure.keys.obstacles import Obstacle, PlaneObstacle, gap
from crumple.structure.parts import StructureParts
from crumple.text.names import listed
from crumple.units import format_quantity

LOOKS = 101
"""Times at which the distances are computed, and within whose steps nothing is taken to be known."""
PLACES = 11
"""Places along a member at which they are; between two, half their distance is left."""


def never_met(structure: StructureParts, duration: float) -> Iterator[str]:
    """One sentence if no member meets an obstacle in a run of one dynamic stage.

    Parameters
    ----------
    structure
        Checked.
    duration
        Of the run [s].
    """
    velocity = _common_velocity(structure)
    times = np.linspace(0.0, duration, LOOKS)[:, None]
    if velocity is None or any(obstacle.turning for obstacle in structure.obstacles.values()):
        return
    paths = {name: _path(one, times) - times * velocity for name, one in structure.obstacles.items()}
    if not any(path.any() for path in paths.values()):
        return
    left = {name for name, path in paths.items() if _leaves(structure, name, path)}
    clearances = (_clearance(structure, name, path) for name, path in paths.items() if name not in left)
    apart = min(clearances, default=np.inf)
    if apart > 0.0:
        away = f"is always more than {format_quantity(apart, 'm', 2)} away" if not left else "comes no nearer"
        one, moves = len(paths) == 1, "only its velocity at the start" if velocity.any() else "nothing"
        yield (
            f"Obstacle{'' if one else 's'} {listed(paths)} {'is' if one else 'are'} met by no member in "
            f"{format_quantity(duration, 's', 3)}: {moves} moves the structure, which {away}. Check place, "
            "direction and velocity, of the structure too, and the duration."
        )


def _common_velocity(structure: StructureParts) -> Floats | None:
    """Velocity of the whole structure before the first contact [m/s], (3,); None if it is not known."""
    fields = structure.initial_velocity
    acting = structure.loads or structure.impulses or any(structure.gravity) or len(fields) > 1
    if acting or any(support.driven for support in structure.supports.values()):
        return None
    if not fields:
        return np.zeros(3)
    (field,) = fields
    velocity = np.asarray(field.translation, float)
    held = {freedom for support in structure.supports.values() for freedom in support.held}
    stopped = any(velocity["xyz".index(freedom)] != 0.0 for freedom in held if freedom in "xyz")
    return None if not field.everywhere or field.rotation or stopped else velocity


def _path(obstacle: Obstacle, times: Floats) -> Floats:
    """Displacement of an obstacle that meets nothing [m], (n, 3)."""
    path = times * np.asarray(obstacle.velocity, float)
    for key, function in prescribed(obstacle):
        path[:, "xyz".index(key[-1])] += function(times[:, 0])
    return np.asarray(path)


def _leaves(structure: StructureParts, name: str, path: Floats) -> bool:
    """Whether an obstacle is a plane in front of which all members are and whose path, (n, 3), leads away."""
    obstacle = structure.obstacles[name]
    if not isinstance(obstacle, PlaneObstacle):
        return False
    normal = np.asarray(obstacle.normal, float)
    members = structure.members if obstacle.members is None else obstacle.members
    nodes = np.array([structure.nodes[node] for one in members for node in structure.members[one].nodes])
    in_front = float(((nodes - np.asarray(obstacle.point)) @ normal).min()) >= 0.0
    return in_front and float((path @ normal).max()) <= 0.0


def _clearance(structure: StructureParts, name: str, path: Floats) -> float:
    """Least distance [m] of an obstacle on its path, (n, 3), from members at the start, less all doubt."""
    obstacle, found = structure.obstacles[name], np.inf
    step = float(np.linalg.norm(np.diff(path, axis=0), axis=1).max())
    for member in structure.members if obstacle.members is None else obstacle.members:
        frame = structure.frame_of(member)
        reach = float(np.linalg.norm(structure.section_of(member).outer_outline(), axis=1).max())
        points = frame.origin + np.linspace(0.0, frame.length, PLACES)[:, None] * frame.x
        doubt = reach + step + frame.length / (2.0 * (PLACES - 1))
        found = min(found, float(gap(obstacle, points - path[:, None]).min()) - doubt)
    return found
