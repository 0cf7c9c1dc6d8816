"""The end velocities that a step starts from: accelerations of the last step, if it was not much shorter."""

import math

import numpy as np
import pytest
from tests.support.multibody.chains import MASS_PER_LENGTH
from tests.support.multibody.space_models import bar, started

from crumple._core.spatial.model import GROUND, SpatialLoad, SpatialModel, revolute

SPEED, HIT, SHORT = 2.0, 5e-3, 1e-7


def pendulum(impulse):
    """A bar of 1 m on a pin that turns at 2 rad/s; its tip gets an impulse [N s] between two breaks."""
    times = HIT + SHORT * np.array([0.0, 0.01, 0.99, 1.0])
    force = impulse / (0.99 * SHORT) * np.array([0.0, 1.0, 1.0, 0.0])
    pin = revolute(GROUND, 0, np.zeros(3), (0.0, 0.0, 1.0))
    push = SpatialLoad(0, np.array([1.0, 0, 0]), np.array([0, 1.0, 0]), np.zeros(3), times, force)
    body = bar((0, 0, 0), (1.0, 0, 0))
    model = SpatialModel((body,), (pin,), (), (push,), breaks=np.array([HIT, HIT + SHORT]))
    return started(model, np.array([[0, 0, SPEED, 0, SPEED / 2.0, 0]]))


def test_a_step_is_not_guessed_from_accelerations_over_a_much_shorter_one():
    """0.1 N s in 0.1 us are 1e6 rad/s2: over the next step they would add thousands of rad/s to the 2."""
    plain, pushed = (pendulum(impulse).run(np.array([4.0 * HIT])) for impulse in (0.0, 0.1))
    gain = 0.1 * math.cos(SPEED * HIT) / (MASS_PER_LENGTH / 3.0)
    assert pushed.velocity[-1, 0, 2] == pytest.approx(SPEED + gain, rel=1e-6)
    assert plain.rejected == pushed.rejected == 0
    assert plain.steps == pushed.steps
