"""Capsules of members for contact: segments with a radius, corners of end faces and tips of corners.

A section wider than deep gets two rows of capsules side by side, so that its width and its depth are both
right.  Planes are also touched by the corners of end faces, since a face that tilts on a wall rolls about its
rim, and by the tips of corners, where the walls of two members that meet at an angle go on beyond the node.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from crumple._core.spatial.model import SpatialCapsule, SpatialFold
from crumple.cancelling import go_on
from crumple.errors import InputError, Problem
from crumple.multibody.bodies.assembly import Piece
from crumple.multibody.bodies.linkage import GROUND, Linkage
from crumple.numeric.arrays import Floats, Integers
from crumple.section import AXES, half_fold_length
from crumple.structure import PlaneObstacle, Structure
from crumple.structure.geometry import NARROWEST
from crumple.structure.hinges.corners import leaving

MOST_PAIRS = 1_000_000
"""Pairs of bars that may touch each other; the kernel looks at each."""
WITHIN = 1.001
"""Distance of a capsule's last ball from a free end, over its radius: the corners of the face touch first."""
POINT = 1e-3
"""Radius of the corners of an end face, over that of the member's capsules."""
DIRECTIONS = 8
"""Directions in which an end face has a corner: 4 different ones of a rectangle, 8 of a round tube."""
LEAST_TIP = 0.1
"""Least distance of a tip beyond its node, over that from the member's axis: at bends below 11 to 16 degrees
the round ends of capsules reach as far, within 1 % of their radius."""
STANDS_OUT = 1.2
"""Distance from the node towards a plane of a tip of three members over that of their capsules from which it
counts: flush contacts that touch with both take several times the linear solves, with the same result."""
SAME = 1e-7
"""Distance [m] below which places are the same."""
ROUND = 1.1
"""Ratio of the sides of a section up to which one row of capsules represents it."""


def pieces_by_length(linkage: Linkage, *, fixed: bool) -> dict[str, tuple[Piece, ...]]:
    """Pieces that keep their length, or those that fold along the member at a hinge at their ends."""
    shortens = {
        (c.hinge.member, c.hinge.station) for c in linkage.connections if c.hinge is not None and 0 in c.free
    }
    return {
        name: tuple(p for p in of if fixed is not bool({(name, p.start), (name, p.end)} & shortens))
        for name, of in linkage.pieces.items()
    }


def member_capsules(
    structure: Structure, of_member: Mapping[str, tuple[Piece, ...]], *, held: bool = False
) -> tuple[list[SpatialCapsule], list[str]]:
    """Capsules of all pieces that move, or of all that are held, and the member of each."""
    ends = Counter(node for member in structure.members.values() for node in member.nodes)
    capsules, owner = [], []
    for name, pieces in of_member.items():
        frame, nodes = structure.frame_of(name), structure.members[name].nodes
        radius = capsule_rows(structure.section_of(name).outer_outline())[1]
        # the round end of a capsule lies within a free end of the member, and rounds a corner
        inset = radius if held else WITHIN * radius
        first, last = (inset if ends[node] == 1 else 0.0 for node in nodes)
        spine = (first, frame.length - last)
        if spine[0] > spine[1]:
            spine = (frame.length / 2.0, frame.length / 2.0)
        for piece in pieces:
            start, end = max(piece.start, spine[0]), min(piece.end, spine[1])
            if (piece.body == GROUND) is not held or start > end:
                continue
            for shift in row_shifts(structure, name):
                capsules.append(
                    SpatialCapsule(
                        piece.body, frame.position(start) + shift, frame.position(end) + shift, radius
                    )
                )
                owner.append(name)
    return capsules, owner


def with_folds(
    structure: Structure, linkage: Linkage, capsules: Sequence[SpatialCapsule], owner: Sequence[str]
) -> list[SpatialCapsule]:
    """Capsules of members with the folds at which they end; a hinge stands for a whole fold."""
    folds = defaultdict(list)
    for connection in linkage.connections:
        hinge = connection.hinge
        if hinge is not None and hinge.plastic:
            fold = fold_at(structure, hinge.member, connection.position)
            folds[hinge.member].append((hinge.station, fold))
    found = []
    for capsule, member in zip(capsules, owner, strict=True):
        frame = structure.frame_of(member)
        ends = [float(frame.x @ (end - frame.origin)) for end in (capsule.first, capsule.second)]
        at = (fold for station, fold in folds[member] if min(abs(station - end) for end in ends) < SAME)
        found.append(replace(capsule, folds=tuple(at)))
    return found


def fold_at(structure: Structure, member: str, middle: Floats) -> SpatialFold:
    """Fold of a member about a place on its axis [m], (3,)."""
    section = structure.section_of(member)
    return SpatialFold(middle, max(half_fold_length(section, axis) for axis in AXES))


def end_corners(
    structure: Structure, of_member: Mapping[str, tuple[Piece, ...]], *, held: bool = False
) -> Iterator[tuple[SpatialCapsule, set[str], str | None]]:
    """Small balls in corners of end faces and tips of corners that move, or that are held.

    With each its members, and the node of a free end face, which moves.
    """
    for node, members in structure.members_at.items():
        if len(members) > 1 and structure.joints_at.get(node):
            continue
        if len(members) > 2 and any(
            len(outermost(structure.section_of(m).outer_outline())) > 4 for m in members
        ):
            continue
        axes = [leaving(structure, name, node) for name in members]
        there: list[tuple[SpatialCapsule, set[str]]] = []
        for i, name in enumerate(members):
            body = end_body(structure, of_member[name], node)
            if (body == GROUND) is not held:
                continue
            outline, across = structure.section_of(name).outer_outline(), structure.frame_of(name).axes[1:]
            radius = POINT * capsule_rows(outline)[1]
            if len(members) == 1:
                points = _face_corners(outline, radius) @ across + radius * axes[i]
            else:
                points = _tips(outline, radius, across, axes[i], axes[:i] + axes[i + 1 :])
            if len(members) > 2:
                points = _standing_out(structure, members, points)
            for place in np.asarray(structure.nodes[node], float) + points:
                # members that move as one have the same tips at their mitre
                near = (
                    of
                    for ball, of in there
                    if ball.body == body and np.linalg.norm(ball.first - place) < radius
                )
                owners = next(near, None)
                if owners is None:
                    there.append((SpatialCapsule(body, place, place, radius), {name}))
                else:
                    owners.add(name)
        for ball, of in there:
            yield ball, of, node if len(members) == 1 and not held else None


def end_body(structure: Structure, pieces: tuple[Piece, ...], node: str) -> int:
    """Body of a member's walls at a node; there are none between the node and a hinge that lies there."""
    from_node = structure.members[pieces[0].member].nodes[0] == node
    return next(piece.body for piece in (pieces if from_node else pieces[::-1]) if piece.end > piece.start)


def _tips(outline: Floats, inset: float, across: Floats, axis: Floats, others: list[Floats]) -> Floats:
    """Corners of a member's walls beyond the node that others share, from the node, (points, 3) [m].

    Every line along the walls starts in the last of the planes that halve the angles, as at a mitre, but not
    further beyond the node than it is from the member's axis: at acute angles shells have no mitre, but this
    outline.
    """
    planes = np.array([axis - other for other in others])
    if any(float(axis @ other) > math.cos(NARROWEST) for other in others):
        return np.zeros((0, 3))

    def starts(points: Floats) -> Floats:
        arms = points @ across
        meeting = (-(arms @ planes.T) / (planes @ axis)).max(axis=1)
        return np.asarray(np.maximum(meeting, -np.linalg.norm(arms, axis=1)))

    # the lines that start first may lie between the directions; all of equal ones, for mirror images
    start = starts(outline)
    first = outline[start <= start.min() + inset]
    points = np.vstack([_face_corners(outline, inset), _moved_in(first, outline, inset)])
    start = starts(points)
    kept = start < -LEAST_TIP * np.linalg.norm(points, axis=1)
    return np.asarray((points @ across + start[:, None] * axis)[kept])


def _standing_out(structure: Structure, members: Sequence[str], points: Floats) -> Floats:
    """Those points from the node of some members that a plane meets well before their capsules."""
    found = np.zeros(len(points), bool)
    for obstacle in structure.obstacles.values():
        if isinstance(obstacle, PlaneObstacle):
            towards = -np.asarray(obstacle.normal, float) / np.linalg.norm(obstacle.normal)
            reach = max(
                float((row_shifts(structure, name) @ towards).max())
                + capsule_rows(structure.section_of(name).outer_outline())[1]
                for name in members
            )
            found |= points @ towards > STANDS_OUT * reach
    return np.asarray(points[found])


def _face_corners(outline: Floats, inset: float) -> Floats:
    """Points of an outline that are outermost in `DIRECTIONS`, moved in, (points, 2) [m]."""
    return _moved_in(outline[outermost(outline)], outline, inset)


def outermost(outline: Floats) -> Integers:
    """Which points of an outline are outermost in `DIRECTIONS`: the corners of a rectangle."""
    turns = 2.0 * np.pi * (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS
    outwards = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    return np.unique((outline @ outwards.T).argmax(axis=0))


def _moved_in(points: Floats, outline: Floats, inset: float) -> Floats:
    middle = (outline.min(axis=0) + outline.max(axis=0)) / 2.0
    return np.asarray(points - inset * np.sign(points - middle))


def capsule_rows(outline: Floats) -> tuple[Floats, float]:
    """Places of a member's capsules in its section [m], (rows, 2), and their radius [m]."""
    low, high = outline.min(axis=0), outline.max(axis=0)
    centre, size = (low + high) / 2.0, high - low
    radius = float(size.min()) / 2.0
    if size.max() <= ROUND * size.min():
        return centre[None, :], float(size.mean()) / 2.0
    apart = np.zeros(2)
    apart[int(size.argmax())] = float(size.max()) / 2.0 - radius
    return np.array([centre - apart, centre + apart]), radius


def row_shifts(structure: Structure, member: str) -> Floats:
    """Places of a member's capsules from its axis at the start [m], (rows, 3)."""
    places, _ = capsule_rows(structure.section_of(member).outer_outline())
    return np.asarray(places @ structure.frame_of(member).axes[1:])


def touching_pairs(
    structure: Structure, capsules: list[SpatialCapsule], member: list[str]
) -> Iterator[tuple[int, int]]:
    """Pairs of capsules that can come into contact: of members without a common node, on different bodies."""
    if len(capsules) * (len(capsules) - 1) // 2 > MOST_PAIRS:
        what, allowed = (
            f"{len(capsules)} bars are too many to touch each other",
            f"at most {MOST_PAIRS} pairs",
        )
        todo = "leave 'member_contact' out, or describe the structure by fewer bars"
        raise InputError(Problem(what, "", allowed, todo, "member_contact"))
    nodes = {name: set(spec.nodes) for name, spec in structure.members.items()}
    for i, j in combinations(range(len(capsules)), 2):
        go_on()
        if capsules[i].body != capsules[j].body and not nodes[member[i]] & nodes[member[j]]:
            yield i, j
