"""Obstacles and members that can come into contact, for the spatial kernel.

A fixed obstacle is part of the ground.  One with a mass is a body that slides along its guide, a driven one a
body whose every freedom is held and some are driven.  What dents walls has a face besides, see `faces`.  What
they can touch of members is in `surface`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np

from crumple._core.spatial.model import (
    ObstacleKind,
    SpatialBody,
    SpatialContact,
    SpatialDrive,
    SpatialJoint,
    SpatialModel,
    SpatialObstacle,
)
from crumple.multibody.bodies.capsules import member_capsules, touching_pairs, with_folds
from crumple.multibody.bodies.crossing import crossing_members
from crumple.multibody.bodies.crumpling_ends import CrumplingEnd
from crumple.multibody.bodies.edges import shifts
from crumple.multibody.bodies.linkage import GROUND, Linkage
from crumple.multibody.bodies.obstacles.faces import Face, face_of
from crumple.multibody.bodies.obstacles.motion import guided_or_driven
from crumple.multibody.bodies.obstacles.sunk_walls import SunkWall, sunk_walls, with_walls
from crumple.multibody.bodies.shared_ends import Place, bodies_together, covered_by_folds, ends_met
from crumple.multibody.bodies.surface import Surface, surface_of
from crumple.numeric.arrays import Floats
from crumple.structure import (
    CylinderObstacle,
    DentedTube,
    Obstacle,
    PlaneObstacle,
    SphereObstacle,
    Stage,
    Structure,
    dented_tubes,
)
from crumple.structure.hinges.runs.straight_runs import straight_run

LIGHT = 1e-3
"""Mass of a driven obstacle, or of a face, over that of the structure.  The motion of a driven one is given,
so that its mass changes nothing but the work of its drive; far smaller ones would cost digits."""
Together = Mapping[Place, Mapping[int, int]]
"""Bodies whose points at a place stay together, as of `bodies_together`."""
Velocity = tuple[float, float, float]
"""[m/s]."""


@dataclass(frozen=True, eq=False)
class Touching:
    """A model with its obstacles, and the owners of its further parts.

    Attributes
    ----------
    model
        For the kernel; obstacles in the structure's order, their bodies after those of the linkage and walls.
    joint
        Joint of every moving obstacle by name.
    drives
        Owner of every drive, in the model's order: a support or an obstacle.
    velocity
        Velocity at the start of every body of an obstacle [m/s], (obstacle bodies, 3).
    members
        Member of every capsule; further capsules are corners of end faces and tips of corners, and points of
        ends that crumple.
    points
        Index of every point of an end that crumples, and its end.
    faces
        Faces of obstacles that dent walls; their slips are the last hinges of the model.
    walls
        Walls into whose folds poles sink.
    obstacles
        Name of every obstacle of the model: those of the structure, and again those that have a face, for
        what is behind it.
    """

    model: SpatialModel
    joint: dict[str, int]
    drives: tuple[str, ...]
    velocity: Floats
    members: tuple[str, ...] = ()
    points: Mapping[int, CrumplingEnd] = field(default_factory=dict)
    faces: tuple[Face, ...] = ()
    walls: tuple[SunkWall, ...] = ()
    obstacles: tuple[str, ...] = ()


def with_obstacles(
    structure: Structure,
    linkage: Linkage,
    model: SpatialModel,
    owners: tuple[str, ...],
    stages: Sequence[Stage],
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
    stages
        Of the run.  Prescribed motion is sampled over the longest; where one is quasi-static, nothing dents.
    """
    if not structure.obstacles and structure.member_contact is None:
        return Touching(model, {}, owners, np.zeros((0, 3)))
    walls = sunk_walls(structure, linkage, model)
    light = LIGHT * sum(body.mass for body in model.bodies)
    model = with_walls(model, walls, light)
    moving, member = member_capsules(structure, linkage.pieces)
    moving = with_folds(structure, linkage, moving, member)
    surface = surface_of(structure, linkage, moving, member, walls)
    rows = {name: shifts(structure, surface.edges, name) for name in structure.members}
    together = {plane: bodies_together(linkage, rows, folding=plane) for plane in (False, True)}
    added = _Added(model, light)
    obstacles = _obstacles(structure, linkage, added, surface, together, stages)
    contact = structure.member_contact
    pairs = SpatialContact()
    if contact is not None:
        of = surface.member
        between = list(touching_pairs(structure, surface.whole, of))
        crossing = crossing_members(surface.whole, of, between)
        meeting = tuple(pair for pair in between if (of[pair[0]], of[pair[1]]) not in crossing)
        pairs = SpatialContact(meeting, contact.friction, contact.restitution)
    touching_model = replace(
        model,
        bodies=(*model.bodies, *added.bodies),
        joints=(*model.joints, *added.joints),
        drives=(*model.drives, *added.drives),
        obstacles=(*obstacles, *added.behind.values()),
        hinges=(*model.hinges, *(face.slip for face in added.faces)),
        capsules=surface.capsules,
        contact=pairs,
    )
    return Touching(
        touching_model,
        added.joint,
        (*owners, *added.owners),
        np.array(added.velocity, float).reshape(-1, 3),
        surface.members,
        surface.points,
        tuple(added.faces),
        walls,
        (*structure.obstacles, *added.behind),
    )


def _obstacles(
    structure: Structure,
    linkage: Linkage,
    added: _Added,
    surface: Surface,
    together: Mapping[bool, Together],
    stages: Sequence[Stage],
) -> list[SpatialObstacle]:
    """Solids of all obstacles, in their order; `together`: as of `bodies_together`, for planes and others.

    A face meets the tubes that it dents, and what is behind it the rest.
    """
    duration = max(stage.duration for stage in stages)
    fast = all(stage.kind == "dynamic" for stage in stages)
    # the resultant that ends a stage is that of one solid
    ends_on = {until.of for stage in stages for until in stage.until if until.quantity == "force"}
    found = []
    for name, obstacle in structure.obstacles.items():
        mass = body = added.obstacle(name, obstacle, duration)
        covered: Set[tuple[int, int]] = set()
        if isinstance(obstacle, PlaneObstacle):
            covered = covered_by_folds(
                structure, linkage, surface.capsules, surface.members, _unit(obstacle.normal)
            )
        at = together[isinstance(obstacle, PlaneObstacle)]
        ends = partial(ends_met, at, surface.capsules, covered=covered)
        allowed = set(structure.members if obstacle.members is None else obstacle.members)
        touching = {i: of for i, of in enumerate(surface.owners(name, obstacle)) if of & allowed}
        tubes = dented_tubes(structure, name) if fast else ()
        if tubes:
            body = added.face(name, obstacle, tubes, mass)
            runs = (straight_run(structure, tube.member) for tube in tubes)
            dented = allowed if name in ends_on else {member for run in runs for member in run.stretches}
            rest = tuple(i for i, of in touching.items() if not of & dented)
            added.behind[name] = _solid(obstacle, mass, rest, ends)
            touching = {i: of for i, of in touching.items() if of & dented}
        found.append(_solid(obstacle, body, tuple(touching), ends))
    return found


class _Added:
    """Bodies, joints and drives of obstacles, each counted on from those of the model."""

    def __init__(self, model: SpatialModel, light: float) -> None:
        self._model = model
        self._light = light
        self.bodies: list[SpatialBody] = []
        self.velocity: list[Velocity] = []
        self.joints: list[SpatialJoint] = []
        self.joint: dict[str, int] = {}
        self.drives: list[SpatialDrive] = []
        self.owners: list[str] = []
        self.faces: list[Face] = []
        self.behind: dict[str, SpatialObstacle] = {}

    def obstacle(self, name: str, obstacle: Obstacle, duration: float) -> int:
        """Add an obstacle that moves; its body, or the ground."""
        if obstacle.mass is None and not obstacle.driven:
            return GROUND
        body = self._body(obstacle, obstacle.mass or self._light)
        joint = self.joint[name] = len(self._model.joints) + len(self.joints)
        added, drives = guided_or_driven(obstacle, body, joint, duration)
        self.joints.append(added)
        self.drives += drives
        self.owners += [name] * len(drives)
        return body

    def face(self, name: str, obstacle: Obstacle, tubes: tuple[DentedTube, ...], mass: int) -> int:
        """Add the face of an obstacle; the body of the face."""
        place = np.asarray(obstacle.point, float)
        hinge = len(self._model.hinges) + len(self.faces)
        joint = len(self._model.joints) + len(self.joints)
        face = face_of(name, tubes, hinge, joint)
        body = self._body(obstacle, self._light)
        self.joints.append(face.guide(mass, body, place))
        self.faces.append(face)
        return body

    def _body(self, obstacle: Obstacle, mass: float) -> int:
        inertia = mass * self._model.length**2 * np.eye(3)
        self.bodies.append(SpatialBody(mass, inertia, np.asarray(obstacle.point, float)))
        self.velocity.append(obstacle.velocity if obstacle.mass is not None else (0.0, 0.0, 0.0))
        return len(self._model.bodies) + len(self.bodies) - 1


def _solid(
    obstacle: Obstacle,
    body: int,
    touching: tuple[int, ...],
    ends: Callable[[tuple[int, ...]], tuple[int, ...]],
) -> SpatialObstacle:
    """Solid of an obstacle that touches some capsules, and the ends of these that it meets."""
    place = np.asarray(obstacle.point, float)
    plain = SpatialObstacle(
        ObstacleKind.SPHERE,
        body,
        place,
        friction=obstacle.friction,
        restitution=obstacle.restitution,
        capsules=touching,
        ends=ends(touching),
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
