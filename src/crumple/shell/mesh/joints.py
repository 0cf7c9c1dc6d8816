"""Treatment of the members' ends at each node: clamped, joined by a mitre, welded, made rigid, or left free.

Members that meet at a node are cut back so that their walls do not cross, and their end sections move as one
rigid body; what was cut away stays as its mass.  With outgoing unit vectors x_i and x_j at an angle a, and
half depths e_i and e_j in their common plane, the inner edges meet at (e_j + e_i cos a) / sin a along i.
Two members whose contours meet point by point in the plane halving their angle share those points: a mitre.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from crumple.errors import InputError, Problem
from crumple.hinge.corner.in_plane import LARGEST
from crumple.numeric.arrays import Floats
from crumple.shell.mesh.contour import Contour
from crumple.shell.mesh.end import End
from crumple.shell.mesh.tees import Tee, tees_of, with_rows
from crumple.structure import FREEDOMS, Structure

SAME_POINT = 1e-6
"""Distance over the section's size below which two contours' points are one."""
NARROWEST_ANGLE = np.radians(10.0)
"""Angle between two members below which they overlap along their length."""
LONGEST_CUT = 0.35
"""Share of a member that a joint may take at one end."""
SHEARED_LENGTH = 2.5
"""Length over which a mitre's slant fades out, over its largest shift: elements keep 60 % of their length."""


class Kind(Enum):
    """Kind of connection of the sections at a node."""

    FREE = "free"
    CLAMPED = "clamped"
    MITRED = "mitred"
    WELDED = "welded"
    RIGID = "rigid"


def shortest_with_mitre(reach: float, turn: float) -> float:
    """Length from which a member can share a mitre [m]; the ends of a shorter one are joined rigidly.

    Parameters
    ----------
    reach
        Of its section from its axis, in the plane of the mitre [m].
    turn
        Change of direction between both members [rad].
    """
    return SHEARED_LENGTH * reach * float(np.tan(turn / 2.0)) / LONGEST_CUT


@dataclass(frozen=True, eq=False)
class Joint:
    """Treatment of the ends at one node.

    Attributes
    ----------
    node
        Its name.
    kind
        Kind of connection of the sections.
    ends
        Members' ends there.
    cut
        Length that each end is cut back by [m], (ends,).
    slant
        Of a mitre: shift into the member of every contour point of each end [m], else empty.
    tee
        Of a welded T-joint, whose ends are those of both members in line, then the branch's.
    match
        Of a mitre, and of both members in line of a T-joint: index of the first end's contour point for each
        of the second's.
    rigid_ring
        Whether a mitre's shared section is rigid, because something acts on the node.
    """

    node: str
    kind: Kind
    ends: tuple[End, ...]
    cut: tuple[float, ...]
    slant: tuple[Floats, ...] = ()
    match: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    rigid_ring: bool = False
    tee: Tee | None = None

    @property
    def is_body(self) -> bool:
        """Whether the node is a rigid body."""
        return self.kind is Kind.RIGID or self.rigid_ring


def joints_of(
    structure: Structure, contours: dict[str, Contour], welded: dict[str, Tee] | None = None
) -> dict[str, Joint]:
    """Joint of every node at which a member ends.

    Parameters
    ----------
    structure, contours
        Members and their divided sections.
    welded
        Welded T-joints by node.

    Raises
    ------
    InputError
        If members overlap along their length, or one is too short for its joints.
    """
    tees = welded or {}
    branches = {tee.branch.member for tee in tees.values()}
    loaded = structure.loaded_nodes
    joints, problems = {}, []
    for node, meeting in ends_of(structure).items():
        if node in tees:
            joints[node] = _welded(structure, contours, tees[node])
            continue
        mitre = not branches & {end.member for end in meeting}
        try:
            joints[node] = _joint(structure, contours, node, meeting, loaded=node in loaded, mitre=mitre)
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(problems)
    return joints


def welded_joints(
    structure: Structure, contours: dict[str, Contour], size: float
) -> tuple[dict[str, Tee], dict[str, Contour]]:
    """T-joints that can be welded, by node, and the sections with rows of nodes along their outlines.

    Nodes that are held, loaded or heavy stay rigid.
    """
    loaded = structure.loaded_nodes
    ends = {node: meeting for node, meeting in ends_of(structure).items() if node not in loaded}
    tees = tees_of(structure, contours, ends, size)
    return tees, with_rows(contours, tees.values(), size)


def ends_of(structure: Structure) -> dict[str, tuple[End, ...]]:
    """Ends of members by node."""
    ends: dict[str, list[End]] = defaultdict(list)
    for name, member in structure.members.items():
        ends[member.nodes[0]].append(End(name, False))
        ends[member.nodes[1]].append(End(name, True))
    return {node: tuple(meeting) for node, meeting in ends.items()}


def _welded(structure: Structure, contours: dict[str, Contour], tee: Tee) -> Joint:
    """Joint of a welded branch, whose slant is that of its outline once its section is divided there."""
    x, out = outgoing(structure, tee.branch), structure.frame_of(tee.before).axes[1 + tee.out]
    normal = tee.side * out
    arms = contours[tee.branch.member].points @ structure.frame_of(tee.branch.member).axes[1:]
    slant = -(arms @ normal) / float(x @ normal)
    straight = np.zeros(len(contours[tee.before].points))
    ends = (End(tee.before, True), End(tee.after, False), tee.branch)
    cut = (0.0, 0.0, tee.height / float(x @ normal))
    match = np.arange(len(straight))
    return Joint(tee.node, Kind.WELDED, ends, cut, (straight, straight, slant), match, tee=tee)


def is_clamped(structure: Structure, node: str) -> bool:
    """Whether supports hold all six freedoms of a node."""
    held = {f for support in structure.supports.values() if support.node == node for f in support.held}
    return held == set(FREEDOMS)


def outgoing(structure: Structure, end: End) -> Floats:
    """Unit vector from the node into the member, (3,)."""
    x = structure.frame_of(end.member).x
    return -x if end.second else x


def _joint(
    structure: Structure,
    contours: dict[str, Contour],
    node: str,
    ends: tuple[End, ...],
    *,
    loaded: bool,
    mitre: bool,
) -> Joint:
    clamped = is_clamped(structure, node)
    if len(ends) == 1:
        kind = Kind.CLAMPED if clamped else Kind.RIGID if loaded else Kind.FREE
        return Joint(node, kind, ends, (0.0,))
    if len(ends) == 2 and not clamped and mitre:
        shared = _mitre(structure, contours, node, ends, loaded)
        if shared is not None:
            return shared
    cut = tuple(_cut(structure, contours, node, end, ends) for end in ends)
    return Joint(node, Kind.CLAMPED if clamped else Kind.RIGID, ends, cut)


def _mitre(
    structure: Structure, contours: dict[str, Contour], node: str, ends: tuple[End, ...], loaded: bool
) -> Joint | None:
    """Shared section of two members, or None where their contours do not meet."""
    x = [outgoing(structure, end) for end in ends]
    turn = np.arccos(np.clip(-float(x[0] @ x[1]), -1.0, 1.0))
    if turn > LARGEST:
        return None
    normal = (x[0] - x[1]) / np.linalg.norm(x[0] - x[1])
    slants, points = [], []
    for end, direction in zip(ends, x, strict=True):
        frame, ring = structure.frame_of(end.member), contours[end.member].points
        arms = ring @ frame.axes[1:]
        slant = -(arms @ normal) / float(direction @ normal)
        if SHEARED_LENGTH * np.abs(slant).max() > LONGEST_CUT * frame.length:
            return None
        slants.append(slant)
        points.append(arms + slant[:, None] * direction)
    if len(points[0]) != len(points[1]):
        return None
    # contours of huge sections have tens of thousands of points: a table of all distances fills the memory
    from scipy.spatial import cKDTree  # noqa: PLC0415  (takes a tenth of a second)

    found = cKDTree(points[0]).query(points[1])
    distance, match = np.asarray(found[0]), np.asarray(found[1], np.int64)
    size = float(np.ptp(contours[ends[0].member].points, axis=0).max())
    if distance.max() > SAME_POINT * size or len(set(match)) < len(match):
        return None
    return Joint(node, Kind.MITRED, ends, (0.0, 0.0), tuple(slants), match, rigid_ring=loaded)


def _cut(
    structure: Structure, contours: dict[str, Contour], node: str, end: End, ends: tuple[End, ...]
) -> float:
    """Length that one end is cut back by, so that its walls keep clear of every other member's [m]."""
    length, most = structure.frame_of(end.member).length, 0.0
    x = outgoing(structure, end)
    for other in ends:
        if other is end:
            continue
        y = outgoing(structure, other)
        cosine, sine = float(x @ y), float(np.linalg.norm(np.cross(x, y)))
        if sine < np.sin(NARROWEST_ANGLE):
            if cosine > 0.0:
                raise _within(node, end, other, np.degrees(np.arctan2(sine, cosine)))
            continue
        mine = _half_depth(structure, contours, end, (y - cosine * x) / sine)
        theirs = _half_depth(structure, contours, other, (x - cosine * y) / sine)
        walls = (
            structure.section_of(end.member).thickness + structure.section_of(other.member).thickness
        ) / 2
        most = max(most, (theirs + cosine * mine) / sine + walls)
    if most > LONGEST_CUT * length:
        raise InputError(
            Problem(
                f"the joint at node {node} cuts too much off member {end.member}",
                f"{1e3 * most:.4g} mm of {1e3 * length:.4g} mm",
                f"at most {LONGEST_CUT:.0%} of the member",
                "make the member longer, or join it at another node",
                f"members.{end.member}",
            )
        )
    return most


def _half_depth(structure: Structure, contours: dict[str, Contour], end: End, direction: Floats) -> float:
    """Largest reach of a section from its axis along a direction [m]."""
    frame = structure.frame_of(end.member)
    return float(np.abs(contours[end.member].points @ (frame.axes[1:] @ direction)).max())


def _within(node: str, end: End, other: End, angle: float) -> InputError:
    return InputError(
        Problem(
            f"the members {end.member} and {other.member} overlap along their length at node {node}",
            f"{angle:.3g} deg between them",
            f"at least {np.degrees(NARROWEST_ANGLE):.0f} deg",
            "describe them as one member, or move a node",
            f"members.{end.member}",
        )
    )
