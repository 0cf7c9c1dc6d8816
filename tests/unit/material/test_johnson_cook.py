"""Johnson-Cook rate law and the power law that stands for it in a hinge."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.errors import InputError
from crumple.hinge.rate import hinge_rate
from crumple.material import JohnsonCook


def test_factor():
    law = JohnsonCook(0.014, 2.0)
    np.testing.assert_allclose(law.factor([0.0, 1.0, 2.0, -2.0 * np.e]), [1.0, 1.0, 1.0, 1.014])


@given(st.floats(0.001, 0.05), st.floats(0.01, 1.0))
def test_power_law_agrees_at_its_two_rates_and_nearly_between(rise, reference):
    law = JohnsonCook(rise, reference)
    power = law.as_cowper_symonds(10.0, 1000.0)
    np.testing.assert_allclose(power.factor([10.0, 1000.0]), law.factor([10.0, 1000.0]), rtol=1e-9)
    between = np.logspace(1, 3, 50)
    assert np.max(np.abs(power.factor(between) / law.factor(between) - 1.0)) < 0.03


def test_documented_error_of_the_power_law():
    law = JohnsonCook(0.014)
    between = np.logspace(1, 3, 500)
    error = np.abs(law.as_cowper_symonds().factor(between) / law.factor(between) - 1.0).max()
    assert 0.005 < error < 0.01


def test_hinge_takes_it():
    law = JohnsonCook(0.014)
    power = law.as_cowper_symonds()
    assert hinge_rate(law).exponent == power.q
    assert hinge_rate(law).reference == pytest.approx(15.0 * power.D)
    assert hinge_rate(JohnsonCook(0.0)) is None


@pytest.mark.parametrize(("rise", "reference"), [(-0.1, 1.0), (0.01, 0.0), (np.nan, 1.0)])
def test_bad_constants_are_refused(rise, reference):
    with pytest.raises(InputError):
        JohnsonCook(rise, reference)


def test_rates_too_low_for_a_power_law_are_refused():
    with pytest.raises(InputError, match="no power law"):
        JohnsonCook(0.014, 10.0).as_cowper_symonds()
