"""A ball dropped on a plane rebounds with the heights and times of the closed form.

From the height H it hits the plane after t0 = sqrt(2H/g) and rises to e^2 H, e^4 H, ...; bounce n occurs at
t0 (1 + 2e + ... + 2e^n), and the bouncing ends at t0 (1+e)/(1-e).

Kind: closed form.  Source: derived here.
"""

import itertools
import math

import numpy as np
import pytest
from tests.support.multibody.contact_models import (
    GRAVITY,
    MAX_RESIDUAL,
    ball_shape,
    plane,
    simulation,
    sphere,
)

HEIGHT = 1.0
FALL = math.sqrt(2 * HEIGHT / GRAVITY)


def dropped(restitution, times, accuracy=1e-3):
    """Height of the ball above its place on the plane at the times, and the record."""
    centre = (0.0, 0.0, 0.1 + HEIGHT)
    run = simulation(
        [sphere(centre)], [ball_shape(0, centre)], [plane(restitution=restitution)], accuracy=accuracy
    )
    record = run.run(np.asarray(times, float))
    assert record.residual < MAX_RESIDUAL
    return record.centre[:, 0, 2] - 0.1, record


def hits(restitution, count):
    """Times of the first impacts."""
    return [FALL * (1 + 2 * sum(restitution**k for k in range(1, n + 1))) for n in range(count)]


@pytest.mark.parametrize("restitution", [1.0, 0.8, 0.5])
def test_rebound_heights(restitution, record_figure):
    """At the middle of each flight, asked for by its closed-form time, the ball is at rest at e^2n H."""
    times = hits(restitution, 6)
    middles = [(a + b) / 2 for a, b in itertools.pairwise(times)]
    height, record = dropped(restitution, middles)
    for n, (value, velocity) in enumerate(zip(height, record.velocity[:, 0, 5], strict=True), 1):
        record_figure(f"height of rebound {n}, e = {restitution}", value, restitution ** (2 * n), 1e-4, "m")
        record_figure(f"velocity at its top, e = {restitution}", velocity, 0.0, 1e-3, "m/s")


@pytest.mark.parametrize("restitution", [1.0, 0.8, 0.5])
def test_times_of_the_impacts(restitution, record_figure):
    """The ball is on the plane at the closed-form times: within its speed there times 1e-5 s."""
    times = hits(restitution, 5)
    height, _ = dropped(restitution, times)
    for n, value in enumerate(height):
        speed = restitution**n * GRAVITY * FALL
        record_figure(f"height at impact {n + 1}, e = {restitution}", value, 0.0, 1e-5 * speed, "m")


@pytest.mark.parametrize("restitution", [0.0, 0.5, 0.8])
def test_comes_to_rest_without_chatter(restitution, record_figure):
    """After the sum of all flights it lies still and carries its weight, in few steps."""
    end = FALL * (1 + restitution) / (1 - restitution)
    height, record = dropped(restitution, [end + 0.1, end + 1.0])
    record_figure(f"height at rest, e = {restitution}", height[-1], 0.0, 2e-6, "m")
    record_figure(f"velocity at rest, e = {restitution}", record.velocity[-1, 0, 5], 0.0, 1e-6, "m/s")
    record_figure(
        f"force at rest, e = {restitution}", record.obstacle_force[-1, 0, 2], -2 * GRAVITY, 1e-6, "N"
    )
    assert record.steps < 300


def test_energy_goes_into_the_contact(record_figure):
    """What contact takes in the first impact is (1 - e^2) m g H."""
    _, record = dropped(0.6, [0.9 * FALL, 1.1 * FALL])
    lost = record.energy.contact[1] - record.energy.contact[0]
    record_figure(
        "energy lost in an impact, e = 0.6", lost, 0.64 * 2 * GRAVITY * HEIGHT, 1e-4, "J", relative=True
    )


def test_impulse_on_the_plane_is_the_change_of_momentum(record_figure):
    """The recorded force is the mean since the last output, so no impact escapes it."""
    times = np.linspace(0.0, 1.5, 31)
    _, record = dropped(0.7, times)
    momentum = 2 * (record.velocity[-1, 0, 5] + GRAVITY * times[-1])
    impulse = -np.sum(record.obstacle_force[1:, 0, 2] * np.diff(times))
    record_figure("impulse on the plane", impulse, momentum, 1e-6, "N s", relative=True)
