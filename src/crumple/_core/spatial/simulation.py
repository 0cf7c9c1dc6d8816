"""Typed interface of the spatial kernel: one run of a `SpatialModel`, in stages."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np

from crumple._core import _kernels
from crumple._core.hinge import as_list
from crumple._core.outcome import Outcome
from crumple._core.records import ComponentRecord, EnergyRecord, HingeEnergyRecord, HingeSummary, named
from crumple._core.spatial.model import (
    SpatialCam,
    SpatialCapsule,
    SpatialDrive,
    SpatialJoint,
    SpatialLoad,
    SpatialModel,
    SpatialObstacle,
)
from crumple.numeric.arrays import Floats

MINIMUM_STEP = 1e-9
"""Smallest step [s]; jumps of the velocity are passed in one such step."""


class Until(IntEnum):
    """Quantity that ends a stage when it reaches a value."""

    FORCE = 0
    """Magnitude of the resultant contact force on an obstacle [N]."""
    DRIVE_FORCE = 1
    """Magnitude of the force of a joint [N], held and hinged translations together."""
    WORK = 2
    """External work since the start of the stage [J]."""
    DISTANCE = 3
    """Change of the distance between two points of bodies [m]."""
    DISPLACEMENT = 4
    """Displacement in a freedom of a joint since the start of the stage [m, rad]."""


@dataclass(frozen=True, eq=False)
class SpatialUntil:
    """Ends a stage when its quantity reaches `value` (from below if positive, from above if negative).

    Attributes
    ----------
    kind, value
        Quantity and threshold.
    index
        Obstacle (FORCE) or joint (DRIVE_FORCE, DISPLACEMENT).
    freedom
        Freedom of the joint (DISPLACEMENT).
    bodies, points
        Two bodies and the points of them (2, 3) in the world at the start of the run (DISTANCE).
    """

    kind: Until
    value: float
    index: int = -1
    freedom: int = 0
    bodies: tuple[int, int] = (-1, -1)
    points: Floats | None = None


@dataclass(frozen=True, eq=False)
class SpatialRows:
    """Positions of bodies in space in n rows, for every output time or for every run; b bodies.

    Attributes
    ----------
    centre, rotation
        Centres of mass (n, b, 3) and unit quaternions (w, x, y, z) from the start, (n, b, 4).
    velocity
        (omega, v) at the centres, in world axes, (n, b, 6).
    hinge, hinge_energy, energy
        Of all components and hinges in their order.
    """

    centre: Floats
    rotation: Floats
    velocity: Floats
    hinge: ComponentRecord
    hinge_energy: HingeEnergyRecord
    energy: EnergyRecord

    @property
    def rows(self) -> int:
        """Number of rows."""
        return len(self.centre)


@dataclass(frozen=True, eq=False)
class SpatialRecord(SpatialRows):
    """Histories of a run; a row for every output time.

    Attributes
    ----------
    time
        (n,) [s].
    acceleration
        At the centres, in world axes, (n, b, 6): the mean of the last step.
    travel
        Rotation vector and displacement of the centres in the last step, world axes, (n, b, 6).
    step
        Length of the last step [s], (n,).
    joint_force
        Force and moment of the held and hinged freedoms on the second body, along the joint's axes (midway
        between both bodies), mean of the last step, (n, joints, 6).
    obstacle_force
        Resultant of contact on every obstacle in world axes, (n, obstacles, 3).
    axial_most
        Largest compression and tension at every hinge [N], without vibration that is not resolved,
        (hinges, 2).
    summary
        Of the whole run.
    ended_by
        Index of the condition that ended the run, -1 for none.
    stuck_body
        Of a run that could not go on: the body where it was furthest from balance; -1: none.
    lost_time
        When the equilibrium ended that a quasi-static stage then did not find again [s]; NaN: it held.
    """

    time: Floats
    acceleration: Floats
    travel: Floats
    step: Floats
    joint_force: Floats
    obstacle_force: Floats
    axial_most: Floats
    summary: HingeSummary
    outcome: Outcome
    reason: str
    ended_by: int
    lost_time: float
    stuck_body: int
    residual: float
    unseen: float
    """Speed that loads and drives may have changed unresolved within steps, over the largest speed."""
    steps: int
    rejected: int
    forced: int
    solves: int


class SpatialSimulation:
    """One run of a model: state and adaptive stepper.

    Parameters
    ----------
    model
        Constants.
    accuracy
        Allowed error of the motion, relative to the largest rotation.
    minimum_step, maximum_step
        Bounds of the step [s].
    parts
        Least number of steps between two of the model's breaks.
    """

    def __init__(
        self,
        model: SpatialModel,
        accuracy: float = 1e-3,
        minimum_step: float = MINIMUM_STEP,
        maximum_step: float = math.inf,
        *,
        parts: int = 1,
    ) -> None:
        self.model = model
        self._kernel = _kernels.spatial.Simulation(
            as_dict(model), accuracy, minimum_step, maximum_step, parts
        )

    def set_motion(self, velocity: Floats, impulse: Floats) -> float:
        """Add velocities of the bodies and impulses on them, both (bodies, 6): (omega, v), (moment, force).

        All are at the centres of mass in world axes.  The motion that the joints allow and that is nearest in
        kinetic energy results.

        Returns
        -------
        float
            Energy [J] that the joints took from the given motion because it did not fit them.
        """
        return self._kernel.set_motion(np.ascontiguousarray(velocity), np.ascontiguousarray(impulse))

    def stage(
        self,
        *,
        quasi_static: bool = False,
        drives: Sequence[int] | None = None,
        obstacles: Sequence[int] | None = None,
        until: Sequence[SpatialUntil] = (),
    ) -> None:
        """Begin a stage: functions of time start at the present time.

        Parameters
        ----------
        quasi_static
            Inertia is neglected: every step starts from rest; the stage ends at rest.
        drives, obstacles
            Those that act, by index; None: all.  Other drives hold where they are.
        until
            Conditions; the first that is met ends the run.
        """
        model = self.model
        self._kernel.stage(
            quasi_static,
            list(range(len(model.drives)) if drives is None else drives),
            list(range(len(model.obstacles)) if obstacles is None else obstacles),
            [as_until(condition) for condition in until],
        )

    def run(self, times: Floats, poll: Callable[[float], bool] | None = None) -> SpatialRecord:
        """Step to the last of the increasing times [s]; ``poll(time)`` returns False to cancel."""
        out = self._kernel.run(np.asarray(times, float).tolist(), poll)
        return SpatialRecord(**named(out) | {"outcome": Outcome(out["outcome"])})

    def keep_guide(self) -> None:
        """Keep the steps from now on, for `guide`."""
        self._kernel.keep_guide()

    @property
    def guide(self) -> Any:
        """Steps kept since `keep_guide`, for `be_guided_by` of runs of similar models."""
        return self._kernel.guide()

    def be_guided_by(self, guide: Any, *, pairs: bool = False) -> None:
        """Take lengths of steps and starts of their solution from another run; errors are controlled.

        With `pairs`, two of its steps are one.
        """
        self._kernel.be_guided_by(guide, pairs)

    def step(self, time_step: float) -> bool:
        """Take one step of fixed length [s]; False when it did not converge and nothing changed."""
        return self._kernel.step(time_step)

    @property
    def freedoms(self) -> tuple[int, int]:
        """Degrees of freedom at the start (hinges free) and redundant constraints."""
        return self._kernel.freedoms()

    @property
    def redundant(self) -> Floats:
        """Redundant constraint directions in every joint, (joints,)."""
        return np.array(self._kernel.redundant())

    @property
    def crushed(self) -> list[tuple[int, int, int, float]]:
        """Obstacle (-1: none), capsules (the first -1 with an obstacle) and depth [m] of crushed contacts."""
        return self._kernel.crushed()

    @property
    def time(self) -> float:
        """Time reached [s]."""
        return self._kernel.time


def as_dict(model: SpatialModel) -> dict[str, Any]:
    """An object in the form that the kernel takes."""
    return {
        "mass": np.array([body.mass for body in model.bodies], float),
        "inertia": _stack([body.inertia for body in model.bodies], (3, 3)),
        "centre": _stack([body.centre for body in model.bodies], (3,)),
        "joints": [_joint(joint) for joint in model.joints],
        "hinges": [hinge.constants for hinge in model.hinges],
        "loads": [_load(load) for load in model.loads],
        "springs": [
            (
                s.first,
                s.second,
                as_list(s.first_point),
                as_list(s.second_point),
                s.stiffness,
                s.free_length,
                s.damping,
            )
            for s in model.springs
        ],
        "drives": [_drive(drive) for drive in model.drives],
        "cams": [_cam(cam) for cam in model.cams],
        "obstacles": [_obstacle(obstacle) for obstacle in model.obstacles],
        "capsules": [
            (c.body, as_list(c.first), as_list(c.second), c.radius, c.crush_force, _folds(c))
            for c in model.capsules
        ],
        "pairs": [list(pair) for pair in model.contact.pairs],
        "contact": (model.contact.friction, model.contact.restitution),
        "gravity": list(model.gravity),
        "length": model.length,
        "resolved_frequency": model.resolved_frequency,
        "breaks": model.breaks.tolist(),
    }


def _stack(rows: list[Floats], shape: tuple[int, ...]) -> Floats:
    return np.ascontiguousarray(rows, float).reshape((len(rows), *shape))


def _joint(joint: SpatialJoint) -> tuple[Any, ...]:
    axes = as_list(np.asarray(joint.axes, float).reshape(9))
    return (joint.first, joint.second, as_list(joint.position), axes, list(joint.held), joint.cross)


def _folds(capsule: SpatialCapsule) -> list[tuple[list[float], float]]:
    return [(as_list(fold.middle), fold.half_length) for fold in capsule.folds]


def _load(load: SpatialLoad) -> tuple[Any, ...]:
    arrays = (load.point, load.force, load.moment, load.times, load.values)
    return (load.body, *(as_list(values) for values in arrays))


def _drive(drive: SpatialDrive) -> tuple[Any, ...]:
    return (drive.joint, drive.freedom, as_list(drive.times), as_list(drive.rates), drive.start)


def _cam(cam: SpatialCam) -> tuple[Any, ...]:
    return (cam.joint, cam.freedom, cam.about, as_list(cam.angle), as_list(cam.slope))


def _obstacle(obstacle: SpatialObstacle) -> dict[str, Any]:
    return {
        "kind": int(obstacle.kind),
        "body": obstacle.body,
        "point": as_list(obstacle.point),
        "direction": as_list(obstacle.direction),
        "edge": as_list(obstacle.edge),
        "radius": obstacle.radius,
        "length": obstacle.length,
        "friction": obstacle.friction,
        "restitution": obstacle.restitution,
        "capsules": None if obstacle.capsules is None else list(obstacle.capsules),
        "ends": None if obstacle.ends is None else list(obstacle.ends),
    }


def as_until(until: SpatialUntil) -> tuple[Any, ...]:
    points = np.zeros((2, 3)) if until.points is None else until.points
    return (int(until.kind), until.value, until.index, until.freedom, list(until.bodies), as_list(points))
