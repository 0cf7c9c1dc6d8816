"""Rectangular tube bent about an oblique axis: exact plastic modulus, and the laws of the sides as limits.

The modulus is compared with a sum over fibres.  The fold has no independent figure, only its limits (the
law of each side), its bound by the largest moment, and its continuity in the angle.

Kind: independent calculation; invariant.  Source: derived here; derived here.
"""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.errors import InputError
from crumple.hinge import KecmanLaw, ObliqueLaw, absorbed_energy
from crumple.hinge.bending.oblique import oblique_plastic_modulus
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 300e6)
TUBE = RectangularTube(0.050, 0.025, 0.00265)
angles = st.floats(0.0, math.pi / 2)


def fibres(width, depth, angle, count=1500):
    y = (np.arange(count) + 0.5) / count * width - width / 2
    z = (np.arange(count) + 0.5) / count * depth - depth / 2
    return np.abs(z[:, None] * math.cos(angle) - y * math.sin(angle)).mean() * width * depth


@pytest.mark.parametrize("degrees", [0, 20, 45, 70, 90])
def test_plastic_modulus_against_a_sum_over_fibres(degrees, record_figure):
    angle = math.radians(degrees)
    expected = fibres(50, 25, angle) - fibres(44.7, 19.7, angle)
    value = 1e9 * oblique_plastic_modulus(TUBE, "y", angle)
    record_figure(f"50x25x2.65 about {degrees} deg: Z_pl", value, expected, 1e-4, "mm^3", relative=True)


def test_ends_are_the_laws_of_the_sides():
    rotation = np.radians([0.0, 2.0, 10.0, 20.0])
    for section in (TUBE, RectangularTube(0.05, 0.025, 0.002, 0.006), RectangularTube(0.08, 0.05, 0.001)):
        for angle, axis in ((0.0, "y"), (math.pi / 2, "z")):
            oblique = ObliqueLaw.of(section, STEEL, "y", angle=angle)
            side = KecmanLaw.of(section, STEEL, axis)
            np.testing.assert_allclose(
                oblique.moment_capacity(rotation), side.moment_capacity(rotation), rtol=1e-9
            )
            assert oblique.jamming_angle == pytest.approx(side.jamming_angle, rel=1e-9)


@given(angles, st.floats(0.001, 0.4))
def test_continuous_in_the_angle_and_below_both_bounds(angle, rotation):
    law = ObliqueLaw.of(TUBE, STEEL, angle=angle, after_jamming="hold")
    beside = ObliqueLaw.of(TUBE, STEEL, angle=min(angle + 1e-9, math.pi / 2), after_jamming="hold")
    moment = float(law.moment_capacity(rotation))
    assert float(beside.moment_capacity(rotation)) == pytest.approx(moment, rel=1e-6)
    assert moment <= law.peak * (1 + 1e-12)
    assert law.peak <= 300e6 * oblique_plastic_modulus(TUBE, "y", angle) * (1 + 1e-12)


@given(angles)
def test_energy_is_not_above_that_of_two_separate_folds(angle):
    law = ObliqueLaw.of(TUBE, STEEL, angle=angle)
    reach = 0.9 * law.jamming_angle
    first, second = (
        absorbed_energy(side, max(reach * share, 1e-9))
        for side, share in ((law.first, math.cos(angle)), (law.second, math.sin(angle)))
    )
    assert absorbed_energy(law, reach) <= (first + second) * (1 + 1e-6)


def test_what_does_not_fit_is_refused():
    with pytest.raises(InputError):
        ObliqueLaw.of(CircularTube(0.05, 0.002), STEEL)
    with pytest.raises(InputError):
        ObliqueLaw.of(TUBE, STEEL, angle=2.0)
