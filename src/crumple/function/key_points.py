"""The points of a polygon that matter most (Ramer, Douglas and Peucker, taken greedily)."""

from __future__ import annotations

import heapq

import numpy as np

from crumple.numeric.arrays import Floats, Integers


def key_points(x: Floats, y: Floats, share: float, most: int) -> Integers:
    """Inner points of a polygon without which straight lines would leave it.

    Between two points that are kept the one farthest from their chord, measured along y, is kept next; the
    farthest of all comes first.

    Parameters
    ----------
    x, y
        Points, x increasing, (n,).
    share
        Distance from the chord, relative to the range of y, below which no point is kept.
    most
        Largest number of points.

    Returns
    -------
    ndarray
        Increasing indices of the points, without the ends, (m,), m <= `most`.
    """
    least = share * float(np.ptp(y))

    def farthest(first: int, last: int) -> tuple[float, int, int, int]:
        if last - first < 2:
            return 0.0, first, first, last
        chord = np.interp(x[first + 1 : last], x[[first, last]], y[[first, last]])
        off = np.abs(y[first + 1 : last] - chord)
        k = int(off.argmax())
        return -float(off[k]), first + 1 + k, first, last

    kept: list[int] = []
    pieces = [farthest(0, x.size - 1)]
    while len(kept) < most and -pieces[0][0] > least:
        _, k, first, last = heapq.heappop(pieces)
        kept.append(k)
        heapq.heappush(pieces, farthest(first, k))
        heapq.heappush(pieces, farthest(k, last))
    return np.array(sorted(kept), dtype=np.int64)
