"""What the page of a study shows: at most a stated number of rows, and what is drawn of all of them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from crumple.numeric.arrays import Floats, Integers
from crumple.numeric.binomial import clopper_pearson
from crumple.numeric.ranking import largest_first
from crumple.study.answer import Answer, columns_of, is_constant, judged_rows, remarks
from crumple.study.space import Axis
from crumple.study.study_file import LoadedStudy, Study
from crumple.study.table import Table
from crumple.units import format_quantity, parse_quantity, plain_number, unit_factor

MOST_ROWS = 5_000
"""Rows on a page: a browser draws them at once."""
DIGITS = 6
"""Digits of numbers on a page."""
CHECKPOINTS = 120
"""Points of a curve of convergence."""
FEW = 12
"""Values up to which a variable is a choice: each has a group of rows of its own."""
LEAST = 30
"""Complete rows that the effect of a range needs."""
TENTH = 0.1
"""Share of the rows at either end of a range."""


def page_data(study: LoadedStudy, table: Table, answer: Answer) -> dict[str, Any]:
    """Content of a study's page, of plain types.

    Parameters
    ----------
    study, table, answer
        A study that was solved.

    Returns
    -------
    dict
        ``columns``: name, unit, kind and values of variables and responses at the rows that are shown, in the
        units of the input; ``rows``: their numbers; ``status``; ``limits``, ``goals``, ``front``, ``best``,
        ``remarks``, ``effects`` and ``convergence`` as the page's script draws them.
    """
    own = study.study
    columns, axes = columns_of(own, table), {axis.name: axis for axis in table.axes}
    units = {name: _unit_of(axis) for name, axis in axes.items()}
    units |= {name: _readable(columns[name], answer.units[name]) for name in own.responses}
    rows = _shown(table, answer)
    return {
        "title": own.title,
        "method": own.method.type,
        "total": len(table.rows),
        "complete": answer.complete,
        "rows": rows.tolist(),
        "columns": [_column(name, table, columns, units, rows) for name in _names(own)],
        "status": [table.rows[i].reason or table.rows[i].status for i in rows.tolist()],
        "limits": [_limit(limit, units) for limit in answer.limits],
        "goals": [{"name": one.response, "sign": one.sign} for one in own.goals],
        "front": [int(one["row"]) for one in answer.front],
        "best": None if answer.best is None else int(answer.best["row"]),
        "remarks": remarks(answer),
        "effects": _effects(own, table, columns, units),
        "convergence": _convergence(own, table, answer, columns, units),
    }


def rows_alike(table: Table, rows: Sequence[int], solved: Sequence[int]) -> dict[int, int]:
    """Of shown rows, the solved row with the same point, where there is one."""
    by_point = {table.points[row]: row for row in reversed(solved)}
    return {row: by_point[table.points[row]] for row in rows if table.points[row] in by_point}


def _names(study: Study) -> list[str]:
    return [*study.variables, *study.responses]


def _unit_of(axis: Axis) -> tuple[str, float]:
    """Unit of a variable in the input, and its value in SI."""
    known = axis.numeric and axis.unit not in {"", "1"}
    return (axis.unit, parse_quantity(f"1 {axis.unit}", axis.unit)) if known else ("", 1.0)


def _readable(values: Floats, unit: str) -> tuple[str, float]:
    """Readable unit of a response of this size, and its value in SI."""
    known = np.abs(values[np.isfinite(values)])
    name = format_quantity(float(np.median(known)) if known.size else 0.0, unit).partition(" ")[2]
    return (name, unit_factor(name, unit)) if name else ("", 1.0)


def _shown(table: Table, answer: Answer) -> Integers:
    """Rows of the page: all, or the best and others evenly."""
    count = len(table.rows)
    if count <= MOST_ROWS:
        return np.arange(count)
    kept = [int(one["row"]) for one in answer.front][: MOST_ROWS // 2]
    kept += [] if answer.best is None else [int(answer.best["row"])]
    even = np.linspace(0, count - 1, MOST_ROWS - len(kept)).round().astype(int)
    return np.unique(np.concatenate([even, np.array(kept, int)]))


def _rounded(values: Floats) -> list[float | None]:
    return [float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None for value in values.tolist()]


def _column(
    name: str,
    table: Table,
    columns: Mapping[str, Floats],
    units: Mapping[str, tuple[str, float]],
    rows: Integers,
) -> dict[str, Any]:
    unit, factor = units[name]
    place = next((k for k, axis in enumerate(table.axes) if axis.name == name), None)
    kind = "response" if place is None else "variable"
    if name not in columns:
        assert place is not None
        words = [str(table.points[i][place]) for i in rows.tolist()]
        return {"name": name, "unit": "", "kind": kind, "words": True, "values": words}
    values = _rounded(columns[name][rows] / factor)
    return {"name": name, "unit": unit, "kind": kind, "words": False, "values": values}


def _limit(limit: tuple[str, float, float], units: Mapping[str, tuple[str, float]]) -> dict[str, Any]:
    name, low, high = limit
    factor = units[name][1]
    ends = [end / factor if math.isfinite(end) else None for end in (low, high)]
    return {"name": name, "low": ends[0], "high": ends[1]}


def _effects(
    study: Study, table: Table, columns: Mapping[str, Floats], units: Mapping[str, tuple[str, float]]
) -> list[dict[str, Any]]:
    """Of each response the mean at either end of each variable, the largest effect first.

    Of a range the ends are the tenths of the rows with its lowest and highest values; of a choice the values
    with the lowest and the highest mean.  The other variables vary meanwhile as they do in the study.  A
    response that is constant has no bars.
    """
    found = []
    for name in study.responses:
        known = np.flatnonzero(np.isfinite(columns[name]))
        if known.size < 2:
            continue
        values, bars = columns[name][known] / units[name][1], []
        constant = is_constant(values)
        for k, axis in enumerate(() if constant else table.axes):
            ends = _ends([table.points[i][k] for i in known.tolist()], values, units[axis.name])
            if ends is not None:
                bars.append({"variable": axis.name, **ends})
        widths = {i: abs(float(bar["high"]) - float(bar["low"])) for i, bar in enumerate(bars)}
        bars = [bars[i] for i in largest_first(widths)]
        if bars or constant:
            mean = float(f"{values.mean():.{DIGITS}g}")
            found.append({"response": name, "unit": units[name][0], "mean": mean, "bars": bars})
    return found


def _ends(given: Sequence[float | str], values: Floats, unit: tuple[str, float]) -> dict[str, Any] | None:
    """Means of the response at the ends of a variable, and what these ends are."""
    levels = sorted(set(given), key=str) if isinstance(given[0], str) else sorted(set(map(float, given)))
    if len(levels) < 2:
        return None
    if len(levels) <= FEW:
        means = [float(values[[one == level for one in given]].mean()) for level in levels]
        words = isinstance(given[0], str)
        low, high = (int(np.argmin(means)), int(np.argmax(means))) if words else (0, len(levels) - 1)
        told = [
            level if isinstance(level, str) else f"{plain_number(level / unit[1])} {unit[0]}".strip()
            for level in (levels[low], levels[high])
        ]
        return {"low": means[low], "high": means[high], "at_low": told[0], "at_high": told[1]}
    if values.size < LEAST:
        return None
    numbers = np.array(given, float)
    below, above = np.quantile(numbers, [TENTH, 1.0 - TENTH])
    told = [f"{plain_number(end / unit[1])} {unit[0]}".strip() for end in (below, above)]
    return {
        "low": float(values[numbers <= below].mean()),
        "high": float(values[numbers >= above].mean()),
        "at_low": f"≤ {told[0]}",
        "at_high": f"≥ {told[1]}",
    }


def _convergence(
    study: Study,
    table: Table,
    answer: Answer,
    columns: Mapping[str, Floats],
    units: Mapping[str, tuple[str, float]],
) -> list[dict[str, Any]]:
    """How the answer settles as rows are added: the best so far, or means and shares with their interval."""
    count = len(table.rows)
    if count < 2:
        return []
    at = np.unique(np.linspace(1, count, min(CHECKPOINTS, count)).round().astype(int))
    if study.goals:
        return _best_so_far(study, table, answer, units, at)
    found = []
    for name in study.responses:
        values = columns[name] / units[name][1]
        good = np.isfinite(values)
        number = np.maximum(np.cumsum(good)[at - 1], 1)
        clean = np.where(good, values, 0.0)
        mean = np.cumsum(clean)[at - 1] / number
        about = clean - mean[-1] * good
        spread = np.sqrt(np.maximum(np.cumsum(about**2)[at - 1] / number - (mean - mean[-1]) ** 2, 0.0))
        half = 1.96 * spread / np.sqrt(number)
        found.append(_curve(f"mean of {name}", units[name][0], at, mean, mean - half, mean + half))
    for name, low, high in answer.limits if study.method.type == "monte_carlo" else ():
        values = columns[name]
        good = np.isfinite(values)
        number = np.cumsum(good)[at - 1].tolist()
        beyond = np.cumsum(good & ((values < low) | (values > high)))[at - 1].tolist()
        ends = [clopper_pearson(b, n) if n else (0.0, 1.0) for b, n in zip(beyond, number, strict=True)]
        share = np.array([b / n if n else math.nan for b, n in zip(beyond, number, strict=True)])
        band = np.array(ends)
        found.append(_curve(f"probability of violating {name}", "", at, share, band[:, 0], band[:, 1]))
    return found


def _best_so_far(
    study: Study, table: Table, answer: Answer, units: Mapping[str, tuple[str, float]], at: Integers
) -> list[dict[str, Any]]:
    goals, violation = judged_rows(study, table, answer.limits)
    found = []
    for goal, values in zip(study.goals, goals, strict=True):
        best = np.minimum.accumulate(np.where(violation == 0.0, values, np.inf))[at - 1]
        best = np.where(np.isfinite(best), goal.sign * best / units[goal.response][1], np.nan)
        found.append(_curve(f"best {goal.response} so far", units[goal.response][0], at, best, None, None))
    return found


def _curve(
    name: str, unit: str, at: Integers, values: Floats, low: Floats | None, high: Floats | None
) -> dict[str, Any]:
    band = [] if low is None or high is None else [_rounded(low), _rounded(high)]
    return {"name": name, "unit": unit, "rows": at.tolist(), "values": _rounded(values), "band": band}
