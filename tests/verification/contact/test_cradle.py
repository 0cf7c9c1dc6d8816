"""Newton's cradle: an impact passes along a row of balls that touch at rest.

With e = 1 the last ball of equal balls continues with the whole velocity.  With smaller e, pairs collide
one after another; the balls behind catch up and collide again until nothing approaches.  Three balls are
followed pair by pair here.  With e = 0 all continue together at v/n.

Kind: closed form.  Source: derived here.
"""

import numpy as np
import pytest
from tests.support.multibody.contact_models import MAX_RESIDUAL, ball_shape, plane, simulation, sphere

from crumple._core.outcome import Outcome
from crumple._core.spatial.model import SpatialContact

RADIUS, MASS, SPEED, GAP = 0.1, 2.0, 3.0, 0.05


def cradle(number, restitution, masses=None, accuracy=1e-3):
    """Velocities along the row after the impact [m/s], and the record; the first ball flies at the others."""
    places = [(-GAP if k == 0 else 0.0) + 2 * RADIUS * k for k in range(number)]
    masses = masses or [MASS] * number
    bodies = [sphere((x, 0, 0), RADIUS, mass) for x, mass in zip(places, masses, strict=True)]
    capsules = [ball_shape(k, (x, 0, 0), RADIUS) for k, x in enumerate(places)]
    pairs = tuple((i, j) for i in range(number) for j in range(i + 1, number))
    contact = SpatialContact(pairs, 0.0, restitution)
    run = simulation(bodies, capsules, contact=contact, gravity=(0.0, 0.0, 0.0), accuracy=accuracy)
    velocity = np.zeros((number, 6))
    velocity[0, 3] = SPEED
    run.set_motion(velocity, np.zeros_like(velocity))
    record = run.run(np.array([2 * GAP / SPEED]))
    assert record.residual < MAX_RESIDUAL
    return record.velocity[-1, :, 3], record


def pair_by_pair(restitution):
    """Velocities of three equal balls after impacts of pairs by turns."""
    v = np.array([SPEED, 0.0, 0.0])
    first = 0
    while v[first] - v[first + 1] > 1e-9 * SPEED:
        mean, half = v[first : first + 2].mean(), restitution * (v[first] - v[first + 1]) / 2
        v[first : first + 2] = mean - half, mean + half
        first = 1 - first
    return v


@pytest.mark.parametrize("number", [2, 3, 5])
def test_elastic_balls_pass_all_motion_on(number, record_figure):
    found, record = cradle(number, 1.0)
    expected = [0.0] * (number - 1) + [SPEED]
    worst = float(np.abs(found - expected).max())
    record_figure(f"velocities of {number} balls, e = 1, worst error", worst, 0.0, 1e-6, "m/s")
    assert record.steps < 60


@pytest.mark.parametrize("restitution", [0.9, 0.8, 0.3])
def test_three_balls_strike_pair_by_pair(restitution, record_figure):
    """The last, weak approaches count as rest: 1e-3 of the accuracy in energy."""
    found, record = cradle(3, restitution, accuracy=1e-6)
    worst = float(np.abs(found - pair_by_pair(restitution)).max())
    record_figure(f"velocities of 3 balls, e = {restitution}, worst error", worst, 0.0, 1e-4 * SPEED, "m/s")
    assert record.steps < 200


def test_balls_that_do_not_bounce_go_on_together(record_figure):
    found, _ = cradle(4, 0.0)
    worst = float(np.abs(found - SPEED / 4).max())
    record_figure("velocities of 4 balls, e = 0, worst error", worst, 0.0, 1e-6, "m/s")
    assert worst < 1e-6


def test_unequal_balls_keep_momentum_and_energy(record_figure):
    """A heavy last ball sends motion back through the row."""
    masses = [2.0, 2.0, 2.0, 8.0]
    found, _ = cradle(4, 1.0, masses)
    record_figure("momentum", float(np.dot(masses, found)), 2.0 * SPEED, 1e-6, "N*s")
    record_figure("energy", float(np.dot(masses, found**2)) / 2, SPEED**2, 1e-6, "J")
    expected = [(2 - 8) / (2 + 8) * SPEED, 0.0, 0.0, 4 / 10 * SPEED]
    assert found == pytest.approx(expected, abs=1e-6)


def test_balls_between_walls_come_to_rest():
    """Five balls that touch one another and two walls: 0.1 % of the approach is lost in each of impacts that
    follow at once, without end.  Their limit is contact that stays.
    """
    number = 5
    bodies = [sphere((2 * RADIUS * k, 0, 0), RADIUS, MASS) for k in range(number)]
    capsules = [ball_shape(k, (2 * RADIUS * k, 0, 0), RADIUS) for k in range(number)]
    pairs = tuple((i, i + 1) for i in range(number - 1))
    walls = [
        plane((-RADIUS, 0, 0), (1, 0, 0), restitution=0.999),
        plane(((2 * number - 1) * RADIUS, 0, 0), (-1, 0, 0), restitution=0.999),
    ]
    contact = SpatialContact(pairs, 0.0, 0.999)
    run = simulation(bodies, capsules, walls, contact=contact, gravity=(0.0, 0.0, 0.0))
    velocity = np.zeros((number, 6))
    velocity[0, 3] = SPEED
    run.set_motion(velocity, np.zeros_like(velocity))
    record = run.run(np.array([0.01]))
    assert record.outcome is Outcome.COMPLETE, record.reason
    assert record.residual < MAX_RESIDUAL
    assert np.abs(record.velocity[-1, :, 3]).max() < 1e-6
