"""Typed interface of the planar kernel: a tree of rigid bodies in the plane, as plain arrays.

Every body hangs on one inboard joint; parents come before children.  Twists and directions are
(rotation, x, y); a body's frame has its origin at the inboard joint and is aligned with the world at
the start.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

import numpy as np

from crumple._core import _kernels
from crumple._core.hinge import HingeConstants
from crumple._core.outcome import Outcome
from crumple._core.records import ComponentRecord, EnergyRecord, HingeEnergyRecord, HingeSummary, named
from crumple.numeric.arrays import Floats

MINIMUM_STEP = 1e-9
"""Smallest step [s]; jumps of the velocity are passed in one such step."""


class JointKind(IntEnum):
    """Inboard joint of a body."""

    REVOLUTE = 0
    FREE = 1


@dataclass(frozen=True)
class TreeBody:
    """One rigid body: parent (-1 ground), joint, anchor in the parent's frame, centre in its own."""

    parent: int
    joint: JointKind
    anchor: tuple[float, float]
    centre: tuple[float, float]
    mass: float
    inertia: float

    @property
    def dofs(self) -> int:
        """Joint coordinates: 1 for a revolute joint, 3 (rotation, x, y) for a free one."""
        return 1 if self.joint is JointKind.REVOLUTE else 3


@dataclass(frozen=True, eq=False)
class TreeHinge(HingeConstants):
    """Hinge of one joint coordinate; codes of form and softening variable as in native/hinge/hinge.hpp.

    `capacity_scale` multiplies both curves.
    """

    dof: int
    form: int
    softening: int
    capacity_scale: float = 1.0

    def as_dict(self) -> dict[str, Any]:
        """The hinge in the form that the kernel takes."""
        own = {"dof": self.dof, "form": self.form, "softening": self.softening}
        return own | {"capacity_scale": self.capacity_scale} | self.constants()


@dataclass(frozen=True)
class TreeLoad:
    """Force or moment on a point of a body, direction fixed in the world, piecewise linear in time."""

    body: int
    point: tuple[float, float]
    direction: tuple[float, float, float]
    times: Floats
    values: Floats


@dataclass(frozen=True)
class TreeDrive(TreeLoad):
    """Prescribed displacement of a point of a body in one direction.

    The kernel takes ``rates``, piecewise linear from time 0 on, and their integral from ``values[0]``.
    """

    rates: Floats


@dataclass(frozen=True)
class TreeHold:
    """A point of a body that a support holds in one direction of the plane."""

    body: int
    point: tuple[float, float]
    direction: tuple[float, float, float]


@dataclass(frozen=True)
class TreeWeld:
    """Two bodies that move as one, closing a loop; ``other`` -1 is the ground.

    ``point`` and ``other_point`` are the same place, in the frame of each (in the world for the ground).
    """

    body: int
    other: int
    point: tuple[float, float]
    other_point: tuple[float, float]


@dataclass(frozen=True)
class TreeModel:
    """Constants of a planar model; frozen."""

    bodies: tuple[TreeBody, ...]
    hinges: tuple[TreeHinge, ...]
    loads: tuple[TreeLoad, ...] = ()
    drives: tuple[TreeDrive, ...] = ()
    holds: tuple[TreeHold, ...] = ()
    welds: tuple[TreeWeld, ...] = ()
    gravity: tuple[float, float] = (0.0, 0.0)
    length: float = 1.0
    """Length [m] that converts translations of free bodies to angles in the error measure."""
    breaks: Floats = field(default_factory=lambda: np.empty(0))
    """Times [s] at which steps end: jumps and kinks of loads and drives, increasing, (n,)."""
    resolved_frequency: float = math.inf
    """Frequency [Hz] above which vibration of elastic hinges does not count in the error measure."""

    @property
    def dofs(self) -> int:
        """Number of joint coordinates."""
        return sum(body.dofs for body in self.bodies)


@dataclass(frozen=True, eq=False)
class TreeRows:
    """Positions of a tree in n rows, for every output time or for every run.

    Attributes
    ----------
    q, w
        Joint coordinates and rates, (n, dofs).
    pose
        Angle and origin of every body, (n, bodies, 3); `velocity` has the same shape, at the centres of mass.
    hinge, hinge_energy, energy
        One component for every hinge, in the sense of its joint coordinate.
    """

    q: Floats
    w: Floats
    pose: Floats
    velocity: Floats
    hinge: ComponentRecord
    hinge_energy: HingeEnergyRecord
    energy: EnergyRecord

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(self.q)


@dataclass(frozen=True, eq=False)
class TreeRecord(TreeRows):
    """Histories of a run; a row for every output time.

    Attributes
    ----------
    time
        (n,) [s].
    drive
        Forces of the drives, (n, drives).
    summary
        Of the whole run.
    """

    time: Floats
    drive: Floats
    summary: HingeSummary
    outcome: Outcome
    reason: str
    residual: float
    unseen: float
    """Speed that loads and drives may have changed unresolved within steps, over the largest speed."""
    steps: int
    rejected: int
    forced: int
    solves: int


class Simulation:
    """One run of a model: state and adaptive stepper.

    Parameters
    ----------
    model
        Constants.
    accuracy
        Allowed error of the motion, relative to the largest rotation.
    minimum_step, maximum_step
        Bounds of the step [s].
    compiled
        The model's compiled form if there is one already: runs share it.
    parts
        Least number of steps between two of the model's breaks.
    """

    def __init__(
        self,
        model: TreeModel,
        accuracy: float = 1e-3,
        minimum_step: float = MINIMUM_STEP,
        maximum_step: float = math.inf,
        compiled: Any = None,
        *,
        parts: int = 1,
    ) -> None:
        self.model = model
        self._kernel = _kernels.planar.Simulation(
            compiled or kernel_model(model), accuracy, minimum_step, maximum_step, parts
        )

    def set_motion(self, velocity: Floats, impulse: Floats) -> float:
        """Start from twists of the bodies and impulses on them, both at the centres of mass, (bodies, 3).

        Returns
        -------
        float
            Energy [J] that the joints took from the given motion because it did not fit them.
        """
        return self._kernel.set_motion(np.ascontiguousarray(velocity), np.ascontiguousarray(impulse))

    def set_rates(self, w: Floats) -> None:
        """Start from joint rates, (dofs,)."""
        self._kernel.set_rates(w.tolist())

    def run(self, times: Floats, poll: Callable[[float], bool] | None = None) -> TreeRecord:
        """Step to the last of the increasing times [s]; ``poll(time)`` returns False to cancel."""
        out = self._kernel.run(times.tolist(), poll)
        return TreeRecord(**named(out) | {"outcome": Outcome(out["outcome"]), "summary": self.summary()})

    def summary(self) -> HingeSummary:
        """Summary of every hinge at the present time."""
        return HingeSummary(*self._kernel.summary())

    def step(self, time_step: float) -> bool:
        """Take one step of fixed length [s]; False when it did not converge and nothing changed."""
        return self._kernel.step(time_step)

    def effective_inertia(self, dof: int) -> float:
        """Inertia that a joint coordinate feels with all hinges free [kg m^2]."""
        return self._kernel.effective_inertia(dof)

    @property
    def time(self) -> float:
        """Time reached [s]."""
        return self._kernel.time

    @property
    def q(self) -> Floats:
        """Joint coordinates, (dofs,)."""
        return np.array(self._kernel.q)

    @property
    def w(self) -> Floats:
        """Joint rates, (dofs,)."""
        return np.array(self._kernel.w)


def kernel_model(model: TreeModel, kind: Callable[..., Any] | None = None) -> Any:
    """The compiled form of a model, in plain or another arithmetic; any number of runs share it."""
    return (kind or _kernels.planar.Model)(
        np.array([b.parent for b in model.bodies], dtype=np.int64),
        np.array([b.joint for b in model.bodies], dtype=np.int64),
        np.array([(*b.anchor, *b.centre, b.mass, b.inertia) for b in model.bodies], dtype=float),
        [0.0] * model.dofs,
        [hinge.as_dict() for hinge in model.hinges],
        [_load(load) for load in model.loads],
        [(*_load(drive), drive.rates.tolist()) for drive in model.drives],
        [(hold.body, list(hold.point), list(hold.direction)) for hold in model.holds],
        [(weld.body, weld.other, list(weld.point), list(weld.other_point)) for weld in model.welds],
        list(model.gravity),
        model.length,
        model.breaks.tolist(),
        model.resolved_frequency,
    )


def _load(load: TreeLoad) -> tuple[Any, ...]:
    return (load.body, list(load.point), list(load.direction), load.times.tolist(), load.values.tolist())
