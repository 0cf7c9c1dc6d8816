"""Obstacles and members that can come into contact, for the spatial kernel.

A fixed obstacle is part of the ground.  One with a mass is a body that slides along its guide, a driven one a
body whose every freedom is held and some are driven.  What they can touch of members is in `surface`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from crumple._core.spatial.model import (
    ObstacleKind,
    SpatialBody,
    SpatialContact,
    SpatialHinge,
    SpatialJoint,
    SpatialModel,
    SpatialObstacle,
    frame_of,
)
from crumple.multibody.bodies.capsules import member_capsules, touching_pairs
from crumple.multibody.bodies.crumpling_ends import CrumplingEnd
from crumple.multibody.bodies.linkage import GROUND, Linkage
from crumple.multibody.bodies.obstacle_motion import guided_or_driven
from crumple.multibody.bodies.shared_ends import bodies_together, ends_met
from crumple.multibody.bodies.surface import surface_of
from crumple.numeric.arrays import Floats
from crumple.structure import CylinderObstacle, Obstacle, PlaneObstacle, SphereObstacle, Structure

LIGHT = 1e-3
"""Mass of a driven obstacle over that of the structure: its motion is given, so that the mass changes nothing
but the work of its drive; far smaller ones would cost digits."""


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
        Member of every capsule; further capsules are corners of end faces and tips of corners, and points of
        ends that crumple.
    points
        Index of every point of an end that crumples, and its end.
    """

    model: SpatialModel
    joint: dict[str, int]
    drives: tuple[str, ...]
    velocity: Floats
    members: tuple[str, ...] = ()
    points: Mapping[int, CrumplingEnd] = field(default_factory=dict)


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
    surface = surface_of(structure, linkage, moving, member)
    together = {plane: bodies_together(linkage, folding=plane) for plane in (False, True)}
    bodies, joints, drives, names = list(model.bodies), list(model.joints), list(model.drives), list(owners)
    light = LIGHT * sum(body.mass for body in bodies)
    obstacles, velocity, joint = [], [], {}
    carriers, faces = [], []
    for name, obstacle in structure.obstacles.items():
        body = GROUND
        if obstacle.mass is not None or obstacle.driven:
            body, joint[name] = len(bodies), len(joints)
            mass = obstacle.mass or light
            place = np.asarray(obstacle.point, float)
            bodies.append(SpatialBody(mass, mass * model.length**2 * np.eye(3), place))
            velocity.append(obstacle.velocity if obstacle.mass is not None else (0.0, 0.0, 0.0))
            added, driven = guided_or_driven(obstacle, body, len(joints), duration)
            joints.append(added)
            drives += driven
            names += [name] * len(driven)
            face = face_of(structure, name)
            if face is not None and obstacle.guide_direction is not None:
                carriers.append(SpatialObstacle(ObstacleKind.SPHERE, body, place, capsules=()))
                # the face lies before the mass, and moves back against its guide
                held = (False, True, True, True, True, True)
                share = FACE * mass
                bodies[body] = SpatialBody(mass - share, bodies[body].inertia, place)
                bodies.append(SpatialBody(share, share * model.length**2 * np.eye(3), place))
                velocity.append(velocity[-1])
                joints.append(SpatialJoint(body, body + 1, place, frame_of(obstacle.guide_direction), held))
                faces.append(replace(face, joint=len(joints) - 1))
                body += 1
        allowed = set(structure.members if obstacle.members is None else obstacle.members)
        touching = tuple(i for i, of in enumerate(surface.owners(name, obstacle)) if of & allowed)
        met = ends_met(together[isinstance(obstacle, PlaneObstacle)], surface.capsules, touching)
        obstacles.append(replace(_shape(obstacle, body, touching), ends=met))
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
        obstacles=(*obstacles, *carriers),
        hinges=(*model.hinges, *faces),
        capsules=surface.capsules,
        contact=pairs,
    )
    speeds = np.array(velocity, float).reshape(-1, 3)
    return Touching(touching_model, joint, tuple(names), speeds, surface.members, surface.points)


FACE = 0.005


def face_of(structure, name):
    from crumple.structure.hinges.runs.straight_runs import straight_run
    from crumple.structure.hinges.struck_folds import dents
    from crumple._core.spatial.model import SpatialComponent
    by_run = {next(iter(straight_run(structure, m).stretches)): d for m, d in dents(structure, name).items()}
    if not by_run:
        return None
    deepest = min(d.deepest for d in by_run.values())
    depth = deepest * np.linspace(0.0, 1.0, 41) ** 2
    force = sum(d.force * np.interp(depth / d.deepest, [0.0, .05, .1, .2, .3, .4, .5, 1], np.array([31, 31, 27, 25.5, 34, 39, 40, 40]) / 27.0) + d.root * np.sqrt(np.maximum(depth, 1e-5)) for d in by_run.values())
    depth, force = np.append(depth, deepest + 1e-5), np.append(force, 50.0 * force[-1])
    rigid = (np.zeros(1), np.array([100.0 * force[0] + 10.0 * force[-2]]))
    return SpatialHinge(-1, (SpatialComponent(0, positive=rigid, negative=(depth, force)),))


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


def _unit(direction: tuple[float, float, float]) -> Floats:
    vector = np.asarray(direction, float)
    unit: Floats = vector / np.linalg.norm(vector)
    return unit
