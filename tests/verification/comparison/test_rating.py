"""Ratings after ISO/TS 18571:2014 equal those of the package objective-rating-metrics.

Ten pairs of curves of different lengths, shifts, amplitudes and oscillations are rated by both.  The
figures of the package are stored with its version in rating_reference.json, because it needs a compiler of
its own (numba); where it is installed it is called again.  All four scores agree to rounding.

Kind: other code.  Source: run here.
"""

import importlib.util
import json
from pathlib import Path

import numpy as np
import pytest
from tests.verification.comparison.rating_curves import PAIRS, arrested, swings

from crumple.comparison import rating

KEPT = json.loads((Path(__file__).parent / "rating_reference.json").read_text(encoding="utf-8"))
PARTS = ("corridor", "phase", "magnitude", "slope", "overall")


def test_every_pair_has_a_reference():
    assert set(KEPT["ratings"]) == set(PAIRS)
    assert KEPT["package"] == "objective-rating-metrics"


@pytest.mark.parametrize("name", PAIRS)
def test_parts_against_the_kept_figures_of_the_package(name, record_figure):
    t, a, b = PAIRS[name]()
    rated = rating(t, a, t, b)
    for part in PARTS:
        kept = KEPT["ratings"][name][part]
        record_figure(
            f"{name}, {part} ({KEPT['package']} {KEPT['version']})", getattr(rated, part), kept, 1e-9
        )


@pytest.mark.skipif(
    importlib.util.find_spec("objective_rating_metrics") is None,
    reason="objective-rating-metrics not installed",
)
@pytest.mark.parametrize("name", PAIRS)
def test_parts_against_the_package(name):
    from objective_rating_metrics.rating import ISO18571

    t, a, b = PAIRS[name]()
    rated, package = rating(t, a, t, b), ISO18571(np.c_[t, a], np.c_[t, b])
    for part in PARTS:
        assert getattr(rated, part) == pytest.approx(getattr(package, f"{part}_rating")(-1), abs=1e-9)


def test_a_long_history_is_sampled_more_coarsely_and_rated_alike():
    t, a = arrested(1.4, 1.1, 0.05, 2.0)
    b = arrested(1.6, 1.2, 0.04, 2.0)[1]
    rated = rating(t, a, t, b)
    assert rated.sampling_rate == 2500.0
    assert rated.end == pytest.approx(2.0, abs=1e-3)
    # the same shapes five times as fast are within the standard's sampling
    quick = rating(t / 5.0, a, t / 5.0, b)
    assert quick.sampling_rate == 10_000.0
    assert rated.overall == pytest.approx(quick.overall, abs=0.02)


def test_a_curve_agrees_with_itself():
    t, a, _ = swings(2)
    rated = rating(t, a, t, a)
    assert (rated.overall, rated.grade, rated.shift) == (1.0, "excellent", 0.0)


def test_sampling_does_not_matter():
    t, a, b = swings(3)
    assert rating(t, a, t[::2], b[::2]).overall == pytest.approx(rating(t, a, t, b).overall, abs=2e-3)


def test_a_late_curve_is_called_late():
    t, a, _ = swings(1)
    late = np.interp(t - 0.002, t, a)
    assert rating(t, a, t, late).shift == pytest.approx(0.002)
