import numpy as np
import pytest

from crumple.hinge import AfterJamming, KecmanLaw
from crumple.hinge.bending.jamming import RAMP_FRACTION, continued, continued_kinks
from crumple.material import Material
from crumple.section import RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
TUBE = RectangularTube(0.050, 0.025, 0.00265)


def falling(rotation):
    return 1000.0 - 500.0 * rotation


@pytest.mark.parametrize("after", AfterJamming)
def test_nothing_changes_before_jamming(after):
    rotation = np.linspace(0.0, 1.0, 11)
    np.testing.assert_array_equal(continued(falling, rotation, 1.0, after), falling(rotation))


@pytest.mark.parametrize("after", [AfterJamming.HOLD, AfterJamming.STOP])
def test_held_capacity(after):
    np.testing.assert_array_equal(continued(falling, [1.0, 1.5, 3.0], 1.0, after), 500.0)


def test_second_fold_restarts_the_curve_over_a_ramp():
    def capacity(rotation):
        return continued(falling, rotation, 1.0, AfterJamming.SECOND_FOLD)

    assert capacity(1.0) == 500.0
    # half way up the ramp
    middle = RAMP_FRACTION / 2
    assert capacity(1.0 + middle) == pytest.approx((500.0 + falling(middle)) / 2)
    for fold in (1.0, 2.0):
        rotation = np.linspace(1.001 * RAMP_FRACTION, 1.0, 7)
        np.testing.assert_allclose(capacity(fold + rotation), falling(rotation))


def test_kinks_of_every_fold_up_to_half_a_turn():
    kinks = continued_kinks((0.3,), 1.5, AfterJamming.SECOND_FOLD)
    ramp = 1.5 * RAMP_FRACTION
    np.testing.assert_allclose(kinks, [0.3, 1.5, 1.5 + ramp, 1.8, 3.0, 3.0 + ramp])
    assert continued_kinks((0.3,), 1.5, AfterJamming.HOLD) == (0.3, 1.5)


def test_tube_regains_its_largest_moment_in_the_second_fold():
    law = KecmanLaw.of(TUBE, STEEL)
    beyond = law.jamming_angle * (1.0 + 1.001 * RAMP_FRACTION)
    assert law.moment_capacity(law.jamming_angle) < 0.5 * law.peak.moment
    assert law.moment_capacity(beyond) == pytest.approx(law.peak.moment)
    assert law.validity.warning_at(beyond) is not None
