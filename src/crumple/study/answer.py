"""What the rows of a study say: statistics, probabilities, indices and the best row."""

from __future__ import annotations

import csv
import math
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

import numpy as np

from crumple.numeric.arrays import Floats, Integers
from crumple.numeric.binomial import clopper_pearson
from crumple.portable import replacing
from crumple.study.formula import Formula
from crumple.study.front import nondominated
from crumple.study.study_file import Study
from crumple.study.table import Table
from crumple.units import format_quantity

ROUNDING = 1e-12
"""Largest difference of values that count as equal, as a share of the largest of them."""
MOST_CHANGES = 6
"""Changes of laws that console and page name."""

_NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[-+]?\d+)?")

Limits = Sequence[tuple[str, float, float]]
"""Of constraints: response, lower limit and upper limit."""


@dataclass(frozen=True)
class Answer:
    """Summary of a study; its numbers are SI.

    Attributes
    ----------
    rows, complete
        Number of rows, and of those with usable values.
    solved
        Points that were solved in this process; the others were known or equal.
    failures, reasons
        Number of rows by status; by status the reason of its first row, and the number of rows that have
        the same but for numbers.
    units
        Of responses.
    responses
        Of each response: mean, deviation, low, median, high of the complete rows.
    probabilities
        Of each constraint (Monte Carlo): share of the complete rows that violate it, and its interval.
    best
        Row with the best objective among those that meet all constraints; None without one.
    nearest
        With objectives and no row that meets all constraints: that with the smallest sum of excesses, each
        over its limit; None without one.
    law_changes
        Between which rows hinges have laws of other types, see `crumple.study.rows.laws`.
    indices
        Sobol' indices of each response, or why there are none.
    verification
        What a slower model says of the best rows and of random ones, see `crumple.study.verify`.
    front
        With several objectives: the rows that meet all constraints and that no other such row is better than
        in one goal and at least equal to in the others, by the first goal.
    limits
        Of each constraint: response, lower limit and upper limit.
    """

    rows: int
    complete: int
    solved: int
    failures: Mapping[str, int]
    units: Mapping[str, str]
    responses: Mapping[str, Mapping[str, float]]
    probabilities: Sequence[Mapping[str, Any]] = ()
    best: Mapping[str, Any] | None = None
    indices: Mapping[str, Any] | str = field(default_factory=dict)
    verification: Mapping[str, Any] | None = None
    front: Sequence[Mapping[str, Any]] = ()
    limits: Limits = ()
    reasons: Mapping[str, tuple[str, int]] = field(default_factory=dict)
    nearest: Mapping[str, Any] | None = None
    law_changes: Sequence[Mapping[str, Any]] = ()

    def plain(self) -> dict[str, Any]:
        """Content of study.json; without `solved`, which a resumed study has otherwise."""
        return {
            "rows": self.rows,
            "complete": self.complete,
            "failures": dict(self.failures),
            "reasons": {status: list(reason) for status, reason in self.reasons.items()},
            "units": dict(self.units),
            "responses": {name: dict(values) for name, values in self.responses.items()},
            "probabilities": list(self.probabilities),
            "best": self.best,
            "nearest": self.nearest,
            "indices": self.indices,
            "front": list(self.front),
            "verification": self.verification,
            "law_changes": list(self.law_changes),
        }


def remarks(answer: Answer) -> list[str]:
    """Sentences for console and page: failed rows, what lacks them, changes of laws, no feasible row."""
    found = [f"first of {count} alike: {reason}" for reason, count in answer.reasons.values()]
    lost = answer.rows - answer.complete
    if answer.probabilities and lost:
        found.append(
            f"caution: {lost} of {answer.rows} rows have no result and are left out of probabilities"
        )
    changes = [change["text"] for change in answer.law_changes]
    found += changes[:MOST_CHANGES]
    if len(changes) > MOST_CHANGES:
        found.append(f"laws change {len(changes) - MOST_CHANGES} times more: study.json, law_changes")
    if answer.nearest is not None:
        near = answer.nearest
        values = [f"{name} {_plain(value)}" for name, value in near["variables"].items()]
        told = [
            f"{name} {format_quantity(value, answer.units[name])}"
            for name, value in near["responses"].items()
        ]
        nearest = f"the nearest is row {near['row']}: {', '.join(values)} (SI units); {', '.join(told)}"
        found.append(f"no row of {answer.rows} keeps all constraints; {nearest}")
    return found


def _plain(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.6g}"


def write_front(answer: Answer, path: Path) -> None:
    """Write the rows of the Pareto front as CSV in SI units; without several objectives there is no file."""
    if not answer.front:
        path.unlink(missing_ok=True)
        return
    first = answer.front[0]
    with replacing(path) as file, file.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["row", *first["variables"], *first["responses"]])
        writer.writerows(
            [one["row"], *one["variables"].values(), *one["responses"].values()] for one in answer.front
        )


def columns_of(study: Study, table: Table) -> dict[str, Floats]:
    """Variables that are numbers, and all responses, (n,) each."""
    columns = table.columns()
    columns.update(derived_columns(study, table))
    return columns


def derived_columns(study: Study, table: Table) -> dict[str, Floats]:
    """Responses by formulas, (n,) each; not a number where the formula is not defined or the row failed."""
    columns, found = table.columns(), {}
    ok = table.ok
    for name, response in study.responses.items():
        if response.formula:
            values = np.broadcast_to(Formula(response.formula)(columns), ok.shape)
            columns[name] = found[name] = np.where(ok & np.isfinite(values), values, np.nan)
    return found


def judged_rows(study: Study, table: Table, limits: Limits, first: int = 0) -> tuple[Floats, Floats]:
    """Goals, each made small, (goals, n), and violation of the constraints, (n,), of the rows from `first`.

    The violation is the sum of excesses over limits, each over the limit's magnitude; infinite in failed
    rows.
    """
    columns = {name: column[first:] for name, column in columns_of(study, table).items()}
    count = len(table.rows) - first
    goals = [goal.sign * columns[goal.response] for goal in study.goals]
    wanted = np.array(goals, float).reshape(len(goals), count)
    violation = np.where(np.isfinite(wanted).all(axis=0), 0.0, np.inf)
    for response, low, high in limits:
        values = columns[response]
        for excess, limit in ((low - values, low), (values - high, high)):
            if math.isfinite(limit):
                beyond = np.maximum(excess, 0.0) / (abs(limit) or 1.0)
                violation = violation + np.where(np.isfinite(beyond), beyond, np.inf)
    return wanted, violation


def violation_of(study: Study, table: Table, limits: Limits, first: int = 0) -> tuple[Floats, Floats]:
    """First goal, made small, and violation of the constraints of the rows from `first`, (n,) each."""
    wanted, violation = judged_rows(study, table, limits, first)
    return (wanted[0] if len(wanted) else np.zeros(violation.size)), violation


def front_of(study: Study, table: Table, limits: Limits) -> list[int]:
    """Numbers of the rows of the Pareto front, in the order of the first goal; of equal rows the first one.

    Empty without several objectives.
    """
    if len(study.goals) < 2 or not table.rows:
        return []
    wanted, violation = judged_rows(study, table, limits)
    return nondominated(wanted, np.flatnonzero(violation == 0.0))


def answer_of(
    study: Study,
    table: Table,
    limits: Limits,
    units: Mapping[str, str],
    indices: Mapping[str, Any] | str | None = None,
) -> Answer:
    """Summary of all rows.

    Parameters
    ----------
    study, table
        The study and its rows.
    limits
        Of constraints [SI].
    units
        Of responses.
    indices
        As `Answer` has them.
    """
    columns, ok = columns_of(study, table), table.ok
    failures = Counter(table.rows[i].status for i in np.flatnonzero(~ok).tolist())
    statistics = {name: _statistics(columns[name]) for name in study.responses}
    likely = []
    if study.method.type == "monte_carlo":
        likely = [_probability(name, low, high, columns[name]) for name, low, high in limits]
    return Answer(
        len(table.rows),
        int(ok.sum()),
        table.solved,
        dict(failures),
        dict(units),
        statistics,
        likely,
        _best(study, table, limits, columns),
        indices or {},
        front=[_shown_row(study, table, columns, row) for row in front_of(study, table, limits)],
        limits=limits,
        reasons=_reasons(table),
        nearest=_nearest(study, table, limits, columns),
    )


def is_constant(values: Floats) -> bool:
    """Whether finite values differ by rounding at most."""
    return bool(np.ptp(values) <= ROUNDING * np.abs(values).max(initial=0.0))


def _statistics(column: Floats) -> dict[str, float]:
    known = column[np.isfinite(column)]
    if not known.size:
        return {}
    low, middle, high = np.quantile(known, [0.025, 0.5, 0.975]).tolist()
    spread = float(known.std(ddof=1)) if known.size > 1 else 0.0
    ends = {"min": float(known.min()), "max": float(known.max())}
    return {
        "mean": float(known.mean()),
        "deviation": spread,
        "q2.5": low,
        "median": middle,
        "q97.5": high,
    } | ends


def _probability(name: str, low: float, high: float, column: Floats) -> dict[str, Any]:
    """Share of rows beyond a limit, with the interval of Clopper and Pearson."""
    known = column[np.isfinite(column)]
    beyond = int(((known < low) | (known > high)).sum())
    limits = {
        "at_least": low if math.isfinite(low) else None,
        "at_most": high if math.isfinite(high) else None,
    }
    found: dict[str, Any] = {"response": name, **limits, "rows": int(known.size), "beyond": beyond}
    if known.size:
        interval = clopper_pearson(beyond, int(known.size))
        found |= {"probability": beyond / known.size, "interval": list(interval)}
    return found


def _best(study: Study, table: Table, limits: Limits, columns: Mapping[str, Floats]) -> dict[str, Any] | None:
    if study.objective is None or not table.rows:
        return None
    objective, violation = violation_of(study, table, limits)
    if not (violation == 0.0).any():
        return None
    return _shown_row(study, table, columns, int(np.argmin(np.where(violation == 0.0, objective, np.inf))))


def _nearest(
    study: Study, table: Table, limits: Limits, columns: Mapping[str, Floats]
) -> dict[str, Any] | None:
    if not study.goals or not table.rows:
        return None
    violation = violation_of(study, table, limits)[1]
    if (violation == 0.0).any() or not np.isfinite(violation).any():
        return None
    return _shown_row(study, table, columns, int(np.argmin(violation)))


def _reasons(table: Table) -> dict[str, tuple[str, int]]:
    """By status the reason of its first failed row that has one, and how many have it but for numbers."""
    failed = [table.rows[i] for i in np.flatnonzero(~table.ok).tolist()]
    first: dict[str, str] = {}
    for row in failed:
        if row.reason:
            first.setdefault(row.status, row.reason)
    alike = Counter(_NUMBER.sub("#", row.reason) for row in failed)
    return {
        status: ("; ".join(map(str.strip, reason.splitlines())), alike[_NUMBER.sub("#", reason)])
        for status, reason in first.items()
    }


def _shown_row(study: Study, table: Table, columns: Mapping[str, Floats], row: int) -> dict[str, Any]:
    return {
        "row": row,
        "variables": {axis.name: table.points[row][k] for k, axis in enumerate(table.axes)},
        "responses": {name: float(columns[name][row]) for name in study.responses},
    }


def sobol_answer(study: Study, table: Table, rows: Integers) -> dict[str, Any]:
    """Sobol' indices of each response.

    Parameters
    ----------
    study, table
        The study and its rows.
    rows
        Numbers of the rows of A, B, and of each variable A with that variable from B, (2 + variables, n).

    Returns
    -------
    dict
        By response and variable ``first`` and ``total``.  Both are None, and ``reason`` says why, if the
        response has no variance, or one that is not known.
    """
    from scipy.stats import sobol_indices  # noqa: PLC0415  (slow to import)

    columns, count = columns_of(study, table), rows.shape[1]
    found: dict[str, Any] = {}
    for name in study.responses:
        values = columns[name][rows]
        reason = "not a number in some rows" if not np.isfinite(values).all() else ""
        if not reason and is_constant(values):
            reason = "the response is constant"
        if reason:
            none = {"first": None, "total": None, "reason": reason}
            found[name] = {axis.name: none for axis in table.axes}
            continue
        # given twice, since SciPy fails for one response of one variable
        a, b, *mixed = np.repeat(values[:, np.newaxis], 2, axis=1)
        given: dict[Literal["f_A", "f_B", "f_AB"], Floats] = {"f_A": a, "f_B": b, "f_AB": np.stack(mixed)}
        result = sobol_indices(func=given, n=count)
        first, total = (x.reshape(2, -1)[0].tolist() for x in (result.first_order, result.total_order))
        found[name] = {axis.name: {"first": first[k], "total": total[k]} for k, axis in enumerate(table.axes)}
    return found
