import numpy as np
import pytest

from crumple.hinge import KecmanLaw
from crumple.material import Material
from crumple.section import RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)


def validity(width, depth, thickness, corner_radius=0.0, material=STEEL):
    return KecmanLaw.of(RectangularTube(width, depth, thickness, corner_radius), material).validity


def test_checked_tube_has_a_band_and_no_warning():
    checked = validity(0.050, 0.025, 0.00265)
    assert checked.warnings == ()
    assert checked.uncertainty >= 0.20
    assert checked.rotation_max == pytest.approx(np.radians(42.0))
    # the same proportions at twice the size
    assert validity(0.100, 0.050, 0.0053).uncertainty == pytest.approx(checked.uncertainty)
    # thicker than the solved tubes of the library
    assert 0.20 <= validity(0.048, 0.024, 0.00265).uncertainty < 0.35


def test_a_tube_that_was_not_compared_has_no_band():
    # not in the library: wide corners, thick walls
    assert validity(0.040, 0.040, 0.002, 0.007).uncertainty is None
    assert validity(0.040, 0.040, 0.0042).uncertainty is None
    # a metal so strong that the flange of the same tube buckles
    strong = Material("strong", 210e9, 0.3, 7850.0, 2000e6)
    assert validity(0.050, 0.025, 0.00265, material=strong).uncertainty is None


def test_range_ends_at_jamming_where_that_comes_first():
    law = KecmanLaw.of(RectangularTube(0.050, 0.025, 0.00265), STEEL, "z")
    assert law.validity.rotation_max == law.jamming_angle < np.radians(42.0)


@pytest.mark.parametrize(
    ("dimensions", "message"),
    [
        ((0.025, 0.050, 0.00265), "thick flange"),
        ((0.025, 0.050, 0.00290), "outside the range of Kecman's tests, 9.14"),
        ((0.100, 0.030, 0.002), "outside the range of Kecman's tests, 0.33"),
        ((0.100, 0.100, 0.002), "the law lowers the largest moment, here to 86% of"),
        ((0.060, 0.180, 0.001), "slender webs"),
        ((0.050, 0.025, 0.00265, 0.005), "rounded corners"),
    ],
)
def test_each_condition_warns_by_itself(dimensions, message):
    assert any(message in warning for warning in validity(*dimensions).warnings)


def test_a_flange_at_the_limit_is_not_thick():
    assert 0.036 / 0.003 < 12.0
    assert not any("thick flange" in warning for warning in validity(0.036, 0.036, 0.003).warnings)
