"""Shapes of multibody results: walls go with their bodies and meet halfway at a hinge, at asked times."""

import numpy as np
import pytest
from tests.support.result.folded_tube import analysis

from crumple.analysis import solve


@pytest.fixture(scope="module", name="result")
def _result():
    return solve(analysis())


def tilt(states, station):
    """Angle by which the section at a station has turned about -y [rad], (n_states,)."""
    ring = np.isclose(states.station, station)
    moved = states.points[ring] + states.displacement[:, ring]
    # upright at the start: its lowest and highest points give its inclination
    low, high = np.argmin(states.points[ring][:, 2]), np.argmax(states.points[ring][:, 2])
    upright = moved[:, high] - moved[:, low]
    start = states.points[ring][high] - states.points[ring][low]
    return np.arctan2(-upright[:, 0], upright[:, 2]) - np.arctan2(-start[0], start[2])


def test_shapes_are_of_the_times_asked_for(result):
    assert result.states.times == pytest.approx(analysis().outputs.pictures, abs=1e-12)


def test_the_ring_at_a_hinge_turns_by_half(result):
    turned = np.interp(result.states.times, result.time, -result["hinge.root.rotation"])
    (position,) = {hinge.position[0] for hinge in result.hinges.values()}
    assert abs(turned).max() > 0.5
    assert abs(tilt(result.states, 0.0)).max() < 1e-12
    np.testing.assert_allclose(abs(tilt(result.states, position)), abs(turned) / 2.0, atol=1e-9)
    np.testing.assert_allclose(abs(tilt(result.states, 1.0)), abs(turned), atol=1e-9)
