"""Stages of a run in sequence, each continuing from the end of the one before."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from pydantic import model_validator

from crumple.registry.quantity import (
    Duration,
    Length,
    PositiveEnergy,
    PositiveForce,
    PositiveLength,
)
from crumple.registry.refusal import refuse
from crumple.structure.keys.load import NodalImpulse
from crumple.structure.keys.motion import InitialVelocity
from crumple.structure.schema.spec import Name, Spec

Quantity = Literal["force", "energy", "displacement", "distance"]
QUANTITIES: tuple[Quantity, ...] = ("force", "energy", "displacement", "distance")


class Until(Spec):
    """Condition that ends a stage; one of `force`, `energy`, `displacement` and `distance`."""

    force: PositiveForce | None = None
    """Force on the obstacle or the driven support named in `of`."""
    energy: PositiveEnergy | None = None
    """Work done on the structure since the start of the stage."""
    displacement: PositiveLength | None = None
    """Path of the obstacle or the driven support named in `of` since the start of the stage."""
    distance: Length | None = None
    """Change of the distance between the nodes of `between`: negative where they come nearer."""
    of: Name | None = None
    """Obstacle or support."""
    between: tuple[Name, Name] | None = None
    """Two nodes."""

    @property
    def quantity(self) -> Quantity:
        """Quantity of the condition."""
        return next(key for key in QUANTITIES if getattr(self, key) is not None)

    @property
    def value(self) -> float:
        """Its value that ends the stage, in SI."""
        return float(getattr(self, self.quantity))

    @model_validator(mode="after")
    def _one_condition(self) -> Until:
        given = [key for key in QUANTITIES if getattr(self, key) is not None]
        if len(given) != 1:
            what = (
                "the condition names no quantity" if not given else "the condition names several quantities"
            )
            refuse(what, allowed="one of " + ", ".join(QUANTITIES), todo="write one condition for each")
        if self.distance == 0.0:
            refuse(
                "a change of distance of 0 is not a condition",
                key="distance",
                allowed="a change that is not 0",
            )
        if (self.of is not None) != (given[0] in {"force", "displacement"}):
            what = f"'{given[0]}' needs 'of'" if self.of is None else f"'{given[0]}' has no 'of'"
            refuse(what, key="of", allowed="an obstacle or a support with 'force' and 'displacement'")
        if (self.between is not None) != (given[0] == "distance"):
            what = "'distance' needs 'between'" if self.between is None else f"'{given[0]}' has no 'between'"
            refuse(what, key="between", allowed="two nodes with 'distance'")
        if self.between is not None and self.between[0] == self.between[1]:
            refuse("both nodes are the same", key="between", allowed="two nodes")
        return self


class Stage(Spec):
    """One stage.  Functions of time count from its start."""

    name: Name
    """Name, unique in the sequence."""
    kind: Literal["dynamic", "quasi-static"] = "dynamic"
    """With inertia, or quasi-static, without inertia."""
    duration: Duration
    """Time after which it ends at the latest."""
    until: tuple[Until, ...] = ()
    """Conditions; the first that is met ends it."""
    drive: tuple[Name, ...] | None = None
    """Obstacles and supports whose prescribed motion runs; the others stay where they are. Without it
    all run, with an empty list none."""
    obstacles: tuple[Name, ...] | None = None
    """Obstacles that are present; without it all."""
    initial_velocity: tuple[InitialVelocity, ...] = ()
    """Velocity fields that are added at its start, to the structure in its current shape."""
    impulses: tuple[NodalImpulse, ...] = ()
    """Impulses at its start, on nodes in their current position."""

    @model_validator(mode="after")
    def _moves(self) -> Stage:
        if self.kind == "quasi-static" and (self.initial_velocity or self.impulses):
            key = "initial_velocity" if self.initial_velocity else "impulses"
            what = "a quasi-static stage has no inertia, so this has no effect"
            refuse(what, key=key, todo="make the stage dynamic, or drive a support or an obstacle")
        return self


def time_in_motion(duration: float, stages: Sequence[Stage]) -> float:
    """Time with inertia [s]: in quasi-static stages time only orders the events."""
    return sum(stage.duration for stage in stages if stage.kind == "dynamic") if stages else duration
