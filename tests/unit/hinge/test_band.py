"""Bands: three laws that stay in order, and the scaled law that passes everything else on."""

import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.errors import InputError
from crumple.hinge import ConstantLaw, HingeLaw, KecmanLaw, record_of
from crumple.hinge.band import Bound, ScaledLaw, band_of
from crumple.hinge.bending.profiles.folded_profile import FoldedProfileLaw
from crumple.material import Material
from crumple.section import Channel, RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
LAW = KecmanLaw.of(RectangularTube(0.05, 0.025, 0.00265), STEEL)


@given(st.floats(0.0, 3.0), st.floats(0.0, 0.9), st.sampled_from([1, -1]))
def test_band_is_in_order(rotation, width, sense):
    band = band_of(LAW, width)
    low, middle, high = (
        float(band.law(bound).moment_capacity(rotation, sense)) for bound in ("lower", "nominal", "upper")
    )
    assert 0.0 < low <= middle <= high
    assert high - middle == pytest.approx(middle - low, rel=1e-9, abs=1e-9)
    assert band.law(Bound.NOMINAL) is LAW


def test_the_stated_band_is_taken():
    assert LAW.validity.uncertainty >= 0.20
    assert band_of(LAW).upper.factor == pytest.approx(1.0 + LAW.validity.uncertainty)
    profile = FoldedProfileLaw.of(Channel(0.04, 0.08, 0.002), STEEL, "z")
    assert band_of(profile).lower.factor == pytest.approx(0.65)


def test_three_records_reach_the_stepper():
    band = band_of(LAW)
    records = [record_of(law) for law in (band.lower, band.nominal, band.upper)]
    peaks = [record.positive.moment[0] for record in records]
    np.testing.assert_allclose(
        np.array(peaks) / peaks[1], 1.0 + LAW.validity.uncertainty * np.array([-1.0, 0.0, 1.0])
    )
    assert all(record.rate_exponent == records[1].rate_exponent for record in records)


def test_scaled_law_is_a_law():
    law = ScaledLaw(LAW, 0.8, "lower")
    assert isinstance(law, HingeLaw)
    assert pickle.loads(pickle.dumps(law)) == law
    assert hash(law) == hash(ScaledLaw(LAW, 0.8, "lower"))
    assert law.validity.uncertainty is None
    assert law.validity.rotation_max == LAW.validity.rotation_max
    assert law.jamming_angle == LAW.jamming_angle
    assert "lower" in law.title


def test_refusals():
    with pytest.raises(InputError, match="scatter of this law is unknown"):
        band_of(ConstantLaw(100.0))
    with pytest.raises(InputError, match="out of range"):
        band_of(LAW, 1.0)
    with pytest.raises(InputError, match="positive"):
        ScaledLaw(LAW, 0.0)
    with pytest.raises(InputError, match="unknown choice"):
        band_of(LAW).law("middle")
