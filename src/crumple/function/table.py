"""A table of points with linear interpolation, constant outside its range."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError
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
        raise InputError(
            f"a table needs two lists of one length, at least 2, not shapes {places.shape} and {values.shape}"
        )
    if not (np.all(np.isfinite(places)) and np.all(np.isfinite(values))):
        raise InputError("a table needs finite numbers")
    if not np.all(np.diff(places) > 0.0):
        first = int(np.argmax(np.diff(places) <= 0.0))
        raise InputError(
            f"the places of a table must increase: {places[first + 1]:g} follows {places[first]:g}"
        )
    return places, values
