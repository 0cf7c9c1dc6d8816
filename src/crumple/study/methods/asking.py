"""Which rows a method asks for, and in which order."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats, Integers
from crumple.study.answer import Answer, answer_of, judged_rows, sobol_answer, violation_of
from crumple.study.methods.descent import descend
from crumple.study.methods.optimise import optimise, optimise_several
from crumple.study.methods.points import blocks, sampled
from crumple.study.rows import masses_of
from crumple.study.setting import Setting
from crumple.study.table import Table, unwatched

GROUP = 50_000
"""Points that are given to a model at a time."""
TOGETHER = 8
"""Combinations of increasing mass that are asked for at a time."""
MOST_COMBINATIONS = 20_000
"""Combinations that are weighed at 0.5 ms each."""
SPARE = 20
"""One block in so many may fail before Sobol' indices are not stated."""


def asked(setting: Setting, table: Table, progress: Callable[[float], None]) -> Answer:
    """Ask for the rows of the method, and say what they are.

    Parameters
    ----------
    setting
        Of the study.
    table
        Takes the rows.
    progress
        Called with the share of the rows that is known.

    Raises
    ------
    InputError
        If the method cannot be used as it is set.
    """
    study, method = setting.study, setting.study.method
    more: dict[str, Any] = {}
    if method.type == "sobol_indices":
        more["indices"] = _indices(setting, table, progress)
    elif method.type == "lightest":
        _lightest(setting, table, progress)
    elif method.gradient:
        descend(setting, table, progress)
    elif method.type == "optimise":
        _optimised(setting, table, progress)
    else:
        points = sampled(setting.axes, method, setting.folder)
        table.solve_in_groups(points, GROUP, progress)
    return answer_of(study, table, setting.limits, setting.units, **more)


def _optimised(setting: Setting, table: Table, progress: Callable[[float], None]) -> None:
    """Ask for generations, towards one goal or several."""
    study, method = setting.study, setting.study.method

    def judged(points: list[Any]) -> tuple[Floats, Floats]:
        first = len(table.points)
        table.solve(points, lambda share: progress(min((first + share * len(points)) / method.rows, 1.0)))
        return judged_rows(study, table, setting.limits, first)

    def alone(points: list[Any]) -> tuple[Floats, Floats]:
        goals, violation = judged(points)
        return goals[0], violation

    if len(study.goals) > 1:
        optimise_several(setting.axes, judged, len(study.goals), method.rows, method.seed)
    else:
        optimise(setting.axes, alone, method.rows, method.seed)


def _lightest(setting: Setting, table: Table, progress: Callable[[float], None]) -> None:
    """Ask for combinations of values by increasing mass, until one keeps all constraints.

    The mass needs no solution, so the first one that does is the lightest of all.
    """
    method, base = setting.study.method, setting.base
    points = sampled(setting.axes, method.model_copy(update={"type": "grid"}), setting.folder)
    if base is None or len(points) > MOST_COMBINATIONS:
        what, todo = "there are too many combinations to weigh", "reduce the values, or use 'optimise'"
        raise InputError(Problem(what, str(len(points)), f"at most {MOST_COMBINATIONS}", todo, "method"))
    values = {
        place: np.array([point[k] for point in points], float)
        for k, axis in enumerate(setting.axes)
        for place in axis.places
    }
    # combinations that are refused come last, as rows with their reason
    order = np.argsort(masses_of(base.structure, values), kind="stable")[: method.rows].tolist()
    for first in range(0, len(order), TOGETHER):
        table.solve([points[i] for i in order[first : first + TOGETHER]])
        progress(min((first + TOGETHER) / len(order), 1.0))
        if (violation_of(setting.study, table, setting.limits, first)[1] == 0.0).any():
            return


def _indices(setting: Setting, table: Table, progress: Callable[[float], None]) -> dict[str, Any] | str:
    """Sobol' indices; failed blocks are dropped and replaced by further ones of the sequence."""
    method, size = setting.study.method, len(setting.axes)
    count = method.rows
    if count & (count - 1):
        what, todo = "the number of blocks must be a power of 2", "write 256, 512, 1024, ..."
        raise InputError(Problem(what, str(count), "1, 2, 4, 8, ...", todo, "method.rows"))

    def ask(first: int, number: int) -> Integers:
        a, b, mixed = blocks(setting.axes, first, number, method.seed)
        table.solve(
            [*a, *b, *(point for one in mixed for point in one)], progress if first == 0 else unwatched
        )
        return (
            np.arange(len(table.points) - number * (size + 2), len(table.points))
            .reshape(-1, number)
            .astype(np.int64)
        )

    rows = ask(0, count)
    failed = int(np.sum(~table.ok[rows].all(axis=0)))
    if SPARE * failed > count:
        return f"{failed} of {count} blocks contain a failed row, more than 5 %: no indices"
    if failed:
        rows = np.concatenate([rows, ask(count, max(count // SPARE, 1))], axis=1)
    good = rows[:, table.ok[rows].all(axis=0)][:, :count]
    if good.shape[1] < count:
        return "too many blocks contain a failed row: no indices"
    return sobol_answer(setting.study, table, good)
