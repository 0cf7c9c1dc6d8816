"""Objective rating of one curve against a reference after ISO/TS 18571:2014.

Corridor, phase, magnitude and slope scores between 0 and 1, weighted 0.4, 0.2, 0.2, 0.2.  Both curves are
sampled at 10 kHz over the interval of evaluation.

Corridor: points within 5 % of the reference's largest absolute value score 1, points beyond 50 % score 0, and
points between them the square of the remaining share.  Phase: the shift by at most 20 % of the samples with
the best cross-correlation; the score decreases linearly with the shift.  Magnitude and slope are rated after
that shift: magnitude by the relative L1 error after dynamic time warping within a tenth of the samples (0.5
scores 0), slope by the relative L1 error of derivatives averaged over nine points (2.0 scores 0).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats

EDITION = "ISO/TS 18571:2014"
SAMPLING_RATE = 10_000.0
"""Sampling rate of the standard [1/s]."""
INNER, OUTER = 0.05, 0.5
"""Half-widths of the corridors over the reference's largest absolute value."""
LARGEST_SHIFT = 0.2
"""Shift over the number of samples at which the phase score is 0."""
WARPING_WINDOW = 0.1
"""Width of the warping window over the number of samples."""
MAGNITUDE_LIMIT, SLOPE_LIMIT = 0.5, 2.0
"""Relative errors at which the scores are 0."""
WEIGHTS = (0.4, 0.2, 0.2, 0.2)
AVERAGED = 9
"""Number of samples over which a slope is averaged."""
MOST = 5_000
"""Most samples of one rating; longer histories are sampled more coarsely, as the cost is quadratic."""
FEWEST = 20
"""Fewest samples: below, shift, window and averages are not meaningful."""


@dataclass(frozen=True)
class Rating:
    """Scores from 0 (none) to 1 (full agreement).

    Attributes
    ----------
    corridor, phase, magnitude, slope
        Parts.
    shift
        Time [s] by which the curve is late.
    start, end
        Interval of evaluation [s].
    sampling_rate
        [1/s]: that of the standard, or less over a long interval.
    """

    corridor: float
    phase: float
    magnitude: float
    slope: float
    shift: float
    start: float
    end: float
    sampling_rate: float = SAMPLING_RATE

    @property
    def overall(self) -> float:
        """Weighted sum."""
        parts = (self.corridor, self.phase, self.magnitude, self.slope)
        return float(np.dot(WEIGHTS, parts))

    @property
    def grade(self) -> str:
        """Grade of the standard: excellent above 0.94, good above 0.80, fair above 0.58, else poor."""
        limits = ((0.94, "excellent"), (0.80, "good"), (0.58, "fair"))
        return next((word for limit, word in limits if self.overall > limit), "poor")


def rating(
    reference_time: ArrayLike,
    reference: ArrayLike,
    time: ArrayLike,
    values: ArrayLike,
    *,
    start: float | None = None,
    end: float | None = None,
) -> Rating:
    """Rate a curve against a reference.

    Parameters
    ----------
    reference_time, reference
        Times [s], increasing, and values, (n,).
    time, values
        The same of the curve that is rated, (m,), in the same unit.
    start, end
        Interval of evaluation [s]; by default the common interval.

    Returns
    -------
    Rating
        Both curves are interpolated linearly at 10 kHz, or at a lower rate over more than half a second.

    Raises
    ------
    InputError
        If values and times differ in number, the curves share too short an interval, or the reference is
        constant or not finite.

    References
    ----------
    ISO/TS 18571:2014, Road vehicles: objective rating metric for non-ambiguous signals.  Verified against the
    published package objective-rating-metrics in tests/verification/comparison/test_rating.py.
    """
    t_reference, t_curve = np.asarray(reference_time, float), np.asarray(time, float)
    whole, values = np.asarray(reference, float), np.asarray(values, float)
    if t_reference.shape != whole.shape or t_curve.shape != values.shape or not whole.size * values.size:
        came = f"{t_reference.size} times, {whole.size} values; {t_curve.size} times, {values.size} values"
        raise _refused("a curve needs as many values as times", came, "one value or more for each curve")
    begin = max(t_reference[0], t_curve[0]) if start is None else start
    finish = min(t_reference[-1], t_curve[-1]) if end is None else end
    rate = min(SAMPLING_RATE, MOST / max(finish - begin, 1e-9))
    number = int(np.floor((finish - begin) * rate + 1e-9)) + 1
    if number < FEWEST:
        raise _refused(
            "the common interval of the curves is too short",
            f"{begin:g} s to {finish:g} s",
            "at least 2 ms",
        )
    sampled = begin + np.arange(number) / rate
    a = np.interp(sampled, t_reference, whole)
    b = np.interp(sampled, t_curve, values)
    if not (np.isfinite(a).all() and np.isfinite(b).all()):
        raise _refused("a curve is not finite", "NaN or infinity", "numbers")
    if not np.ptp(a) > 0.0:
        raise _refused("the reference is constant", f"{a[0]:g}", "a reference that varies")
    late = best_shift(a, b)
    shifted_a, shifted_b = (a[: number - late], b[late:]) if late >= 0 else (a[-late:], b[: number + late])
    return Rating(
        corridor=corridor_score(a, b),
        phase=max(0.0, 1.0 - abs(late) / (LARGEST_SHIFT * number)),
        magnitude=magnitude_score(shifted_a, shifted_b),
        slope=slope_score(shifted_a, shifted_b),
        shift=late / rate,
        start=float(begin),
        end=float(sampled[-1]),
        sampling_rate=rate,
    )


def corridor_score(reference: Floats, curve: Floats) -> float:
    """Mean over the samples of the score of the distance from the reference."""
    norm = float(np.abs(reference).max())
    share = (OUTER * norm - np.abs(reference - curve)) / ((OUTER - INNER) * norm)
    return float(np.mean(np.clip(share, 0.0, 1.0) ** 2))


def best_shift(reference: Floats, curve: Floats) -> int:
    """Samples by which the curve is late, by cross-correlation; of equal ones the smallest shift."""
    best, found = _correlation(reference, curve), 0
    for shift in range(1, int(np.floor(LARGEST_SHIFT * reference.size)) + 1):
        for late, a, b in (
            (shift, reference[:-shift], curve[shift:]),
            (-shift, reference[shift:], curve[:-shift]),
        ):
            value = _correlation(a, b)
            if value > best:
                best, found = value, late
    return found


def _correlation(a: Floats, b: Floats) -> float:
    """Correlation coefficient; -1 if a curve is constant, so that such a shift is never chosen."""
    x, y = a - a.mean(), b - b.mean()
    size = float(np.sqrt((x @ x) * (y @ y)))
    return float(x @ y) / size if size > 0.0 else -1.0


def magnitude_score(reference: Floats, curve: Floats) -> float:
    """Score of the relative L1 error after dynamic time warping."""
    i, j = warping_path(curve, reference, int(np.ceil(WARPING_WINDOW * reference.size)) - 1)
    error = float(np.abs(curve[i] - reference[j]).sum() / np.abs(reference[j]).sum())
    return max(0.0, 1.0 - error / MAGNITUDE_LIMIT)


def warping_path(first: Floats, second: Floats, window: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs of indices along the monotone alignment of least cost of two curves of equal length.

    Parameters
    ----------
    first, second
        Values, (n,).
    window
        Largest distance of paired indices.

    Returns
    -------
    first_index, second_index
        From (0, 0) to (n-1, n-1), shape (length,) each.  The cost is the sum of squared differences; of
        predecessors with equal cost: one back in the first, then one back in the second, then both.
    """
    n = first.size
    mirrored = second[::-1]
    # costs of an anti-diagonal depend only on the two before it; entry i + 1 is index i of the first curve
    older, old, new = (np.full(n + 3, np.inf) for _ in range(3))
    # whether the way came back in the second, and back in both
    from_second, from_both = np.empty((2, 2 * n - 1, window + 1), dtype=np.bool_)
    lows = np.empty(2 * n - 1, dtype=np.int64)
    # the way starts with no cost
    older[0] = 0.0
    for d in range(2 * n - 1):
        low = max(0, d - n + 1, (d - window + 1) // 2)
        high = min(n - 1, d, (d + window) // 2)
        lows[d] = low
        width = high - low + 1
        in_first, in_second, in_both = old[low : high + 1], old[low + 1 : high + 2], older[low : high + 1]
        np.less(in_second, in_first, out=from_second[d, :width])
        cheapest = np.minimum(in_first, in_second)
        np.less(in_both, cheapest, out=from_both[d, :width])
        np.minimum(cheapest, in_both, out=cheapest)
        difference = first[low : high + 1] - mirrored[n - 1 - d + low : n - d + high]
        np.add(difference * difference, cheapest, out=new[low + 1 : high + 2])
        new[low] = new[high + 2] = np.inf
        older, old, new = old, new, older
    row, column = n - 1, n - 1
    path = [(row, column)]
    while row or column:
        d = row + column
        place = d, row - lows[d]
        both = from_both[place]
        row, column = row - (both or not from_second[place]), column - (both or from_second[place])
        path.append((row, column))
    pairs = np.array(path[::-1], dtype=np.int64)
    return pairs[:, 0], pairs[:, 1]


def slope_score(reference: Floats, curve: Floats) -> float:
    """Score of the relative L1 error of the averaged derivatives."""
    a, b = averaged_slope(reference), averaged_slope(curve)
    error = float(np.abs(b - a).sum() / np.abs(a).sum())
    return max(0.0, 1.0 - error / SLOPE_LIMIT)


def averaged_slope(values: Floats) -> Floats:
    """Differences per sample averaged over nine samples; near the ends over as many as fit symmetrically."""
    slope = np.gradient(values)
    half = AVERAGED // 2
    averaged = np.empty_like(slope)
    averaged[half:-half] = np.convolve(slope, np.full(AVERAGED, 1.0 / AVERAGED), mode="valid")
    for k in range(half):
        averaged[k] = slope[: 2 * k + 1].mean()
        averaged[-k - 1] = slope[-2 * k - 1 :].mean()
    return averaged


def _refused(what: str, came: str, allowed: str) -> InputError:
    return InputError(Problem(what, came, allowed, "choose other curves or another interval"))
