"""Nodes that obstacles meet first.

A plane meets the nodes from which no member leads towards it by more than `FLAT`; other obstacles, and the
edge of a plane, meet the nodes that are nearest to them.  A node that supports hold in the direction of the
blow, or drive, does not meet an obstacle: they take it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.hinges.corners import leaving
from crumple.structure.hinges.joint_reach import nearest_ends
from crumple.structure.hinges.lengthening.framework import free_directions
from crumple.structure.keys.obstacles import Obstacle, PlaneObstacle, gap
from crumple.structure.parts import StructureParts
from crumple.structure.struck_places import LEAST

FLAT = math.radians(25.0)
"""Angle by which members at a node may lead towards a plane that meets it."""
TOGETHER = 1e-3
"""Difference of the distances from an obstacle to nodes that it meets at the same time [m]."""
HELD = 1e-6
"""Part of a blow along the directions that supports leave that is none."""


def nodes_met(structure: StructureParts, obstacle: Obstacle) -> Iterator[tuple[str, Floats]]:
    """Nodes that an obstacle meets, each with the unit vector from the obstacle to it."""
    for node in _first(structure, obstacle):
        outwards = _outwards(obstacle, np.asarray(structure.nodes[node], float))
        supports = [support for _, support in structure.supports_at.get(node, ())]
        driven = any(not freedom.startswith("r") for support in supports for freedom in support.driven)
        if not driven and np.linalg.norm(free_directions(structure, node) @ outwards) > HELD:
            yield node, outwards


def supports_met(structure: StructureParts) -> Iterator[tuple[str, str]]:
    """Obstacles, and the nodes that they would meet first or with the first, and that supports hold."""
    for name, obstacle in structure.obstacles.items():
        nodes = list(_first(structure, obstacle))
        if not nodes:
            continue
        gaps = gap(obstacle, np.array([structure.nodes[node] for node in nodes], float))
        yielding = {node for node, _ in nodes_met(structure, obstacle)}
        for node, distance in zip(nodes, gaps - gaps.min(), strict=True):
            if node not in yielding and distance <= TOGETHER:
                yield name, node


def _first(structure: StructureParts, obstacle: Obstacle) -> Iterator[str]:
    wanted = obstacle.members or structure.members
    names = [name for name in wanted if name in structure.members and structure.is_whole(name)]
    if isinstance(obstacle, PlaneObstacle) and obstacle.edge is None:
        normal = np.asarray(obstacle.normal, float) / np.linalg.norm(obstacle.normal)
        for node, members in structure.members_at.items():
            away = [float(leaving(structure, name, node) @ normal) for name in members if name in names]
            if away and min(away) >= -math.sin(FLAT):
                yield node
        return
    if not names:
        return
    yield from dict.fromkeys(node for _, node in nearest_ends(structure, obstacle, names))


def _outwards(obstacle: Obstacle, point: Floats) -> Floats:
    """Unit vector from an obstacle to a point: the gradient of its distance."""
    ahead = gap(obstacle, point + LEAST * np.eye(3)) - gap(obstacle, point - LEAST * np.eye(3))
    size = float(np.linalg.norm(ahead))
    return ahead / size if size > 0.0 else np.zeros(3)
