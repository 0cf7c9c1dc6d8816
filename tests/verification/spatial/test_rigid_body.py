"""Rigid bodies of the spatial kernel without hinges: closed forms and conserved quantities.

A body free of torque conserves its energy and its angular momentum in the global frame; the errors of both
must be of second order in the step.  A slender rod of 1.5 m on its end swings from horizontal rest like a
point on 1 m, with the period 4 sqrt(L/g) K(1/2) = 2.3678419475762373 s for g = 9.81 m/s^2 (simple pendulum
of the IFToMM library, A01).  A rod that circles at a constant angle to the vertical, without spin about
itself, does so with omega^2 = (3/2) (g/l) / cos(angle): gravity rotates its angular momentum about the
pivot.

Kind: closed form; invariant.  Source: derived here; derived here.
"""

import math

import numpy as np
import pytest
from tests.support.multibody.space_models import GRAVITY, bar, pendulum, started

from crumple._core.spatial.model import GROUND, SpatialBody, SpatialModel, spherical
from crumple._core.spatial.simulation import SpatialSimulation

PERIOD = 2.3678419475762373
INERTIA = np.diag([1.0, 2.0, 3.5])
SPIN = np.array([1.0, 2.0, 0.5])


def turned(quaternion, vector):
    w, v = quaternion[0], quaternion[1:]
    t = 2.0 * np.cross(v, vector)
    return vector + w * t + np.cross(v, t)


def test_free_body_keeps_momentum_and_energy(record_figure):
    """Errors after 2 s with steps of 20, 10 and 5 ms; it turns mainly about its unstable middle axis."""
    body = SpatialBody(2.0, INERTIA, np.zeros(3))
    momentum, energy, places = [], [], []
    for h in (0.02, 0.01, 0.005):
        simulation = started(SpatialModel((body,)), [[*SPIN, 0.1, 0.0, 0.0]])
        for _ in range(round(2.0 / h)):
            assert simulation.step(h)
        record = simulation.run(np.array([2.0]))
        q, w = record.rotation[-1, 0], record.velocity[-1, 0, :3]
        inverse = q * (1.0, -1.0, -1.0, -1.0)
        spin = turned(q, INERTIA @ turned(inverse, w))
        momentum.append(np.linalg.norm(spin - INERTIA @ SPIN))
        energy.append(abs(record.energy.kinetic[-1] - SPIN @ INERTIA @ SPIN / 2 - 0.01))
        places.append(q)
        assert record.centre[-1, 0] == pytest.approx([0.2, 0.0, 0.0], abs=1e-14)
    record_figure("order of the angular momentum's error", math.log2(momentum[0] / momentum[2]) / 2, 2.0, 0.2)
    assert math.log2(energy[0] / energy[2]) / 2 > 1.8
    first, second = np.linalg.norm(places[0] - places[1]), np.linalg.norm(places[1] - places[2])
    record_figure("order of the rotation", math.log2(first / second), 2.0, 0.1)
    assert momentum[2] < 1e-4 * np.linalg.norm(INERTIA @ SPIN)


@pytest.mark.parametrize("accuracy", [1e-4, 1e-6])
def test_period_of_the_pendulum(accuracy, record_figure):
    """Where it turns back, at horizontal rest, its rate shows the time by which it lags."""
    record = pendulum(accuracy).run(np.array([PERIOD]))
    late = record.velocity[-1, 0, 1] / GRAVITY
    record_figure(f"error of the period, accuracy {accuracy:g}", abs(late) / PERIOD, 0.0, 2 * accuracy)
    assert record.residual < accuracy


def test_order_of_the_pendulum(record_figure):
    errors = []
    for number in (200, 400, 800):
        simulation = pendulum()
        for _ in range(number):
            assert simulation.step(PERIOD / number)
        errors.append(abs(simulation.run(np.array([simulation.time])).velocity[-1, 0, 1]))
    record_figure("order", math.log2(errors[0] / errors[2]) / 2, 2.0, 0.1)


@pytest.mark.slow
@pytest.mark.parametrize("joint", [None, spherical])
def test_hundred_periods(joint, record_figure):
    """A ball joint leaves the plane free; nothing may lead the pendulum out of it."""
    simulation = pendulum(1e-6) if joint is None else pendulum(1e-6, joint)
    record = simulation.run(np.array([100 * PERIOD]))
    late = abs(record.velocity[-1, 0, 1]) / GRAVITY
    name = "pin" if joint is None else "ball joint"
    record_figure(f"lag after 100 periods over a period, {name}", late / PERIOD, 0.0, 1e-3)
    assert record.residual < 1e-5
    assert abs(record.centre[-1, 0, 1]) < 1e-9


def test_conical_pendulum(record_figure):
    """A rod of 1.5 m circles at 60 degrees to the vertical, ten times around."""
    angle, length = math.radians(60.0), 1.5
    rate = math.sqrt(1.5 * GRAVITY / length / math.cos(angle))
    end = length * np.array([math.sin(angle), 0.0, -math.cos(angle)])
    body = bar((0, 0, 0), end, mass=2.0, about_axis=0.01)
    model = SpatialModel(
        (body,), (spherical(GROUND, 0, np.zeros(3)),), gravity=(0.0, 0.0, -GRAVITY), length=length
    )
    # the rod turns about the vertical, less its spin about itself, of which it has none
    along = end / length
    omega = np.array([0.0, 0.0, rate])
    omega = omega - along * (along @ omega)
    simulation = SpatialSimulation(model, 1e-6)
    simulation.set_motion(np.concatenate([omega, np.cross(omega, body.centre)])[None], np.zeros((1, 6)))
    record = simulation.run(np.linspace(0.0, 10 * 2 * math.pi / rate, 101)[1:])
    heights = record.centre[:, 0, 2] / body.centre[2]
    record_figure("height of the circle", float(heights[np.argmax(abs(heights - 1))]), 1.0, 1e-5)
    around = math.atan2(record.centre[-1, 0, 1], record.centre[-1, 0, 0])
    record_figure("angle after ten rounds", around, 0.0, 1e-3, "rad")
