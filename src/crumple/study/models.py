"""What solves the rows of a study: the batch kernels, processes, or a function of the caller's."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from crumple.analysis import Analysis, solve
from crumple.analysis.solve import run_of
from crumple.errors import InputError, Problem, Status
from crumple.numeric.arrays import Floats
from crumple.structure import changed
from crumple.study.space import Axis, Point

if TYPE_CHECKING:
    from crumple.result import Result

TARGET_TIME = 0.4
"""Wall time of a chunk of a batch [s]: rows are stored at the latest a second after they are known."""
FIRST_CHUNK, LARGEST_CHUNK = 64, 4096
"""Rows of the first chunk and of the largest one."""
SUMMARISED = ("rotation", "moment")
"""Channels of hinges whose largest value a batch gives."""


@dataclass(frozen=True)
class Row:
    """What one point gave.

    Attributes
    ----------
    values
        Of the measured responses, in their order; NaN in a row without an answer.
    status
        ``complete``, or how it failed.
    reason
        Why it failed.
    """

    values: tuple[float, ...]
    status: str
    reason: str

    @property
    def ok(self) -> bool:
        """Whether its values can be used."""
        return self.status == Status.COMPLETE.value


@dataclass(frozen=True)
class Measured:
    """A response that is read from a result.

    Attributes
    ----------
    name
        Of the response.
    channel
        Of the result; empty for the mass of members.
    take, time
        As in the study file; [s].
    """

    name: str
    channel: str
    take: str = "final"
    time: float = 0.0

    @property
    def quantity(self) -> str | None:
        """Name in a table of variants; None if batches do not give it."""
        parts = self.channel.split(".")
        if self.take == "final":
            return self.channel
        if self.take == "max" and parts[0] == "hinge" and len(parts) == 3 and parts[2] in SUMMARISED:
            return f"{self.channel}_max"
        return None


class Model(ABC):
    """Solves points in groups."""

    @abstractmethod
    def rows(self, points: Sequence[Point]) -> Iterator[list[tuple[int, Row]]]:
        """Groups of numbers of points and their rows, each as soon as it is known."""


class BatchModel(Model):
    """Rows by `crumple.multibody.solve_variants`.

    Parameters
    ----------
    analysis
        Base.
    axes
        Numeric variables.
    measured
        Responses that batches give.
    threads
        Rows do not depend on it.
    """

    def __init__(
        self, analysis: Analysis, axes: Sequence[Axis], measured: Sequence[Measured], threads: int
    ) -> None:
        self._analysis, self._axes, self._measured, self._threads = analysis, axes, measured, threads

    def rows(self, points: Sequence[Point]) -> Iterator[list[tuple[int, Row]]]:
        """See `Model`."""
        first, size = 0, FIRST_CHUNK
        while first < len(points):
            started = time.perf_counter()
            chunk = points[first : first + size]
            yield list(enumerate(self._solved(chunk), first))
            first += len(chunk)
            spent = max(time.perf_counter() - started, 1e-6)
            size = int(min(max(size * TARGET_TIME / spent, 1), 4 * size, LARGEST_CHUNK))

    def _solved(self, points: Sequence[Point]) -> Iterator[Row]:
        from crumple.multibody import solve_variants  # noqa: PLC0415  (needs the kernels)

        values = {
            place: np.array([point[k] for point in points], float)
            for k, axis in enumerate(self._axes)
            for place in axis.places
        }
        run = run_of(self._analysis)
        table = solve_variants(self._analysis.structure, run, values, self._threads)
        columns = [
            table.quantities[str(one.quantity)] if one.channel else self._mass(values)
            for one in self._measured
        ]
        for i, (status, reason) in enumerate(zip(table.status, table.reason, strict=True)):
            yield _row([float(column[i]) for column in columns], status, reason)

    def _mass(self, values: Mapping[str, Floats]) -> Floats:
        """Mass of the members of each variant [kg]."""
        slow = {place: column for place, column in values.items() if place.startswith(_HEAVY)}
        structure = self._analysis.structure
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


class ProcessModel(Model):
    """Rows one by one in an executor.

    Parameters
    ----------
    analysis, fidelity
        Base, and its solver.
    axes, measured
        Variables and responses.
    executor
        Any; a point and the base are pickled.
    workers
        Points that are given to it at a time.
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
        self._job = (analysis, fidelity, tuple(axes), tuple(measured))
        self._executor, self._ahead = executor, 4 * workers

    def rows(self, points: Sequence[Point]) -> Iterator[list[tuple[int, Row]]]:
        """See `Model`."""
        working: dict[Future[Row], int] = {}
        waiting = iter(enumerate(points))
        try:
            while True:
                for i, point in waiting:
                    working[self._executor.submit(solve_point, *self._job, point)] = i
                    if len(working) >= self._ahead:
                        break
                if not working:
                    return
                done, _ = wait(working, return_when=FIRST_COMPLETED)
                yield [(working.pop(one), one.result()) for one in done]
        except BrokenExecutor:
            what, todo = "a worker process ended", "look for lack of memory; go on with --resume"
            raise InputError(Problem(what, "", "", todo)) from None
        finally:
            for one in working:
                one.cancel()


class FunctionModel(Model):
    """Rows by a function of the caller's, for models other than Crumple's.

    Parameters
    ----------
    function
        Takes columns of variables by name, (n,) each, and gives columns of responses, (n,) each; a value
        that is not finite is a failed row.
    axes, measured
        Variables and responses.
    """

    def __init__(
        self,
        function: Callable[[Mapping[str, Floats]], Mapping[str, Floats]],
        axes: Sequence[Axis],
        measured: Sequence[Measured],
    ) -> None:
        self._function, self._axes, self._measured = function, axes, measured

    def rows(self, points: Sequence[Point]) -> Iterator[list[tuple[int, Row]]]:
        """See `Model`."""
        columns = {axis.name: np.array([p[k] for p in points], float) for k, axis in enumerate(self._axes)}
        found = self._function(columns)
        given = [np.broadcast_to(np.asarray(found[one.name], float), len(points)) for one in self._measured]
        rows = zip(*(column.tolist() for column in given), strict=True)
        yield [(i, _row(list(row), Status.COMPLETE, "")) for i, row in enumerate(rows)]


def solve_point(
    analysis: Analysis, fidelity: str, axes: Sequence[Axis], measured: Sequence[Measured], point: Point
) -> Row:
    """One row by `crumple.solve`; a refusal is a row."""
    values = {place: value for axis, value in zip(axes, point, strict=True) for place in axis.places}
    try:
        structure = changed(analysis.structure, values)
        new = analysis.model_copy(update={"structure": structure})
        result = solve(new, fidelity)
    except InputError as error:
        return _row([np.nan] * len(measured), Status.REFUSED, str(error))
    mass = structure.mass_of_members
    found = [measure(result, one) if one.channel else mass for one in measured]
    return _row(found, result.status, result.reason)


def measure(result: Result, wanted: Measured) -> float:
    """A response of a result; NaN if it has no such channel."""
    quantity = wanted.quantity
    if wanted.take == "max" and quantity is not None:
        hinge, name = quantity.split(".")[1:]
        summary = result.hinges.get(hinge)
        return np.nan if summary is None else float(getattr(summary, name))
    channel = result.channels.get(wanted.channel)
    if channel is None or not channel.values.size:
        return np.nan
    if wanted.take == "final":
        return float(channel.values[-1])
    if wanted.take == "at":
        return float(np.interp(wanted.time, result.time, channel.values))
    return float(channel.values[np.argmax(np.abs(channel.values))])


def _row(values: list[float], status: Status, reason: str) -> Row:
    if status.ok and not np.all(np.isfinite(values)):
        return Row(tuple(values), "no value", "a response is not a finite number")
    return Row(tuple(values), status.value, reason)
