"""Model M3: a portal with softening hinges struck sideways equals an integration in its one coordinate.

Reference: Lagrange's equation in the angle of the left column, with the other two angles from the closure
of the four-bar linkage, integrated by SciPy to 1e-10: I(a) a'' + I'(a) a'^2/2 = -sum of moments times the
derivatives of the hinge rotations by a.  Set-valued: until the coordinate stops, when all hinges lock at
once.  With the HAVSIN ramp: to 100 ms, including creep; that form converges with first order, see
docs/theory/multibody_stepper.md.

Kind: independent calculation.  Source: derived here.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.support.multibody.chains import MASS_PER_LENGTH, REGULARISED, m3

LEFT, RIGHT, SPAN, LUMP, SPEED, SCALE = 0.5, 0.6, 1.0, 20.0, 10.0, 0.5
TOP = math.hypot(SPAN, RIGHT - LEFT)
START = np.array([math.pi / 2, math.atan2(RIGHT - LEFT, SPAN), math.pi / 2])
END = 0.1


def angles_of(column):
    """Angles of the left column, the top and the right column to the x axis, all counter-clockwise."""
    bx, by = LEFT * math.cos(column), LEFT * math.sin(column)
    dx, dy = SPAN - bx, -by
    distance = math.hypot(dx, dy)
    # C lies to the left of the line from B to D
    inner = math.acos((TOP**2 + distance**2 - RIGHT**2) / (2 * TOP * distance))
    top = math.atan2(dy, dx) + inner
    cx, cy = bx + TOP * math.cos(top), by + TOP * math.sin(top)
    return np.array([column, top, math.atan2(cy, cx - SPAN)])


def rates_of(angles):
    """Derivatives of the three angles by the first."""
    a, t, c = angles
    # LEFT e'(a) + TOP e'(t) t' = RIGHT e'(c) c'
    matrix = np.array([[-TOP * math.sin(t), RIGHT * math.sin(c)], [TOP * math.cos(t), -RIGHT * math.cos(c)]])
    top, right = np.linalg.solve(matrix, [LEFT * math.sin(a), -LEFT * math.cos(a)])
    return np.array([1.0, top, right])


def inertia(angles):
    """Of the coordinate: twice the kinetic energy at unit rate."""
    a, t, _ = angles
    _, top, right = rates_of(angles)
    middle = np.array(
        [
            -LEFT * math.sin(a) - TOP / 2 * math.sin(t) * top,
            LEFT * math.cos(a) + TOP / 2 * math.cos(t) * top,
        ]
    )
    bar = MASS_PER_LENGTH * TOP
    columns = MASS_PER_LENGTH * (LEFT**3 + RIGHT**3 * right**2) / 3
    return columns + (bar + LUMP) * middle @ middle + bar * TOP**2 / 12 * top**2


def of_hinges(three):
    """Rotations of the hinges A, B, C, D, or their derivatives, as the kernel counts them."""
    a, t, c = three
    return np.array([a, t - a, c - t, c])


def moments(rotation, rate, ramp):
    size = np.abs(rotation)
    capacity = SCALE * 1000 * (0.576 + 0.5 / np.sqrt(np.maximum(size, 0.05)))
    share = np.sign(rate) if ramp is None else np.sin(math.pi / 2 * np.clip(rate / ramp, -1, 1))
    return capacity * share


def reference(ramp=None):
    """Rotations of the hinges at the end, and the time at which they stop (set-valued)."""

    def slope(_, state):
        angles = angles_of(state[0])
        e = 1e-6
        by = (inertia(angles_of(state[0] + e)) - inertia(angles_of(state[0] - e))) / (2 * e)
        turned = of_hinges(angles - START)
        turning = of_hinges(rates_of(angles))
        force = -turning @ moments(turned, turning * state[1], ramp)
        return [state[1], (force - by * state[1] ** 2 / 2) / inertia(angles)]

    def stopped(_, state):
        return state[1]

    stopped.terminal = ramp is None
    method = "DOP853" if ramp is None else "Radau"
    # motion is clockwise; capacities have a kink where a rotation passes 0.05
    begin = [START[0], -SPEED / LEFT]
    found = solve_ivp(slope, (0.0, END), begin, method, rtol=1e-10, atol=1e-12, events=stopped, max_step=1e-3)
    assert found.success
    rotations = of_hinges(angles_of(found.y[0, -1]) - START)
    assert np.abs(rotations).max() < 1.2  # no stop is touched
    return rotations, found.t[-1]


@pytest.fixture(scope="module")
def stopped():
    return reference()


@pytest.mark.parametrize("accuracy", [1e-3, 1e-4, 1e-5, 1e-6])
def test_set_valued(accuracy, stopped, record_figure):
    rotations, time = stopped
    record = (simulation := m3(accuracy, error=min(1e-6, accuracy / 100))).run(np.array([END]))
    assert record.outcome == 0
    assert record.residual < accuracy
    largest = np.abs(rotations).max()
    for name, value, expected in zip("ABCD", simulation.q, rotations, strict=True):
        record_figure(
            f"rotation of {name}, accuracy {accuracy:g}", value, expected, accuracy * largest, "rad"
        )
    rest = record.summary.rest_time.max()
    record_figure(f"time of rest, accuracy {accuracy:g}", rest, time, 2 * accuracy, "s", relative=True)


def test_ramp(record_figure):
    rotations, _ = reference(0.05)
    errors = []
    for accuracy in (1e-4, 1e-5, 1e-6):
        simulation = m3(accuracy, REGULARISED, 0.05, error=1e-7)
        simulation.run(np.array([END]))
        errors.append(np.abs(simulation.q - rotations).max() / np.abs(rotations).max())
        record_figure(
            f"error with a ramp of 0.05 rad/s, accuracy {accuracy:g}", errors[-1], 0.0, 4 * accuracy
        )
    assert errors[2] < errors[0] / 20
