"""Andrews' squeezing mechanism: seven bodies, ten pins, three loops, one degree of freedom.

Data and figures: test set for initial value problems (IVP Test Set), problem "Andrews' squeezing
mechanism", the seven angles at 0.03 s, with its names.  The crank rotates two and a half times in 30 ms,
from rest.

Kind: published.  Source: quoted.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from tests.support.multibody.space_models import revolute

from crumple._core.spatial.model import GROUND, SpatialBody, SpatialLoad, SpatialModel, SpatialSpring
from crumple._core.spatial.simulation import SpatialSimulation

END = 0.03
# beta, Theta, gamma, Phi, delta, Omega, epsilon [rad]
START = (
    -0.0617138900142765,
    0.0,
    0.455279819163070,
    0.222668390165886,
    0.487364979543843,
    -0.222668390165886,
    1.23054744454982,
)
REFERENCE = np.array(
    [
        15.81077119629904,
        -15.75637105984298,
        0.04082224013073101,
        -0.5347301163226948,
        0.5244099658805304,
        0.5347301163226948,
        1.048080741042263,
    ]
)
MASSES = (0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498)
INERTIAS = (2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5)
A, B, C = (np.array([x, y, 0.0]) for x, y in ((-0.06934, -0.00227), (-0.03635, 0.03273), (0.014, 0.072)))


def along(angle, x, y=0.0):
    """Vector (x, y) in axes turned by an angle."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * x - s * y, s * x + c * y, 0.0])


def squeezer(accuracy=1e-3):
    """The mechanism at rest."""
    beta, theta, gamma, phi, delta, omega, epsilon = START
    crank = along(beta, 7e-3)
    e = crank - along(beta + theta, 28e-3)
    g, h = A + along(delta, 4e-2), A + along(epsilon, 0.0, -4e-2)
    centres = (
        along(beta, 92e-5),
        crank - along(beta + theta, 115e-4),
        B + along(gamma, 1043e-5, -1874e-5),
        g + along(phi + delta, 0.0, -(2e-2 - 1421e-5)),
        A + along(delta, 2308e-5, 916e-5),
        h + along(omega + epsilon, 2e-2 - 1421e-5),
        A + along(epsilon, -449e-5, -1228e-5),
    )
    assert e == pytest.approx(B + along(gamma, 0.0, -35e-3), abs=1e-14)
    assert e == pytest.approx(g + along(phi + delta, 0.0, -2e-2), abs=1e-14)
    assert e == pytest.approx(h + along(omega + epsilon, 2e-2), abs=1e-14)
    bodies = tuple(
        SpatialBody(mass, inertia * np.eye(3), centre)
        for mass, inertia, centre in zip(MASSES, INERTIAS, centres, strict=True)
    )
    pins = [(GROUND, 0, np.zeros(3)), (0, 1, crank), (1, 2, e), (1, 3, e), (1, 5, e)]
    pins += [(GROUND, 2, B), (GROUND, 4, A), (GROUND, 6, A), (3, 4, g), (5, 6, h)]
    joints = tuple(revolute(first, second, place, (0, 0, 1)) for first, second, place in pins)
    motor = SpatialLoad(0, np.zeros(3), np.zeros(3), np.array([0.0, 0.0, 0.033]), np.zeros(1), np.ones(1))
    spring = SpatialSpring(GROUND, 2, C, B + along(gamma, 2e-2, -18e-3), 4530.0, 0.07785)
    return SpatialSimulation(
        SpatialModel(bodies, joints, loads=(motor,), springs=(spring,), length=0.1), accuracy
    )


def angles(record):
    """The seven angles at the last time; no body may turn half around between two outputs."""
    quaternions = record.rotation
    turned = np.unwrap(2 * np.arctan2(quaternions[:, :, 3], quaternions[:, :, 0]), axis=0, period=4 * np.pi)
    k1, k2, k3, k4, k5, k6, k7 = turned[-1]
    return np.add(START, (k1, k2 - k1, k3, k4 - k5, k5, k6 - k7, k7))


def stepped(number):
    """Angles after a number of equal steps."""
    simulation = squeezer()
    turned, last = np.zeros(7), np.zeros(7)
    for _ in range(number):
        assert simulation.step(END / number)
        q = simulation.run(np.array([simulation.time])).rotation[-1]
        now = 2 * np.arctan2(q[:, 3], q[:, 0])
        turned += (now - last + 2 * np.pi) % (4 * np.pi) - 2 * np.pi
        last = now
    k1, k2, k3, k4, k5, k6, k7 = turned
    return np.add(START, (k1, k2 - k1, k3, k4 - k5, k5, k6 - k7, k7))


def test_one_freedom():
    assert squeezer().freedoms == (1, 9)


def test_figures(record_figure):
    record = squeezer(1e-6).run(np.linspace(0.0, END, 301)[1:])
    found = angles(record)
    for name, value, reference in zip(("beta", "Theta"), found, REFERENCE, strict=False):
        record_figure(f"{name} at 30 ms, accuracy 1e-6", value, reference, 5e-6, "rad")
    record_figure("worst of the other five angles", abs(found - REFERENCE)[2:].max(), 0.0, 5e-7, "rad")
    assert record.residual < 1e-6


@pytest.mark.slow
def test_richardson(record_figure):
    """The error goes with h^2, so a third of what half the step changes is what is left of it."""
    coarse, fine = stepped(6000), stepped(12000)
    order = np.log2(abs(coarse - REFERENCE) / abs(fine - REFERENCE))
    record_figure("order of beta", order[0], 2.0, 0.05)
    extrapolated = fine + (fine - coarse) / 3
    record_figure("beta, extrapolated", extrapolated[0], REFERENCE[0], 1e-7, "rad", relative=True)
    record_figure("worst angle, extrapolated", abs(extrapolated - REFERENCE).max(), 0.0, 1e-6, "rad")
