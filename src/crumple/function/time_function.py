"""Functions of time: frozen data with a value, a derivative and a sampled form for the stepper.

Linear interpolation of a function with |f''| <= C over pieces of length h errs by at most C h^2/8.
For a passage of height H over the time T, C = c H/T^2 with c known for each kind, so n equal pieces
err by at most c H/(8 n^2): the number of pieces follows from the tolerance.

Jumps and kinks have a method of their own, since a time stepper ends its steps there
(docs/theory/time_functions.md).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.function.contact import bistop, impact
from crumple.function.key_points import key_points
from crumple.function.table import checked_table, slopes_of
from crumple.function.transition import PASSAGES
from crumple.numeric.arrays import Floats

MAX_SAMPLES = 1_000_000
"""Points of a sampled function; a tolerance that needs more is refused."""
MAX_BREAKS = 100
"""Breaks of one function.  Each costs a time stepper a step or two; a run takes some hundred steps anyhow."""
BREAK_SHARE = 0.01
"""Distance from the straight lines between breaks, relative to the range of the values, that is no break
any more where a function has more kinks than `MAX_BREAKS`."""
STRAIGHT = 1e-9
"""Change of a table's slope at a point, relative to its largest slope, that is rounding."""


class TimeFunction(ABC):
    """A function of time [s]; call it for its value in SI, shape of the times."""

    @abstractmethod
    def __call__(self, t: ArrayLike) -> Floats: ...

    @abstractmethod
    def derivative(self, t: ArrayLike) -> Floats:
        """Rate of change per second, shape of the times; at a kink the rate to its right."""

    @abstractmethod
    def sample_times(self, start: float, end: float, tolerance: float) -> Floats:
        """Times between which straight lines err by at most the tolerance, any order."""

    @abstractmethod
    def kinks(self, start: float, end: float) -> Floats:
        """Times within the range at which the function or one of its derivatives jumps, any order."""

    @abstractmethod
    def as_mapping(self) -> dict[str, Any]:
        """Plain data in SI; `parse_time_function(..., plain_numbers=True)` reads it back."""

    def sampled(self, start: float, end: float, tolerance: float) -> tuple[Floats, Floats]:
        """Piecewise linear form.

        Parameters
        ----------
        start, end
            Range [s], start < end.
        tolerance
            Largest error, in the function's own SI unit, > 0.

        Returns
        -------
        times, values
            Shape (n,) each; times increase strictly from `start` to `end`.

        Raises
        ------
        InputError
            If the range is empty, the tolerance is not positive, or more than `MAX_SAMPLES` points result.
        """
        if not (math.isfinite(start) and math.isfinite(end) and start < end and tolerance > 0.0):
            came = f"{start:g}, {end:g} and {tolerance:g}"
            raise InputError(f"a range start < end and a tolerance > 0 are needed, not {came}")
        inner = self.sample_times(start, end, tolerance)
        times = np.unique(np.concatenate([[start, end], inner[(inner > start) & (inner < end)]]))
        if times.size > MAX_SAMPLES:
            raise InputError(
                f"sampling within {tolerance:g} takes {times.size} points; at most {MAX_SAMPLES}"
            )
        return times, self(times)

    def breaks(self, start: float, end: float) -> Floats:
        """Jumps and isolated kinks: where a step of a time integration should end.

        Up to `MAX_BREAKS` kinks are all breaks.  Of more, for example the points of a measured table, breaks
        are those that a polygon needs to follow the function within `BREAK_SHARE` of its range, chosen one by
        one where the distance is largest, and `MAX_BREAKS` at most.

        Parameters
        ----------
        start, end
            Range [s], start < end.

        Returns
        -------
        times
            Shape (n,), n <= `MAX_BREAKS`; increasing, within the range and without its ends.
        """
        times = np.unique(self.kinks(start, end))
        times = times[(times > start) & (times < end)]
        if times.size <= MAX_BREAKS:
            return times
        corners = np.concatenate([[start], times, [end]])
        return corners[key_points(corners, self(corners), BREAK_SHARE, MAX_BREAKS)]

    def largest(self, start: float, end: float) -> float:
        """Largest absolute value within the range, to a few percent; exact where it lies at a kink."""
        times = np.concatenate([np.linspace(start, end, 257), self.kinks(start, end)])
        return float(np.abs(self(np.clip(times, start, end))).max())


@dataclass(frozen=True)
class Constant(TimeFunction):
    """The same value at all times."""

    value: float

    def __call__(self, t: ArrayLike) -> Floats:
        return np.full(np.shape(t), self.value)

    def derivative(self, t: ArrayLike) -> Floats:
        return np.zeros(np.shape(t))

    def sample_times(self, start: float, end: float, tolerance: float) -> Floats:
        return np.empty(0)

    def kinks(self, start: float, end: float) -> Floats:
        return np.empty(0)

    def as_mapping(self) -> dict[str, Any]:
        return {"constant": self.value}


@dataclass(frozen=True)
class Transition(TimeFunction):
    """STEP, STEP5 or HAVSIN of time: `h0` until `x0` [s], `h1` from `x1` [s]."""

    kind: str
    x0: float
    h0: float
    x1: float
    h1: float

    KINDS: ClassVar[tuple[str, ...]] = tuple(PASSAGES)

    def __post_init__(self) -> None:
        if self.kind not in PASSAGES:
            raise InputError(f"{self.kind!r} is not one of {', '.join(PASSAGES)}")
        if not self.x0 < self.x1:
            came, todo = f"x0 = {self.x0:g} s, x1 = {self.x1:g} s", "exchange them, or correct the times"
            raise InputError(Problem(f"{self.kind} ends before it begins", came, "x0 < x1", todo))

    def __call__(self, t: ArrayLike) -> Floats:
        return PASSAGES[self.kind][0](t, self.x0, self.h0, self.x1, self.h1)

    def derivative(self, t: ArrayLike) -> Floats:
        return PASSAGES[self.kind][1](t, self.x0, self.h0, self.x1, self.h1)

    def sample_times(self, start: float, end: float, tolerance: float) -> Floats:
        pieces = math.sqrt(PASSAGES[self.kind][2] * abs(self.h1 - self.h0) / (8.0 * tolerance))
        if not pieces < MAX_SAMPLES:
            raise InputError(f"sampling within {tolerance:g} takes more than {MAX_SAMPLES} points")
        return np.linspace(self.x0, self.x1, max(1, math.ceil(pieces)) + 1)

    def kinks(self, start: float, end: float) -> Floats:
        return np.array([self.x0, self.x1])

    def as_mapping(self) -> dict[str, Any]:
        return {self.kind: {"x0": self.x0, "h0": self.h0, "x1": self.x1, "h1": self.h1}}


@dataclass(frozen=True)
class Table(TimeFunction):
    """Points (time [s], value) joined by straight lines; the nearest end's value outside."""

    time: tuple[float, ...]
    value: tuple[float, ...]

    def __post_init__(self) -> None:
        _ = self._points

    @cached_property
    def _points(self) -> tuple[Floats, Floats, Floats]:
        """Times, values, and slopes of the pieces, 0 outside; converted once, for tables can be long."""
        times, values = checked_table(self.time, self.value)
        return times, values, slopes_of(times, values)

    def __call__(self, t: ArrayLike) -> Floats:
        times, values, _ = self._points
        return np.asarray(np.interp(np.asarray(t, np.float64), times, values))

    def derivative(self, t: ArrayLike) -> Floats:
        times, _, slopes = self._points
        return np.asarray(slopes[np.searchsorted(times, np.asarray(t, np.float64), side="right")])

    def sample_times(self, start: float, end: float, tolerance: float) -> Floats:
        return self._points[0]

    def kinks(self, start: float, end: float) -> Floats:
        times, _, slopes = self._points
        return np.asarray(times[np.abs(np.diff(slopes)) > STRAIGHT * np.abs(slopes).max()])

    def as_mapping(self) -> dict[str, Any]:
        return {"table": {"time": list(self.time), "value": list(self.value)}}


@dataclass(frozen=True)
class Sum(TimeFunction):
    """Several functions added."""

    terms: tuple[TimeFunction, ...]

    def __post_init__(self) -> None:
        if not self.terms:
            raise InputError(
                Problem("a sum needs at least one term", todo="add a function of time, or write 0")
            )

    def __call__(self, t: ArrayLike) -> Floats:
        return np.asarray(sum(term(t) for term in self.terms))

    def derivative(self, t: ArrayLike) -> Floats:
        return np.asarray(sum(term.derivative(t) for term in self.terms))

    def sample_times(self, start: float, end: float, tolerance: float) -> Floats:
        # the errors add up; a finer grid than a term needs never makes its error larger
        share = tolerance / len(self.terms)
        return np.concatenate([term.sample_times(start, end, share) for term in self.terms])

    def kinks(self, start: float, end: float) -> Floats:
        return np.concatenate([term.kinks(start, end) for term in self.terms])

    def as_mapping(self) -> dict[str, Any]:
        return {"sum": [term.as_mapping() for term in self.terms]}


@dataclass(frozen=True)
class Stop(TimeFunction):
    """IMPACT (x2 None) or BISTOP of a motion that is itself given as a function of time."""

    motion: TimeFunction
    x1: float
    x2: float | None
    k: float
    e: float
    cmax: float
    d: float

    def __post_init__(self) -> None:
        self._force(0.0, 0.0)

    def __call__(self, t: ArrayLike) -> Floats:
        return self._force(self.motion(t), self.motion.derivative(t))

    def derivative(self, t: ArrayLike) -> Floats:
        # forward difference over a tenth of a microsecond: the second derivative is not available
        times, small = np.asarray(t, np.float64), 1e-7
        return np.asarray((self(times + small) - self(times)) / small)

    def sample_times(self, start: float, end: float, tolerance: float) -> Floats:
        # halve until three inner points of every piece lie on its chord within half the tolerance
        motion_times = self.motion.sample_times(start, end, tolerance / max(self.k, 1.0))
        times = np.unique(np.concatenate([np.linspace(start, end, 65), motion_times]))
        times = times[(times >= start) & (times <= end)]
        while times.size <= MAX_SAMPLES:
            rough = np.zeros(times.size - 1, dtype=bool)
            for place in (0.25, 0.5, 0.75):
                inner = times[:-1] + place * np.diff(times)
                rough |= np.abs(self(inner) - np.interp(inner, times, self(times))) > 0.5 * tolerance
            rough &= np.diff(times) > 1e-12 * (end - start)
            if not rough.any():
                return times
            times = np.sort(np.concatenate([times, (times[:-1] + 0.5 * np.diff(times))[rough]]))
        raise InputError(f"sampling within {tolerance:g} takes more than {MAX_SAMPLES} points")

    def kinks(self, start: float, end: float) -> Floats:
        # where the stop is touched and let go, to a thousandth of the motion's range
        own = self.motion.kinks(start, end)
        grid = np.unique(np.clip(np.concatenate([np.linspace(start, end, 257), own]), start, end))
        reach = float(np.ptp(self.motion(grid)))
        times, x = self.motion.sampled(start, end, max(1e-3 * reach, 1e-12))
        found = [own]
        for place in (self.x1, self.x2):
            if place is None:
                continue
            ahead = x - place
            k = np.flatnonzero((ahead[:-1] < 0.0) != (ahead[1:] < 0.0))
            found.append(times[k] + (times[k + 1] - times[k]) * ahead[k] / (ahead[k] - ahead[k + 1]))
        return np.concatenate(found)

    def as_mapping(self) -> dict[str, Any]:
        numbers = {"x1": self.x1, "x2": self.x2, "k": self.k, "e": self.e, "cmax": self.cmax, "d": self.d}
        given = {name: number for name, number in numbers.items() if number is not None}
        return {"impact" if self.x2 is None else "bistop": {"x": self.motion.as_mapping(), **given}}

    def _force(self, x: ArrayLike, v: ArrayLike) -> Floats:
        if self.x2 is None:
            return impact(x, v, self.x1, self.k, self.e, self.cmax, self.d)
        return bistop(x, v, self.x1, self.x2, self.k, self.e, self.cmax, self.d)
