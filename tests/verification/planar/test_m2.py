"""Model M2(N): chain of N bars with softening hinges and a mass at its tip, rotating as one with 15 rad/s.

Figures for N = 10: sum of rotations 0.6656451692 rad with a HAVSIN ramp of 0.05 rad/s and 0.6621691528 rad
with 5e-4 rad/s, nearly set-valued (accurate integrations with a separate code).  For the set-valued chain
there is no independent figure.  It must be the limit of the ramps: the difference is proportional to the
width of the ramp, 3.5e-3 rad for 0.05, so 3.5e-5 rad for 5e-4.  Nearly all rotation occurs in the second
hinge.  The errors of every hinge and of the tip must stay below the requested accuracy, relative to the
largest rotation.

Kind: independent calculation.  Source: derived here.
"""

import numpy as np
import pytest
from tests.support.multibody.chains import REGULARISED, SET_VALUED, m2

from crumple.multibody.run import CHECK_FACTOR

SUMS = {0.05: 0.6656451692, 5e-4: 0.6621691528}
END = np.array([0.1])
FORMS = [(SET_VALUED, 0.05), (REGULARISED, 0.05), (REGULARISED, 5e-4)]
NAMES = {(SET_VALUED, 0.05): "set-valued", (REGULARISED, 0.05): "ramp 0.05", (REGULARISED, 5e-4): "ramp 5e-4"}


@pytest.fixture(scope="module")
def tight():
    """Rotations of every hinge at an accuracy of 1e-6 (law sampled to 1e-7), by form and ramp."""
    found = {}
    for form, rate in FORMS:
        simulation = m2(10, 1e-6, form, rate, error=1e-7)
        record = simulation.run(END)
        assert record.residual < 1e-6
        found[form, rate] = simulation.q
    return found


@pytest.mark.parametrize("rate", SUMS)
def test_tight_runs_meet_the_figures(rate, tight, record_figure):
    # measured: 4e-7 and 8e-7 of the sum, shrinking in proportion to the accuracy
    total = tight[REGULARISED, rate].sum()
    record_figure(f"sum of rotations, ramp {rate:g} rad/s", total, SUMS[rate], 2e-6, "rad", relative=True)


def test_set_valued_is_where_the_ramps_lead(tight, record_figure):
    wide, narrow = (tight[REGULARISED, rate].sum() for rate in (0.05, 5e-4))
    limit = narrow - (wide - narrow) * 5e-4 / (0.05 - 5e-4)
    record_figure(
        "sum of rotations, set-valued", tight[SET_VALUED, 0.05].sum(), limit, 2e-6, "rad", relative=True
    )


@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-4, 1e-5])
@pytest.mark.parametrize(("form", "rate"), FORMS)
def test_accuracy_is_honoured(form, rate, accuracy, tight, record_figure):
    """Creeping hinges converge with first order: they get the margin with which `solve_multibody` asks."""
    simulation = m2(10, accuracy / (CHECK_FACTOR if form == REGULARISED else 1.0), form, rate)
    record = simulation.run(END)
    largest = np.abs(tight[form, rate]).max()
    name = f"{NAMES[form, rate]}, accuracy {accuracy:g}"
    worst = np.abs(simulation.q - tight[form, rate]).max() / largest
    record_figure(f"error of the worst hinge, {name}", worst, 0.0, accuracy)
    tip = abs(simulation.q.sum() - tight[form, rate].sum()) / largest
    record_figure(f"error of the tip, {name}", tip, 0.0, accuracy)
    assert record.residual < accuracy


@pytest.mark.parametrize(("form", "rate"), FORMS)
def test_long_chain(form, rate):
    """M2(100): no figure, but it must run, keep its energy, and agree with a tighter run."""
    runs = []
    for accuracy in (1e-3, 1e-4):
        simulation = m2(100, accuracy, form, rate)
        record = simulation.run(END)
        assert record.outcome == 0
        assert record.forced == 0
        assert record.residual < 1e-3
        runs.append(simulation.q)
    assert abs(runs[0].sum() / runs[1].sum() - 1.0) < 1.5e-3
