"""Intervals of Clopper and Pearson: binomial tails at their ends, closed forms, coverage."""

import numpy as np
import pytest
from scipy.stats import binom

from crumple.numeric.binomial import clopper_pearson


@pytest.mark.parametrize(("successes", "trials"), [(1, 10), (5, 50), (251, 300), (299, 300)])
def test_the_ends_leave_two_and_a_half_per_cent_on_either_side(successes, trials):
    low, high = clopper_pearson(successes, trials)
    assert binom.sf(successes - 1, trials, low) == pytest.approx(0.025, rel=1e-9)
    assert binom.cdf(successes, trials, high) == pytest.approx(0.025, rel=1e-9)


def test_without_successes_or_failures_there_is_a_closed_form():
    assert clopper_pearson(0, 20) == pytest.approx((0.0, 1.0 - 0.025 ** (1.0 / 20.0)), rel=1e-12)
    assert clopper_pearson(20, 20) == pytest.approx((0.025 ** (1.0 / 20.0), 1.0), rel=1e-12)


@pytest.mark.parametrize("probability", [0.02, 0.3, 0.95])
def test_at_least_95_per_cent_of_all_intervals_hold_the_probability(probability):
    """Exactly, by the probability of every count."""
    trials = 60
    intervals = [clopper_pearson(count, trials) for count in range(trials + 1)]
    holding = [low <= probability <= high for low, high in intervals]
    assert binom.pmf(np.arange(trials + 1), trials, probability)[holding].sum() >= 0.95
