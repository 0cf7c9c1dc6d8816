"""The winner is checked: the best rows and random ones are solved again by a slower model.

Errors of all rows that were solved twice, and of the random ones the rank correlation between the fast and
the slow answers: whether the fast model orders variants as the slow one does.  The best rows are not in it,
because they were chosen by the fast model.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from crumple.numeric.arrays import Floats, Integers
from crumple.study.answer import Limits, columns_of, front_of, violation_of
from crumple.study.space import Point
from crumple.study.study_file import Study, Verify
from crumple.study.table import Table

RESAMPLES = 2000
"""Bootstrap resamples of an interval."""
LEAST = 4
"""Rows that a rank correlation needs."""


def chosen_rows(study: Study, verify: Verify, table: Table, limits: Limits) -> tuple[list[int], list[int]]:
    """Numbers of the best rows, the best first, and of random ones; every point once.

    With several objectives the best rows are those of the Pareto front, evenly chosen along it.

    Parameters
    ----------
    study, verify
        The study, and how many rows.
    table
        All rows.
    limits
        Of the constraints.
    """
    first: dict[Point, int] = {}
    for i, (point, row) in enumerate(zip(table.points, table.rows, strict=True)):
        if row.ok:
            first.setdefault(point, i)
    rows = np.array(list(first.values()), int)
    best: list[int] = []
    front = front_of(study, table, limits)
    if front:
        places = np.linspace(0.0, len(front) - 1.0, min(verify.best, len(front))).round().astype(int)
        best = [front[i] for i in places.tolist()]
    elif study.goals and rows.size:
        objective, violation = violation_of(study, table, limits)
        order = np.lexsort((objective[rows], violation[rows]))
        best = rows[order][: verify.best].tolist()
    rest = np.setdiff1d(rows, best)
    drawn = np.random.default_rng(study.method.seed).permutation(rest)[: verify.sample]
    return best, sorted(drawn.tolist())


def verification(
    study: Study, fast: Table, slow: Table, limits: Limits, chosen: tuple[list[int], list[int]]
) -> dict[str, Any]:
    """What the slow answers say of the fast ones.

    Parameters
    ----------
    study, limits
        The study and its constraints.
    fast, slow
        All rows of the fast model; those of the slow one are the chosen ones in their order.
    chosen
        As `chosen_rows` gives them.

    Returns
    -------
    dict
        ``rows``: each with `row`, why it was chosen, fast and slow values, status, and whether it keeps the
        constraints by the slow model; ``responses``: errors and rank correlation of each; ``best``: the row
        with the best objective among the best ones that keep the constraints by the slow model, None if all
        are rejected or there are several objectives; ``rejected``: numbers of the best rows that do not.
    """
    best, sample = chosen
    numbers = [*best, *sample]
    quick, slowly = columns_of(study, fast), columns_of(study, slow)
    good = slow.ok
    objective, violation = violation_of(study, slow, limits) if numbers else (np.empty(0), np.empty(0))
    rows = [
        {
            "row": row,
            "chosen": "best" if i < len(best) else "sample",
            "variables": {axis.name: fast.points[row][k] for k, axis in enumerate(fast.axes)},
            "fast": {name: float(quick[name][row]) for name in study.responses},
            "slow": {name: _number(slowly[name][i]) for name in study.responses},
            "status": slow.rows[i].status,
            "reason": slow.rows[i].reason,
            "keeps_constraints": bool(good[i] and violation[i] == 0.0),
        }
        for i, row in enumerate(numbers)
    ]
    kept = [i for i in range(len(best)) if good[i] and violation[i] == 0.0]
    winner = min(kept, key=lambda i: float(objective[i]), default=None) if study.objective else None
    compared = {
        name: _compared(quick[name][numbers], slowly[name], len(best), study.method.seed)
        for name, response in study.responses.items()
        if not response.mass
    }
    return {
        "rows": rows,
        "responses": compared,
        "best": None if winner is None else rows[winner],
        "rejected": [best[i] for i in range(len(best)) if i not in kept],
    }


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _compared(fast: Floats, slow: Floats, best: int, seed: int) -> dict[str, Any]:
    """Errors of the fast values, and rank correlation of those of the sample."""
    both = np.isfinite(fast) & np.isfinite(slow)
    found: dict[str, Any] = {"rows": int(both.sum())}
    if both.any():
        error = (fast - slow)[both]
        found |= {
            "mean_error": float(error.mean()),
            "rms_error": float(np.sqrt((error**2).mean())),
            "largest_error": float(error[np.argmax(np.abs(error))]),
            "mean_slow": float(slow[both].mean()),
        }
    drawn = both & (np.arange(both.size) >= best)
    if drawn.sum() < LEAST:
        return found | {"tau": None, "interval": None, "sample": int(drawn.sum())}
    tau, interval = kendall(fast[drawn], slow[drawn], seed)
    return found | {"tau": tau, "interval": interval, "sample": int(drawn.sum())}


def kendall(x: Floats, y: Floats, seed: int) -> tuple[float | None, list[float] | None]:
    """Rank correlation tau-b of two columns, (n,), and its 95 % interval by bootstrap of the rows.

    None where all values of a column are equal.

    References
    ----------
    M. G. Kendall, The treatment of ties in ranking problems, Biometrika 33 (1945) 239-251.  Interval:
    B. Efron, R. Tibshirani, An introduction to the bootstrap, Chapman and Hall 1993, section 13.3.
    """
    above = np.sign(x[:, None] - x), np.sign(y[:, None] - y)
    whole = _tau(*above, np.arange(x.size))
    draws = np.random.default_rng(seed).integers(0, x.size, (RESAMPLES, x.size))
    found = np.array([value for draw in draws if (value := _tau(*above, draw)) is not None])
    if whole is None or found.size < RESAMPLES // 2:
        return whole, None
    low, high = np.quantile(found, [0.025, 0.975]).tolist()
    return whole, [low, high]


def _tau(x: Floats, y: Floats, rows: Integers) -> float | None:
    """tau-b of some rows from the signs of the differences of all pairs, (n, n)."""
    pairs = np.ix_(rows, rows)
    a, b = x[pairs], y[pairs]
    size = float((a * a).sum() * (b * b).sum())
    return float((a * b).sum() / np.sqrt(size)) if size > 0.0 else None
