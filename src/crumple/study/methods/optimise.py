"""Optimisation: SciPy's differential evolution for one goal, Optuna's NSGA-II for several.

Each generation is one group of rows.  The optimiser's random numbers come from the seed and its decisions
from the rows alone, so a resumed study asks for the same points and finds their rows in the table.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from types import ModuleType

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.study.space import Axis, Point

POPULATION = 8
"""Members of a generation per variable."""
FAILED = 1e150
"""Value of a row that failed: the optimiser squares it for the spread of a generation."""
Judged = Callable[[list[Point]], tuple[Floats, Floats]]
"""Points to their objective, which is made small, and the violation of constraints: 0 without one, infinite
in failed rows."""
SeverallyJudged = Callable[[list[Point]], tuple[Floats, Floats]]
"""The same with goals that are made small, (goals, n)."""


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
        return np.where(feasible, objective, np.minimum(raised, FAILED))

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


def optimise_several(axes: Sequence[Axis], judged: SeverallyJudged, goals: int, most: int, seed: int) -> None:
    """Ask for generations of a fixed size, and tell what they gave in the order of their rows.

    Parameters
    ----------
    axes
        Variables with a range or values.
    judged
        Solves points.
    goals
        Number of goals.
    most
        Rows; the last generation ends before it.
    seed
        Of the optimiser.

    Raises
    ------
    InputError
        If Optuna is not installed.

    References
    ----------
    K. Deb et al., A fast and elitist multiobjective genetic algorithm: NSGA-II, IEEE Trans. Evol. Comput. 6
    (2002) 182-197, with its crossover and mutation of real numbers.  A failed row is told as such: its
    generation is continued by the next points.
    """
    optuna = _optuna()
    space = {
        axis.name: optuna.distributions.IntDistribution(0, len(axis.values) - 1)
        if axis.values
        else optuna.distributions.IntDistribution(math.ceil(axis.low or 0.0), math.floor(axis.high or 0.0))
        if axis.integer
        else optuna.distributions.FloatDistribution(axis.low or 0.0, axis.high or 0.0)
        for axis in axes
    }
    size = min(max(POPULATION * len(axes), 16), max(most, 2))
    with warnings.catch_warnings():
        # the interfaces of crossover and mutation may change
        warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
        sampler = optuna.samplers.NSGAIISampler(
            population_size=size,
            seed=seed,
            crossover=optuna.samplers.nsgaii.SBXCrossover(),
            mutation=optuna.samplers.nsgaii.PolynomialMutation(),
        )
    study = optuna.create_study(directions=["minimize"] * goals, sampler=sampler)
    for _ in range(max(most // size, 1)):
        trials = [study.ask(space) for _ in range(min(size, most))]
        points: list[Point] = [
            tuple(
                axis.values[trial.params[axis.name]] if axis.values else float(trial.params[axis.name])
                for axis in axes
            )
            for trial in trials
        ]
        wanted, violation = judged(points)
        for trial, values, beyond in zip(trials, wanted.T.tolist(), violation.tolist(), strict=True):
            if math.isfinite(beyond):
                trial.set_constraint("violation", beyond)
                study.tell(trial, values)
            else:
                study.tell(trial, state=optuna.trial.TrialState.FAIL)


def _optuna() -> ModuleType:
    """Optuna, without its messages for each point."""
    try:
        import optuna  # noqa: PLC0415  (an extra)
    except ImportError:
        what, todo = "several objectives need Optuna", "install crumple[study]"
        raise InputError(Problem(what, "", "", todo, "objectives")) from None
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    found: ModuleType = optuna
    return found


def _start(bounds: Sequence[tuple[float, float]], size: int, seed: int) -> Floats:
    from scipy.stats import qmc  # noqa: PLC0415

    shares = qmc.LatinHypercube(len(bounds), seed=seed).random(size)
    low, high = np.array(bounds, float).T
    return np.asarray(low + (high - low) * shares)
