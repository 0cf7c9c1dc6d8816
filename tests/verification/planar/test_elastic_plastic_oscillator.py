"""Elastic-perfectly plastic oscillator: largest rotation, residual rotation, then free vibration.

With omega^2 = k/I and x_y = M_y/k, a start from x = 0 with rate r omega x_y, r > 1, gives

    x_max/x_y = (1 + r^2)/2,   residual = x_max - x_y,   reached at (asin(1/r) + sqrt(r^2 - 1))/omega,

then harmonic vibration of amplitude x_y about the residual; for r <= 1 it stays elastic.  The tolerance is
the requested accuracy, 1e-4 of the largest rotation; the elastic vibration itself keeps its energy to
rounding.

Two wheels, the second on the first by a stiff spring: slow motion with a fast vibration on it, which does
not shorten the steps.  The mass matrix of (q1, q2) is [[I1 + I2, I2], [I2, I2]], the stiffness diag(k1, k2).
Both start with a rate.  A mode above the resolved frequency keeps its energy, the slow one also its phase.

Kind: closed form.  Source: derived here.
"""

import dataclasses
import math

import numpy as np
import pytest
from scipy.linalg import eigh
from tests.support.multibody.chains import ELASTIC_PLASTIC, hinge, started, wheel

from crumple._core.planar.simulation import TreeModel

INERTIA, STIFFNESS, YIELD = 2.0, 2e5, 700.0
OMEGA, X_Y = math.sqrt(STIFFNESS / INERTIA), YIELD / STIFFNESS
PERIOD = 2 * math.pi / OMEGA
ACCURACY = 1e-4


def run(ratio, sense=1.0, periods=5.0, accuracy=ACCURACY):
    one = hinge(0, YIELD, ELASTIC_PLASTIC, elastic_stiffness=STIFFNESS)
    simulation = started(TreeModel((wheel(INERTIA),), (one,)), [sense * ratio * OMEGA * X_Y], accuracy)
    return simulation.run(np.linspace(0.0, periods * PERIOD, 501))


@pytest.mark.parametrize("ratio", [1.5, 3.0, 10.0])
def test_yields_once_and_swings_about_its_residual(ratio, record_figure):
    record, largest = run(ratio), X_Y * (1 + ratio**2) / 2
    allowed = ACCURACY * largest
    residual = largest - X_Y
    name = f"start at {ratio:g} times the yield rate"
    record_figure(f"largest rotation, {name}", record.summary.rotation_max[0], largest, allowed, "rad")
    record_figure(f"plastic rotation, {name}", record.hinge.plastic[-1, 0], residual, allowed, "rad")
    after = record.q[record.time > 2 * PERIOD, 0]
    record_figure(f"middle of the swing, {name}", (after.max() + after.min()) / 2, residual, allowed, "rad")
    # the swing is read off 100 outputs a period: its top is missed by (pi/100)^2/2 of it
    missed = (math.pi / 100) ** 2 / 2 * X_Y
    record_figure(f"amplitude, {name}", (after.max() - after.min()) / 2, X_Y, allowed + missed, "rad")
    stop = (math.asin(1 / ratio) + math.sqrt(ratio**2 - 1)) / OMEGA
    record_figure(f"time of rest, {name}", record.summary.rest_time[0], stop, ACCURACY, "s", relative=True)
    assert record.summary.turning[0] == 0.0
    assert record.hinge_energy.dissipated[-1, 0] == pytest.approx(YIELD * residual, rel=10 * ACCURACY)
    assert record.residual < 1e-12


@pytest.mark.parametrize("ratio", [0.5, 0.999])
def test_below_yield_it_is_a_harmonic_oscillator(ratio, record_figure):
    record = run(ratio)
    closed = ratio * X_Y * np.sin(OMEGA * record.time)
    worst = float(np.abs(record.q[:, 0] - closed).max())
    # the trapezoidal rule lengthens the period by (omega h)^2/12: 0.033 % at 100 steps a period
    drift = 2 * math.pi * 5 * (2 * math.pi / 100) ** 2 / 12
    record_figure(f"departure from a sine over 5 periods, {ratio:g}", worst / (ratio * X_Y), 0.0, drift)
    assert abs(record.hinge_energy.dissipated[-1, 0]) < 1e-12 * record.energy.kinetic[0]
    np.testing.assert_allclose(
        record.energy.kinetic + record.energy.elastic, record.energy.kinetic[0], rtol=1e-12
    )


def test_senses_mirror():
    one, other = run(3.0), run(3.0, sense=-1.0)
    np.testing.assert_array_equal(one.q, -other.q)
    np.testing.assert_array_equal(one.hinge.plastic, -other.hinge.plastic)
    np.testing.assert_array_equal(one.hinge.moment, -other.hinge.moment)


@pytest.mark.parametrize("accuracy", [1e-3, 1e-4, 1e-5, 1e-6])
@pytest.mark.parametrize("stiffness", [1e5, 1e6])
def test_long_steps_do_not_run_past_the_turning_point(stiffness, accuracy):
    """Without outputs between, steps grow while the moment is constant; the unloading must end them."""
    one = hinge(0, YIELD, ELASTIC_PLASTIC, elastic_stiffness=stiffness)
    record = started(TreeModel((wheel(INERTIA),), (one,)), [15.0], accuracy).run(np.array([0.2]))
    plastic = (INERTIA * 15.0**2 - YIELD**2 / stiffness) / (2 * YIELD)
    assert record.hinge.plastic[-1, 0] == pytest.approx(plastic, rel=accuracy)


FIRST, SECOND = 2.0, 0.05
SLOW, FAST = 2 * math.pi * 12.0, 2 * math.pi * 4000.0
"""Angular frequencies of either wheel alone on its spring [rad/s]: 12 and 4000 Hz."""
STIFF = (FIRST + SECOND) * SLOW**2, SECOND * FAST**2
RATES = (6.0, 3.0)
END, LOOSE = 0.04, 1e-3


def pair(frequency=math.inf, yields=(1e9, 1e9)):
    springs = [
        hinge(k, yields[k], ELASTIC_PLASTIC, elastic_stiffness=stiffness) for k, stiffness in enumerate(STIFF)
    ]
    second = dataclasses.replace(wheel(SECOND), parent=0)
    return TreeModel((wheel(FIRST), second), tuple(springs), resolved_frequency=frequency)


def modes():
    """Angular frequencies, and rotations of (q1, q2) at a time in the slow mode alone."""
    mass = np.array([[FIRST + SECOND, SECOND], [SECOND, SECOND]])
    squares, shapes = eigh(np.diag(STIFF), mass)
    omega = np.sqrt(squares)
    given = shapes.T @ mass @ np.array(RATES)
    return omega, given, lambda t: shapes[0, 0] * given[0] * np.sin(omega[0] * t) / omega[0]


def run_pair(frequency, yields=(1e9, 1e9), number=6):
    simulation = started(pair(frequency, yields), RATES, LOOSE)
    return simulation.run(np.linspace(0.0, END, number))


def test_slow_motion_is_exact_in_a_fraction_of_the_steps(record_figure):
    over, every = run_pair(500.0), run_pair(math.inf)
    omega, given, slow = modes()
    assert omega[1] / (2 * math.pi) > 4000.0
    largest = abs(slow(0.25 * 2 * math.pi / omega[0]))
    wiggle = float(given[1] / omega[1])  # rotation of the fast mode, of unit modal mass
    assert wiggle / largest < 1e-3
    for name, record in (("passed over", over), ("resolved", every)):
        worst = float(np.abs(record.q[:, 0] - slow(record.time)).max())
        record_figure(f"rotation of the slow mode, vibration {name}", worst / largest, 0.0, LOOSE, "-")
        assert record.residual < 1e-9
    assert every.steps > 5 * over.steps


def test_the_fast_mode_keeps_its_energy(record_figure):
    """Energy of the relative rotation, which is that of the fast mode within SECOND/FIRST."""
    record = run_pair(500.0, number=26)
    _, given, _ = modes()
    elastic = STIFF[1] * record.q[:, 1] ** 2 / 2
    kinetic = SECOND * FIRST / (FIRST + SECOND) * record.w[:, 1] ** 2 / 2
    start = float(given[1] ** 2 / 2)
    record_figure("energy of the vibration", float((elastic + kinetic)[-1]), start, 0.02, "J", relative=True)
    assert float(np.abs(elastic + kinetic - start).max()) < 0.02 * start


def test_a_slow_spring_that_yields_turns_as_far_as_if_all_were_resolved(record_figure):
    """Elastic-plastic oscillator of both wheels as one: (1 + r^2)/2 - 1 yield rotations remain."""
    slow, ratio = math.sqrt(STIFF[0] / (FIRST + SECOND)), 2.0
    rate = RATES[0] + SECOND / (FIRST + SECOND) * RATES[1]
    yields = (STIFF[0] * rate / slow / ratio, 1e9)
    expected = yields[0] / STIFF[0] * ((1.0 + ratio**2) / 2.0 - 1.0)
    for name, frequency in (("passed over", 500.0), ("resolved", math.inf)):
        record = run_pair(frequency, yields)
        found = record.hinge.plastic[-1, 0]
        record_figure(f"plastic rotation, vibration {name}", found, expected, LOOSE, "rad", relative=True)
        assert found == pytest.approx(expected, rel=LOOSE)


@pytest.mark.parametrize("share", [0.1, 0.2, 0.5])
def test_a_fast_spring_that_yields_takes_its_energy(share, record_figure):
    """Its yield moment is a share of the largest elastic one. Which way it turns depends on its phase."""
    given = float(modes()[1][1])
    yields = (1e9, share * given * math.sqrt(STIFF[1]))
    over, every = (
        run_pair(frequency, yields).hinge_energy.dissipated[-1, 1] for frequency in (500.0, math.inf)
    )
    assert every > 0.7 * given**2 / 2
    record_figure(f"energy of a spring that yields at {share:g}", over, every, 0.01, "J", relative=True)
