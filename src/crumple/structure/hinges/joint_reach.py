"""Rigid joints: how far they reach along a member, to where the walls of the others end; which are struck.

Members whose ends meet at a node and share no mitre are joined by what lies between them: a weld to the
faces of the others, a gusset, a cast node.  Their folds form outside of it.  With unit vectors x and y from
the node into two members at an angle a, and half depths d and e in their common plane, the inner edges meet
at (e + d cos a) / sin a along the first.

A wall or a mitred corner that an obstacle strikes dents, which limits the force of the impact far below the
squash load of the members behind it.  A rigid joint does not dent: it stops at once, with the masses that it
carries, and members in line with the motion stop what lies behind them with their squash load.  Members of
fixed length would pass any force on in no time.
"""

from __future__ import annotations

import math

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.geometry import NARROWEST
from crumple.structure.hinges.corners import corners, leaving
from crumple.structure.keys.member import united
from crumple.structure.keys.obstacles import Obstacle
from crumple.structure.parts import StructureParts
from crumple.structure.struck_places import LEAST, PLACES, axis_gaps

LARGEST_SHARE = 0.35
"""Share of a member that a joint takes at most."""


def joint_reach(structure: StructureParts, member: str, node: str) -> float:
    """Distance from a node up to which a member is part of a rigid joint [m].

    Parameters
    ----------
    structure, member, node
        The member ends at the node.

    Returns
    -------
    float
        0 at nodes without other members, at mitred corners, and where a joint lets members turn.
    """
    return structure.kept.once("joint reach", (member, node), lambda: _joint_reach(structure, member, node))


def _joint_reach(structure: StructureParts, member: str, node: str) -> float:
    others = [name for name in structure.members_at.get(node, ()) if name != member]
    if node in corners(structure) or structure.joints_at.get(node):
        return 0.0
    reach = 0.0
    own = leaving(structure, member, node)
    for other in others:
        if not structure.is_whole(other):
            continue
        along = leaving(structure, other, node)
        cosine, sine = float(own @ along), float(np.linalg.norm(np.cross(own, along)))
        if sine < math.sin(NARROWEST):
            continue
        mine = _half_depth(structure, member, (along - cosine * own) / sine)
        theirs = _half_depth(structure, other, (own - cosine * along) / sine)
        reach = max(reach, (theirs + cosine * mine) / sine)
    return min(reach, LARGEST_SHARE * structure.frame_of(member).length)


def unbent_parts(structure: StructureParts, member: str) -> tuple[tuple[float, float], ...]:
    """Stretches of a member that do not deform [m]: rigid parts, and of elastic members those in joints.

    Hinges of rigid bars stand for members from node to node.
    """
    spec, length = structure.members[member], structure.frame_of(member).length
    rigid = spec.rigid_parts(length)
    if not spec.elastic:
        return rigid
    first, last = (joint_reach(structure, member, node) for node in spec.nodes)
    return united((a, b) for a, b in (*rigid, (0.0, first), (length - last, length)) if a < b)


def strikes_joint(structure: StructureParts) -> bool:
    """Whether structure or obstacle moves at the start, and a nearest place of the members is a rigid joint.

    Where a face meets a member flush, all places along it are equally near, and the joint at its end counts,
    in whichever order the input names members and their nodes.
    """
    return structure.kept.once("strikes joint", "", lambda: _strikes_joint(structure))


def _strikes_joint(structure: StructureParts) -> bool:
    moves = bool(structure.initial_velocity)
    struck = [one for one in structure.obstacles.values() if moves or any(one.velocity)]
    return any(_nearest_is_joint(structure, one) for one in struck)


def _nearest_is_joint(structure: StructureParts, obstacle: Obstacle) -> bool:
    """Whether the nearest place of the members' axes to an obstacle, at the start, is a rigid joint.

    Of a member that lies along the obstacle all places are equally near, its joints among them.
    """
    names = [name for name in obstacle.members or structure.members if structure.is_whole(name)]
    if not names:
        return False
    ends = nearest_ends(structure, obstacle, names)
    return any(joint_reach(structure, name, node) > 0.0 for name, node in ends)


def nearest_ends(structure: StructureParts, obstacle: Obstacle, names: list[str]) -> list[tuple[str, str]]:
    """Members nearest to an obstacle at a node of theirs, or within its rigid joint; with the node."""
    gaps = axis_gaps(structure, obstacle, names)
    found = []
    for which, place in np.argwhere(gaps <= gaps.min() + LEAST):
        name, length = names[which], structure.frame_of(names[which]).length
        shares = (PLACES[place], 1.0 - PLACES[place])
        for node, share in zip(structure.members[name].nodes, shares, strict=True):
            if share * length <= joint_reach(structure, name, node):
                found.append((name, node))
    return found


def _half_depth(structure: StructureParts, member: str, direction: Floats) -> float:
    """Largest distance of a section's outline from its axis in a direction [m]."""
    frame = structure.frame_of(member)
    points = structure.section_of(member).outer_outline()
    return float(np.abs(points @ np.stack([frame.y @ direction, frame.z @ direction])).max())
