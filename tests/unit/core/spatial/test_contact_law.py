"""The law of a contact: a convex potential, no pull, friction within its limit, rates that a step allows."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple._core import _kernels

RATE = st.floats(-2.0, 2.0)
INVERSE_MASS = 0.5


def answer(rates, friction=0.4, normal=3.0, cap=np.inf):
    """Impulse (3,), tangent (3, 3) and potential at rates (normal, two tangents)."""
    impulse, tangent, potential = _kernels.spatial.contact_response(
        friction, INVERSE_MASS, normal, list(map(float, rates)), cap
    )
    return np.array(impulse), np.array(tangent).reshape(3, 3), potential


@given(normal=RATE, first=RATE, second=RATE)
def test_never_pulls_and_rubs_within_its_limit(normal, first, second):
    impulse, tangent, _ = answer((normal, first, second))
    assert impulse[0] <= 0
    assert (impulse[0] == 0) == (normal >= 0)
    assert np.hypot(*impulse[1:]) <= 1.2 * (1 + 1e-12)
    # against the slip, and positive semidefinite
    assert impulse[1] * first + impulse[2] * second >= 0
    assert np.linalg.eigvalsh(tangent).min() >= -1e-12 * np.abs(tangent).max()


@given(normal=st.floats(0.1, 2.0), first=st.floats(0.1, 2.0), second=RATE, pressed=st.booleans())
def test_impulse_and_tangent_are_derivatives_of_the_potential(normal, first, second, pressed):
    rates = np.array([-normal if pressed else normal, first, second])
    impulse, tangent, _ = answer(rates)
    for k in range(3):
        step = np.zeros(3)
        step[k] = 1e-5
        above, below = answer(rates + step), answer(rates - step)
        scale = max(1.0, np.abs(impulse).max())
        assert (above[2] - below[2]) / 2e-5 == pytest.approx(impulse[k], abs=1e-4 * scale)
        np.testing.assert_allclose(
            (above[0] - below[0]) / 2e-5, tangent[k], atol=1e-4 * np.abs(tangent).max()
        )


@given(normal=st.floats(0.1, 2.0), first=RATE, cap=st.floats(1e-3, 10.0))
def test_a_wall_that_crushes_bounds_the_impulse(normal, first, cap):
    """Approach beyond the compliance of the contact gives the largest impulse; the potential follows it."""
    rates = np.array([-normal, first, 0.5])
    impulse, tangent, _ = answer(rates, cap=cap)
    assert impulse[0] == -cap
    assert tangent[0, 0] == 0.0
    step = np.array([1e-5, 0.0, 0.0])
    slope = (answer(rates + step, cap=cap)[2] - answer(rates - step, cap=cap)[2]) / 2e-5
    assert slope == pytest.approx(-cap, rel=1e-6)
    # at the approach where it begins to crush both branches agree
    limit = np.array([-1e-8 * INVERSE_MASS * cap, first, 0.5])
    assert answer(limit, cap=cap)[2] == pytest.approx(answer(limit)[2], rel=1e-12)


def test_sticks_below_the_limit():
    """At rates below the creep rate friction carries what equilibrium asks."""
    impulse, tangent, _ = answer((0.0, 0.5e-6, 0.0))
    assert impulse[1] == pytest.approx(0.6)
    assert tangent[1, 1] == pytest.approx(1.2e6)


@pytest.mark.parametrize(
    ("gap", "rate", "expected"),
    [
        # closed: bounces, is too slow to bounce, parts
        (0.0, -2.0, 1.2),
        (0.0, -1e-4, 0.0),
        (0.0, 2.0, 0.0),
        # open by 1 cm over 10 ms: closes at -2 m/s; at -1.5 m/s may keep 0.5 m/s; at 1 m/s free
        (0.01, -2.0, 0.0),
        (0.01, -1.5, -0.5),
        (0.01, 1.0, -3.0),
    ],
)
def test_rate_that_a_step_allows(gap, rate, expected):
    allowed = _kernels.spatial.allowed_rate(0.6, gap, rate, 0.01, 1e-6, 1e-3)
    assert allowed == pytest.approx(expected, abs=1e-12)


@given(gap=st.floats(1e-5, 1.0), rate=st.floats(-5.0, 5.0), h=st.floats(1e-6, 1e-2))
def test_open_contact_does_not_overlap_at_the_end_nor_gain_speed(gap, rate, h):
    allowed = _kernels.spatial.allowed_rate(0.6, gap, rate, h, 1e-6, 1e-3)
    assert allowed <= 0
    if allowed < 0:
        assert gap + h * (rate + allowed) / 2 == pytest.approx(0.0, abs=1e-12)
