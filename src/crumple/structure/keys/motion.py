"""Supports, prescribed motion and initial motion of the structure."""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import BeforeValidator, model_validator

from crumple.function import TimeFunction
from crumple.numeric.arrays import Floats
from crumple.numeric.rotation import cross
from crumple.registry.quantity import AngularVelocity, Direction, Position, Velocity
from crumple.registry.refusal import refuse
from crumple.structure.keys.time_function import AngleFunction, LengthFunction
from crumple.structure.schema.problems import shown
from crumple.structure.schema.spec import Name, Spec

Freedom = Literal["x", "y", "z", "rx", "ry", "rz"]
"""Displacement along, or rotation about, a global axis."""
FREEDOMS: tuple[Freedom, ...] = ("x", "y", "z", "rx", "ry", "rz")


class Motion(Spec):
    """Prescribed motion from the start position, each as a function of time that starts from 0."""

    x: LengthFunction | None = None
    """Displacement along x."""
    y: LengthFunction | None = None
    """Displacement along y."""
    z: LengthFunction | None = None
    """Displacement along z."""
    rx: AngleFunction | None = None
    """Rotation about x."""
    ry: AngleFunction | None = None
    """Rotation about y."""
    rz: AngleFunction | None = None
    """Rotation about z."""


def _known_freedoms(given: object) -> object:
    if given in ("all", "pin"):
        return given
    listed = given if isinstance(given, list | tuple) else [given]
    wrong = [freedom for freedom in listed if freedom not in FREEDOMS]
    if wrong:
        refuse(
            f"'{shown(wrong[0])}' is not a degree of freedom",
            allowed="all, pin, or a list of x, y, z, rx, ry, rz",
            todo="write 'fix: all' for a clamp, 'fix: pin' for x, y, z, or a list such as 'fix: [x, z]'",
        )
    return tuple(listed)


Fixed = Literal["all", "pin"] | tuple[Freedom, ...]


class Support(Spec):
    """Holds or drives a node."""

    node: Name
    """Node that it holds."""
    fix: Annotated[Fixed, BeforeValidator(_known_freedoms, json_schema_input_type=Fixed)] = ()
    """Fixed degrees of freedom: all (a clamp), pin (displacements), or a list of x, y, z, rx, ry, rz."""
    motion: Motion = Motion()
    """Prescribed motion instead of fixed degrees of freedom; what neither it nor `fix` names stays free."""

    @model_validator(mode="after")
    def _holds_something(self) -> Support:
        if not self.held and not self.driven:
            refuse("the support fixes nothing", todo="add 'fix' or 'motion'")
        both = [freedom for freedom in self.driven if isinstance(self.fix, tuple) and freedom in self.fix]
        if both:
            verb, one = ("is", "it") if len(both) == 1 else ("are", "each")
            todo = f"give {one} in 'fix' or in 'motion'"
            refuse(f"{' and '.join(both)} {verb} both fixed and driven", key="motion", todo=todo)
        return self

    @property
    def held(self) -> tuple[Freedom, ...]:
        """Freedoms that are held at zero: those of `fix` that are not driven."""
        words: dict[object, tuple[Freedom, ...]] = {"all": FREEDOMS, "pin": FREEDOMS[:3]}
        named = words[self.fix] if isinstance(self.fix, str) else self.fix
        driven = self.driven
        return tuple(freedom for freedom in named if freedom not in driven)

    @property
    def driven(self) -> dict[Freedom, TimeFunction]:
        """Prescribed motion from the start position by freedom: [m] or [rad] against time [s]."""
        functions = {freedom: getattr(self.motion, freedom) for freedom in FREEDOMS}
        return {freedom: function for freedom, function in functions.items() if function is not None}


class InitialVelocity(Spec):
    """Rigid velocity field at the start: v = translation + rotation * axis x (position - about)."""

    translation: tuple[Velocity, Velocity, Velocity] = (0.0, 0.0, 0.0)
    """Velocity of translation."""
    rotation: AngularVelocity = 0.0
    """Angular velocity about `axis` through `about`."""
    about: Position = (0.0, 0.0, 0.0)
    """Point on the axis of rotation."""
    axis: Direction | None = None
    """Direction of the axis of rotation, right-handed; of any length."""
    nodes: tuple[Name, ...] | None = None
    """Only masses at these nodes; without `nodes` and `members` the whole structure."""
    members: tuple[Name, ...] | None = None
    """Only these members, and masses at nodes at which all members have this motion; not a mass whose node
    any entry has in `nodes`."""

    @property
    def everywhere(self) -> bool:
        """Whether it moves the whole structure."""
        return self.nodes is None and self.members is None

    @property
    def rate(self) -> Floats:
        """Angular velocity [rad/s], (3,)."""
        if self.axis is None:
            return np.zeros(3)
        return np.asarray(self.axis, float) * (self.rotation / math.hypot(*self.axis))

    def at(self, point: Floats) -> Floats:
        """Velocity at a point [m/s], (3,)."""
        arm = point - np.asarray(self.about, float)
        return np.asarray(self.translation, float) + cross(self.rate, arm)

    @model_validator(mode="after")
    def _complete(self) -> InitialVelocity:
        if self.axis is not None and not any(self.axis):
            refuse("the axis is zero", key="axis", allowed="a direction such as [0, -1, 0]")
        if not self.everywhere and not (self.nodes or self.members):
            todo = "name nodes or members, or remove the key for the whole structure"
            refuse("it moves nothing", key="members" if self.nodes is None else "nodes", todo=todo)
        if self.rotation and self.axis is None:
            refuse("a rotation needs an axis", key="rotation", todo="add 'axis', for example [0, -1, 0]")
        return self
