"""Root of a monotone function of one variable between two values: false position that cannot stall."""

from __future__ import annotations

from collections.abc import Callable

# Enough for bisection alone to reach rounding.
_MOST_STEPS = 120


def rising_root(f: Callable[[float], float], low: float, high: float, small: float) -> float:
    """Where a rising function passes zero; a jump across zero counts, and ends are returned as they are.

    Parameters
    ----------
    f
        Rising on the interval.
    low, high
        Interval.
    small
        A value of f that counts as zero.
    """
    f_low, f_high = f(low), f(high)
    if f_low >= 0.0:
        return low
    if f_high <= 0.0:
        return high
    smallest = 4e-16 * (abs(low) + abs(high))
    kept = 0
    for step in range(_MOST_STEPS):
        # every third step halves, so that a kink or a jump does not slow the search
        middle = low - f_low * (high - low) / (f_high - f_low) if step % 3 < 2 else (low + high) / 2.0
        value = f(middle)
        if abs(value) <= small or high - low <= smallest:
            return middle
        # Illinois: an end that stays twice counts half
        if value < 0.0:
            low, f_low = middle, value
            f_high *= 0.5 if kept < 0 else 1.0
            kept = -1
        else:
            high, f_high = middle, value
            f_low *= 0.5 if kept > 0 else 1.0
            kept = 1
    return (low + high) / 2.0
