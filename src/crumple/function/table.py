"""A table of points with linear interpolation, constant outside its range."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats


def table(x: ArrayLike, xs: Sequence[float] | Floats, ys: Sequence[float] | Floats) -> Floats:
    """Value of the table at `x`.

    Parameters
    ----------
    x
        Independent variable, any shape.
    xs
        Places, strictly increasing, shape (n,), n >= 2.
    ys
        Values at the places, shape (n,).

    Returns
    -------
    NDArray
        Values in the unit of `ys`, shape of `x`; outside the range the nearest end's value.

    Raises
    ------
    InputError
        If the table has fewer than two points, unequal lengths, or places that do not increase.
    """
    places, values = checked_table(xs, ys)
    return np.asarray(np.interp(np.asarray(x, np.float64), places, values))


def table_slope(x: ArrayLike, xs: Sequence[float] | Floats, ys: Sequence[float] | Floats) -> Floats:
    """Slope of the table at `x`: at a point of the table that of the piece to its right, 0 outside."""
    places, values = checked_table(xs, ys)
    return np.asarray(
        slopes_of(places, values)[np.searchsorted(places, np.asarray(x, np.float64), side="right")]
    )


def slopes_of(places: Floats, values: Floats) -> Floats:
    """Slope before the first place, between the places and after the last one, (n + 1,)."""
    return np.concatenate([[0.0], np.diff(values) / np.diff(places), [0.0]])


def checked_table(xs: Sequence[float] | Floats, ys: Sequence[float] | Floats) -> tuple[Floats, Floats]:
    """Places and values as arrays; raises what `table` raises."""
    places, values = np.asarray(xs, np.float64), np.asarray(ys, np.float64)
    if places.ndim != 1 or places.shape != values.shape or places.size < 2:
        came = f"{_entries(places)} in the first, {_entries(values)} in the second"
        what, allowed = "a table needs two lists of one length", "at least 2 numbers in each"
        raise InputError(Problem(what, came, allowed, "give a value for each place"))
    if not (np.all(np.isfinite(places)) and np.all(np.isfinite(values))):
        raise InputError("a table needs finite numbers")
    if not np.all(np.diff(places) > 0.0):
        first = int(np.argmax(np.diff(places) <= 0.0))
        came = f"{places[first + 1]:g} (SI) after {places[first]:g}, at place {first + 2} of the list"
        todo = "sort the rows; for a jump put two places a little apart"
        what = "the places of a table must increase"
        raise InputError(Problem(what, came, "each place larger than the one before", todo))
    return places, values


def _entries(values: Floats) -> str:
    """Size of what should be a list of numbers, in words."""
    if values.ndim != 1:
        return "no list of numbers"
    return f"{values.size} number{'' if values.size == 1 else 's'}"
