"""Band of a formula from the library of tubes: its definition, its limits, and where it is missing."""

import numpy as np
import pytest

from crumple.hinge import absorbed_energy, build_law
from crumple.hinge.tube_library.formula_band import LARGEST, formula_band
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 350e6)
TUBE, ROUND = RectangularTube(0.060, 0.045, 0.002), CircularTube(0.060, 0.002)


@pytest.mark.parametrize(("name", "section"), [("kecman", TUBE), ("circular", ROUND)])
def test_the_energies_of_the_library_with_its_band_lie_in_that_of_the_formula(name, section):
    law, library = (build_law(kind, section, STEEL, "y") for kind in (name, "library"))
    shares = []
    for at in np.radians([10.0, 30.0]):
        share = absorbed_energy(library, at) / absorbed_energy(law, at)
        shares += [share * (1.0 + side * library.validity.uncertainty) for side in (-1.0, 1.0)]
    found = law.validity.uncertainty
    assert found == pytest.approx(np.abs(np.array(shares) - 1.0).max())
    assert law.validity.rotation_max >= np.radians(30.0)
    assert "against the library of tubes" in law.validity.basis


def test_the_band_does_not_depend_on_the_size_and_follows_the_options():
    double = RectangularTube(2.0 * TUBE.width, 2.0 * TUBE.depth, 2.0 * TUBE.thickness)
    one, other = (build_law("kecman", section, STEEL, "y") for section in (TUBE, double))
    assert one.validity.uncertainty == pytest.approx(other.validity.uncertainty)
    lower = build_law("kecman", TUBE, STEEL, "y", rolling_weight=0.0)
    assert lower.validity.uncertainty != pytest.approx(one.validity.uncertainty)


def test_a_law_that_is_far_too_weak_has_the_largest_band():
    weak = build_law("constant", TUBE, STEEL, "y", moment=10.0)
    assert formula_band(weak, TUBE, STEEL, "y") == LARGEST


def test_tubes_that_the_library_refuses_have_none():
    law = build_law("kecman", TUBE, STEEL, "y")
    assert formula_band(law, RectangularTube(0.060, 0.020, 0.002), STEEL, "y") is None
