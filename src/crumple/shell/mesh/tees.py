"""Welded T-joints: a branch whose end meets one face of a member that goes through, with shared nodes.

The through member consists of two members in line with one section in one position.  Rows and rings of its
mesh follow the branch's outline on the face; the branch is divided where they cross the outline, cut back to
the face, and takes their nodes: walls of both are joined as by a weld along the whole outline.
The through wall goes on inside the outline.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from crumple.numeric.arrays import Floats, Integers
from crumple.section.shapes.rectangular_tube import RectangularTube
from crumple.shell.mesh.end import End
from crumple.shell.mesh.profile import Contour, number_of_sides
from crumple.structure import Structure

STEEPEST = np.cos(np.radians(30.0))
"""Cosine of the angle between both members from which a joint stays rigid."""
IN_LINE = 1e-6
"""Sine of the angle up to which directions are one."""
SAME_ROW = 0.25
"""Distance over the element size up to which a row of nodes is moved to another one."""
LONGEST = 0.35
"""Share of a member of the through member that the outline may take."""


@dataclass(frozen=True, eq=False)
class Tee:
    """A branch welded to a face.

    Attributes
    ----------
    node
        Of the joint.
    before, after
        The members in line: the one that ends at the node, and the one that starts there.
    branch
        End of the branch.
    across, out
        Axis of the section (0 y, 1 z) along the face and across it.
    side
        +1 or -1: sign of the face's coordinate.
    height
        Distance of the face's mid-plane from the axis [m].
    half_width
        Of the outline, across the through member [m].
    span
        First and last station of the outline from the node, along the through member [m].
    """

    node: str
    before: str
    after: str
    branch: End
    across: int
    out: int
    side: int
    height: float
    half_width: float
    span: tuple[float, float]

    def stations(self, member: str, length: float) -> list[float]:
        """Stations of a through member at which the outline needs a ring [m]."""
        if member == self.before:
            return [length + at for at in self.span if at < 0.0]
        return [at for at in self.span if at > 0.0] if member == self.after else []


def tees_of(
    structure: Structure, contours: Mapping[str, Contour], ends: Mapping[str, tuple[End, ...]], size: float
) -> dict[str, Tee]:
    """Joints of three members that can be welded, by node.

    Parameters
    ----------
    structure
        Sound.
    contours
        Divided sections.
    ends
        Ends of members at each node that may be welded.
    size
        Of the elements there [m].

    Notes
    -----
    A member is a branch at one end only, and not at once a branch and a through member.
    """
    found: dict[str, Tee] = {}
    branches: set[str] = set()
    through: set[str] = set()
    for node, meeting in ends.items():
        tee = _tee(structure, contours, node, meeting, size) if len(meeting) == 3 else None
        if tee is None or tee.branch.member in branches | through or {tee.before, tee.after} & branches:
            continue
        found[node] = tee
        branches.add(tee.branch.member)
        through |= {tee.before, tee.after}
    return found


def _tee(
    structure: Structure, contours: Mapping[str, Contour], node: str, ends: tuple[End, ...], size: float
) -> Tee | None:
    for branch in ends:
        before, after = sorted((end for end in ends if end is not branch), key=lambda end: not end.second)
        if not before.second or after.second or not _in_line(structure, before.member, after.member):
            continue
        sections = [structure.section_of(end.member) for end in (before, branch)]
        if not all(isinstance(section, RectangularTube) for section in sections):
            continue
        frame = structure.frame_of(before.member)
        x = structure.frame_of(branch.member).x * (-1.0 if branch.second else 1.0)
        along = float(frame.x @ x)
        if abs(along) > STEEPEST:
            continue
        sine = float(np.sqrt(1.0 - along**2))
        inside = frame.axes[1:] @ (x - along * frame.x) / sine
        out = int(np.argmax(np.abs(inside)))
        own = structure.frame_of(branch.member).axes[1:] @ frame.axes[2 - out]
        if abs(inside[1 - out]) > IN_LINE or np.abs(own).min() > IN_LINE:
            continue
        return _outline(
            structure,
            contours,
            Tee(
                node,
                before.member,
                after.member,
                branch,
                1 - out,
                out,
                int(np.sign(inside[out])),
                0.0,
                0.0,
                (0.0, 0.0),
            ),
            (along, sine, int(np.argmax(np.abs(own)))),
            size,
        )
    return None


def _in_line(structure: Structure, before: str, after: str) -> bool:
    same = structure.section_of(before) == structure.section_of(after)
    first, second = (structure.frame_of(name).axes for name in (before, after))
    return bool(same and np.allclose(first, second, atol=IN_LINE))


def _outline(
    structure: Structure, contours: Mapping[str, Contour], tee: Tee, at: tuple[float, float, int], size: float
) -> Tee | None:
    """The joint with the place of its outline; None where the face has no room for it."""
    along, sine, wide = at
    points, own = contours[tee.before].points, contours[tee.branch.member].points
    height = float((tee.side * points[:, tee.out]).max())
    flat = np.abs(points[_on_face(points, tee.out, tee.side), tee.across]).max()
    half_width, half_depth = np.abs(own[:, wide]).max(), np.abs(own[:, 1 - wide]).max()
    walls = [structure.section_of(name).thickness for name in (tee.before, tee.branch.member)]
    near = SAME_ROW * size
    if half_width > flat + max(near, walls[0] / 2):
        return None
    # as wide outside: mid-planes of walls of other thicknesses are apart
    as_wide = abs(half_width - flat + (walls[1] - walls[0]) / 2) < near
    half_width = flat if as_wide or half_width > flat - near else half_width
    span = [(height * along + sign * half_depth) / sine for sign in (-1.0, 1.0)]
    span = [0.0 if abs(one) < 2 * SAME_ROW * size else one for one in span]
    lengths = [structure.frame_of(name).length for name in (tee.before, tee.after)]
    if -span[0] > LONGEST * lengths[0] or span[1] > LONGEST * lengths[1]:
        return None
    if height / sine > LONGEST * structure.frame_of(tee.branch.member).length:
        return None
    return replace(tee, height=height, half_width=float(half_width), span=(span[0], span[1]))


def _on_face(points: Floats, out: int, side: int) -> Integers:
    """Numbers of the points of a flat face."""
    level = side * points[:, out]
    return np.flatnonzero(level > level.max() - IN_LINE * np.ptp(points))


def with_rows(contours: Mapping[str, Contour], tees: Iterable[Tee], size: float) -> dict[str, Contour]:
    """Sections of the through members, divided anew on faces so that rows of nodes follow the outlines.

    Members in line get one division.
    """
    tees = tuple(tees)
    group = {name: name for tee in tees for name in (tee.before, tee.after)}
    for _ in tees:
        for tee in tees:
            group[tee.before] = group[tee.after] = min(group[tee.before], group[tee.after])
    new = dict(contours)
    for name, first in group.items():
        faces = {(tee.out, tee.side) for tee in tees if group[tee.before] == first}
        for out, side in sorted(faces):
            widths = {
                round(tee.half_width, 9)
                for tee in tees
                if group[tee.before] == first and (tee.out, tee.side) == (out, side)
            }
            new[name] = _divided(new[name], out, side, widths, size)
    return new


def _divided(contour: Contour, out: int, side: int, widths: set[float], size: float) -> Contour:
    points = contour.points
    face = _on_face(points, out, side)
    # the face as a run of the closed contour
    start = next(int(i) for i in face if (i - 1) % len(points) not in face)
    turned = np.roll(points, -start, axis=0)
    last = len(face) - 1
    first, end = turned[0, 1 - out], turned[last, 1 - out]
    flat, sign = abs(end), float(np.sign(end - first))
    breaks = [-flat, flat, *(s * w for w in widths for s in (-1.0, 1.0) if w < flat - IN_LINE * flat)]
    rows = np.concatenate(
        [
            [-flat],
            *(
                np.linspace(a, b, number_of_sides(b - a, size, bend=False) + 1)[1:]
                for a, b in pairwise(sorted(breaks))
            ),
        ]
    )
    own = np.full((len(rows), 2), turned[0, out])
    own[:, 1 - out] = sign * rows
    points = np.concatenate([own, turned[last + 1 :]])
    numbers = np.arange(len(points))
    sides = np.column_stack([numbers, np.roll(numbers, -1)])
    return Contour(points, sides, np.full(len(points), contour.thickness[0]))


@dataclass(frozen=True, eq=False)
class Seam:
    """Nodes of the through member on the outline, in the order of the branch's contour.

    Attributes
    ----------
    places
        (member, ring, point) of each node.
    position
        From the joint's node [m], (n, 3).
    """

    places: tuple[tuple[str, int, int], ...]
    position: Floats


def seam_of(structure: Structure, tee: Tee, contour: Contour, rings: Mapping[str, Floats]) -> Seam:
    """Seam of a joint: once around the outline, counter-clockwise in the branch's section.

    Parameters
    ----------
    structure, tee
        Sound.
    contour
        Of the through member.
    rings
        Stations of the rings of each member [m].
    """
    frame = structure.frame_of(tee.before)
    face = _on_face(contour.points, tee.out, tee.side)
    across = contour.points[face, tee.across]
    inside = face[np.abs(across) < tee.half_width * (1.0 + IN_LINE)]
    columns = inside[np.argsort(contour.points[inside, tee.across])].tolist()
    rows = [
        *((tee.before, i, float(at - frame.length)) for i, at in enumerate(rings[tee.before])),
        *((tee.after, i, float(at)) for i, at in enumerate(rings[tee.after]) if i),
    ]
    at = np.array([row[2] for row in rows])
    first, last = (int(np.abs(at - end).argmin()) for end in tee.span)
    rows = rows[first : last + 1]
    loop = [
        *((rows[0], column) for column in columns[:-1]),
        *((row, columns[-1]) for row in rows[:-1]),
        *((rows[-1], column) for column in columns[:0:-1]),
        *((row, columns[0]) for row in rows[:0:-1]),
    ]
    position = np.array([row[2] * frame.x + contour.points[c] @ frame.axes[1:] for row, c in loop])
    y, z = structure.frame_of(tee.branch.member).axes[1:] @ position.T
    if float(y @ np.roll(z, -1) - z @ np.roll(y, -1)) < 0.0:
        loop, position = loop[::-1], position[::-1]
    return Seam(tuple((row[0], row[1], column) for row, column in loop), position)


def branch_contour(structure: Structure, tee: Tee, seam: Seam) -> Contour:
    """Section of the branch, divided at the nodes of the seam."""
    member = tee.branch.member
    points = seam.position @ structure.frame_of(member).axes[1:].T
    numbers = np.arange(len(points))
    sides = np.column_stack([numbers, np.roll(numbers, -1)])
    return Contour(points, sides, np.full(len(points), structure.section_of(member).thickness))


def shared_nodes(seam: Seam, nodes: Mapping[str, Integers]) -> Integers:
    """Nodes of the seam.

    Parameters
    ----------
    seam
        Of a joint.
    nodes
        Node of each ring and point of every member.
    """
    return np.array([nodes[member][ring, point] for member, ring, point in seam.places], dtype=np.int64)
