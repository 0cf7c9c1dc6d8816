"""What surrounds the walls in a scene: obstacles with their motion, masses, supports, forces as arrows."""

from __future__ import annotations

from typing import Any

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.result import Result, States
from crumple.structure import Structure
from crumple.structure.keys.obstacles import CylinderObstacle, Obstacle, PlaneObstacle, SphereObstacle

REACH = 0.5
"""Half-width of a drawn plane over the diagonal of the scene."""
AROUND, ALONG = 24, 8
"""Sides of round obstacles, and rings of a sphere between its poles."""
SMALL = 1e-3
"""Share of the largest force of a scene below which no force is drawn."""


def obstacles(
    structure: Structure | None, result: Result, times: Floats, low: Floats, high: Floats
) -> list[dict[str, Any]]:
    """Obstacles as meshes at the start, and their pose at every frame: x = R (x_0 - about) + about + shift.

    Parameters
    ----------
    structure
        None: what is around the walls is not known.
    result
        Its channels hold the motion of obstacles with a mass.
    times
        Of the frames [s], (n,).
    low, high
        Bounding box of the walls over all frames [m]: planes without an end are cut around it.
    """
    if structure is None:
        return []
    found = []
    for name, obstacle in structure.obstacles.items():
        points, quads = _mesh(obstacle, low, high)
        entry: dict[str, Any] = {
            "name": name,
            "type": obstacle.type,
            "points": np.round(points, 5).tolist(),
            "quads": quads.tolist(),
            "shift": np.round(_shift(name, obstacle, result, times), 6).tolist(),
        }
        if obstacle.turning is not None:
            entry["about"] = list(obstacle.turning.about)
            entry["axis"] = _unit(np.asarray(obstacle.turning.axis, float)).tolist()
            entry["angle"] = np.round(obstacle.turning.angle(times), 6).tolist()
        found.append(entry)
    return found


def _shift(name: str, obstacle: Obstacle, result: Result, times: Floats) -> Floats:
    """Displacement at the frames [m], (n, 3): from the result where it has it, else as prescribed."""
    columns = []
    for axis, speed in zip("xyz", obstacle.velocity, strict=True):
        channel = result.channels.get(f"obstacle.{name}.displacement.{axis}")
        function = getattr(obstacle.motion, axis)
        if channel is not None and np.isfinite(channel.values).all():
            columns.append(np.interp(times, result.time, channel.values))
        elif function is not None:
            columns.append(np.broadcast_to(function(times), times.shape))
        else:
            columns.append(speed * times if obstacle.mass is None else np.zeros_like(times))
    return np.stack(columns, axis=1)


def _mesh(obstacle: Obstacle, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """Points [m], (n, 3), and quadrilaterals, (m, 4), of an obstacle where it starts."""
    point = np.asarray(obstacle.point, float)
    diagonal = float(np.linalg.norm(high - low))
    middle = (low + high) / 2.0
    if isinstance(obstacle, PlaneObstacle):
        return _plane(obstacle, point, middle, REACH * diagonal)
    if isinstance(obstacle, CylinderObstacle):
        axis = _unit(np.asarray(obstacle.axis, float))
        if obstacle.length is None:
            centre = point + axis * float(axis @ (middle - point))
            begin, length = centre - REACH * diagonal * axis, 2.0 * REACH * diagonal
        else:
            begin, length = point, obstacle.length
        rings = [(0.0, 0.0), (0.0, 1.0), (length, 1.0), (length, 0.0)]
        return _round(begin, axis, obstacle.radius, rings)
    assert isinstance(obstacle, SphereObstacle)
    angles = np.linspace(0.0, np.pi, ALONG + 1)
    rings = [(-obstacle.radius * float(np.cos(a)), float(np.sin(a))) for a in angles]
    return _round(point, np.array([0.0, 0.0, 1.0]), obstacle.radius, rings)


def _plane(plane: PlaneObstacle, point: Floats, middle: Floats, reach: float) -> tuple[Floats, Floats]:
    """A square around the foot of the scene's middle, or from the edge inwards."""
    normal = _unit(np.asarray(plane.normal, float))
    centre = middle - normal * float(normal @ (middle - point))
    if plane.edge is None:
        across = _unit(np.eye(3)[int(np.argmin(np.abs(normal)))] - normal * normal[np.argmin(np.abs(normal))])
        along = np.cross(normal, across)
        corners = [centre + reach * (a * across + b * along) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    else:
        across = _unit(np.asarray(plane.edge, float))
        along = np.cross(normal, across)
        begin = point + along * float(along @ (middle - point))
        inner = 1.6 * reach
        corners = [
            begin + a * across + b * along
            for a, b in ((-inner, -reach), (0, -reach), (0, reach), (-inner, reach))
        ]
    return np.array(corners), np.array([[0, 1, 2, 3]])


def _round(
    begin: Floats, axis: Floats, radius: float, rings: list[tuple[float, float]]
) -> tuple[Floats, Floats]:
    """Surface of revolution about an axis: (distance along it [m], share of the radius) of each ring."""
    one = _unit(np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))]))
    two = np.cross(axis, one)
    angle = 2.0 * np.pi * np.arange(AROUND)[:, None] / AROUND
    circle = radius * (np.cos(angle) * one + np.sin(angle) * two)
    points = np.concatenate([begin + along * axis + share * circle for along, share in rings])
    i, j = np.divmod(np.arange((len(rings) - 1) * AROUND), AROUND)
    k = (j + 1) % AROUND
    first, second = i * AROUND, (i + 1) * AROUND
    return points, np.stack([first + j, first + k, second + k, second + j], axis=1)


def masses(structure: Structure | None, states: States) -> list[dict[str, Any]]:
    """Lumped masses [kg] and their place at every frame."""
    if structure is None:
        return []
    return [
        {"name": name, "mass": mass.mass, "place": _carried(structure, mass.node, states)}
        for name, mass in structure.masses.items()
    ]


def supports(structure: Structure | None, states: States) -> list[dict[str, Any]]:
    """Supports, what they hold, and their place at every frame."""
    if structure is None:
        return []
    return [
        {
            "name": name,
            "held": [*support.held, *support.driven],
            "place": _carried(structure, support.node, states),
        }
        for name, support in structure.supports.items()
    ]


def forces(structure: Structure | None, result: Result, states: States) -> list[dict[str, Any]]:
    """Forces of the structure on supports and obstacles [N] at every frame, where the result has them.

    An arrow on an obstacle starts at the point of the walls that is nearest to its surface, seen along the
    force, since a resultant has no place of its own.
    """
    if structure is None:
        return []
    moved = states.points + states.displacement
    found: list[dict[str, Any]] = []
    for kind, entries in (("support", structure.supports), ("obstacle", structure.obstacles)):
        for name in entries:
            force = _vector(result, f"{kind}.{name}.force", states.times)
            if force is None:
                continue
            if kind == "support":
                place = _carried(structure, structure.supports[name].node, states)
            else:
                far = np.einsum("fpk,fk->fp", moved, force)
                place = np.round(moved[np.arange(len(moved)), far.argmax(axis=1)], 5).tolist()
            values = [[float(f"{x:.4g}") for x in row] for row in force]
            found.append({"name": name, "on": kind, "place": place, "force": values})
    largest = max((float(np.linalg.norm(entry["force"], axis=1).max()) for entry in found), default=0.0)
    return [e for e in found if float(np.linalg.norm(e["force"], axis=1).max()) > SMALL * largest > 0.0]


def _vector(result: Result, name: str, times: Floats) -> Floats | None:
    """Three channels at some times, (n, 3), or None."""
    channels = [result.channels.get(f"{name}.{axis}") for axis in "xyz"]
    columns = [np.interp(times, result.time, np.nan_to_num(c.values)) for c in channels if c is not None]
    return np.stack(columns, axis=1) if len(columns) == len(channels) else None


def _carried(structure: Structure, node: str, states: States) -> list[list[float]]:
    """Place of a node at every frame: it moves with the nearest points of the walls."""
    start = np.asarray(structure.nodes[node], float)
    distance = np.linalg.norm(states.points - start, axis=1)
    near = np.argsort(distance)[:8]
    weight = 1.0 / (distance[near] + 1e-6) ** 2
    moved = start + np.einsum("j,ijk->ik", weight / weight.sum(), states.displacement[:, near])
    return [[round(float(x), 5) for x in row] for row in moved]


def _unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))
