"""IMPACT and BISTOP: documented formula, no pull, no jump at touch, mirror symmetry, passivity."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.errors import InputError
from crumple.function import bistop, impact, step

K, E, CMAX, D = 1e6, 1.5, 2e3, 1e-3
position = st.floats(-0.01, 0.02)
rate = st.floats(-10.0, 10.0)


def test_free_beyond_touch() -> None:
    assert impact(0.01, -5.0, 0.01, K, E, CMAX, D) == 0.0
    assert impact(0.02, -5.0, 0.01, K, E, CMAX, D) == 0.0


@given(x=position, v=rate)
def test_documented_formula(x: float, v: float) -> None:
    expected = 0.0
    if x < 0.01:
        expected = max(0.0, K * (0.01 - x) ** E - CMAX * v * float(step(x, 0.01 - D, 1.0, 0.01, 0.0)))
    assert impact(x, v, 0.01, K, E, CMAX, D) == pytest.approx(expected, rel=1e-12)


def test_no_jump_at_touch() -> None:
    assert impact(0.01 - 1e-9, -10.0, 0.01, K, E, CMAX, D) < 1e-3


def test_damper_at_once_without_a_ramp() -> None:
    assert impact(0.01 - 1e-9, -10.0, 0.01, K, 1.0, CMAX, 0.0) == pytest.approx(2e4, rel=1e-6)


@given(x=position, v=rate)
def test_never_pulls_and_dissipates(x: float, v: float) -> None:
    force = float(impact(x, v, 0.01, K, E, CMAX, D))
    elastic = float(impact(x, 0.0, 0.01, K, E, CMAX, D))
    assert force >= 0.0
    assert (force - elastic) * v <= 1e-9


@given(x=position, v=rate)
def test_bistop_is_two_mirrored_impacts(x: float, v: float) -> None:
    lower, upper = 0.0, 0.012
    force = float(bistop(x, v, lower, upper, K, E, CMAX, D))
    mirrored = float(bistop(lower + upper - x, -v, lower, upper, K, E, CMAX, D))
    assert force == pytest.approx(-mirrored, rel=1e-6, abs=1e-3)
    if x <= lower:
        assert force == impact(x, v, lower, K, E, CMAX, D)
    if lower <= x <= upper:
        assert force == 0.0
    if x > upper:
        assert force <= 0.0


def test_broadcasts() -> None:
    assert impact(np.zeros((3, 1)), np.zeros(4), 0.01, K, E, CMAX, D).shape == (3, 4)
    assert bistop(np.zeros((3, 1)), np.zeros(4), 0.0, 1.0, K, E, CMAX, D).shape == (3, 4)


@pytest.mark.parametrize(
    "numbers", [(-1.0, E, CMAX, D), (K, 0.5, CMAX, D), (K, E, -1.0, D), (K, E, CMAX, -1.0)]
)
def test_refuses_numbers_that_make_no_stop(numbers) -> None:
    with pytest.raises(InputError, match="k, cmax and d >= 0"):
        impact(0.0, 0.0, 0.01, *numbers)
    with pytest.raises(InputError, match="k, cmax and d >= 0"):
        bistop(0.0, 0.0, 0.0, 1.0, *numbers)


def test_bistop_refuses_crossed_ends() -> None:
    with pytest.raises(InputError, match="x1 < x2"):
        bistop(0.0, 0.0, 1.0, 1.0, K, E, CMAX, D)


@pytest.mark.parametrize("wrong", [{"k": math.inf}, {"e": math.inf}, {"cmax": math.nan}, {"d": math.inf}])
def test_stiffness_and_damping_must_be_finite(wrong: dict[str, float]) -> None:
    with pytest.raises(InputError, match="need finite k"):
        impact(0.0, 0.0, 0.0, **{"k": K, "e": E, "cmax": CMAX, "d": D} | wrong)
