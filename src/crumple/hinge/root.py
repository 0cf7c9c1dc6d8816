"""First sign change of a smooth function of the rotation, without the import of SciPy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from crumple.hinge.law import Floats

GRID = 65
"""Points of the first pass: a change that turns back within a sixty-fourth of the interval may be missed."""
PASSES = 60
"""A smooth function needs about four; halving the bracket alone would need this many."""
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
    is left is about as narrow as the guess was good.
    """
    grid = np.linspace(low, high, GRID)
    found = None
    for _ in range(PASSES):
        values = function(grid)
        positive = np.flatnonzero(values >= 0.0)
        # the same rotation may round to the other side of zero in another pass
        if positive.size == 0:
            return found
        first = int(positive[0])
        found = float(grid[first])
        if first == 0 or found - grid[first - 1] <= 2.0 * np.spacing(found):
            return found
        low, high = float(grid[first - 1]), found
        near = slice(max(first - 2, 0), first + 2)
        guess = min(max(_inverse(values[near].tolist(), grid[near].tolist()), low), high)
        around = (high - low) * AROUND
        grid = np.concatenate([guess - around, [low, (low + high) / 2.0, guess, high], guess + around])
        grid = np.sort(np.clip(grid, low, high))
    return found


def _inverse(values: list[float], places: list[float]) -> float:
    """Place of the value zero by Neville's interpolation over the values; the middle if two are equal."""
    found = list(places)
    for width in range(1, len(found)):
        for i in range(len(found) - width):
            apart = values[i + width] - values[i]
            if apart == 0.0:
                return (places[0] + places[-1]) / 2.0
            found[i] = (values[i + width] * found[i] - values[i] * found[i + 1]) / apart
    return found[0]
