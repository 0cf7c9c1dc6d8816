"""Typed interface of the spatial batch: many variants of a spatial model in one call, on several threads."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crumple._core import _kernels
from crumple._core.records import HingeSummary, named
from crumple._core.spatial.model import SpatialModel
from crumple._core.spatial.simulation import MINIMUM_STEP, SpatialRows, SpatialUntil, as_dict, as_until
from crumple._core.variants import Variants
from crumple.numeric.arrays import Floats


@dataclass(frozen=True, eq=False)
class SpatialStage:
    """A stage of a run: duration [s], and the arguments of `SpatialSimulation.stage`."""

    duration: float
    quasi_static: bool = False
    drives: tuple[int, ...] | None = None
    obstacles: tuple[int, ...] | None = None
    until: tuple[SpatialUntil, ...] = ()


@dataclass(frozen=True, eq=False)
class StagedModel:
    """A model and the stages of its run."""

    model: SpatialModel
    stages: tuple[SpatialStage, ...]


@dataclass(frozen=True, eq=False)
class SpatialEndValues(SpatialRows):
    """Final values of every variant, n rows; zeros in rows that were refused or not begun.

    Attributes
    ----------
    time
        Reached [s], (n,).
    start
        Centres of mass at the start, (n, bodies, 3).
    summary
        Summaries of the hinges of each variant, (n, hinges).
    residual
        Largest energy residual of its stages, (n,).
    lost
        Energy [J] that the joints took from the motion that stages add, (n,).
    outcome
        Codes of `Outcome`, (n,).
    steps
        Steps taken, (n,).
    samples
        With times the columns of `SpatialRows` at these, (n times, ...), all times of a variant in sequence;
        zeros at times that it did not reach.
    """

    time: Floats
    start: Floats
    summary: HingeSummary
    residual: Floats
    lost: Floats
    outcome: NDArray[np.int64]
    steps: NDArray[np.int64]
    samples: dict[str, Any] = field(default_factory=dict)


def solve_many(
    variants: Variants[StagedModel],
    accuracy: float = 1e-3,
    minimum_step: float = MINIMUM_STEP,
    maximum_step: float = math.inf,
    threads: int = 1,
    *,
    poll: Callable[[float], bool] | None = None,
    led: bool = False,
    times: Sequence[float] = (),
    parts: int = 1,
    guided: bool = False,
) -> SpatialEndValues:
    """Solve every variant through its stages, bit for bit as a `SpatialSimulation` of it.

    ``poll(share)`` is called at intervals with the share done and returns False to cancel; variants that were
    not begun then have the outcome CANCELLED.  The states at increasing ``times`` [s] are kept.
    `parts`: as of a `SpatialSimulation`.

    `led`: the first variant alone is solved so.  The others take its steps, and in place of every solution of
    Newton's method the first Newton step from the leader's: half the difference of two of them that lie close
    above and below the leader is the derivative of the run, see docs/theory/sensitivities.md.  Runs with
    contact have no followers.

    `guided`: the others solve their own equations, and take from the steps of the first one what a run that
    `SpatialSimulation.be_guided_by` another takes: their lengths and the starts of their solution.
    """
    out = _kernels.spatial.solve_many(
        [kernel_case(case) for case in variants.cases],
        variants.numbers(),
        *variants.columns(),
        accuracy,
        minimum_step,
        maximum_step,
        threads,
        poll,
        led,
        times,
        parts,
        guided,
    )
    samples = named(out.pop("samples", {}))
    return SpatialEndValues(**named(out), samples=samples)


def kernel_case(case: StagedModel) -> _kernels._Spatial.Case:
    """A case in the kernel's own form."""
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
