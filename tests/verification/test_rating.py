"""Rating after ISO/TS 18571:2014 against the published package objective-rating-metrics 1.3.

Six pairs of curves of different lengths, shifts, sizes and oscillations are rated by both.  The figures that
the package gave are recorded here, since it brings a compiler of its own (numba) along; where it is
installed it is asked again.  All four parts agree to rounding.
"""

import importlib.util

import numpy as np
import pytest

from crumple.comparison import rating

# corridor, phase, magnitude, slope as the package gave them
RECORDED = (
    (1.0, 1.0, 1.0, 1.0),
    (0.8232920514130164, 0.9040307101727447, 0.9400278565706172, 0.758812891022095),
    (0.7136955055662297, 0.84399375975039, 0.9203050764536543, 0.5091995639683695),
    (0.47540092116058086, 0.7963206307490145, 0.7234877368014045, 0.053480326979975734),
    (0.4958448957935662, 0.7673098751418842, 0.7880726405500385, 0.0),
    (0.40380965584141393, 0.7452547452547452, 0.4610913487184334, 0.0),
)


def curves(k):
    """Time and two decaying swings: the second larger, shifted either way, with an oscillation on it."""
    t = np.arange(401 + 120 * k) / 1e4
    a = np.sin(60 * t) * np.exp(-20 * t)
    b = (1 + 0.1 * k) * np.sin(60 * (t - 0.001 * k * (-1) ** k)) * np.exp(-20 * t) + 0.02 * k * np.sin(
        900 * t
    )
    return t, a, b


@pytest.mark.parametrize("k", range(6))
def test_four_parts_against_the_recorded_figures(k, record_figure):
    t, a, b = curves(k)
    rated = rating(t, a, t, b)
    for part, expected in zip(("corridor", "phase", "magnitude", "slope"), RECORDED[k], strict=True):
        record_figure(f"pair {k + 1}, {part}", getattr(rated, part), expected, 1e-9)


@pytest.mark.skipif(
    importlib.util.find_spec("objective_rating_metrics") is None,
    reason="objective-rating-metrics not installed",
)
@pytest.mark.parametrize("k", range(6))
def test_four_parts_against_the_package(k):
    from objective_rating_metrics.rating import ISO18571

    t, a, b = curves(k)
    rated, package = rating(t, a, t, b), ISO18571(np.c_[t, a], np.c_[t, b])
    assert rated.corridor == pytest.approx(package.corridor_rating(-1), abs=1e-9)
    assert rated.phase == pytest.approx(package.phase_rating(-1), abs=1e-9)
    assert rated.magnitude == pytest.approx(package.magnitude_rating(-1), abs=1e-9)
    assert rated.slope == pytest.approx(package.slope_rating(-1), abs=1e-9)
    assert rated.overall == pytest.approx(package.overall_rating(-1), abs=1e-9)


def test_a_curve_agrees_with_itself():
    t, a, _ = curves(2)
    rated = rating(t, a, t, a)
    assert (rated.overall, rated.grade, rated.shift) == (1.0, "excellent", 0.0)


def test_sampling_does_not_matter():
    t, a, b = curves(3)
    assert rating(t, a, t[::2], b[::2]).overall == pytest.approx(rating(t, a, t, b).overall, abs=2e-3)


def test_a_late_curve_is_called_late():
    t, a, _ = curves(1)
    late = np.interp(t - 0.002, t, a)
    assert rating(t, a, t, late).shift == pytest.approx(0.002)
