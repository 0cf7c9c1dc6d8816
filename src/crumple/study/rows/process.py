"""Rows by an executor: processes of this machine or of others."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from functools import partial

import numpy as np

from crumple.analysis import Analysis, solve
from crumple.analysis.criteria import Measured, measure
from crumple.analysis.solve import run_of
from crumple.errors import InputError, Status
from crumple.structure import changed
from crumple.study.rows.batch import (
    NOTHING,
    batched,
    columns_of_batch,
    largest_chunk,
    solve_alone,
    solve_chunk,
)
from crumple.study.rows.groups import in_groups
from crumple.study.rows.model import Model, Row, row_of, rows_of
from crumple.study.space import Axis, Point

BATCH = "batch"
"""In place of a fidelity: a row that is solved as a batch of one."""
AHEAD = 4
"""Groups that are given to an executor at a time, for each of its workers."""


class ProcessModel(Model):
    """Rows in an executor: one by one, or in groups where batches give them.

    Parameters
    ----------
    analysis, fidelity
        Base, and its solver.
    axes, measured
        Variables and responses.
    executor
        Any; a point and the base are pickled.
    workers
        That it has.
    """

    def __init__(
        self,
        analysis: Analysis,
        fidelity: str,
        axes: Sequence[Axis],
        measured: Sequence[Measured],
        executor: Executor,
        workers: int,
    ) -> None:
        alike = fidelity == "multibody" and batched(analysis, measured)
        self._solve = partial(
            solve_points, analysis, BATCH if alike else fidelity, tuple(axes), tuple(measured)
        )
        self._executor, self._ahead = executor, AHEAD * workers
        # single runs take long enough to be given one by one
        self._largest = largest_chunk(analysis, measured, 1) if alike else 1

    def rows(self, points: Sequence[Point]) -> Iterator[list[tuple[int, Row]]]:
        """See `Model`."""
        yield from in_groups(self._executor, self._solve, points, self._ahead, largest=self._largest)


def solve_points(
    analysis: Analysis,
    fidelity: str,
    axes: Sequence[Axis],
    measured: Sequence[Measured],
    points: Sequence[Point],
) -> tuple[list[Row], float]:
    """Rows of points, and the time that they took [s]."""
    begun = time.perf_counter()
    if fidelity == BATCH and all(axis.numeric for axis in axes):
        rows = solve_chunk(analysis, axes, measured, points, 1)
    else:
        rows = [solve_point(analysis, fidelity, axes, measured, point) for point in points]
    return rows, time.perf_counter() - begun


def solve_point(
    analysis: Analysis, fidelity: str, axes: Sequence[Axis], measured: Sequence[Measured], point: Point
) -> Row:
    """One row; a refusal is a row.

    What batches give is solved as they do: rows do not depend on how they were solved.  The rest is by
    `crumple.solve`, which solves at a quarter of the accuracy, with steps that end at its outputs.
    """
    from crumple.multibody import OTHER_PARTS  # noqa: PLC0415  (needs the kernels)

    values = {place: value for axis, value in zip(axes, point, strict=True) for place in axis.places}
    try:
        if fidelity == BATCH:
            words = {place: value for place, value in values.items() if isinstance(value, str)}
            numbers = {place: np.array([values[place]], float) for place in values if place not in words}
            structure = changed(analysis.structure, words) if words else analysis.structure
            table, columns = columns_of_batch(structure, run_of(analysis), numbers or NOTHING, measured, 1)
            if table.reason[0] == OTHER_PARTS:
                return solve_alone(analysis, values, measured)
            return rows_of(np.stack(columns, axis=1), table.status, table.reason)[0]
        structure = changed(analysis.structure, values)
        result = solve(analysis.model_copy(update={"structure": structure}), fidelity)
    except InputError as error:
        return row_of([np.nan] * len(measured), Status.REFUSED, str(error))
    mass = structure.mass_of_members
    found = [measure(result, one) if one.channel else mass for one in measured]
    return row_of(found, result.status, result.reason)
