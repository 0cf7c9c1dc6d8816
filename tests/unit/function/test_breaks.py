"""Where functions of time jump or bend, and which points of a long table matter."""

import numpy as np
import pytest

from crumple.function import MAX_BREAKS, Constant, Stop, Sum, Table, Transition
from crumple.function.key_points import key_points
from crumple.multibody.bodies.sampled_functions import sampled, sampled_motion

PULSE = Table((0.0, 0.1, 0.1001, 0.1004, 0.1005, 1.0), (0.0, 0.0, 1.0, 1.0, 0.0, 0.0))


def test_breaks_are_the_kinks_within_the_range():
    assert Constant(3.0).breaks(0.0, 1.0).size == 0
    np.testing.assert_array_equal(Transition("step", 0.2, 0.0, 0.3, 1.0).breaks(0.0, 1.0), [0.2, 0.3])
    np.testing.assert_array_equal(Transition("step", 0.2, 0.0, 2.0, 1.0).breaks(0.0, 1.0), [0.2])
    np.testing.assert_array_equal(PULSE.breaks(0.0, 1.0), [0.1, 0.1001, 0.1004, 0.1005])
    # a point on a straight line is no kink
    assert Table((0.0, 0.5, 1.0), (0.0, 1.0, 2.0)).breaks(0.0, 1.0).size == 0
    np.testing.assert_array_equal(
        Sum((Constant(1.0), PULSE, Transition("havsin", 0.2, 0.0, 0.3, 1.0))).breaks(0.0, 1.0),
        [0.1, 0.1001, 0.1004, 0.1005, 0.2, 0.3],
    )


def test_a_stop_breaks_where_it_is_touched_and_let_go():
    motion = Table((0.0, 0.4, 1.0), (0.1, -0.1, 0.2))
    np.testing.assert_allclose(Stop(motion, 0.0, None, 1e5, 1.5, 0.0, 1e-3).breaks(0.0, 1.0), [0.2, 0.4, 0.6])


@pytest.mark.parametrize("noise", [0.0, 0.3])
def test_a_long_table_has_few_breaks_and_those_that_matter(noise):
    """A measured half sine of 10 000 points with a spike of one point."""
    times = np.linspace(0.0, 1.0, 10_001)
    values = np.sin(np.pi * times) + noise * np.random.default_rng(1).standard_normal(times.size)
    values[2500] += 5.0
    breaks = Table(tuple(times), tuple(values)).breaks(0.0, 1.0)
    assert 5 < breaks.size <= MAX_BREAKS
    assert times[2500] in breaks
    assert (noise > 0.0) == (breaks.size == MAX_BREAKS)
    # neighbours of the spike come with it where noise does not hide them
    if noise == 0.0:
        assert {times[2499], times[2501]} <= set(breaks)
        assert (
            np.abs(
                np.interp(times, [0.0, *breaks, 1.0], values[np.searchsorted(times, [0.0, *breaks, 1.0])])
                - values
            ).max()
            <= 0.07
        )


def test_key_points_come_farthest_first():
    x, y = np.arange(7.0), np.array([0.0, 0.0, 3.0, 0.0, -1.0, 0.0, 0.0])
    np.testing.assert_array_equal(key_points(x, y, 0.01, 1), [2])
    # the chord from (2, 3) to the end passes (4, 1.8)
    np.testing.assert_array_equal(key_points(x, y, 0.01, 2), [2, 4])
    np.testing.assert_array_equal(key_points(x, y, 0.01, 9), [1, 2, 3, 4, 5])


def test_a_passage_shorter_than_the_grid_is_sampled():
    """Up and down within a microsecond of a second; a grid of 257 points sees nothing of it."""
    pulse = Sum(
        (
            Transition("havsin", 0.3, 0.0, 0.3 + 5e-7, 1e5),
            Transition("havsin", 0.3 + 5e-7, 0.0, 0.300001, -1e5),
        )
    )
    assert pulse.largest(0.0, 1.0) == 1e5
    times, values = sampled(pulse, 1.0)
    assert times.size < 20_000
    area = float(np.sum(np.diff(times) * (values[1:] + values[:-1]) / 2.0))
    assert area == pytest.approx(1e5 * 5e-7, rel=1e-5)


@pytest.mark.parametrize("points", [6, 60, 10_000])
def test_rates_of_a_table_add_up_to_it(points):
    """Sparse ones jump at every kink, dense ones at none."""
    times = np.linspace(0.0, 1.0, points)
    motion = Table(tuple(times), tuple(0.01 * np.sin(2.0 * times)))
    at, _, rates = sampled_motion(motion, 1.0)
    way = np.concatenate([[0.0], np.cumsum(np.diff(at) * (rates[1:] + rates[:-1]) / 2.0)])
    assert np.abs(way - motion(at)).max() < 1e-6 * 0.01
    assert rates[-1] == pytest.approx((motion(1.0) - motion(1.0 - 1e-6)) / 1e-6, rel=1e-4)
