"""Obstacles and members that can come into contact, for the spatial kernel.

A fixed obstacle is part of the ground.  One with a mass is a body that slides along its guide, a driven one a
body whose every freedom is held and some are driven.  Members touch with capsules: segments with a radius.  A
section wider than deep gets two of them side by side, so that its width and its depth are both right.  Planes
are also touched by the corners of free end faces, since a face that tilts on a wall rolls about its rim, and
by the tips of corners, where the walls of two members that meet at an angle go on beyond the node.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from crumple._core.spatial.model import (
    ObstacleKind,
    SpatialBody,
    SpatialCapsule,
    SpatialContact,
    SpatialDrive,
    SpatialJoint,
    SpatialModel,
    SpatialObstacle,
    frame_of,
)
from crumple.cancelling import go_on
from crumple.errors import InputError, Problem
from crumple.multibody.bodies.assembly import Piece
from crumple.multibody.bodies.linkage import GROUND, Linkage
from crumple.multibody.bodies.sampled_functions import sampled_motion
from crumple.numeric.arrays import Floats
from crumple.structure import CylinderObstacle, Obstacle, PlaneObstacle, SphereObstacle, Structure, gap
from crumple.structure.geometry import NARROWEST
from crumple.structure.hinges.corners import leaving

LIGHT = 1e-3
"""Mass of a driven obstacle over that of the structure: its motion is given, so that the mass changes nothing
but the work of its drive; far smaller ones would cost digits."""
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
ROUND = 1.1
"""Ratio of the sides of a section up to which one row of capsules represents it."""


@dataclass(frozen=True, eq=False)
class Touching:
    """A model with its obstacles, and the owners of its further parts.

    Attributes
    ----------
    model
        For the kernel; obstacles in the structure's order, their bodies after those of the linkage.
    joint
        Joint of every moving obstacle by name.
    drives
        Owner of every drive, in the model's order: a support or an obstacle.
    velocity
        Velocity at the start of every body after those of the linkage [m/s], (obstacle bodies, 3).
    members
        Member of every capsule; further capsules are corners of end faces and tips of corners.
    """

    model: SpatialModel
    joint: dict[str, int]
    drives: tuple[str, ...]
    velocity: Floats
    members: tuple[str, ...] = ()


def with_obstacles(
    structure: Structure, linkage: Linkage, model: SpatialModel, owners: tuple[str, ...], duration: float
) -> Touching:
    """Add the obstacles of a structure, and the capsules of its members, to a model.

    Parameters
    ----------
    structure, linkage
        The structure, and its bodies and connections.
    model
        Without obstacles.
    owners
        Supports that the model's drives belong to.
    duration
        Prescribed motion is sampled over it [s].
    """
    if not structure.obstacles and structure.member_contact is None:
        return Touching(model, {}, owners, np.zeros((0, 3)))
    moving, member = member_capsules(structure, linkage.pieces)
    corners = list(end_corners(structure, linkage.pieces))
    first_corner = len(corners)
    capsules = list(moving)
    if any(obstacle.mass is not None for obstacle in structure.obstacles.values()):
        # what is held stops nothing but a mass: other obstacles are held or driven themselves
        held, owner = member_capsules(structure, pieces_by_length(linkage, fixed=True), held=True)
        capsules, member = [*capsules, *held], [*member, *owner]
        corners += end_corners(structure, linkage.pieces, held=True)
    bodies, joints, drives, names = list(model.bodies), list(model.joints), list(model.drives), list(owners)
    light = LIGHT * sum(body.mass for body in bodies)
    obstacles, velocity, joint = [], [], {}
    for name, obstacle in structure.obstacles.items():
        body = GROUND
        if obstacle.mass is not None or obstacle.driven:
            body, joint[name] = len(bodies), len(joints)
            mass = obstacle.mass or light
            place = np.asarray(obstacle.point, float)
            bodies.append(SpatialBody(mass, mass * model.length**2 * np.eye(3), place))
            velocity.append(obstacle.velocity if obstacle.mass is not None else (0.0, 0.0, 0.0))
            added, driven = _moved(obstacle, body, len(joints), duration)
            joints.append(added)
            drives += driven
            names += [name] * len(driven)
        meets_held = obstacle.mass is not None
        owners_of = [{of} if i < len(moving) or meets_held else set() for i, of in enumerate(member)]
        if isinstance(obstacle, PlaneObstacle):
            # what starts inside is met with the round ends of capsules, which are less far out
            owners_of += [
                of
                if (meets_held or i < first_corner) and (free or float(gap(obstacle, ball.first)) > 0.0)
                else set()
                for i, (ball, of, free) in enumerate(corners)
            ]
        allowed = set(structure.members if obstacle.members is None else obstacle.members)
        touching = tuple(i for i, of in enumerate(owners_of) if of & allowed)
        obstacles.append(_shape(obstacle, body, touching))
    contact = structure.member_contact
    pairs = SpatialContact()
    if contact is not None:
        pairs = SpatialContact(
            tuple(touching_pairs(structure, moving, member)), contact.friction, contact.restitution
        )
    touching_model = replace(
        model,
        bodies=tuple(bodies),
        joints=tuple(joints),
        drives=tuple(drives),
        obstacles=tuple(obstacles),
        capsules=(*capsules, *(ball for ball, *_ in corners)),
        contact=pairs,
    )
    speeds = np.array(velocity, float).reshape(-1, 3)
    return Touching(touching_model, joint, tuple(names), speeds, tuple(member))


def pieces_by_length(linkage: Linkage, *, fixed: bool) -> dict[str, tuple[Piece, ...]]:
    """Pieces that keep their length, or those that fold along the member at a hinge at their ends."""
    shortens = {
        (c.hinge.member, c.hinge.station) for c in linkage.connections if c.hinge is not None and 0 in c.free
    }
    return {
        name: tuple(p for p in of if fixed is not bool({(name, p.start), (name, p.end)} & shortens))
        for name, of in linkage.pieces.items()
    }


def _shape(obstacle: Obstacle, body: int, touching: tuple[int, ...]) -> SpatialObstacle:
    place = np.asarray(obstacle.point, float)
    plain = SpatialObstacle(
        ObstacleKind.SPHERE,
        body,
        place,
        friction=obstacle.friction,
        restitution=obstacle.restitution,
        capsules=touching,
    )
    if isinstance(obstacle, PlaneObstacle):
        edge = np.zeros(3) if obstacle.edge is None else _unit(obstacle.edge)
        return replace(plain, kind=ObstacleKind.PLANE, direction=_unit(obstacle.normal), edge=edge)
    if isinstance(obstacle, CylinderObstacle):
        return replace(
            plain,
            kind=ObstacleKind.CYLINDER,
            direction=_unit(obstacle.axis),
            radius=obstacle.radius,
            length=obstacle.length or 0.0,
        )
    assert isinstance(obstacle, SphereObstacle)
    return replace(plain, radius=obstacle.radius)


def _moved(
    obstacle: Obstacle, body: int, joint: int, duration: float
) -> tuple[SpatialJoint, list[SpatialDrive]]:
    """Joint that guides or drives an obstacle, and its drives."""
    place = np.asarray(obstacle.point, float)
    guide = obstacle.guide_direction
    if guide is not None:
        held = (False, True, True, True, True, True)
        return SpatialJoint(GROUND, body, place, frame_of(guide), held), []
    axes = np.eye(3)
    if obstacle.turning is not None:
        place, axes = np.asarray(obstacle.turning.about, float), frame_of(obstacle.turning.axis)
    drives = []
    times, rates = _travel(obstacle, duration)
    for freedom, rate in enumerate(axes @ rates.T):
        if np.any(rate != 0.0):
            drives.append(SpatialDrive(joint, freedom, times, rate))
    if obstacle.turning is not None:
        turn_times, _, turn_rates = sampled_motion(obstacle.turning.angle, duration)
        drives.append(SpatialDrive(joint, 3, turn_times, turn_rates))
    return SpatialJoint(GROUND, body, place, axes, (True,) * 6), drives


def _travel(obstacle: Obstacle, duration: float) -> tuple[Floats, Floats]:
    """Times [s], (n,), and prescribed velocity in global axes [m/s], (n, 3)."""
    if any(obstacle.velocity):
        return np.array([0.0, duration]), np.tile(np.asarray(obstacle.velocity, float), (2, 1))
    parts = []
    for axis in "xyz":
        function = getattr(obstacle.motion, axis)
        times, _, rates = (
            (np.zeros(1), None, np.zeros(1)) if function is None else sampled_motion(function, duration)
        )
        parts.append((times, rates))
    union = np.unique(np.concatenate([times for times, _ in parts]))
    return union, np.stack([np.interp(union, times, rates) for times, rates in parts], axis=1)


def member_capsules(
    structure: Structure, of_member: Mapping[str, tuple[Piece, ...]], *, held: bool = False
) -> tuple[list[SpatialCapsule], list[str]]:
    """Capsules of all pieces that move, or of all that are held, and the member of each."""
    ends = Counter(node for member in structure.members.values() for node in member.nodes)
    capsules, owner = [], []
    for name, pieces in of_member.items():
        frame, nodes = structure.frame_of(name), structure.members[name].nodes
        places, radius = capsule_rows(structure.section_of(name).outer_outline())
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
            for place in places:
                shift = place @ frame.axes[1:]
                capsules.append(
                    SpatialCapsule(
                        piece.body, frame.position(start) + shift, frame.position(end) + shift, radius
                    )
                )
                owner.append(name)
    return capsules, owner


def end_corners(
    structure: Structure, of_member: Mapping[str, tuple[Piece, ...]], *, held: bool = False
) -> Iterator[tuple[SpatialCapsule, set[str], bool]]:
    """Small balls in corners of end faces and tips of corners that move, or that are held.

    With each its members, and whether it belongs to a free end face, which moves.
    """
    for node, members in structure.members_at.items():
        if len(members) > 2 or (len(members) == 2 and structure.joints_at.get(node)):
            continue
        axes = [leaving(structure, name, node) for name in members]
        there: list[tuple[SpatialCapsule, set[str]]] = []
        for i, name in enumerate(members):
            body = _end_body(structure, of_member[name], node)
            if (body == GROUND) is not held:
                continue
            outline, across = structure.section_of(name).outer_outline(), structure.frame_of(name).axes[1:]
            radius = POINT * capsule_rows(outline)[1]
            if len(members) == 1:
                points = _face_corners(outline, radius) @ across + radius * axes[i]
            else:
                points = _tips(outline, radius, across, axes[i], axes[1 - i])
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
            yield ball, of, len(members) == 1 and not held


def _end_body(structure: Structure, pieces: tuple[Piece, ...], node: str) -> int:
    """Body of a member's walls at a node; there are none between the node and a hinge that lies there."""
    from_node = structure.members[pieces[0].member].nodes[0] == node
    return next(piece.body for piece in (pieces if from_node else pieces[::-1]) if piece.end > piece.start)


def _tips(outline: Floats, inset: float, across: Floats, axis: Floats, other: Floats) -> Floats:
    """Corners of a member's walls beyond the node that another shares, from the node, (points, 3) [m].

    Every line along the walls starts in the plane that halves the angle, as at a mitre, but not further
    beyond the node than it is from the member's axis: at acute angles shells have no mitre, but this outline.
    """
    plane = axis - other
    if float(axis @ other) > math.cos(NARROWEST):
        return np.zeros((0, 3))

    def starts(points: Floats) -> Floats:
        arms = points @ across
        meeting = -(arms @ plane) / float(axis @ plane)
        return np.asarray(np.maximum(meeting, -np.linalg.norm(arms, axis=1)))

    # the line that starts first may lie between the directions; of equal ones the first in this order
    first = outline[int(np.rint(starts(outline) / inset).argmin())]
    points = np.vstack([_face_corners(outline, inset), _moved_in(first, outline, inset)])
    start = starts(points)
    kept = start < -LEAST_TIP * np.linalg.norm(points, axis=1)
    return np.asarray((points @ across + start[:, None] * axis)[kept])


def _face_corners(outline: Floats, inset: float) -> Floats:
    """Points of an outline that are outermost in `DIRECTIONS`, moved in, (points, 2) [m]."""
    turns = 2.0 * np.pi * (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS
    outwards = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    return _moved_in(outline[np.unique((outline @ outwards.T).argmax(axis=0))], outline, inset)


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


def _unit(direction: tuple[float, float, float]) -> Floats:
    vector = np.asarray(direction, float)
    unit: Floats = vector / np.linalg.norm(vector)
    return unit
