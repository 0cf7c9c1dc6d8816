"""Closed form of a square tube after Wierzbicki et al.: its bracket, continuity, fold length and jamming.

M = C (0.576 + 1/(2 sqrt(theta))), C = 4.65 s0 b^(4/3) t^(5/3), as it is quoted.  The coefficient 4.65 was
not found in a text that could be read, so nothing here confirms it.  H_b = 1.276 b^(2/3) t^(1/3) is as read
in a public text.  The only independent comparison is with the Kecman-type law of the same tube: two
derivations of one fold.

Kind: published.  Source: quoted.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.hinge import KecmanLaw, WierzbickiLaw, absorbed_energy
from crumple.material import Material
from crumple.section import RectangularTube, half_fold_length

STEEL = Material("steel", 206e9, 0.3, 7850.0, 300e6)
SQUARE = RectangularTube(0.040, 0.040, 0.002)


def test_curve_is_the_quoted_formula(record_figure):
    law = WierzbickiLaw.of(SQUARE, STEEL)
    for degrees in (15, 30, 45):
        rotation = np.radians(degrees)
        assert law.folding_from < rotation < law.jamming_angle
        # in N and mm, mid-line side 38
        expected = 4.65 * 300.0 * 38.0 ** (4 / 3) * 2.0 ** (5 / 3) * (0.576 + 0.5 / np.sqrt(rotation)) / 1e3
        value = float(law.moment_capacity(rotation))
        record_figure(f"40x40x2, 300 MPa: M at {degrees} deg", value, expected, 1e-9, "N m", relative=True)


def test_half_fold_length(record_figure):
    record_figure(
        "half fold length, 40x40x2",
        half_fold_length(SQUARE) * 1e3,
        1.276 * 38 ** (2 / 3) * 2 ** (1 / 3),
        1e-9,
        "mm",
    )


@given(st.floats(0.02, 0.2), st.floats(0.005, 0.2))
def test_cap_and_fold_meet(side, slender):
    law = WierzbickiLaw.of(RectangularTube(side, side, side * slender), STEEL)
    assert law.moment_capacity(0.0) == pytest.approx(law.peak)
    if law.folding_from < law.jamming_angle:
        fold = law.scale * (0.576 + 0.5 / np.sqrt(law.folding_from))
        assert fold == pytest.approx(law.peak, rel=1e-12)
        assert law.moment_capacity(law.folding_from * 1.01) < law.peak


@given(st.floats(0.02, 0.2), st.floats(0.02, 0.1), st.floats(1.1, 5.0))
def test_curve_scales_with_size_and_stress(side, slender, factor):
    small, large = (RectangularTube(side * s, side * s, side * s * slender) for s in (1.0, factor))
    strong = Material("strong", STEEL.youngs_modulus * factor, 0.3, 7850.0, STEEL.yield_stress * factor)
    rotation = np.array([0.1, 0.3, 0.6])
    base = WierzbickiLaw.of(small, STEEL).moment_capacity(rotation)
    np.testing.assert_allclose(WierzbickiLaw.of(large, STEEL).moment_capacity(rotation), base * factor**3)
    np.testing.assert_allclose(WierzbickiLaw.of(small, strong).moment_capacity(rotation), base * factor)


def test_equivalent_side_makes_a_rectangle_possible_and_warns():
    tube = RectangularTube(0.050, 0.025, 0.00265)
    law = WierzbickiLaw.of(tube, STEEL, equivalent_side=0.030)
    assert law.scale == pytest.approx(4.65 * 300e6 * 0.030 ** (4 / 3) * 0.00265 ** (5 / 3))
    assert any("given by the user" in warning for warning in law.validity.warnings)


def test_same_order_as_the_kecman_type_law():
    closed, mechanism = WierzbickiLaw.of(SQUARE, STEEL), KecmanLaw.of(SQUARE, STEEL)
    rotation = np.radians(40.0)
    ratio = absorbed_energy(closed, rotation) / absorbed_energy(mechanism, rotation)
    assert 0.8 < ratio < 1.4
