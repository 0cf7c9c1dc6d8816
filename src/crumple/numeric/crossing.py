"""When a history passes a limit."""

from __future__ import annotations

import numpy as np

from crumple.numeric.arrays import Floats


def first_above(time: Floats, values: Floats, limit: float) -> float | None:
    """Time at which values first exceed a limit, linear between two of them; None if they never do.

    Parameters
    ----------
    time
        Not decreasing [s], (n,).
    values
        (n,).
    limit
        In the unit of the values.
    """
    above = np.flatnonzero(values > limit)
    if not above.size:
        return None
    i = int(above[0])
    if i == 0:
        return float(time[0])
    share = float((limit - values[i - 1]) / (values[i] - values[i - 1]))
    return float(time[i - 1] + share * (time[i] - time[i - 1]))
