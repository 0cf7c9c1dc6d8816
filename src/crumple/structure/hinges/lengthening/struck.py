"""Structures whose members must shorten, because an obstacle stops or pushes them along their axes.

Members in line with an impact pass on their squash load; members of fixed length would pass any force on in
no time, and stop what lies behind them.  A plane meets nodes *in front*: no member leads from there towards
the plane by more than `FLAT`, and one leads away within `ALONG` of its normal.  Others, and the edge of a
plane, strike the place of the members' axes that is nearest to them at the start.  Where that is a wall or a
mitred corner it dents, which limits the force far below the squash load; a rigid joint does not.
"""

from __future__ import annotations

import math

import numpy as np

from crumple.structure.hinges.corners import is_whole, leaving
from crumple.structure.hinges.joint_reach import joint_reach
from crumple.structure.keys.obstacles import Obstacle, PlaneObstacle
from crumple.structure.parts import StructureParts
from crumple.structure.struck_places import LEAST, PLACES, axis_gaps

FLAT = math.radians(25.0)
"""Angle by which members at a node in front may lead towards the plane."""
ALONG = math.radians(60.0)
"""Angle to the normal of a plane within which a member is pressed along its axis: the edges of a cube that
falls on a corner are."""


def strikes_along(structure: StructureParts) -> bool:
    """Whether structure or obstacle moves at the start, and strikes members along their axes."""
    return structure.kept.once("strikes along", "", lambda: _strikes_along(structure))


def _strikes_along(structure: StructureParts) -> bool:
    moves = bool(structure.initial_velocity)
    struck = [one for one in structure.obstacles.values() if moves or any(one.velocity)]
    return any(
        _meets_node(structure, one)
        if isinstance(one, PlaneObstacle) and one.edge is None
        else _nearest_is_joint(structure, one)
        for one in struck
    )


def _nearest_is_joint(structure: StructureParts, obstacle: Obstacle) -> bool:
    """Whether a rigid joint is among the places of the members' axes that are nearest to an obstacle."""
    names = _before(structure, obstacle)
    if not names:
        return False
    gaps = axis_gaps(structure, obstacle, names)
    return any(
        PLACES[place] in (0.0, 1.0)
        and joint_reach(structure, names[which], structure.members[names[which]].nodes[int(PLACES[place])])
        for which, place in np.argwhere(gaps <= gaps.min() + LEAST)
    )


def _meets_node(structure: StructureParts, plane: PlaneObstacle) -> bool:
    """Whether a plane meets a node in front, with a member behind it."""
    normal = np.asarray(plane.normal, float) / np.linalg.norm(plane.normal)
    names = set(_before(structure, plane))
    for node, members in structure.members_at.items():
        if names.isdisjoint(members) or structure.supports_at.get(node):
            continue
        away = [float(leaving(structure, name, node) @ normal) for name in members if name in names]
        if min(away) >= -math.sin(FLAT) and max(away) >= math.cos(ALONG):
            return True
    return False


def _before(structure: StructureParts, obstacle: Obstacle) -> list[str]:
    """Members that an obstacle can touch."""
    return [name for name in obstacle.members or structure.members if is_whole(structure, name)]
