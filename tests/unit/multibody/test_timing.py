"""Wall times of repeated solves."""

import pytest

from crumple.multibody.timing import LONG, REPEATS, least_seconds


@pytest.mark.parametrize(
    ("times", "least", "left"),
    [
        ([0.3e-3, 0.1e-3, *[0.2e-3] * (REPEATS - 2), 0.05e-3], 0.1e-3, 1),
        ([0.7 * LONG, 0.6 * LONG, 0.1 * LONG], 0.6 * LONG, 1),
        ([2.0 * LONG, 0.1 * LONG], 2.0 * LONG, 1),
    ],
)
def test_least_of_several_but_not_for_long(times, least, left):
    waiting = list(times)
    assert least_seconds(lambda: waiting.pop(0)) == least
    assert len(waiting) == left
