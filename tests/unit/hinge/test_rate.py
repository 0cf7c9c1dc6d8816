import numpy as np
import pytest

from crumple.errors import InputError
from crumple.hinge import ConstantLaw, HingeRate, KecmanLaw, TabulatedLaw
from crumple.hinge.rate import hinge_rate, rate_factor
from crumple.material import CowperSymonds, Material
from crumple.section import RectangularTube

TUBE = RectangularTube(0.050, 0.025, 0.00265)


def steel(**rates):
    return Material("steel", 210e9, 0.3, 7850.0, 488e6, **rates)


def test_fifteen_radians_a_second_strain_the_folds_at_one_per_second():
    # (15/3)/(2 x 2.5) = 1 /s: factor 1.48 with the pair at yield, 1.10 with the pair at large strain
    for D, q, expected in ((40.4, 5.0, 1.48), (6844.0, 3.91, 1.10)):
        law = CowperSymonds(D, q)
        factor = rate_factor(hinge_rate(law), 15.0)
        assert factor == pytest.approx(float(law.factor(1.0)), rel=1e-14)
        assert factor == pytest.approx(expected, abs=0.005)


def test_no_rate_law_is_no_effect():
    assert hinge_rate(None) is None
    np.testing.assert_array_equal(rate_factor(None, [0.0, 1.0, -5.0]), 1.0)


def test_a_fold_uses_the_flow_pair_and_warns_if_it_is_missing():
    yielding, flowing = CowperSymonds(40.4, 5.0), CowperSymonds(6844.0, 3.91)
    assert KecmanLaw.of(TUBE, steel(yield_rate=yielding, flow_rate=flowing)).rate == hinge_rate(flowing)
    without = KecmanLaw.of(TUBE, steel(yield_rate=yielding))
    assert without.rate is None
    assert any("rate law at yield" in warning for warning in without.validity.warnings)


def test_given_moments_and_slow_tests_warn_of_a_rate_at_yield_alone_too():
    yielding, curve = CowperSymonds(40.4, 5.0), {"rotation": (0.0, 1.0), "moment": (900.0, 500.0)}

    def warned(law):
        return any("rate law at yield" in warning for warning in law.validity.warnings)

    metal = steel(yield_rate=yielding)
    assert warned(ConstantLaw.of(TUBE, metal))
    assert warned(ConstantLaw.of(TUBE, metal, moment=1000.0))
    assert warned(TabulatedLaw.of(TUBE, metal, **curve))
    # a fast test holds its rate effect already
    assert not warned(TabulatedLaw.of(TUBE, metal, **curve, static=False))
    assert not warned(ConstantLaw.of(TUBE, steel(), moment=1000.0))


@pytest.mark.parametrize(
    ("reference", "exponent"), [(0.0, 1.0), (1.0, 0.5), (float("nan"), 1.0), (1.0, float("nan"))]
)
def test_impossible_rates_are_refused(reference, exponent):
    with pytest.raises(InputError):
        HingeRate(reference, exponent)
