"""Obstacles as the stepper takes them: shape, motion of this stage, and the wall nodes that can touch."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from crumple._core.shell.model import History
from crumple._core.shell.simulation import RigidObstacle, Shape, ShellState
from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Integers
from crumple.shell.mesh.contour import triple
from crumple.shell.mesh.mesh import Mesh
from crumple.shell.model.drives import velocity_of
from crumple.structure import CylinderObstacle, Obstacle, PlaneObstacle, SphereObstacle, Stage, Structure, gap

INSIDE = 1e-6
"""Depth of a wall in an obstacle at the start that is still rounding [m]."""


LEAST_REBOUND = 0.01
"""Restitution that counts as none: smaller values would need ever stronger damping."""


def obstacles_of(structure: Structure, mesh: Mesh, stage: Stage, begin: float) -> Iterator[RigidObstacle]:
    """Every obstacle in the order of the structure, including those absent in this stage.

    Parameters
    ----------
    structure, mesh
        What is computed.
    stage
        Determines which obstacles are present and which are driven.
    begin
        Time at which the stage starts [s].
    """
    for name, obstacle in structure.obstacles.items():
        runs = stage.drive is None or name in stage.drive
        yield RigidObstacle(
            **_shape_of(obstacle),
            point=obstacle.point,
            friction=obstacle.friction,
            damping=rebound_damping(obstacle.restitution),
            active=stage.obstacles is None or name in stage.obstacles,
            nodes=np.concatenate(
                [touching(mesh, obstacle), *_cut_away(mesh, obstacle)], dtype=np.uint32, casting="unsafe"
            ),
            **(
                _mass(obstacle)
                if obstacle.mass is not None
                else _driven(obstacle, stage, begin)
                if runs
                else {}
            ),
        )


def touching(mesh: Mesh, obstacle: Obstacle) -> np.ndarray[tuple[int], np.dtype[np.int64]]:
    """Wall nodes of the members that can touch an obstacle."""
    members = mesh.tubes if obstacle.members is None else obstacle.members
    return np.unique(np.concatenate([mesh.tubes[member].nodes.reshape(-1) for member in members]))


def _cut_away(mesh: Mesh, obstacle: Obstacle) -> list[Integers]:
    """Points of the outlines of those members where joints cut them back."""
    return [end.nodes for end in mesh.cut_ends if obstacle.members is None or end.member in obstacle.members]


def refuse_walls_inside(structure: Structure, mesh: Mesh, stage: Stage) -> None:
    """Refuse walls that start inside an obstacle of the first stage.

    Raises
    ------
    InputError
        Naming obstacle, depth and member.
    """
    problems = []
    for name, obstacle in structure.obstacles.items():
        if stage.obstacles is not None and name not in stage.obstacles:
            continue
        nodes = touching(mesh, obstacle)
        depth = -gap(obstacle, mesh.position[nodes])
        worst = int(np.argmax(depth))
        if depth[worst] > INSIDE:
            member = next(m for m, tube in mesh.tubes.items() if nodes[worst] in tube.nodes)
            what, todo = f"walls of member {member} start inside the obstacle", "move the obstacle away"
            came = f"{1e3 * depth[worst]:.4g} mm deep"
            problems.append(Problem(what, came, "walls outside it", todo, f"obstacles.{name}"))
    if problems:
        raise InputError(problems)


def appeared_inside(structure: Structure, mesh: Mesh, state: ShellState) -> str:
    """Obstacle of this stage that appeared inside the deformed structure, in words; empty if none did."""
    for name, (depth, node) in zip(structure.obstacles, state.appeared_inside, strict=True):
        if depth > INSIDE:
            member = next(m for m, tube in mesh.tubes.items() if int(node) in tube.nodes)
            return f"walls of member {member} are {1e3 * depth:.4g} mm inside obstacle {name} when it appears"
    return ""


def rebound_damping(restitution: float) -> float:
    """Share of critical damping with which a mass rebounds by a restitution from a spring that never pulls.

    Parameters
    ----------
    restitution
        0 to 1; less than `LEAST_REBOUND` is taken as that.

    References
    ----------
    Schwager and Poeschel, Granular Matter 9 (2007) 465; derivation in docs/theory/contact.md.  Verified in
    tests/unit/shell/model/test_heavy_lumps.py.
    """
    wanted = max(restitution, LEAST_REBOUND)
    low, high = 0.0, 10.0
    for _ in range(60):
        middle = (low + high) / 2.0
        low, high = (middle, high) if rebound(middle) > wanted else (low, middle)
    return (low + high) / 2.0


def rebound(damping: float) -> float:
    """Speed of separation over speed of approach at a share of critical damping; at 1 it is exp(-2)."""
    z = damping
    if abs(z - 1.0) < 1e-9:
        return math.exp(-2.0)
    if z < 1.0:
        free = math.sqrt(1.0 - z * z)
        return math.exp(-z / free * (math.pi - math.atan2(2.0 * z * free, 1.0 - 2.0 * z * z)))
    slow = math.sqrt(z * z - 1.0)
    return math.exp(-z / slow * math.log((z + slow) / (z - slow)))


def too_sharp(structure: Structure, largest_side: float) -> list[str]:
    """Names of obstacles that press in between the nodes of a wall by more than half its thickness.

    Only nodes touch: between two nodes at a distance h on a radius R, a depth of h^2 / (8 R) is not seen.
    """
    thinnest = min(structure.section_of(member).thickness for member in structure.members)
    return [
        name
        for name, obstacle in structure.obstacles.items()
        if largest_side**2 / (8.0 * getattr(obstacle, "radius", np.inf)) > thinnest / 2.0
    ]


def _shape_of(obstacle: Obstacle) -> dict[str, Any]:
    if isinstance(obstacle, PlaneObstacle):
        if obstacle.edge is None:
            return {"shape": Shape.PLANE, "axis": obstacle.normal}
        return {"shape": Shape.EDGE, "axis": obstacle.normal, "edge": obstacle.edge}
    assert isinstance(obstacle, CylinderObstacle | SphereObstacle)
    radius = obstacle.radius
    if isinstance(obstacle, CylinderObstacle):
        if obstacle.length is None:
            return {"shape": Shape.POLE, "axis": obstacle.axis, "radius": radius}
        return {"shape": Shape.CYLINDER, "axis": obstacle.axis, "radius": radius, "length": obstacle.length}
    return {"shape": Shape.SPHERE, "radius": radius}


def _mass(obstacle: Obstacle) -> dict[str, Any]:
    guide = obstacle.guide_direction
    assert guide is not None
    return {"mass": obstacle.mass, "guide": triple(guide), "velocity": obstacle.velocity}


def _driven(obstacle: Obstacle, stage: Stage, begin: float) -> dict[str, Any]:
    """Prescribed velocities over a stage."""
    motion: list[History | None] = [None, None, None]
    for i, axis in enumerate("xyz"):
        function = getattr(obstacle.motion, axis)
        if function is not None:
            motion[i] = velocity_of(function, stage.duration, begin)
        elif obstacle.velocity[i]:
            motion[i] = ([begin], [obstacle.velocity[i]])
    given: dict[str, Any] = {"motion": tuple(motion)}
    if obstacle.turning is not None:
        turning = velocity_of(obstacle.turning.angle, stage.duration, begin)
        given |= {
            "turn_about": obstacle.turning.about,
            "turn_axis": obstacle.turning.axis,
            "turning": turning,
        }
    return given
