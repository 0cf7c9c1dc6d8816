"""First sign change of a smooth function of the rotation, without the import of SciPy."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from crumple.numeric.arrays import Floats

GRID = np.linspace(0.0, 1.0, 65)
"""Points of the first pass: a change that turns back within a sixty-fourth of the interval may be missed."""
PASSES = 60
"""A smooth function needs two or three; halving the bracket alone would need this many."""
GOOD = 1e-3
"""A guess that left less than this of the bracket around it belongs to a function that is smooth there."""
AROUND = 4.0 ** -np.arange(27.0)
"""Places around the guess over the width of the bracket: 4**-26 is its rounding."""


def sign_change(function: Callable[[Floats], Floats], low: float, high: float) -> float | None:
    """First point of (low, high) where a function turns from negative to positive, or None if it does not.

    Parameters
    ----------
    function
        Vectorised, any unit.
    low, high
        Interval.

    Returns
    -------
    float or None
        Crossing, exact to rounding.

    Notes
    -----
    Each pass is one call, since a law costs more by the call than by the rotation: the middle of the bracket
    and many places around a guess by inverse interpolation, nearer and nearer to it, so that the bracket that
    is left is about as narrow as the guess was good.  It ends where the guess before was good and the last
    two orders of the next agree to rounding.
    """
    grid = low + (high - low) * GRID
    grid[-1] = high
    found = None
    for _ in range(PASSES):
        values = function(grid)
        first = int(np.argmax(values >= 0.0))
        # the same rotation may round to the other side of zero in another pass
        if not values[first] >= 0.0:
            return found
        found = float(grid[first])
        if first == 0 or found - grid[first - 1] <= 2.0 * math.ulp(found):
            return found
        good = found - grid[first - 1] < GOOD * (high - low)
        low, high = float(grid[first - 1]), found
        near = slice(max(first - 2, 0), first + 2)
        guess, doubt = _inverse(values[near].tolist(), grid[near].tolist())
        if good and doubt <= 2.0 * math.ulp(found) and low <= guess <= high:
            return guess
        guess = min(max(guess, low), high)
        around = (high - low) * AROUND
        grid = np.concatenate([guess - around, [low, (low + high) / 2.0, guess, high], guess + around])
        grid = np.minimum(np.maximum(grid, low), high)
        grid.sort()
    return found


def _inverse(values: list[float], places: list[float]) -> tuple[float, float]:
    """Place of the value zero by Neville's interpolation over the values, and what its last order changed.

    The middle and infinity if two values are equal.
    """
    found, before = list(places), list(places)
    for width in range(1, len(found)):
        before = list(found)
        for i in range(len(found) - width):
            apart = values[i + width] - values[i]
            if apart == 0.0:
                return (places[0] + places[-1]) / 2.0, math.inf
            found[i] = (values[i + width] * before[i] - values[i] * before[i + 1]) / apart
    return found[0], max(abs(found[0] - before[0]), abs(found[0] - before[1]))
