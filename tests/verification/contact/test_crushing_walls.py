"""Walls that crush under a contact at a constant force, in closed form.

A mass m that strikes a wall of crush force F at the speed v stops after m v/F, having crushed it by
m v^2/(2 F); all of its energy is dissipated and nothing rebounds.

Kind: closed form.  Source: derived here.
"""

from dataclasses import replace

import numpy as np
import pytest
from tests.support.multibody.contact_models import ball_shape, plane, simulation, sphere

MASS, SPEED, FORCE, RADIUS = 2.0, 3.0, 4000.0, 0.1
STOP, DEPTH = MASS * SPEED / FORCE, MASS * SPEED**2 / (2 * FORCE)
GAP = 0.0045


def thrown(accuracy=1e-3, restitution=0.0, friction=0.0, across=0.0, gravity=(0.0, 0.0, 0.0), speed=SPEED):
    """A ball above a plane whose own wall crushes."""
    centre = (0.0, 0.0, RADIUS + GAP)
    return simulation(
        [sphere(centre, RADIUS, MASS)],
        [replace(ball_shape(0, centre, RADIUS), crush_force=FORCE)],
        [plane(restitution=restitution, friction=friction)],
        [[0, 0, 0, across, 0, -speed]],
        gravity,
        accuracy,
    )


@pytest.mark.parametrize("restitution", [0.0, 0.7])
def test_stops_at_the_crush_force(restitution, record_figure):
    run = thrown(restitution=restitution)
    record = run.run(np.array([0.0, GAP / SPEED + STOP / 2, 0.02]))
    ((obstacle, _, capsule, depth),) = run.crushed
    assert (obstacle, capsule) == (0, 0)
    record_figure(f"depth, e = {restitution}", depth, DEPTH, 2e-3, "m")
    half = DEPTH * 0.75
    record_figure(
        f"way after half the time, e = {restitution}", RADIUS - record.centre[1, 0, 2], half, 5e-3, "m"
    )
    record_figure(f"dissipated, e = {restitution}", record.energy.contact[-1], MASS * SPEED**2 / 2, 1e-6, "J")
    assert abs(record.velocity[-1, 0, 5]) < 1e-6
    assert record.residual < 1e-9


@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-4, 1e-5])
def test_the_error_is_within_the_accuracy(accuracy, record_figure):
    run = thrown(accuracy)
    run.run(np.array([0.0, 0.02]))
    record_figure(f"depth, accuracy {accuracy:g}", run.crushed[0][3], DEPTH, accuracy, "m", relative=True)


def test_a_second_blow_begins_at_the_crushed_wall(record_figure):
    """Thrown up by gravity's reversal it falls again through the gap and the depth of the first blow."""
    gravity = 9.81
    run = thrown(gravity=(0.0, 0.0, -gravity))
    run.run(np.array([0.0, 0.05]))
    first = run.crushed[0][3]
    # at rest on the crushed wall, whose force is far above the weight; then thrown up
    up = 1.0
    run.stage()
    run.set_motion(np.array([[0, 0, 0, 0, 0, up]], float), np.zeros((1, 6)))
    run.run(np.array([0.05, 0.4]))
    # returns with the same speed: work of the crush force less that of the weight
    more = MASS * up**2 / 2 / (FORCE - MASS * gravity)
    record_figure("further depth of a second blow", run.crushed[0][3] - first, more, 5e-3, "m")


def test_friction_acts_with_the_crush_force(record_figure):
    """While the wall crushes, the slip loses mu F t/m (the ball does not spin up within the short time)."""
    mu, across = 0.2, 5.0
    run = thrown(friction=mu, across=across)
    record = run.run(np.array([0.0, 0.02]))
    lost = across - record.velocity[-1, 0, 3]
    record_figure("speed lost to friction", lost, mu * FORCE * STOP / MASS, 2e-3, "m/s")
