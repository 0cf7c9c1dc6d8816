"""Model M1: one bar with a softening hinge and a mass at its tip, stopped from 15 rad/s.

Figures: the set-valued closed form (kinetic energy = area under the law) 0.424127729101 rad, at rest at
0.064005833 s; with the HAVSIN ramp of 0.05 rad/s 0.424130871579 rad (accurate integration with a separate
code).  The law is sampled so finely (1e-8) that the sampling is negligible.  The error must stay below the
requested accuracy, and half the step must give a quarter of the error while the hinge slides.

Kind: closed form; independent calculation.  Source: derived here; derived here.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.support.multibody.chains import MASS_PER_LENGTH, PAYLOAD, REGULARISED, SET_VALUED, m1

INERTIA = MASS_PER_LENGTH / 3 + PAYLOAD
ROTATION, REST, REGULARISED_ROTATION = 0.424127729101, 0.064005833, 0.424130871579
ACCURACIES = [1e-2, 1e-3, 1e-4, 1e-5]


def test_reference_is_the_closed_form():
    """Area under the law: 1000 (0.576 x + sqrt(x)) beyond the plateau up to 0.05 rad."""

    def work(x):
        plateau = 0.05 * (0.576 + 0.5 / math.sqrt(0.05))
        return 1000.0 * (plateau + 0.576 * (x - 0.05) + math.sqrt(x) - math.sqrt(0.05))

    assert work(ROTATION) == pytest.approx(INERTIA * 15.0**2 / 2, rel=1e-11)


@pytest.mark.parametrize("accuracy", ACCURACIES)
def test_set_valued(accuracy, record_figure):
    summary = m1(accuracy).run(np.array([0.1])).summary
    rotation, rest = summary.rotation_max[0], summary.rest_time[0]
    record_figure(f"rotation, accuracy {accuracy:g}", rotation, ROTATION, accuracy, "rad", relative=True)
    record_figure(f"time of rest, accuracy {accuracy:g}", rest, REST, accuracy, "s", relative=True)


@pytest.mark.parametrize("accuracy", ACCURACIES)
def test_regularised(accuracy, record_figure):
    simulation = m1(accuracy, REGULARISED)
    simulation.run(np.array([0.1]))
    name = f"regularised rotation, accuracy {accuracy:g}"
    record_figure(name, simulation.q[0], REGULARISED_ROTATION, accuracy, "rad", relative=True)


def test_tight_runs_meet_the_figures(record_figure):
    """At accuracy 1e-7 what is left is the sampling of the law, 1e-8, and the digits of the figures."""
    tight = m1(1e-7).run(np.array([0.1])).summary
    record_figure("rotation, accuracy 1e-7", tight.rotation_max[0], ROTATION, 1e-7, "rad", relative=True)
    record_figure("time of rest, accuracy 1e-7", tight.rest_time[0], REST, 2e-7, "s", relative=True)
    simulation = m1(1e-7, REGULARISED)
    simulation.run(np.array([0.1]))
    record_figure(
        "regularised, accuracy 1e-7", simulation.q[0], REGULARISED_ROTATION, 1e-7, "rad", relative=True
    )


@pytest.mark.parametrize("form", [SET_VALUED, REGULARISED])
def test_second_order_while_the_hinge_slides(form, record_figure):
    """Fixed steps up to 40 ms, against an explicit integration (DOP853) of the formula itself."""

    def motion(t, y):
        return y[1], -1000.0 * (0.576 + 0.5 / math.sqrt(max(y[0], 0.05))) / INERTIA

    start = solve_ivp(motion, (0, 0.04), (0, 15.0), "DOP853", rtol=1e-13, atol=1e-14, max_step=1e-4).y[0, -1]
    errors = []
    for number in (10, 20, 40, 80):
        simulation = m1(form=form)
        for _ in range(number):
            assert simulation.step(0.04 / number)
        errors.append(abs(simulation.q[0] - start))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    # the kink of the law at 0.05 rad falls anywhere within a step, so single orders scatter about 2
    mean = float(orders.mean())
    record_figure(f"order, {'set-valued' if form == SET_VALUED else 'regularised'}", mean, 2.0, 0.3)
    assert errors[-1] < 1e-6
