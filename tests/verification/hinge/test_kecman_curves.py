"""Kecman-type law of the 50x25x2.65 mm tube: the table of moments, energies and jamming angles.

The figures were computed with a separate implementation of the same derivation at E = 206 GPa, 488 MPa,
outer dimensions, flow stress equal to yield stress; E enters only the buckling stress.  Moments are printed
to 1 N m, energies to 1 J and angles to 0.1 deg, so they are reproduced within half a unit.

The finite-element figures are those of one mesh of solid elements of the flat tube (a quarter of half the
fold, perfect plasticity, no contact).  They are not reproduced, but they limit what the law may claim.

Kind: independent calculation; other code.  Source: derived here; quoted.
"""

import numpy as np
import pytest

from crumple.hinge import KecmanLaw, absorbed_energy, build_law, rotation_absorbing
from crumple.material import Material
from crumple.section import RectangularTube

STEEL = Material("steel", 206e9, 0.3, 7850.0, 488e6)
TUBE = RectangularTube(0.050, 0.025, 0.00265)
AXES = {"flat": "y", "upright": "z"}

DEGREES = (0, 1, 2, 5, 10, 20, 30, 45, "jamming")
# orientation, start, weight of the second rolling line: moment [N m] at DEGREES, None beyond jamming
MOMENTS = {
    ("flat", "cap", 0.0): (1696, 1696, 1696, 1696, 1398, 955, 779, 658, 625),
    ("flat", "cap", 0.5): (1696, 1696, 1696, 1696, 1653, 1121, 912, 770, 732),
    ("flat", "cap", 1.0): (1696, 1696, 1696, 1696, 1696, 1288, 1045, 882, 840),
    ("flat", "parabola", 0.0): (1696, 1693, 1684, 1619, 1389, 955, 779, 658, 625),
    ("flat", "parabola", 1.0): (1696, 1695, 1692, 1670, 1593, 1288, 1045, 882, 840),
    ("upright", "cap", 0.0): (2823, 2823, 2823, 2823, 2096, 1394, None, None, 1195),
    ("upright", "cap", 0.5): (2823, 2823, 2823, 2823, 2449, 1598, None, None, 1350),
    ("upright", "cap", 1.0): (2823, 2823, 2823, 2823, 2802, 1801, None, None, 1504),
    ("upright", "parabola", 0.0): (2823, 2815, 2793, 2639, 2096, 1394, None, None, 1195),
    ("upright", "parabola", 1.0): (2823, 2820, 2811, 2751, 2534, 1801, None, None, 1504),
}
TANGENT = {
    ("flat", "parabola", 0.0): 11.0,
    ("flat", "parabola", 1.0): 18.9,
    ("upright", "parabola", 0.0): 9.3,
    ("upright", "parabola", 1.0): 15.4,
}
ENERGY_TO_JAMMING = {"flat": (912, 1028, 1132), "upright": (889, 975, 1047)}
STOPPING = {
    ("flat", 675.0): (33.0, 28.2, 25.4),
    ("flat", 783.7): (41.8, 35.2, 31.2),
    ("upright", 675.0): (16.8, 15.1, 14.2),
    ("upright", 783.7): (21.1, 18.5, 17.1),
}
# degrees: finite elements, law with weight 0, law with weight 1 [J]
FINITE_ELEMENTS = {10: (280, 288, 296), 20: (507, 486, 561), 30: (689, 635, 762), 42: (865, 786, 964)}
FINITE_ELEMENT_MOMENTS = {1: 1634, 2: 1656, 5: 1662, 10: 1456, 20: 1164, 30: 939, 42: 753}


def law(orientation, weight=1.0, start="cap", **options):
    return KecmanLaw.of(TUBE, STEEL, AXES[orientation], rolling_weight=weight, start=start, **options)


@pytest.mark.parametrize("case", MOMENTS, ids=str)
def test_moments(case, record_figure):
    orientation, start, weight = case
    curve = law(orientation, weight, start)
    for at, expected in zip(DEGREES, MOMENTS[case], strict=True):
        rotation = curve.jamming_angle if at == "jamming" else np.radians(at)
        place = "jamming" if at == "jamming" else f"{at} deg"
        if expected is None:
            assert rotation > curve.jamming_angle
        else:
            value = float(curve.moment_capacity(rotation))
            record_figure(
                f"{orientation}, {start}, weight {weight:g}: M at {place}", value, expected, 0.51, "N m"
            )


@pytest.mark.parametrize("case", TANGENT, ids=str)
def test_parabola_is_tangent_to_the_mechanism(case, record_figure):
    orientation, start, weight = case
    curve = law(orientation, weight, start)
    at = curve.mechanism_from
    record_figure(
        f"{orientation}, weight {weight:g}: parabola ends at", np.degrees(at), TANGENT[case], 0.05, "deg"
    )
    step = 1e-6
    before = (curve.moment_capacity(at) - curve.moment_capacity(at - step)) / step
    after = (curve.moment_capacity(at + step) - curve.moment_capacity(at)) / step
    # one-sided slopes of a curve with a jump in curvature: they differ by the step times that jump
    assert before == pytest.approx(after, rel=1e-4)


@pytest.mark.parametrize("orientation", ENERGY_TO_JAMMING)
def test_energy_to_jamming(orientation, record_figure):
    for weight, expected in zip((0.0, 0.5, 1.0), ENERGY_TO_JAMMING[orientation], strict=True):
        curve = law(orientation, weight)
        value = absorbed_energy(curve, curve.jamming_angle)
        record_figure(f"{orientation}, weight {weight:g}: energy to jamming", value, expected, 0.51, "J")


@pytest.mark.parametrize("case", STOPPING, ids=str)
def test_rotation_that_absorbs_the_kinetic_energy(case, record_figure):
    orientation, energy = case
    for weight, expected in zip((0.0, 0.5, 1.0), STOPPING[case], strict=True):
        value = np.degrees(rotation_absorbing(law(orientation, weight), energy))
        record_figure(
            f"{orientation}, weight {weight:g}: {energy:g} J stopped at", value, expected, 0.051, "deg"
        )


def test_low_energy_stops_on_the_plateau(record_figure):
    for orientation, expected in (("flat", 7.6), ("upright", 4.6)):
        value = np.degrees(rotation_absorbing(law(orientation), 225.0))
        record_figure(f"{orientation}: 225 J stopped at", value, expected, 0.05, "deg")


def test_energy_beside_finite_elements(record_figure):
    for degrees, (elements, light, full) in FINITE_ELEMENTS.items():
        values = [absorbed_energy(law("flat", weight), np.radians(degrees)) for weight in (0.0, 1.0)]
        for value, expected, weight in zip(values, (light, full), (0, 1), strict=True):
            record_figure(f"flat, weight {weight}: energy to {degrees} deg", value, expected, 0.51, "J")
        # as stated in crumple.hinge.bending.kecman_range: -9 to +3 % with weight 0, +6 to +11 % with weight 1
        assert -0.095 < values[0] / elements - 1 < 0.035
        assert 0.05 < values[1] / elements - 1 < 0.115


def test_library_of_tubes_beside_solid_elements():
    """Shells, and so the library, are 8 to 12 % below solids at this thick tube; the band holds that."""
    found = build_law("library", TUBE, STEEL, AXES["flat"])
    for degrees, (elements, *_) in FINITE_ELEMENTS.items():
        error = absorbed_energy(found, np.radians(degrees)) / elements - 1
        assert -found.validity.uncertainty <= error < -0.04


def test_claimed_band_holds_the_finite_element_moments():
    curve = law("flat")
    worst = max(
        abs(float(curve.moment_capacity(np.radians(degrees))) / moment - 1)
        for degrees, moment in FINITE_ELEMENT_MOMENTS.items()
    )
    # solid elements to 42 deg are 20 % below; the library of tubes widens the band by half
    assert worst == pytest.approx(0.20, abs=0.01)
    assert worst <= curve.validity.uncertainty <= worst + 0.10
    assert curve.validity.rotation_max == pytest.approx(np.radians(42.0))
    # the other way up nothing was compared, so no band is claimed
    assert law("upright").validity.uncertainty is None
