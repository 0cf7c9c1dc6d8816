"""Hardening curves: ends, slopes, and the Swift curve of a tensile test."""

import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.errors import InputError
from crumple.material import (
    HardeningCurve,
    HardeningTable,
    Material,
    PerfectlyPlastic,
    Swift,
    Voce,
    swift_from_tensile_test,
)

CURVES = [
    PerfectlyPlastic(300e6),
    Swift(300e6, 0.01, 0.15),
    Voce(300e6, 200e6, 0.1),
    HardeningTable([0.0, 0.05, 0.2], [300e6, 400e6, 450e6]),
]
every_curve = pytest.mark.parametrize("curve", CURVES, ids=lambda curve: type(curve).__name__)
strains = st.lists(st.floats(0.0, 2.0), min_size=2, max_size=6)


@every_curve
@given(given_strains=strains)
def test_curve_begins_at_yield_and_never_falls(curve, given_strains):
    assert isinstance(curve, HardeningCurve)
    strain = np.sort(given_strains)
    assert float(curve.stress(0.0)) == pytest.approx(curve.yield_stress, rel=1e-14)
    assert np.all(np.diff(curve.stress(strain)) >= 0.0)
    assert np.all(curve.slope(strain) >= 0.0)
    assert curve.stress(strain).shape == strain.shape
    assert pickle.loads(pickle.dumps(curve)) == curve
    hash(curve)


@every_curve
def test_slope_is_that_of_the_stress(curve):
    strain, step = np.array([0.013, 0.07, 0.3]), 1e-6
    difference = (curve.stress(strain + step) - curve.stress(strain - step)) / (2 * step)
    np.testing.assert_allclose(curve.slope(strain), difference, rtol=1e-6, atol=1.0)


@given(st.floats(0.05, 0.4))
def test_ends(strain):
    yielding = PerfectlyPlastic(300e6).stress(strain)
    assert Swift(300e6, 0.01, 0.0).stress(strain) == yielding
    assert Voce(300e6, 0.0, 0.1).stress(strain) == yielding
    assert HardeningTable([0.0], [300e6]).stress(strain) == yielding
    assert Voce(300e6, 200e6, 1e-9).stress(strain) == pytest.approx(500e6)
    assert Voce(300e6, 200e6, 1e9).stress(strain) == pytest.approx(300e6)


@given(st.floats(150e6, 900e6), st.floats(1.15, 2.0), st.floats(0.02, 0.12))
def test_swift_of_a_tensile_test_necks_where_the_test_did(yielding, ratio, elongation):
    curve = swift_from_tensile_test(yielding, ratio * yielding, elongation)
    strain = math.log1p(elongation)
    wanted = ratio * yielding * (1.0 + elongation)
    assert float(curve.stress(0.0)) == pytest.approx(yielding)
    assert float(curve.stress(strain)) == pytest.approx(wanted, rel=1e-9)
    assert float(curve.slope(strain)) == pytest.approx(wanted, rel=1e-9)
    # engineering stress is largest there
    around = strain + np.array([-0.01, 0.0, 0.01])
    engineering = curve.stress(around) * np.exp(-around)
    assert engineering[1] > engineering[0]
    assert engineering[1] > engineering[2]


def test_a_test_that_no_power_law_fits_is_refused():
    with pytest.raises(InputError, match="no power law"):
        swift_from_tensile_test(420e6, 421e6, 0.12)


@pytest.mark.parametrize(
    "build",
    [
        lambda: PerfectlyPlastic(0.0),
        lambda: Swift(300e6, 0.0, 0.1),
        lambda: Swift(300e6, 0.01, 1.5),
        lambda: Voce(300e6, -1.0, 0.1),
        lambda: HardeningTable([], []),
        lambda: HardeningTable([0.1, 0.2], [1.0, 2.0]),
        lambda: HardeningTable([0.0, 0.2], [2.0, 1.0]),
        lambda: HardeningTable([0.0, math.nan], [2.0, 3.0]),
    ],
)
def test_bad_curves_are_refused(build):
    with pytest.raises(InputError):
        build()


def test_a_material_refuses_a_curve_with_another_yield_stress():
    Material("steel", 210e9, 0.3, 7850.0, 300e6, hardening=CURVES[1])
    with pytest.raises(InputError, match="does not begin"):
        Material("steel", 210e9, 0.3, 7850.0, 310e6, hardening=CURVES[1])
