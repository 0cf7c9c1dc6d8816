"""Members that an impact presses along their axes until they yield, and that may then kink before they fold.

Metal that hardens lets a compressed member yield all along while its force grows; shells of such struts turn
about two folds between their ends, or about one, before their walls fold.  Without hardening the first fold
takes everything at once.  The members are those within `ALONG` of the impact: of the momentum relative to the
obstacles that move, or to the ground.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.hinges.corners import leaving
from crumple.structure.hinges.joint_reach import strikes_joint
from crumple.structure.hinges.lengthening.at_start import nodes_at_start, obstacle_at_start
from crumple.structure.hinges.lengthening.nodes_met import FLAT, nodes_met
from crumple.structure.hinges.lengthening.stopped import ALONG, stopped
from crumple.structure.parts import StructureParts

IN_LINE = math.radians(1.0)
"""Angle within which one member continues another."""


def struck_along(structure: StructureParts, member: str) -> bool:
    """Whether an impact presses a structure together along its members, of which this one can yield.

    Rigid bars yield only where all would stop at once.
    """
    if stopped(structure):
        return True
    if not structure.members[member].elastic:
        return False
    return strikes_joint(structure) or member in struck_ends(structure)


def struck_ends(structure: StructureParts) -> frozenset[str]:
    """Members in line with a free end that an obstacle meets along its axis.

    What is behind them may bend, so that nothing stops; a crash box in front of it folds all the same.
    """
    return structure.kept.once("struck ends", "", lambda: frozenset(_struck_ends(structure)))


def _struck_ends(structure: StructureParts) -> Iterator[str]:
    moving = nodes_at_start(structure)
    for obstacle in structure.obstacles.values():
        motion, _ = obstacle_at_start(obstacle, 1.0)
        for node, outwards in nodes_met(structure, obstacle):
            names = structure.members_at[node]
            apart = (moving[node][1] - motion) @ outwards >= 0.0
            if apart or len(names) > 1 or node in structure.supports_at or not structure.is_whole(names[0]):
                continue
            if float(leaving(structure, names[0], node) @ outwards) > math.cos(FLAT):
                yield from _in_line(structure, names[0], node)


def _in_line(structure: StructureParts, member: str, node: str) -> Iterator[str]:
    """A member that leads away from a node, and those that continue it in its direction."""
    while True:
        yield member
        direction = leaving(structure, member, node)
        first, last = structure.members[member].nodes
        node = last if node == first else first
        others = [name for name in structure.members_at[node] if name != member]
        if len(others) != 1 or not structure.is_whole(others[0]):
            return
        if float(leaving(structure, others[0], node) @ direction) < math.cos(IN_LINE):
            return
        member = others[0]


def kinks_pressed(structure: StructureParts, member: str) -> bool:
    """Whether a member is pressed by an impact along its axis, and its metal hardens."""
    if structure.material_of(member).hardening is None or not struck_along(structure, member):
        return False
    direction = structure.kept.once("impact", "", lambda: _direction(structure))
    along = float(structure.frame_of(member).axes[0] @ direction)
    return abs(along) > math.cos(ALONG) * float(np.linalg.norm(direction))


def _direction(structure: StructureParts) -> Floats:
    """Momentum of the nodes relative to the fastest obstacle [kg m/s], (3,)."""
    moving = nodes_at_start(structure)
    struck = [obstacle_at_start(obstacle, 1.0)[0] for obstacle in structure.obstacles.values()]
    fastest = max(struck, key=lambda motion: float(motion @ motion), default=np.zeros(3))
    return sum((mass * (velocity - fastest) for mass, velocity in moving.values()), np.zeros(3))
