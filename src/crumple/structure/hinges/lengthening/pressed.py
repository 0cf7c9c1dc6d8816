"""Members that an impact presses along their axes until they yield, and that may then kink before they fold.

Metal that hardens lets a compressed member yield all along while its force grows; shells of such struts turn
about two folds between their ends, or about one, before their walls fold.  Without hardening the first fold
takes everything at once.  The members are those within `ALONG` of the impact: of the momentum relative to the
obstacles that move, or to the ground.
"""

from __future__ import annotations

import math

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.hinges.joint_reach import strikes_joint
from crumple.structure.hinges.lengthening.at_start import nodes_at_start, obstacle_at_start
from crumple.structure.hinges.lengthening.stopped import ALONG, stopped
from crumple.structure.parts import StructureParts


def struck_along(structure: StructureParts, member: str) -> bool:
    """Whether an impact presses a structure together along its members, of which this one can yield.

    Rigid bars yield only where all would stop at once.
    """
    if stopped(structure):
        return True
    return bool(structure.members[member].elastic) and strikes_joint(structure)


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
