"""Scatter of a run with its input: bands on curves, probability of keeping each criterion, and a tornado.

The variants are independent points of the distributions, so that the number of those that keep a criterion is
binomial.  They are solved by the batch kernels.  Bands of the hinge laws are not mixed in: they say how far
the model may err, the scatter says how far the structure may differ; see `crumple.analysis.with_law_range`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from crumple.analysis import Analysis
from crumple.analysis.criteria import Measured, limits_of
from crumple.analysis.distribution import numbers_of, quantile
from crumple.analysis.solve import run_of
from crumple.analysis.uncertainty import Uncertainty
from crumple.errors import Status
from crumple.numeric.arrays import Floats
from crumple.numeric.binomial import clopper_pearson
from crumple.numeric.ranking import largest_first
from crumple.result import Result
from crumple.result.scatter import Chance, Scatter, Swing

TIMES = 41
"""Points of a band: enough for a smooth figure."""
SHARES = (0.025, 0.5, 0.975)
"""Quantiles of a band, and places of the variables in a tornado."""
SPOKEN = 3
"""Hinges whose rotation has a tornado if there are no criteria: those that absorb most energy."""


@dataclass(frozen=True, eq=False)
class _Solved:
    """Variants that were solved: quantities (n,), histories (n, times), which are complete."""

    quantities: Mapping[str, Floats]
    histories: Mapping[str, Floats]
    times: Floats
    good: Floats

    def values(self, wanted: Measured) -> Floats | None:
        """A measured number of every variant, (n,); None if batches do not have it."""
        if wanted.quantity is not None and wanted.quantity in self.quantities:
            return self.quantities[wanted.quantity]
        history = self.histories.get(wanted.channel)
        if history is None:
            return None
        if wanted.take == "at":
            return np.array([np.interp(wanted.time, self.times, row) for row in history])
        largest = np.argmax(np.abs(np.nan_to_num(history)), axis=1)
        return np.asarray(history[np.arange(len(history)), largest])


def with_uncertainty(
    result: Result,
    analysis: Analysis,
    threads: int = 1,
    progress: Callable[[float], None] | None = None,
    cancel: Callable[[], bool] | None = None,
) -> Result:
    """A multibody result with its scatter, if the analysis has an uncertainty; see `Scatter`.

    Parameters
    ----------
    result
        Of the analysis.
    analysis
        As it was solved.
    threads, progress, cancel
        As in `crumple.multibody.solve_variants`.

    Raises
    ------
    InputError
        If a distribution is none, or a factor does not exist.

    References
    ----------
    docs/uncertainty.md.  Verified in tests/unit/study/test_scatter.py.
    """
    from crumple.multibody import solve_variants  # noqa: PLC0415  (needs the kernels)

    given = analysis.uncertainty
    if given is None or not given.variables:
        return result
    shares = _shares(given)
    values: dict[str, Floats] = {}
    for k, (name, one) in enumerate(given.variables.items()):
        where = f"uncertainty.variables.{name}.distribution"
        # an analysis has SI numbers
        numbers = numbers_of(one.distribution, "1", where)
        column = quantile(one.distribution.type, numbers, shares[:, k])
        values |= dict.fromkeys(one.places, column)
    times = np.linspace(0.0, analysis.duration, TIMES)
    table = solve_variants(
        analysis.structure, run_of(analysis), values, threads, progress, cancel, times=times
    )
    good = np.array([status.ok for status in table.status])
    solved = _Solved(table.quantities, table.histories, times, good)
    notes = _failures(table.status[: given.rows])
    chances, more = _chances(result, analysis, solved, given.rows)
    return replace(
        result,
        scatter=Scatter(
            given.rows,
            int(good[: given.rows].sum()),
            {name: one.source for name, one in given.variables.items()},
            tuple(times.tolist()),
            _bands(result, solved, given.rows),
            chances,
            _swings(result, analysis, solved, given),
            (*notes, *more),
        ),
    )


def _shares(given: Uncertainty) -> Floats:
    """Places of all variants in the distributions: independent ones, the medians, and either end of each."""
    size = len(given.variables)
    ends = np.full((1 + 2 * size, size), SHARES[1])
    for k in range(size):
        ends[1 + 2 * k, k], ends[2 + 2 * k, k] = SHARES[0], SHARES[2]
    return np.concatenate([np.random.default_rng(given.seed).random((given.rows, size)), ends])


def _failures(status: Sequence[Status]) -> tuple[str, ...]:
    stopped = sum(one is Status.CANCELLED for one in status)
    lost = sum(not one.ok for one in status) - stopped
    notes = (
        (stopped, "were not solved: stopped on request"),
        (lost, "did not reach the end and are left out"),
    )
    return tuple(f"{number} of {len(status)} variants {what}" for number, what in notes if number)


def _bands(
    result: Result, solved: _Solved, rows: int
) -> dict[str, tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]]:
    """Quantiles of the channels that the result and the variants have, at each time."""
    good = solved.good[:rows]
    if not good.any():
        return {}
    found = {}
    for name, history in solved.histories.items():
        if name in result.channels:
            low, middle, high = np.quantile(history[:rows][good], SHARES, axis=0).tolist()
            found[name] = (tuple(low), tuple(middle), tuple(high))
    return found


def _chances(
    result: Result, analysis: Analysis, solved: _Solved, rows: int
) -> tuple[tuple[Chance, ...], tuple[str, ...]]:
    """Share of the complete variants that keep each criterion, and which criteria variants cannot judge."""
    found, notes, good = [], [], solved.good[:rows]
    for wanted, low, high in limits_of(analysis.criteria, result):
        values = solved.values(wanted)
        if values is None or not good.any():
            notes.append(f"variants do not have {wanted.channel} of criterion {wanted.name}")
            continue
        known = values[:rows][good]
        kept = int(((known >= low) & (known <= high)).sum())
        interval = clopper_pearson(kept, known.size)
        found.append(Chance(wanted.name, known.size, kept, kept / known.size, interval))
    return tuple(found), tuple(notes)


def _swings(result: Result, analysis: Analysis, solved: _Solved, given: Uncertainty) -> tuple[Swing, ...]:
    """One variable at a time at its ends, the others at their medians."""
    wanted = [one for one, _, _ in limits_of(analysis.criteria, result)]
    if not wanted:
        ranked = largest_first({name: hinge.energy for name, hinge in result.hinges.items()})[:SPOKEN]
        channels = [f"hinge.{name}.rotation" for name in ranked]
        wanted = [Measured(channel, channel, "max") for channel in channels if channel in result.channels]
    found = []
    for one in wanted:
        values = solved.values(one)
        if values is None:
            continue
        middle, *ends = np.where(solved.good, values, np.nan)[given.rows :].tolist()
        unit = result.channels[one.channel].unit
        swings = [
            Swing(one.name, unit, name, ends[2 * k], middle, ends[2 * k + 1])
            for k, name in enumerate(given.variables)
            if math.isfinite(ends[2 * k]) and math.isfinite(ends[2 * k + 1]) and math.isfinite(middle)
        ]
        order = largest_first({i: abs(swing.high - swing.low) for i, swing in enumerate(swings)})
        found += [swings[i] for i in order]
    return tuple(found)
