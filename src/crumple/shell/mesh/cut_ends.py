"""Outlines of the ends that joints cut back: what is solid between a node and a member's first ring.

Members that meet at a node are cut back clear of each other and joined by a rigid body (`joints`).  There
are no walls where they were cut, and an obstacle would pass into the joint by the length of the cuts.  So
points of the outlines there move with the rigid body and touch obstacles; they have no mass and no elements.

Walls go on until they meet those of the other members, as at a mitre: the line of the contour point o along
the outgoing axis x starts where it passes the last of the planes that halve the angles to the other axes y,
s = -(o . m) / (x . m) with m = x - y, but not further beyond the node than o lies beside the axis, which
matters at acute angles.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats, Integers
from crumple.shell.mesh.contour import Contour
from crumple.shell.mesh.joints import Joint, Kind, outgoing
from crumple.structure import Structure


@dataclass(frozen=True, eq=False)
class CutEnd:
    """Points of one member's outline between a node and its first ring there.

    Attributes
    ----------
    node, member
        Names.
    nodes
        Numbers in the mesh.
    """

    node: str
    member: str
    nodes: Integers


def cut_ends_of(
    structure: Structure, contours: dict[str, Contour], joints: dict[str, Joint], size: float, first: int
) -> tuple[tuple[CutEnd, ...], list[Floats]]:
    """Ends cut back at rigid joints, and the positions of their points [m], (n, 3) each.

    Parameters
    ----------
    structure, contours, joints
        Members, their divided sections, and how they are joined.
    size
        Largest distance of the points along a member [m].
    first
        Number of the first point.
    """
    ends: list[CutEnd] = []
    positions: list[Floats] = []
    for joint in joints.values():
        if joint.kind is not Kind.RIGID or len(joint.ends) < 2:
            continue
        axes = [outgoing(structure, end) for end in joint.ends]
        for i, (end, cut) in enumerate(zip(joint.ends, joint.cut, strict=True)):
            ring = contours[end.member].points @ structure.frame_of(end.member).axes[1:]
            start = outline_starts(ring, axes[i], axes[:i] + axes[i + 1 :])
            steps = math.ceil((cut - float(start.min())) / size)
            along = start + (cut - start) * (np.arange(steps) / steps)[:, None]
            points = np.asarray(structure.nodes[joint.node]) + along[..., None] * axes[i] + ring
            ends.append(CutEnd(joint.node, end.member, first + np.arange(along.size)))
            positions.append(points.reshape(-1, 3))
            first += along.size
    return tuple(ends), positions


def outline_starts(ring: Floats, axis: Floats, others: list[Floats]) -> Floats:
    """Distances from the node at which the lines of the contour points start [m], (n,).

    Parameters
    ----------
    ring
        Contour points relative to the member's axis [m], (n, 3).
    axis, others
        Unit vectors from the node into the member, and into the others, (3,) each.
    """
    planes = [axis - other for other in others]
    meeting = [-(ring @ plane) / float(axis @ plane) for plane in planes]
    return np.asarray(np.maximum(np.max(meeting, axis=0), -np.linalg.norm(ring, axis=1)))
