"""First sign change: exact to rounding, the first of several, none, and at the ends."""

import math

import numpy as np
import pytest

from crumple.numeric.sign_change import sign_change


def counted(function):
    def call(x):
        call.number += 1
        return function(x)

    call.number = 0
    return call


@pytest.mark.parametrize(
    ("function", "low", "high", "exact"),
    [
        (lambda x: x**2 - 2.0, 0.0, 3.0, math.sqrt(2.0)),
        (lambda x: -np.cos(x), 0.0, 3.0, math.pi / 2.0),
        (lambda x: 1.0 - 0.02 / np.sqrt(x), 1e-6, 1.0, 4e-4),
    ],
)
def test_crossing_of_a_smooth_function_in_a_few_calls(function, low, high, exact):
    call = counted(function)
    assert sign_change(call, low, high) == pytest.approx(exact, rel=4e-16)
    assert call.number <= 12


@pytest.mark.parametrize("power", [1.0 / 9.0, 9.0])
def test_steep_and_flat_crossings_end_too(power):
    def function(x):
        return np.sign(x - 1.234) * np.abs(x - 1.234) ** power

    assert sign_change(function, 0.0, 3.0) == pytest.approx(1.234, rel=4e-16)


def test_jump_is_found_by_halving():
    assert sign_change(lambda x: np.where(x < 1.0 / 3.0, -1.0, 1.0), 0.0, 3.0) == pytest.approx(
        1.0 / 3.0, rel=4e-16
    )


def test_first_of_several_crossings():
    assert sign_change(lambda x: np.sin(6.0 * x) - 0.5, 0.0, 3.0) == pytest.approx(math.pi / 36.0, rel=1e-15)


def test_no_crossing_and_crossings_at_the_ends():
    assert sign_change(lambda x: x - 5.0, 0.0, 3.0) is None
    assert sign_change(lambda x: x - 3.0, 0.0, 3.0) == 3.0
    assert sign_change(lambda x: x + 5.0, 0.0, 3.0) == 0.0
