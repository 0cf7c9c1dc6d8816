"""Circular tube in bending: plastic moment, Brazier's limit, plastic ovalisation.

Brazier's limit is compared with the maximum of its own curve (elastic energy of an ovalising tube, one
term), and the plastic ovalisation with the equilibrium of a ring of four hinges computed by sums.  The
kinked branch is a scaled mechanism and has no independent figure.

Kind: closed form; independent calculation.  Source: quoted; derived here.
"""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.errors import InputError
from crumple.hinge import CircularLaw, KecmanLaw
from crumple.hinge.bending.circular import FLATTENED, brazier_moment, ovalisation_curvature
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 300e6)
TUBE = CircularTube(0.050, 0.002)


def test_brazier_limit_from_the_energy_of_an_ovalising_tube(record_figure):
    # Brazier: flattening z = R^4 k^2 (1 - nu^2)/t^2 of the ring, then M = E pi R^3 t k (1 - 3/2 z)
    radius, wall, nu = 0.024, 0.002, 0.3
    curvature = np.linspace(0.0, 2.0, 200001) * wall / radius**2
    flattening = radius**4 * curvature**2 * (1 - nu**2) / wall**2
    moment = 210e9 * math.pi * radius**3 * wall * curvature * (1 - 1.5 * flattening)
    record_figure(
        "Brazier's moment, R 24, t 2",
        brazier_moment(radius, wall, STEEL),
        moment.max(),
        1e-3,
        "N m",
        relative=True,
    )


def test_plastic_ovalisation_by_sums(record_figure):
    radius, wall, stress = 24.0, 2.0, 300.0
    arc = (np.arange(100000) + 0.5) / 100000 * math.pi / 2
    length = radius * math.pi / 2 / arc.size
    # quarter ring from the top (angle 0) to the side: load stress t k per arc length, hinges m_p at both ends
    lever = radius * length * arc.size - (radius * np.sin(arc)).sum() * length
    curvature = 2.0 * stress * wall**2 / 4.0 / (stress * wall * lever)
    value = ovalisation_curvature(radius, wall)
    record_figure(
        "curvature of plastic ovalisation, R 24, t 2", value, curvature, 1e-6, "1/mm", relative=True
    )
    # the same arc turned flat: its first moment about the side line
    y, z = radius * np.sin(arc) - radius, radius * np.cos(arc)
    turned = z * math.cos(math.pi / 4) + y * math.sin(math.pi / 4)
    record_figure(
        "modulus of the flattened ring over the round one", turned.mean() / z.mean(), FLATTENED, 1e-6
    )


def test_largest_moment_regimes_meet():
    # the diameter at which elastic ovalisation and full plasticity give the same moment
    def law(diameter):
        return CircularLaw.of(CircularTube(diameter, 0.001), STEEL)

    low, high = 0.05, 5.0
    for _ in range(60):
        middle = (low + high) / 2
        stout = law(middle).elastic_limit >= STEEL.yield_stress * CircularTube(
            middle, 0.001
        ).plastic_section_modulus("y")
        low, high = (middle, high) if stout else (low, middle)
    assert law(low).fold.peak == pytest.approx(law(high).fold.peak, rel=1e-9)
    assert 0.05 < low < 5.0
    assert any("thin wall" in warning for warning in law(2.0 * high).validity.warnings)
    assert not any("thin wall" in warning for warning in law(0.5 * low).validity.warnings)


@given(st.floats(0.02, 0.3), st.floats(0.005, 0.1), st.floats(0.001, 0.5))
def test_law_stays_between_its_bounds_and_is_continuous_in_the_wall(diameter, slenderness, rotation):
    law = CircularLaw.of(CircularTube(diameter, diameter * slenderness), STEEL)
    moment = float(law.moment_capacity(rotation))
    assert law.residual <= moment <= law.fold.peak
    beside = CircularLaw.of(CircularTube(diameter, diameter * slenderness * (1 + 1e-9)), STEEL)
    assert float(beside.moment_capacity(rotation)) == pytest.approx(moment, rel=1e-6)
    # without a band from the library of tubes the range ends with the kink
    assert law.validity.rotation_max <= law.kink_from or law.validity.uncertainty is not None


def test_kinked_branch_is_that_of_the_square_tube_with_the_same_mid_line():
    law = CircularLaw.of(TUBE, STEEL)
    side = math.pi * 0.048 / 4 + 0.002
    square = KecmanLaw.of(RectangularTube(side, side, 0.002), STEEL)
    for degrees in (10.0, 30.0):
        rotation = math.radians(degrees)
        assert float(law.moment_capacity(rotation)) == pytest.approx(
            float(square.moment_capacity(rotation)), rel=1e-12
        )


def test_documented_numbers(record_figure):
    law = CircularLaw.of(TUBE, STEEL)
    record_figure("50x2, 300 MPa: largest moment", law.fold.peak, 1383.2, 0.05, "N m")
    record_figure("50x2: rotation of plastic ovalisation", math.degrees(law.kink_from), 7.40, 0.005, "deg")
    record_figure(
        "50x2: capacity at 20 deg", float(law.moment_capacity(math.radians(20))), 654.1, 0.05, "N m"
    )


def test_what_does_not_fit_is_refused():
    with pytest.raises(InputError):
        CircularLaw.of(RectangularTube(0.05, 0.05, 0.002), STEEL)
