"""Sections that are no tubes harden as the tubes around them."""

from dataclasses import replace

import numpy as np
import pytest

from crumple.errors import InputError
from crumple.hinge import build_law
from crumple.hinge.bending.estimate import automatic_type
from crumple.hinge.tube_library.hardening import HardeningEffect
from crumple.material import Material
from crumple.material.hardening.swift import Swift
from crumple.section import RectangularTube
from crumple.section.shapes.written import written_section
from crumple.section.wall import Wall
from crumple.section.wall_section import WallSection
from crumple.structure import Structure, law_uses

YIELD = Material("steel", 210e9, 0.3, 7850.0, 350e6)
STEEL = replace(YIELD, hardening=Swift(350e6, 0.01, 0.15))
AT = np.radians(np.linspace(0.0, 20.0, 41))
CHANNEL, HAT, CLOSED = (
    written_section(text)
    for text in (
        "channel 60x40x2 mm",
        "hat 60x50x1.5 mm, flange 20 mm",
        "closed_hat 50x40x1.5 mm, flange 15 mm",
    )
)


@pytest.mark.parametrize(
    ("section", "axis", "plain"),
    [(CHANNEL, "z", "folded_profile"), (HAT, "y", "folded_profile"), (CLOSED, "z", "folded_plates")],
)
@pytest.mark.parametrize("sense", [1, -1])
def test_it_is_the_law_at_yield_times_the_effect_in_the_tube_around(section, axis, plain, sense):
    assert automatic_type(section, YIELD, axis) == plain
    assert automatic_type(section, STEEL, axis) == "hardening_section"
    found, at_yield = build_law("auto", section, STEEL, axis), build_law(plain, section, YIELD, axis)
    around = RectangularTube(section.flange_width(axis), section.bending_depth(axis), section.thickness)
    effect = HardeningEffect.of(around, STEEL).at(AT)
    assert effect.max() > 1.2
    np.testing.assert_allclose(
        found.moment_capacity(AT, sense), effect * at_yield.moment_capacity(AT, sense), rtol=1e-12
    )
    assert found.symmetric == at_yield.symmetric
    assert found.validity.uncertainty == (0.15 if plain == "folded_plates" else None)
    assert "an estimate" in found.validity.basis


def test_without_a_tube_around_it_is_the_law_at_yield():
    strip = WallSection((Wall(((0.0, 0.0), (0.04, 0.0)), 0.003),))
    found = build_law("hardening_section", strip, STEEL, "y")
    at_yield = build_law("estimate", strip, YIELD, "y")
    np.testing.assert_array_equal(found.moment_capacity(AT), at_yield.moment_capacity(AT))


@pytest.mark.parametrize(
    ("section", "material", "message"),
    [
        (RectangularTube(0.05, 0.05, 0.002), STEEL, "sections that are no tubes"),
        (HAT, YIELD, "metals that harden"),
    ],
)
def test_it_is_refused_for_tubes_and_for_metals_that_do_not_harden(section, material, message):
    with pytest.raises(InputError, match=message):
        build_law("hardening_section", section, material, "y")


@pytest.mark.parametrize(("axis", "band"), [("y", None), ("z", 0.15)])
def test_its_origin_and_band_are_those_of_the_law_at_yield(axis, band):
    curve = {"type": "swift", "prestrain": 0.01, "exponent": 0.15}
    steel = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 350e6}
    shape = {"type": "closed_hat", "width": 0.05, "depth": 0.04, "thickness": 0.0015, "flange": 0.015}
    whole = Structure(
        materials={"steel": steel | {"hardening": curve}},
        sections={"hat": shape},
        nodes={"foot": (0.0, 0.0, 0.0), "tip": (0.5, 0.0, 0.0)},
        members={"arm": {"nodes": ("foot", "tip"), "section": "hat", "material": "steel"}},
        hinges={"axis": axis},
        supports={"foot": {"node": "foot", "fix": "all"}},
        masses={"tip": {"node": "tip", "mass": 5.0}},
    )
    (use,) = law_uses(whole).values()
    assert (use.origin, use.band) == ("formula", band)
