"""What a rating refuses."""

import numpy as np
import pytest

from crumple.comparison.rating.rating import rating, warping_path
from crumple.errors import InputError

TIME = np.linspace(0.0, 0.1, 50)


@pytest.mark.parametrize(
    ("times", "values"),
    [(TIME, TIME[1:]), (TIME[1:], TIME), (np.empty(0), np.empty(0)), (TIME, np.empty(0))],
)
def test_curves_have_as_many_values_as_times(times, values):
    with pytest.raises(InputError, match="as many values as times"):
        rating(TIME, TIME, times, values)
    with pytest.raises(InputError, match="as many values as times"):
        rating(times, values, TIME, TIME)


@pytest.mark.parametrize("window", [1, 4, 29])
@pytest.mark.parametrize("of_seed", range(4))
def test_the_alignment_is_that_of_a_table_of_all_costs(of_seed, window):
    """Small whole numbers, so that many predecessors have equal costs."""
    first, second = np.random.default_rng(of_seed).integers(0, 4, (2, 30)).astype(float)
    cost = np.full((31, 31), np.inf)
    cost[0, 0] = 0.0
    steps = ((1, 0), (0, 1), (1, 1))

    def before(i, j):
        return [cost[i + 1 - back_i, j + 1 - back_j] for back_i, back_j in steps]

    for i, j in np.ndindex(30, 30):
        if abs(i - j) <= window:
            cost[i + 1, j + 1] = (first[i] - second[j]) ** 2 + min(before(i, j))
    path = [(29, 29)]
    while path[-1] != (0, 0):
        i, j = path[-1]
        back_i, back_j = steps[int(np.argmin(before(i, j)))]
        path.append((i - back_i, j - back_j))
    found = warping_path(first, second, window)
    assert list(zip(*(one.tolist() for one in found), strict=True)) == path[::-1]
