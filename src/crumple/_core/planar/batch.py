"""Typed face of the batch: many variants of a planar tree in one call, on several threads."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crumple._core import _kernels
from crumple._core.planar.simulation import MINIMUM_STEP, TreeModel, kernel_model
from crumple.numeric.arrays import Floats


@dataclass(frozen=True, eq=False)
class TreeVariants:
    """What varies from variant to variant, n rows; None leaves the model's own.

    Attributes
    ----------
    models
        Models of one topology: as many as differ in more than the arrays below.
    model_of
        (n,) which of the models.
    velocity, impulse
        Twists of the bodies at the start and impulses on them, at the centres of mass, (n, bodies, 3).
    capacity_scale
        (n, hinges), times the model's capacities; > 0.
    load_scale
        (n, loads), times the model's loads.
    bodies
        (n, bodies, 4): centre x, y [m], mass [kg], inertia [kg m^2].
    gravity
        (n, 2) [m/s^2].
    """

    models: Sequence[TreeModel]
    model_of: NDArray[np.int64]
    velocity: Floats | None = None
    impulse: Floats | None = None
    capacity_scale: Floats | None = None
    load_scale: Floats | None = None
    bodies: Floats | None = None
    gravity: Floats | None = None


@dataclass(frozen=True, eq=False)
class TreeFinals:
    """Where every variant ended, n rows; zeros where it was refused or never begun.

    Attributes
    ----------
    time, q, w, pose, velocity, hinge, energy, summary
        The last row of a `TreeRecord` for each variant: (n,), (n, dofs), (n, bodies, 3), ...
    residual
        Energy residual, (n,).
    lost
        Energy [J] that the joints took from the motion at the start, (n,).
    outcome
        Codes of `Outcome`, (n,).
    steps
        Steps taken, (n,).
    """

    time: Floats
    q: Floats
    w: Floats
    pose: Floats
    velocity: Floats
    hinge: Floats
    energy: Floats
    summary: Floats
    residual: Floats
    lost: Floats
    outcome: NDArray[np.int64]
    steps: NDArray[np.int64]


def solve_many(
    variants: TreeVariants,
    end: float,
    accuracy: float = 1e-3,
    minimum_step: float = MINIMUM_STEP,
    maximum_step: float = math.inf,
    threads: int = 1,
    *,
    poll: Callable[[float], bool] | None = None,
) -> TreeFinals:
    """Solve every variant up to time ``end`` [s], with the very bits of a `Simulation` of it alone.

    ``poll(share)`` is asked now and then with the share done and returns False to cancel; variants that were
    not begun then have the outcome CANCELLED.
    """
    out = _kernels.planar.solve_many(
        [kernel_model(model) for model in variants.models],
        np.ascontiguousarray(variants.model_of, dtype=np.int64),
        end,
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
    )
    return TreeFinals(**out)


def as_rows(given: Floats | None) -> Floats | None:
    """What varies as the kernels take it."""
    return None if given is None else np.ascontiguousarray(given, dtype=float)
