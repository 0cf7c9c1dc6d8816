"""Optimisation by SciPy's differential evolution: each generation is one group of rows.

The optimiser's random numbers come from the seed and its decisions from the rows alone, so a resumed study
asks for the same points and finds their rows in the table.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.study.space import Axis, Point

POPULATION = 8
"""Members of a generation per variable."""
Judged = Callable[[list[Point]], tuple[Floats, Floats]]
"""Points to their objective, which is made small, and the violation of constraints: 0 without one, infinite
in failed rows."""


def optimise(axes: Sequence[Axis], judged: Judged, most: int, seed: int) -> None:
    """Ask for rows until the population has converged or the number of rows is reached.

    Parameters
    ----------
    axes
        Variables with a range or values.
    judged
        Solves points.
    most
        Rows; the last generation ends before it.
    seed
        Of the optimiser.

    References
    ----------
    R. Storn, K. Price, Differential evolution, J. Global Optim. 11 (1997) 341-359.  Points that violate a
    constraint are compared by their violation: K. Deb, Comput. Methods Appl. Mech. Eng. 186 (2000) 311-338.
    """
    from scipy.optimize import Bounds, differential_evolution  # noqa: PLC0415  (slow to import)

    # a choice is the number of its value
    bounds: list[tuple[float, float]] = [
        (0.0, len(axis.values) - 1.0) if axis.values else (float(axis.low or 0.0), float(axis.high or 0.0))
        for axis in axes
    ]
    whole = [bool(axis.values) or axis.integer for axis in axes]
    size = max(POPULATION * len(axes), 16)
    worst = [0.0]

    def values(columns: Floats) -> Floats:
        points: list[Point] = [
            tuple(
                axis.values[round(x)] if axis.values else float(round(x) if axis.integer else x)
                for axis, x in zip(axes, column, strict=True)
            )
            for column in np.atleast_2d(columns.T).tolist()
        ]
        objective, violation = judged(points)
        feasible = violation == 0.0
        # above every feasible value, and rising with the violation
        if feasible.any():
            worst[0] = max(worst[0], float(np.abs(objective[feasible]).max()))
        raised = 1e6 * (1.0 + worst[0]) * (1.0 + violation)
        return np.where(feasible, objective, np.where(np.isfinite(raised), raised, 1e300))

    differential_evolution(
        values,  # type: ignore[arg-type]  # a generation at a time: `vectorized`
        Bounds(*np.array(bounds).T),
        integrality=whole,
        maxiter=max(most // size - 1, 0),
        init=_start(bounds, size, seed),
        tol=1e-6,
        seed=seed,
        polish=False,
        vectorized=True,
        updating="deferred",
    )


def _start(bounds: Sequence[tuple[float, float]], size: int, seed: int) -> Floats:
    from scipy.stats import qmc  # noqa: PLC0415

    shares = qmc.LatinHypercube(len(bounds), seed=seed).random(size)
    low, high = np.array(bounds, float).T
    return np.asarray(low + (high - low) * shares)
