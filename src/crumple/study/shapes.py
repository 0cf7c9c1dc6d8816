"""Single runs of some rows of a study, for their shapes."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from crumple.analysis import Analysis
from crumple.analysis.solve import run_of
from crumple.errors import InputError
from crumple.result import Result
from crumple.structure import Structure, changed
from crumple.study.answer import Answer, columns_of
from crumple.study.rows import layout_place, without
from crumple.study.space import Axis, Point
from crumple.study.study_file import LoadedStudy
from crumple.study.table import Table

BEST = 10
"""Rows with the best objective."""
PICTURES = 31
"""Shapes of a run: enough to show its motion."""
SECONDS = 20.0
"""Time after which no further run is begun [s]."""
SCALED = ("initial_velocity", "gravity")
"""Factors that single runs take besides those on capacities."""


def chosen_for_shapes(study: LoadedStudy, table: Table, answer: Answer, most: int) -> list[int]:
    """Numbers of rows to show: the best, those of the front, and others spread over the first goal.

    Parameters
    ----------
    study, table, answer
        A study that was solved.
    most
        Rows.
    """
    own, ok = study.study, np.flatnonzero(table.ok)
    columns = columns_of(own, table)
    first = own.goals[0].response if own.goals else next(iter(own.responses))
    known = ok[np.isfinite(columns[first][ok])]
    order = known[np.argsort(columns[first][known], kind="stable")]
    front = np.array([one["row"] for one in answer.front], int)
    wanted = [] if answer.best is None else [int(answer.best["row"])]
    if front.size:
        wanted += _spread(front, max(most // 2, 1))
    elif own.goals:
        better = order[::-1] if own.goals[0].maximise else order
        wanted += [row for row in better.tolist() if _keeps(columns, answer, row)][:BEST]
    # equal points are solved once
    points: dict[Point, int] = {}
    for row in wanted:
        points.setdefault(table.points[row], row)
    best = list(points.values())[:most]
    for row in order.tolist():
        points.setdefault(table.points[row], row)
    return best + _spread(list(points.values())[len(best) :], most - len(best))


def solved_for_shapes(
    study: LoadedStudy, table: Table, rows: list[int]
) -> Iterator[tuple[int, Result, Structure]]:
    """Runs of rows by the multibody model, with shapes; without rows that single runs cannot solve.

    Parameters
    ----------
    study, table
        A study that was solved.
    rows
        Their numbers.

    Yields
    ------
    tuple
        Number of the row, its run and its structure.
    """
    from crumple.multibody import solve_multibody  # noqa: PLC0415  (needs the kernels)

    place = layout_place(table.axes)
    axes = [axis for k, axis in enumerate(table.axes) if k != place]
    begun = time.perf_counter()
    for row in rows:
        if time.perf_counter() - begun > SECONDS:
            return
        point, base = table.points[row], study.base.analysis
        if place is not None:
            point, base = without(point, place), study.bases[str(point[place])].analysis
        run = run_of(base)
        times = tuple(np.linspace(0.0, run.duration, PICTURES).tolist())
        run = replace(run, outputs=run.outputs.model_copy(update={"pictures": times}))
        try:
            structure, capacities = structure_of(base, axes, point)
            result = solve_multibody(structure, replace(run, capacities=capacities))
        except InputError:
            continue  # a row whose factors single runs do not take, or that they refuse
        if result.status.ok and result.states is not None:
            yield row, result, structure


def structure_of(base: Analysis, axes: Sequence[Axis], point: Point) -> tuple[Structure, dict[str, float]]:
    """The structure of a row, and factors on the capacities of its hinges.

    Raises
    ------
    InputError
        If the structure is refused, or the row has a factor on loads or impulses.
    """
    values: dict[str, Any] = {
        place: value for axis, value in zip(axes, point, strict=True) for place in axis.places
    }
    factors = {place: value for place, value in values.items() if "." not in place}
    capacities = {
        place.split(".")[1]: float(value) for place, value in values.items() if place.startswith("hinges.")
    }
    unknown = [place for place in factors if place not in SCALED]
    if unknown:
        raise InputError(f"a single run takes no factor on {unknown[0]}")
    paths = {
        place: value
        for place, value in values.items()
        if place not in factors and not place.startswith("hinges.")
    }
    structure = changed(base.structure, paths) if paths else base.structure
    speed, weight = (float(factors.get(name, 1.0)) for name in SCALED)
    scaled: dict[str, float] = {}
    for i, field in enumerate(structure.initial_velocity if speed != 1.0 else ()):
        scaled[f"initial_velocity.{i}.rotation"] = speed * float(field.rotation)
        scaled |= {
            f"initial_velocity.{i}.translation.{k}": speed * float(value)
            for k, value in enumerate(field.translation)
        }
    if weight != 1.0:
        scaled |= {f"gravity.{k}": weight * float(value) for k, value in enumerate(structure.gravity)}
    return (changed(structure, scaled) if scaled else structure), capacities


def _keeps(columns: dict[str, Any], answer: Answer, row: int) -> bool:
    return all(low <= columns[name][row] <= high for name, low, high in answer.limits)


def _spread(rows: Any, most: int) -> list[int]:
    """Some of the rows, evenly in their order."""
    if not len(rows) or most < 1:
        return []
    places = np.linspace(0.0, len(rows) - 1.0, min(most, len(rows))).round().astype(int)
    found: list[int] = np.asarray(rows)[places].tolist()
    return found
