"""First sign change of a smooth function of the rotation, without the import of SciPy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from crumple.hinge.law import Floats

GRID = 65
"""Points per pass; each pass narrows the bracket 64 times."""
PASSES = 9
"""64**9 = 2**54: the bracket ends at the rounding of its end points."""


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
    """
    if function(np.array([low]))[0] >= 0.0:
        return low
    for _ in range(PASSES):
        grid = np.linspace(low, high, GRID)
        positive = np.flatnonzero(function(grid) >= 0.0)
        if positive.size == 0:
            return None
        # vectorised functions may round the same point differently from pass to pass: never step below low
        first = max(int(positive[0]), 1)
        low, high = float(grid[first - 1]), float(grid[first])
    return high
