"""Intervals of a probability from counts."""

from __future__ import annotations

from scipy import special

CONFIDENCE = 0.95
"""Of intervals."""


def clopper_pearson(successes: int, trials: int) -> tuple[float, float]:
    """Interval that contains the probability of success in at least 95 % of repetitions.

    Parameters
    ----------
    successes, trials
        Counts of independent trials; at least one trial.

    References
    ----------
    C. J. Clopper, E. S. Pearson, Biometrika 26 (1934) 404-413.
    """
    tail, failures = 0.5 * (1.0 - CONFIDENCE), trials - successes
    low = special.betaincinv(successes, failures + 1, tail) if successes else 0.0
    high = special.betaincinv(successes + 1, failures, 1.0 - tail) if failures else 1.0
    return float(low), float(high)
