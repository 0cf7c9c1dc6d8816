"""Obstacles: rigid planes, cylinders and spheres, fixed, driven or with a mass on a guide."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Discriminator, Tag, model_validator

from crumple.numeric.arrays import Floats
from crumple.registry.quantity import (
    Direction,
    FrictionCoefficient,
    Position,
    PositiveLength,
    PositiveMass,
    Restitution,
    Velocity,
)
from crumple.registry.refusal import refuse
from crumple.structure.keys.time_function import AngleFunction, LengthFunction
from crumple.structure.schema.spec import Name, Spec, type_tag

SLANT = 1e-3
"""Share of a vector at an angle to where it should point that is taken for rounding of the input, and left
out: directions and velocities with four digits err by 1e-4."""


class Travel(Spec):
    """Prescribed displacement in global axes, each a function of time that starts from 0."""

    x: LengthFunction | None = None
    """Displacement along x."""
    y: LengthFunction | None = None
    """Displacement along y."""
    z: LengthFunction | None = None
    """Displacement along z."""


class Turning(Spec):
    """Prescribed rotation about a fixed axis."""

    about: Position
    """Point on the axis."""
    axis: Direction
    """Direction of the axis, right-handed; of any length."""
    angle: AngleFunction
    """Angle as a function of time that starts from 0."""

    @model_validator(mode="after")
    def _has_axis(self) -> Turning:
        _refuse_zero("axis", self.axis)
        return self


class Obstacle(Spec):
    """Keys that every obstacle has: motion and contact."""

    point: Position
    """Point on the plane or its edge, on the cylinder's axis, or the sphere's centre."""
    friction: FrictionCoefficient = 0.0
    """Coulomb coefficient between it and the structure."""
    restitution: Restitution = 0.0
    """Speed of separation over speed of approach, where rigid bodies hit it; in shells these are rigid
    sections with their masses, while the rebound of walls follows from the walls."""
    members: tuple[Name, ...] | None = None
    """Only these members touch it; without it all."""
    mass: PositiveMass | None = None
    """Mass that slides along `guide`; without it the obstacle is fixed or driven."""
    guide: Direction | None = None
    """Direction in which the mass moves; without it that of `velocity`, or across a plane."""
    velocity: tuple[Velocity, Velocity, Velocity] = (0.0, 0.0, 0.0)
    """Initial velocity of the mass; without `mass` the constant velocity of the obstacle."""
    motion: Travel = Travel()
    """Prescribed displacement of the obstacle."""
    turning: Turning | None = None
    """Driven rotation, after the displacements of `motion`."""
    dents: bool = True
    """Whether a pole or ball dents the walls of tubes that it strikes between their ends, where rigid bodies
    or elastic members stand for them; in shells walls always dent."""

    @property
    def driven(self) -> bool:
        """Whether its motion is prescribed and not that of rest."""
        functions = (self.motion.x, self.motion.y, self.motion.z, self.turning)
        return self.mass is None and (any(self.velocity) or any(f is not None for f in functions))

    @property
    def guide_direction(self) -> Floats | None:
        """Unit vector along which its mass moves, (3,); None without mass."""
        if self.mass is None:
            return None
        given = self.guide or (self.velocity if any(self.velocity) else self._across())
        return None if given is None else np.asarray(given, float) / np.linalg.norm(given)

    def _across(self) -> Direction | None:
        """Usual direction of impact on such an obstacle; None if there is none."""
        return None

    @model_validator(mode="after")
    def _moves_one_way(self) -> Obstacle:
        given = [key for key in ("x", "y", "z") if getattr(self.motion, key) is not None]
        if self.members == ():
            refuse("no member can touch it", key="members", todo="give members, or remove 'members' for all")
        if self.guide is not None:
            _refuse_zero("guide", self.guide)
        if self.mass is None:
            if self.guide is not None:
                refuse("a guide without a mass", key="guide", todo="give 'mass' too, or remove the guide")
            if any(self.velocity) and given:
                refuse("the obstacle is driven twice", key="velocity", todo="keep 'velocity' or 'motion'")
            return self
        if given or self.turning is not None:
            key = "motion" if given else "turning"
            refuse("an obstacle with a mass is not driven", key=key, todo=f"remove 'mass' or '{key}'")
        usual = self._across()
        if self.guide is None and not any(self.velocity) and usual is not None and not any(usual):
            # a plane without a direction has a refusal of its own
            return self
        direction = self.guide_direction
        if direction is None:
            todo = "add 'guide', for example [1, 0, 0]"
            refuse("the direction in which the mass moves is not given", key="mass", todo=todo)
        along = float(direction @ self.velocity) * direction
        if float(np.linalg.norm(self.velocity - along)) > SLANT * float(np.linalg.norm(self.velocity)):
            todo = "give its part along the guide, or turn the guide"
            refuse(
                "the velocity is at an angle to the guide",
                key="velocity",
                allowed="a velocity along 'guide'",
                todo=todo,
            )
        if self.guide is not None:
            object.__setattr__(self, "velocity", tuple(along.tolist()))
        return self


class PlaneObstacle(Obstacle):
    """Rigid plane; solid behind it.  With `edge` it ends there, like the ground at a ditch."""

    type: Literal["plane"] = "plane"
    """Kind of obstacle."""
    normal: Direction
    """Direction out of the solid; of any length."""
    edge: Direction | None = None
    """Direction out of the solid across the edge that passes through `point`, at right angles to the normal;
    without it the plane has no end."""

    @model_validator(mode="after")
    def _has_sides(self) -> PlaneObstacle:
        _refuse_zero("normal", self.normal)
        if self.edge is not None:
            _refuse_zero("edge", self.edge)
            normal, edge = np.asarray(self.normal), np.asarray(self.edge)
            slant = float(normal @ edge)
            if abs(slant) > SLANT * float(np.linalg.norm(normal) * np.linalg.norm(edge)):
                todo = "turn one of them"
                refuse(
                    "the direction of the edge is not perpendicular to the normal",
                    key="edge",
                    allowed="at right angles to 'normal'",
                    todo=todo,
                )
            square = edge - slant / float(normal @ normal) * normal
            object.__setattr__(self, "edge", tuple(square.tolist()))
        return self

    def _across(self) -> Direction:
        return self.normal


class CylinderObstacle(Obstacle):
    """Rigid round pole."""

    type: Literal["cylinder"] = "cylinder"
    """Kind of obstacle."""
    axis: Direction
    """Direction of its axis; of any length."""
    radius: PositiveLength
    """Radius."""
    length: PositiveLength | None = None
    """Length from `point` along `axis`, with round ends; without it the pole has no end."""

    @model_validator(mode="after")
    def _has_axis(self) -> CylinderObstacle:
        _refuse_zero("axis", self.axis)
        return self


class SphereObstacle(Obstacle):
    """Rigid ball."""

    type: Literal["sphere"] = "sphere"
    """Kind of obstacle."""
    radius: PositiveLength
    """Radius."""


ObstacleSpec = Annotated[
    Annotated[PlaneObstacle, Tag("(type=plane)")]
    | Annotated[CylinderObstacle, Tag("(type=cylinder)")]
    | Annotated[SphereObstacle, Tag("(type=sphere)")],
    Discriminator(type_tag),
]
"""Any obstacle, by its ``type``."""


class MemberContact(Spec):
    """Contact of members with members that share no node."""

    friction: FrictionCoefficient = 0.0
    """Coulomb coefficient."""
    restitution: Restitution = 0.0
    """Speed of separation over speed of approach between rigid bodies; not used in shells."""


def gap(obstacle: Obstacle, points: Floats) -> Floats:
    """Distance of points, (..., 3), from an obstacle at the start [m], (...,), negative inside."""
    apart = points - np.asarray(obstacle.point, float)
    if isinstance(obstacle, PlaneObstacle):
        above = apart @ _unit(obstacle.normal)
        if obstacle.edge is None:
            return np.asarray(above, float)
        beyond = apart @ _unit(obstacle.edge)
        outside = np.minimum(above, beyond) > 0.0
        return np.asarray(np.where(outside, np.hypot(above, beyond), np.maximum(above, beyond)))
    radius = float(getattr(obstacle, "radius", 0.0))
    if isinstance(obstacle, CylinderObstacle):
        axis = _unit(obstacle.axis)
        along = apart @ axis
        if obstacle.length is not None:
            along = np.clip(along, 0.0, obstacle.length)
        apart = apart - along[..., None] * axis
    return np.asarray(np.linalg.norm(apart, axis=-1) - radius)


def _refuse_zero(key: str, direction: Direction) -> None:
    if not any(direction):
        refuse("the direction is zero", key=key, allowed="a direction such as [0, 0, 1]")


def _unit(direction: tuple[float, float, float]) -> Floats:
    vector = np.asarray(direction, float)
    unit: Floats = vector / np.linalg.norm(vector)
    return unit
