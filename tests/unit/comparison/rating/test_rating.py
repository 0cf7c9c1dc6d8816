"""What a rating refuses."""

import numpy as np
import pytest

from crumple.comparison.rating.rating import rating
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
