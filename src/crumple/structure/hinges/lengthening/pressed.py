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
from crumple.structure.hinges.lengthening.at_start import approaches, momentum_at_start
from crumple.structure.hinges.lengthening.nodes_met import FLAT, nodes_met
from crumple.structure.hinges.lengthening.stopped import ALONG, stopped
from crumple.structure.parts import StructureParts


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
    """Members that lead away from a node that an obstacle meets, along the blow, and those behind them.

    Bends keep such a structure from stopping, and so does a wall that meets the tip of a beam before the
    boxes behind it; a crash box folds all the same, and what is behind it bends under the axial force.
    """
    return structure.kept.once("struck ends", "", lambda: frozenset(_struck_ends(structure)))


def _struck_ends(structure: StructureParts) -> Iterator[str]:
    for obstacle in structure.obstacles.values():
        for node, outwards in nodes_met(structure, obstacle):
            if node in structure.supports_at or not approaches(structure, obstacle, node, outwards):
                continue
            for name in structure.members_at[node]:
                along = float(leaving(structure, name, node) @ outwards)
                if structure.is_whole(name) and along > math.cos(FLAT):
                    yield from _behind(structure, name, node, outwards)


def _behind(structure: StructureParts, member: str, node: str, blow: Floats) -> Iterator[str]:
    """A member that leads away from a node, and those behind it within `ALONG` of the blow."""
    seen: set[str] = set()
    while member not in seen:
        seen.add(member)
        yield member
        first, last = structure.members[member].nodes
        node = last if node == first else first
        others = [name for name in structure.members_at[node] if name != member]
        if len(others) != 1 or not structure.is_whole(others[0]):
            return
        if float(leaving(structure, others[0], node) @ blow) <= math.cos(ALONG):
            return
        member = others[0]


def kinks_pressed(structure: StructureParts, member: str) -> bool:
    """Whether a member is pressed by an impact along its axis, and its metal hardens."""
    if structure.material_of(member).hardening is None or not struck_along(structure, member):
        return False
    direction = structure.kept.once("impact", "", lambda: momentum_at_start(structure))
    along = float(structure.frame_of(member).axes[0] @ direction)
    return abs(along) > math.cos(ALONG) * float(np.linalg.norm(direction))
