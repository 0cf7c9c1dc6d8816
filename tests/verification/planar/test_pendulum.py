"""Simple pendulum from the horizontal: period 4 sqrt(L/g) K(1/2) = 2.3678419475762373 s for L = 1 m.

A body whose inertia makes its equivalent length 1 m falls from rest.  After 100 periods it must be back at
rest at the horizontal, where its rate is g/L times its error in time.  The accuracy refers to the largest
rotation step by step; without dissipation the errors of 100 periods add up.  The error of the period may
therefore be ten times the accuracy and that of the energy fifty times: 3 and 27 times were found at 1e-5,
and less below, in proportion.

Kind: closed form.  Source: textbook.
"""

import numpy as np
import pytest
from tests.support.multibody.chains import started

from crumple._core.planar.simulation import JointKind, TreeBody, TreeModel

PERIOD, GRAVITY, PERIODS = 2.3678419475762373, 9.81, 100
BODY = TreeBody(-1, JointKind.REVOLUTE, (0.0, 0.0), (0.5, 0.0), 2.0, 0.5)
"""Inertia about the pivot 2 kg (0.5 m)^2 + 0.5 kg m^2 = 1 kg m^2 = 2 kg 0.5 m L."""


@pytest.mark.parametrize("accuracy", [1e-5, 1e-6, 1e-7])
def test_hundred_periods(accuracy, record_figure):
    simulation = started(TreeModel((BODY,), (), gravity=(0.0, -GRAVITY)), [0.0], accuracy)
    record = simulation.run(np.array([PERIODS * PERIOD]))
    assert record.outcome == 0
    # at the horizontal the angular acceleration is -g/L
    delay = simulation.w[0] / GRAVITY / PERIODS
    name = f"accuracy {accuracy:g}"
    record_figure(f"period, {name}", PERIOD + delay, PERIOD, 10 * accuracy, "s", relative=True)
    drop = record.energy.kinetic[-1] - record.energy.external_work[-1]
    record_figure(f"energy gained, {name}", drop / (2.0 * GRAVITY * 0.5), 0.0, 50 * accuracy)
