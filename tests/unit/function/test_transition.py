"""STEP, STEP5, HAVSIN: end values, smoothness, monotonic passage, slopes, ADAMS's formulas."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.errors import InputError
from crumple.function import havsin, havsin_slope, step, step5, step5_slope, step_slope
from crumple.function.transition import PASSAGES

KINDS = [(step, step_slope), (step5, step5_slope), (havsin, havsin_slope)]
level = st.floats(-1e6, 1e6)


@pytest.mark.parametrize("kind", KINDS)
def test_levels_hold_outside(kind) -> None:
    f, slope = kind
    x = np.array([-10.0, 2.0, 5.0, 100.0])
    assert np.array_equal(f(x, 2.0, 3.0, 5.0, -7.0), [3.0, 3.0, -7.0, -7.0])
    assert np.array_equal(slope(x, 2.0, 3.0, 5.0, -7.0), np.zeros(4))


@pytest.mark.parametrize("kind", KINDS)
def test_middle_is_the_mean(kind) -> None:
    assert kind[0](3.5, 2.0, 3.0, 5.0, -7.0) == pytest.approx(-2.0, rel=1e-14)


def test_documented_formulas() -> None:
    x, x0, h0, x1, h1 = 2.7, 2.0, 3.0, 5.0, -7.0
    d = (x - x0) / (x1 - x0)
    assert step(x, x0, h0, x1, h1) == pytest.approx(h0 + (h1 - h0) * d**2 * (3 - 2 * d), rel=1e-14)
    assert step5(x, x0, h0, x1, h1) == pytest.approx(
        h0 + (h1 - h0) * d**3 * (10 - 15 * d + 6 * d**2), rel=1e-14
    )
    expected = (h0 + h1) / 2 + (h1 - h0) / 2 * math.sin((x - x0) / (x1 - x0) * math.pi - math.pi / 2)
    assert havsin(x, x0, h0, x1, h1) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("kind", KINDS)
@given(h0=level, h1=level, place=st.floats(-0.2, 1.2))
def test_slope_is_the_finite_difference(kind, h0: float, h1: float, place: float) -> None:
    f, slope = kind
    x0, x1, small = 1.0, 3.0, 1e-5
    x = x0 + place * (x1 - x0)
    difference = (f(x + small, x0, h0, x1, h1) - f(x - small, x0, h0, x1, h1)) / (2 * small)
    assert slope(x, x0, h0, x1, h1) == pytest.approx(
        difference, abs=2e-5 * max(1.0, abs(h1 - h0)) + 1e-9 * (abs(h0) + abs(h1)) / small * 1e-3
    )


@pytest.mark.parametrize("kind", KINDS)
@given(h0=level, h1=level)
def test_monotonic_and_between_the_levels(kind, h0: float, h1: float) -> None:
    values = kind[0](np.linspace(-0.5, 1.5, 401), 0.0, h0, 1.0, h1)
    rounding = 4e-16 * max(abs(h0), abs(h1)) + 1e-300
    assert np.all(np.diff(values) * np.sign(h1 - h0) >= -rounding)
    assert values.min() >= min(h0, h1) - rounding
    assert values.max() <= max(h0, h1) + rounding


@pytest.mark.parametrize("name", list(PASSAGES))
def test_continuity_at_both_ends(name: str) -> None:
    """Value, slope, and for STEP5 the second derivative, approach zero change at the rate of their order."""
    f, slope, _ = PASSAGES[name]
    order = {"step": 2, "step5": 3, "havsin": 2}[name]
    for small in (1e-2, 1e-3):
        near = f(small, 0.0, 0.0, 1.0, 1.0)
        assert near == pytest.approx(1.0 - f(1.0 - small, 0.0, 0.0, 1.0, 1.0), rel=1e-6)
        assert near <= 11.0 * small**order
        assert slope(small, 0.0, 0.0, 1.0, 1.0) <= 31.0 * small ** (order - 1)


@pytest.mark.parametrize("name", list(PASSAGES))
def test_stated_bound_of_the_second_derivative(name: str) -> None:
    _, slope, bound = PASSAGES[name]
    x = np.linspace(0.0, 1.0, 100_001)
    largest = np.abs(np.gradient(slope(x, 0.0, 0.0, 1.0, 1.0), x)).max()
    assert largest == pytest.approx(bound, rel=1e-4)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("ends", [(1.0, 1.0), (2.0, 1.0), (math.nan, 1.0)])
def test_refuses_an_empty_passage(kind, ends) -> None:
    for f in kind:
        with pytest.raises(InputError, match="x0 < x1"):
            f(0.0, ends[0], 0.0, ends[1], 1.0)


@pytest.mark.parametrize("kind", KINDS)
def test_keeps_shapes(kind) -> None:
    for f in kind:
        assert f(np.zeros((3, 2)), 0.0, 0.0, 1.0, 1.0).shape == (3, 2)
        assert np.shape(f(0.5, 0.0, 0.0, 1.0, 1.0)) == ()
