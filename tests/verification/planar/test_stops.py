"""Stops: rebound and contact time of a linear stop, exponents of IMPACT, and its ramp of the damper.

A wheel of inertia I runs into a stop of stiffness k and damping ratio zeta with the rate w0; omega^2 = k/I.
The stop pushes but does not pull, so it separates where k g + c g' = 0.  Closed forms:

    critical (zeta = 1)   separates at omega t = 2 with e^-2 = 0.1353 of the rate
    underdamped           rebound e^(-zeta tau), d tau = atan2(2 zeta d, 2 zeta^2 - 1), d^2 = 1 - zeta^2
    undamped, exponent e  rebound 1, deepest penetration ((e+1) I w0^2/(2 k))^(1/(e+1))

The damped IMPACT form is integrated by DOP853.  A damper acts with the rate at the end of the step, which
makes it first order: the error of the rate is up to ten times the requested accuracy, 1e-5.

Kind: closed form; independent calculation.  Source: derived here; derived here.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.support.multibody.chains import MASS_PER_LENGTH, bar, hinge, started, wheel

from crumple._core.planar.simulation import Simulation, TreeModel
from crumple.function import impact

INERTIA, STIFFNESS, RATE, GAP = 2.0, 1e6, 5.0, 0.01
OMEGA = math.sqrt(STIFFNESS / INERTIA)
CRITICAL = 2 * math.sqrt(STIFFNESS * INERTIA)
ACCURACY = 1e-5


def struck(damping, exponent=1.0, full_damping=0.0, stiffness=STIFFNESS, sense=1, outputs=400):
    """Run into the stop and out of it again."""
    stop = (GAP, stiffness, exponent, damping, full_damping)
    side = {"stop_positive": stop} if sense > 0 else {"stop_negative": stop}
    model = TreeModel((wheel(INERTIA),), (hinge(0, 1e-9, **side),))
    return started(model, [sense * RATE], ACCURACY).run(np.linspace(0.0, GAP / RATE + 6 / OMEGA, outputs))


@pytest.mark.parametrize("outputs", [2, 400])
@pytest.mark.parametrize("sense", [1, -1])
def test_critical_stop_returns_e_to_the_minus_two(sense, outputs, record_figure):
    """The critical damper is found by the solver: NaN asks for it."""
    record = struck(math.nan, sense=sense, outputs=outputs)
    name = f"rebound of the critical stop, sense {sense:+d}, {outputs} outputs"
    record_figure(name, -sense * record.w[-1, 0] / RATE, math.exp(-2), 10 * ACCURACY)
    assert record.residual < 1e-12
    assert record.hinge_energy.dissipated[-1, 0] == pytest.approx(
        INERTIA * RATE**2 / 2 * (1 - math.exp(-4)), rel=1e-4
    )


def test_critical_stop_separates_at_omega_t_two(record_figure):
    record = struck(math.nan, outputs=4001)
    apart = record.time[np.argmax(np.abs(record.w[:, 0] - record.w[-1, 0]) < 1e-6 * RATE)]
    # the force falls to zero linearly, so the rate nears its last value quadratically: to 1e-6 at 2 - 3e-3
    record_figure("contact time times omega", (apart - GAP / RATE) * OMEGA, 2.0, 5e-3)


@pytest.mark.parametrize("ratio", [0.1, 0.3, 0.7])
def test_underdamped_stop(ratio, record_figure):
    damped = math.sqrt(1 - ratio**2)
    contact = math.atan2(2 * ratio * damped, 2 * ratio**2 - 1) / damped
    record = struck(ratio * CRITICAL)
    # a wheel that comes in on a parabola of no width: the error is that of finding the touch, c w0 h/I
    allowed = 1e-3 * (1 - math.exp(-ratio * contact))
    record_figure(
        f"rebound, damping ratio {ratio}", -record.w[-1, 0] / RATE, math.exp(-ratio * contact), allowed
    )
    assert record.residual < 1e-12


@pytest.mark.parametrize("exponent", [1.0, 1.5, 2.2, 3.0])
def test_undamped_stop_keeps_the_energy(exponent, record_figure):
    stiffness = STIFFNESS * 0.005 ** (1 - exponent)
    record = struck(0.0, exponent, stiffness=stiffness)
    deepest = ((exponent + 1) * INERTIA * RATE**2 / (2 * stiffness)) ** (1 / (exponent + 1))
    record_figure(f"rebound, exponent {exponent}", -record.w[-1, 0] / RATE, 1.0, ACCURACY)
    penetration = record.summary.rotation_max[0] - GAP
    record_figure(f"penetration, exponent {exponent}", penetration, deepest, ACCURACY, "rad", relative=True)


@pytest.mark.parametrize(
    ("exponent", "full_damping", "ratio"), [(1.5, 0.003, 0.2), (2.2, 0.001, 0.5), (1.0, 0.002, 1.0)]
)
def test_impact_with_its_ramp_of_the_damper(exponent, full_damping, ratio, record_figure):
    """Against an integration of crumple.function.impact, whose x runs the other way."""
    stiffness, damping = STIFFNESS * 0.005 ** (1 - exponent), ratio * CRITICAL

    def motion(t, y):
        return y[1], -float(impact(-y[0], -y[1], -GAP, stiffness, exponent, damping, full_damping)) / INERTIA

    def out(t, y):
        return y[0] - GAP if t > 1e-6 else 1.0

    out.terminal, out.direction = True, -1
    exact = solve_ivp(
        motion, (0, 1), (GAP, RATE), "DOP853", rtol=1e-10, atol=1e-12, max_step=2e-5, events=out
    )
    record = struck(damping, exponent, full_damping, stiffness)
    name = f"exponent {exponent}, penetration {full_damping * 1e3:g} mrad, ratio {ratio}"
    record_figure(f"rebound rate, {name}", record.w[-1, 0], exact.y[1, -1], 10 * ACCURACY * RATE, "rad/s")
    record_figure(
        f"rotation, {name}", record.summary.rotation_max[0], exact.y[0].max(), 1e-4, "rad", relative=True
    )
    assert record.residual < 1e-12


def test_critical_damping_is_of_the_configuration_at_first_touch(record_figure):
    """A bar folded by 1 rad on a free one feels another inertia than the straight pair.

    Both hinges are free until the second touches its stop.  Then the stop's impulse acts on the relative rate
    with m = 1/(J M^-1 J^T): a single stop event returns e^-2 of it.
    """
    angle = 1.0
    stop = (angle, 1e8, 1.0, math.nan, 0.0)
    bodies = (bar(1.0), bar(1.0, 0.0, (1.0, 0.0), 0))
    hinges = (hinge(0, 1e-9), hinge(1, 1e-9, stop_positive=stop))
    model = TreeModel(bodies, hinges)
    record = started(model, [0.0, 10.0], 1e-6).run(np.linspace(0.0, 0.4, 20001))
    touch = int(np.argmax(record.q[:, 1] > angle))
    # the contact lasts 2/omega = 0.14 ms, seven outputs; then the rate changes by 2 in 1000 per output
    returned = -record.w[touch + 8, 1] / record.w[touch - 1, 1]
    straight, folded = (Simulation(model).effective_inertia(1), inertia_felt(model, record.q[touch]))
    assert folded > 1.3 * straight
    record_figure("rate that returns from a stop in a folded pair", returned, math.exp(-2), 2e-3)


def inertia_felt(model, rotations):
    """Inertia of the second joint of two bars in any configuration, from their mass matrix."""
    bend = rotations[1]
    own, line = MASS_PER_LENGTH / 3, MASS_PER_LENGTH
    coupling = own + line / 2 * math.cos(bend)
    first = own + own + line + line * math.cos(bend)
    return own - coupling**2 / first
