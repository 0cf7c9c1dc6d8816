"""Typed interface of the batch: many variants of a planar tree in one call, on several threads."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crumple._core import _kernels
from crumple._core.planar.simulation import MINIMUM_STEP, TreeModel, TreeRows, kernel_model
from crumple._core.records import HingeSummary, named
from crumple._core.variants import Variants
from crumple.numeric.arrays import Floats


@dataclass(frozen=True, eq=False)
class TreeEnds(TreeRows):
    """Final values of runs: the last row of each record, and the summaries of the hinges, (n, hinges)."""

    summary: HingeSummary


@dataclass(frozen=True, eq=False)
class TreeEndValues(TreeEnds):
    """Final values of every variant, n rows; zeros in rows that were refused or not begun.

    Attributes
    ----------
    time
        Reached [s], (n,).
    residual
        Energy residual, (n,).
    lost
        Energy [J] that the joints took from the motion at the start, (n,).
    outcome
        Codes of `Outcome`, (n,).
    steps
        Steps taken, (n,).
    samples
        With times the columns of `TreeRows` at these, (n times, ...), all times of a variant in sequence;
        zeros at times that it did not reach.
    """

    time: Floats
    residual: Floats
    lost: Floats
    outcome: NDArray[np.int64]
    steps: NDArray[np.int64]
    samples: dict[str, Any] = field(default_factory=dict)


def solve_many(
    variants: Variants[TreeModel],
    end: float,
    accuracy: float = 1e-3,
    minimum_step: float = MINIMUM_STEP,
    maximum_step: float = math.inf,
    threads: int = 1,
    *,
    poll: Callable[[float], bool] | None = None,
    times: Sequence[float] = (),
    parts: int = 1,
) -> TreeEndValues:
    """Solve every variant up to time ``end`` [s], bit for bit as a `Simulation` of it.

    ``poll(share)`` is called at intervals with the share done and returns False to cancel; variants that were
    not begun then have the outcome CANCELLED.  At increasing ``times`` [s] steps end, as at the output times
    of a run, and the states there are kept.  `parts`: as of a `Simulation`.
    """
    out = _kernels.planar.solve_many(
        [kernel_model(model) for model in variants.cases],
        variants.numbers(),
        end,
        *variants.columns(),
        accuracy,
        minimum_step,
        maximum_step,
        threads,
        poll,
        times,
        parts,
    )
    samples = named(out.pop("samples", {}))
    return TreeEndValues(**named(out), samples=samples)
