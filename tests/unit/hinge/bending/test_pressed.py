"""The law of a fold under a pole: its limits, and what its two works have in common."""

from math import pi

import numpy as np
import pytest

from crumple.hinge.bending.constant import ConstantLaw
from crumple.hinge.bending.pressed import NARROW, WIDE, Press, PressedLaw
from crumple.hinge.record.sampling import sampled_envelope

MOMENT, FORCE, HALF = 2400.0, 40e3, 20e-3
FOLD = ConstantLaw(MOMENT)


def press_of(radius=HALF, spans=(0.2, 0.3), held=(800.0, 0.0)):
    return Press(FORCE, radius, HALF, spans, held)


@pytest.mark.parametrize("radius", [NARROW * HALF, 0.5 * (NARROW + WIDE) * HALF])
@pytest.mark.parametrize("held", [(0.0, 0.0), (800.0, 1600.0)])
def test_moment_and_force_at_collapse_lie_on_the_surface_and_balance(radius, held):
    press = press_of(radius, held=held)
    share = float(press.at_collapse(np.array(MOMENT)))
    moment = MOMENT * (1.0 - press.on_fold * share**2)
    balance = sum((moment + carried) / span for carried, span in zip(held, press.spans, strict=True))
    assert FORCE * share == pytest.approx(balance, rel=1e-12)
    law = PressedLaw(FOLD, press, 1)
    # what the fold takes is the work of its moment and that of the pole
    assert law.moment_capacity(0.1) == pytest.approx(moment + FORCE * share * law.slope(0.1), rel=1e-12)


@pytest.mark.parametrize(
    ("radius", "share"), [(0.1, 1.0), (NARROW, 1.0), (0.5 * (NARROW + WIDE), 0.5), (WIDE, 0.0), (9.0, 0.0)]
)
def test_share_of_the_force_on_the_fold(radius, share):
    assert press_of(radius * HALF).on_fold == pytest.approx(share)


def test_a_small_force_does_not_change_the_law():
    far = PressedLaw(FOLD, press_of(spans=(40.0, 40.0), held=(0.0, 0.0)), 1)
    assert far.moment_capacity(0.2) == pytest.approx(MOMENT, rel=1e-4)
    assert far.depth(0.2) == pytest.approx(
        0.2 * 2.0 * MOMENT / FORCE * (2.0 * MOMENT / 40.0 / FORCE), rel=1e-2
    )


def test_ends_that_carry_more_than_the_tube_let_the_force_dent_it_alone():
    stiff = PressedLaw(FOLD, press_of(held=(1e6, 1e6)), 1)
    assert stiff.moment_capacity(0.0) == pytest.approx(2.0 * MOMENT)
    assert stiff.slope(0.0) == pytest.approx(2.0 * MOMENT / FORCE)


@pytest.mark.parametrize("sense", [1, -1])
def test_the_pole_acts_in_one_sense(sense):
    law = PressedLaw(FOLD, press_of(), sense)
    assert law.moment_capacity(0.3, -sense) == pytest.approx(MOMENT)
    assert law.moment_capacity(0.3, sense) > 1.05 * MOMENT
    assert not law.symmetric
    assert law.depth(-0.3) == 0.0
    assert law.depth(0.3) == pytest.approx(0.3 * law.slope(0.3))
    table = sampled_envelope(law, sense)
    assert table.rotation[-1] == pytest.approx(pi)
    assert table.moment == pytest.approx(law.moment_capacity(table.rotation, sense))
