"""When a history passes a limit: linear between two values, at once, or never."""

import numpy as np

from crumple.numeric.crossing import first_above

TIME = np.array([0.0, 1.0, 2.0, 3.0])


def test_the_time_is_linear_between_two_values():
    assert first_above(TIME, np.array([0.0, 1.0, 3.0, 0.0]), 1.5) == 1.25


def test_a_value_at_the_limit_has_not_passed_it():
    assert first_above(TIME, np.array([0.0, 1.0, 1.0, 1.0]), 1.0) is None


def test_what_starts_above_passed_at_the_start():
    assert first_above(TIME, np.array([2.0, 0.0, 2.0, 2.0]), 1.0) == 0.0
