"""Rows by the batch kernels."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from crumple.analysis import Analysis
from crumple.analysis.criteria import Measured
from crumple.analysis.solve import run_of
from crumple.errors import InputError, Status
from crumple.numeric.arrays import Floats
from crumple.structure import Outputs, Structure, changed
from crumple.study.rows.derived import Source
from crumple.study.rows.groups import TARGET_TIME, in_groups
from crumple.study.rows.model import Model, Row, row_of, rows_of
from crumple.study.space import Axis, Point

if TYPE_CHECKING:
    from crumple.multibody import Run
    from crumple.multibody.variants.variants import VariantTable

NOTHING: Mapping[str, Floats] = {"initial_velocity": np.ones(1)}
"""Parameter that leaves the structure as it is."""
SHARED_FROM = 3.0
"""Time that rows must still take to be shared by processes, which take a second to begin [s]."""
MOST_SAMPLES = 200_000
"""Samples of a channel in a chunk: some hundred channels of them fit into memory."""
FIRST_CHUNK, LARGEST_CHUNK = 4, 16_384
"""Rows of the first chunk and of the largest one."""
GROWTH = 64
"""Most by which a chunk is larger than the one before."""


class BatchModel(Model):
    """Rows by `crumple.multibody.solve_variants`.

    Parameters
    ----------
    analysis
        Base.
    axes
        Numeric variables.
    measured
        Responses that batches give, see `batched`.
    threads
        Rows do not depend on it.
    pool
        Processes that share long studies in which every row has laws of its own: these are made in Python,
        without threads.
    """

    def __init__(
        self,
        analysis: Analysis,
        axes: Sequence[Axis],
        measured: Sequence[Measured],
        threads: int,
        pool: Executor | None = None,
    ) -> None:
        self._job = analysis, tuple(axes), tuple(measured)
        self._threads, self._pool = threads, pool
        self._largest = largest_chunk(analysis, measured, threads)
        self._size = min(FIRST_CHUNK, self._largest)

    def rows(self, points: Sequence[Point]) -> Iterator[list[tuple[int, Row]]]:
        """See `Model`."""
        first = 0
        while first < len(points):
            size = min(self._size, len(points) - first)
            started = time.perf_counter()
            yield list(enumerate(solve_chunk(*self._job, points[first : first + size], self._threads), first))
            each = max(time.perf_counter() - started, 1e-6) / size
            first += size
            self._size = int(min(max(TARGET_TIME / each, self._threads), GROWTH * size, self._largest))
            if self._pool is not None and each * (len(points) - first) > SHARED_FROM:
                wanted, ahead = max(int(TARGET_TIME / each), 1), 2 * self._threads + 1
                solve = partial(_timed_chunk, *self._job)
                more = {"first": first, "size": min(wanted, self._largest), "largest": self._largest}
                yield from in_groups(self._pool, solve, points, ahead, **more)
                return


def _timed_chunk(
    analysis: Analysis, axes: Sequence[Axis], measured: Sequence[Measured], points: Sequence[Point]
) -> tuple[list[Row], float]:
    """A chunk by one thread, and the time that it took [s]."""
    begun = time.perf_counter()
    return solve_chunk(analysis, axes, measured, points, 1), time.perf_counter() - begun


def largest_chunk(analysis: Analysis, measured: Sequence[Measured], threads: int) -> int:
    """Rows of the largest chunk, whose histories fit into memory."""
    samples = len(_times(run_of(analysis), measured))
    return max(min(LARGEST_CHUNK, MOST_SAMPLES // max(samples, 1)), threads)


def solve_chunk(
    analysis: Analysis,
    axes: Sequence[Axis],
    measured: Sequence[Measured],
    points: Sequence[Point],
    threads: int,
) -> list[Row]:
    """Rows of points in one batch."""
    from crumple.multibody import OTHER_PARTS  # noqa: PLC0415  (needs the kernels)

    values = {
        place: np.array([point[k] for point in points], float)
        for k, axis in enumerate(axes)
        for place in axis.places
    }
    table, columns = columns_of_batch(analysis.structure, run_of(analysis), values, measured, threads)
    rows = rows_of(np.stack(columns, axis=1), table.status, table.reason)
    if OTHER_PARTS in table.reason:
        for i, reason in enumerate(table.reason):
            if reason == OTHER_PARTS:
                own = {place: float(column[i]) for place, column in values.items()}
                rows[i] = solve_alone(analysis, own, measured)
    return rows


def solve_alone(analysis: Analysis, values: Mapping[str, float | str], measured: Sequence[Measured]) -> Row:
    """Row of a point whose structure has parts of its own, as a batch of one; a refusal is a row.

    Parameters
    ----------
    analysis, measured
        As in `solve_chunk`.
    values
        By path or factor.
    """
    from crumple.multibody.variants.factors import is_factor  # noqa: PLC0415  (needs the kernels)

    factors = {place: np.array([value], float) for place, value in values.items() if is_factor(place)}
    paths = {place: value for place, value in values.items() if place not in factors}
    try:
        structure = changed(analysis.structure, paths) if paths else analysis.structure
        table, columns = columns_of_batch(structure, run_of(analysis), factors or NOTHING, measured, 1)
    except InputError as error:
        return row_of([np.nan] * len(measured), Status.REFUSED, str(error))
    return rows_of(np.stack(columns, axis=1), table.status, table.reason)[0]


def batched(analysis: Analysis, measured: Sequence[Measured]) -> bool:
    """Whether batches give all these responses: rates of rotation, forces and others they do not.

    Raises
    ------
    InputError
        If the base cannot be solved.
    """
    from crumple.multibody import solve_variants  # noqa: PLC0415  (needs the kernels)

    run = run_of(analysis)
    table = solve_variants(analysis.structure, run, NOTHING, 1, times=[run.duration])
    return all(
        not one.channel
        or one.quantity in table.quantities
        or Source.of(one.channel, run.outputs).raw in table.histories
        for one in measured
    )


def _times(run: Run, measured: Sequence[Measured]) -> list[float]:
    """Times whose values are needed [s]: those of 'at', and all outputs for what a history is needed for."""
    from crumple.multibody.run import output_times  # noqa: PLC0415  (needs the kernels)

    found: set[float] = set()
    for one in measured:
        source = Source.of(one.channel, run.outputs)
        if one.channel and (source.derived or one.quantity is None) and (source.derived or one.take != "at"):
            found |= set(output_times(run).tolist())
        elif one.channel and one.take == "at":
            found.add(min(one.time, run.duration))
        elif source.raw.split(".")[2:3] == ["velocity"]:
            found.add(run.duration)
    return sorted(found)


def _needed(outputs: Outputs, measured: Sequence[Measured]) -> Outputs:
    """Outputs without those that no response asks for: each takes time in every row."""
    names = {Source.of(one.channel, outputs).raw for one in measured}
    nodes = {name.split(".")[1] for name in names if name.startswith("node.")}
    kinds = ("section_rotations", "distances", "clearances")
    update: dict[str, Any] = {
        kind: {name: one for name, one in getattr(outputs, kind).items() if name in names} for kind in kinds
    }
    return outputs.model_copy(update={**update, "nodes": [node for node in outputs.nodes if node in nodes]})


def columns_of_batch(
    structure: Structure,
    run: Run,
    values: Mapping[str, Floats],
    measured: Sequence[Measured],
    threads: int,
) -> tuple[VariantTable, list[Floats]]:
    """Variants, and the responses of each, (n,)."""
    from crumple.multibody import solve_variants  # noqa: PLC0415  (needs the kernels)

    times = np.array(_times(run, measured))
    needed = replace(run, outputs=_needed(run.outputs, measured))
    table = solve_variants(structure, needed, values, threads, times=times)
    none = np.full((len(table), times.size), np.nan)

    def column(one: Measured) -> Floats:
        if not one.channel:
            return masses_of(structure, values)
        source = Source.of(one.channel, run.outputs)
        # with other sections a structure may lack a channel of the base
        history = table.histories.get(source.raw, none)
        if source.derived:
            return source.values(history, times, run, one)
        if one.take == "at":
            return np.asarray(history[:, np.searchsorted(times, min(one.time, run.duration))])
        if one.quantity is None:
            return _largest(history)
        if one.quantity in table.histories and one.quantity not in table.quantities:
            return np.asarray(history[:, -1])
        return table.quantities.get(one.quantity, np.full(len(table), np.nan))

    return table, [column(one) for one in measured]


def _largest(history: Floats) -> Floats:
    """Value of largest magnitude of each row, (n,)."""
    place = np.argmax(np.abs(np.nan_to_num(history)), axis=1)
    return np.asarray(history[np.arange(len(history)), place])


def masses_of(structure: Structure, values: Mapping[str, Floats]) -> Floats:
    """Mass of the members of variants [kg], (n,); NaN of those that are refused.

    Parameters
    ----------
    structure
        Gives what the values leave alone.
    values
        By path, (n,) each.
    """
    slow = {place: column for place, column in values.items() if place.startswith(_HEAVY)}
    count = len(next(iter(values.values())))
    if not slow:
        return np.full(count, structure.mass_of_members)
    found = np.full(count, np.nan)
    rows, place_of = np.unique(np.stack(list(slow.values()), 1), axis=0, return_inverse=True)
    for i, row in enumerate(rows.tolist()):
        try:
            mass = changed(structure, dict(zip(slow, row, strict=True))).mass_of_members
        except InputError:
            continue  # the row is refused, with its reason
        found[place_of.reshape(-1) == i] = mass
    return found


_HEAVY = ("sections.", "materials.", "nodes.", "members.")
"""Parts of an input that the mass of its members depends on."""
