"""Lumped masses, impulses, loads."""

from __future__ import annotations

from pydantic import model_validator

from crumple.registry.quantity import (
    AngularImpulse,
    Impulse,
    NonNegativeMass,
    NonNegativeRotaryInertia,
    Position,
)
from crumple.registry.refusal import refuse
from crumple.structure.keys.time_function import ForceFunction, MomentFunction
from crumple.structure.schema.spec import Name, Spec

Inertia = tuple[NonNegativeRotaryInertia, NonNegativeRotaryInertia, NonNegativeRotaryInertia]


class Mass(Spec):
    """Rigid lump fixed to a node."""

    node: Name
    """Node that carries it."""
    mass: NonNegativeMass
    """Mass."""
    offset: Position = (0.0, 0.0, 0.0)
    """Its centre, from the node, in global axes at the start."""
    rotary_inertia: Inertia = (0.0, 0.0, 0.0)
    """Principal moments of inertia about its centre, in global axes at the start."""

    @model_validator(mode="after")
    def _inertia(self) -> Mass:
        if self.mass == 0.0 and not any(self.rotary_inertia):
            refuse("the mass has no inertia", key="mass", allowed="a mass above 0, or a rotary inertia")
        # no mass distribution has a moment above the sum of the other two: I_x + I_y - I_z = 2 int z^2 dm
        if 2.0 * max(self.rotary_inertia) > sum(self.rotary_inertia) * (1.0 + 1e-9):
            refuse(
                "these moments of inertia are impossible: one exceeds the sum of the other two",
                key="rotary_inertia",
                allowed="Ixx <= Iyy + Izz and so on",
            )
        return self


class NodalImpulse(Spec):
    """Impulse on a node at the start."""

    node: Name
    """Node with the impulse."""
    impulse: tuple[Impulse, Impulse, Impulse] = (0.0, 0.0, 0.0)
    """Impulse in global axes."""
    angular_impulse: tuple[AngularImpulse, AngularImpulse, AngularImpulse] = (0.0, 0.0, 0.0)
    """Angular impulse in global axes."""


class ForceComponents(Spec):
    """Force in global axes, each component a function of time."""

    x: ForceFunction | None = None
    """Component along x."""
    y: ForceFunction | None = None
    """Component along y."""
    z: ForceFunction | None = None
    """Component along z."""


class MomentComponents(Spec):
    """Moment in global axes, each component a function of time."""

    x: MomentFunction | None = None
    """Component about x."""
    y: MomentFunction | None = None
    """Component about y."""
    z: MomentFunction | None = None
    """Component about z."""


class Load(Spec):
    """Force and moment on a node; their directions stay fixed in space."""

    node: Name
    """Node with the load."""
    force: ForceComponents = ForceComponents()
    """Force."""
    moment: MomentComponents = MomentComponents()
    """Moment."""
