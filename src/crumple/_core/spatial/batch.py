"""Typed face of the spatial batch: many variants of a spatial model in one call, on several threads."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crumple._core import _kernels
from crumple._core.planar.batch import as_rows
from crumple._core.spatial.model import SpaceModel
from crumple._core.spatial.simulation import MINIMUM_STEP, SpaceUntil, as_dict, as_until
from crumple.numeric.arrays import Floats


@dataclass(frozen=True, eq=False)
class SpaceStage:
    """A stage of a run: duration [s], and the rest as `SpaceSimulation.stage` takes it."""

    duration: float
    quasi_static: bool = False
    drives: tuple[int, ...] | None = None
    obstacles: tuple[int, ...] | None = None
    until: tuple[SpaceUntil, ...] = ()


@dataclass(frozen=True, eq=False)
class SpaceCase:
    """A model and the stages of its run."""

    model: SpaceModel
    stages: tuple[SpaceStage, ...]


@dataclass(frozen=True, eq=False)
class SpaceVariants:
    """What varies from variant to variant, n rows; None leaves the model's own.

    Attributes
    ----------
    cases
        Models with as many bodies, joints, hinges, loads, drives, obstacles and stages, between the same
        bodies: as many as differ in more than the arrays below.
    case_of
        (n,) which of the cases.
    velocity, impulse
        Motion that every stage adds as it begins: twists of the bodies and impulses on them, at the centres
        of mass, (n, stages, bodies, 6).
    capacity_scale
        (n, hinges), times the capacities of all components; > 0.
    load_scale
        (n, loads), times the model's loads.
    bodies
        (n, bodies, 13): centre [m], mass [kg], inertia about the centre [kg m^2] row by row.
    gravity
        (n, 3) [m/s^2].
    """

    cases: Sequence[SpaceCase]
    case_of: NDArray[np.int64]
    velocity: Floats | None = None
    impulse: Floats | None = None
    capacity_scale: Floats | None = None
    load_scale: Floats | None = None
    bodies: Floats | None = None
    gravity: Floats | None = None


@dataclass(frozen=True, eq=False)
class SpaceFinals:
    """Where every variant ended, n rows; zeros where it was refused or never begun.

    Attributes
    ----------
    time, centre, rotation, velocity, hinge_rotation, hinge_rate, hinge_plastic, hinge_moment, hinge_capacity,
    hinge_energy, summary, energy
        The last row of a `SpaceRecord` for each variant: (n,), (n, bodies, 3), (n, bodies, 4), ...
    start
        Centres of mass at the start, (n, bodies, 3).
    residual
        Largest energy residual of its stages, (n,).
    lost
        Energy [J] that the joints took from the motion that stages add, (n,).
    outcome
        Codes of `Outcome`, (n,).
    steps
        Steps taken, (n,).
    """

    time: Floats
    start: Floats
    centre: Floats
    rotation: Floats
    velocity: Floats
    hinge_rotation: Floats
    hinge_rate: Floats
    hinge_plastic: Floats
    hinge_moment: Floats
    hinge_capacity: Floats
    hinge_energy: Floats
    summary: Floats
    energy: Floats
    residual: Floats
    lost: Floats
    outcome: NDArray[np.int64]
    steps: NDArray[np.int64]


def solve_many(
    variants: SpaceVariants,
    accuracy: float = 1e-3,
    minimum_step: float = MINIMUM_STEP,
    maximum_step: float = math.inf,
    threads: int = 1,
    *,
    poll: Callable[[float], bool] | None = None,
    led: bool = False,
) -> SpaceFinals:
    """Solve every variant through its stages, with the very bits of a `SpaceSimulation` of it alone.

    ``poll(share)`` is asked now and then with the share done and returns False to cancel; variants that were
    not begun then have the outcome CANCELLED.

    `led`: the first variant alone is solved so.  The others take its steps, and in place of every solution of
    Newton's method the first Newton step from the leader's: half the difference of two of them that lie close
    above and below the leader is the derivative of the run, see docs/theory/sensitivities.md.  Runs with
    contact have no followers.
    """
    out = _kernels.spatial.solve_many(
        [kernel_case(case) for case in variants.cases],
        np.ascontiguousarray(variants.case_of, dtype=np.int64),
        as_rows(variants.velocity),
        as_rows(variants.impulse),
        as_rows(variants.capacity_scale),
        as_rows(variants.load_scale),
        as_rows(variants.bodies),
        as_rows(variants.gravity),
        accuracy,
        minimum_step,
        maximum_step,
        threads,
        poll,
        led,
    )
    return SpaceFinals(**out)


def kernel_case(case: SpaceCase) -> _kernels._Spatial.Case:
    """A case as the kernel holds it."""
    model = case.model
    kernel = _kernels.spatial.Case(as_dict(model))
    for stage in case.stages:
        kernel.add_stage(
            stage.duration,
            stage.quasi_static,
            list(range(len(model.drives)) if stage.drives is None else stage.drives),
            list(range(len(model.obstacles)) if stage.obstacles is None else stage.obstacles),
            [as_until(condition) for condition in stage.until],
        )
    return kernel
