"""What a point gave, and what gives it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import repeat
from typing import Any, NamedTuple

import numpy as np

from crumple.errors import Status
from crumple.numeric.arrays import Floats
from crumple.study.space import Point

COMPLETE = Status.COMPLETE.value


class Row(NamedTuple):
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
        return self.status == COMPLETE


class Model(ABC):
    """Solves points in groups."""

    @abstractmethod
    def rows(self, points: Sequence[Point]) -> Iterator[list[tuple[int, Row]]]:
        """Groups of numbers of points and their rows, each as soon as it is known."""


_COMPLETE_ROW: Callable[[Iterable[Any]], Row] = partial(tuple.__new__, Row)
"""A row of a tuple of its fields."""


def rows_of(values: Floats, status: Sequence[Status], reason: Sequence[str]) -> list[Row]:
    """Rows of values, (n, responses), with the status and the reason of each."""
    known = map(tuple, values.tolist())
    if np.isfinite(values).all() and status.count(Status.COMPLETE) == len(status):
        # the rows of a quick study are made without Python in between
        return list(map(_COMPLETE_ROW, zip(known, repeat(COMPLETE), repeat(""))))
    finite: list[bool] = np.all(np.isfinite(values), axis=1).tolist()
    return [
        Row(own, COMPLETE, "") if good and state is Status.COMPLETE else row_of(list(own), state, why)
        for own, good, state, why in zip(known, finite, status, reason, strict=True)
    ]


def row_of(values: list[float], status: Status, reason: str) -> Row:
    """One row; without a number in every response it has no value."""
    if status.ok and not np.all(np.isfinite(values)):
        return Row(tuple(values), "no value", "a response is not a finite number")
    return Row(tuple(values), status.value, reason)
