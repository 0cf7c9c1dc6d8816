"""Estimate of sections without a formula: plastic moment, softening of a tube; and what `auto` chooses."""

import numpy as np
import pytest

from crumple.hinge import Trust, build_law, fitting_laws
from crumple.material import Material
from crumple.section import RectangularTube
from crumple.section.shapes.written import written_section
from crumple.section.wall import Wall
from crumple.section.wall_section import WallSection

STEEL = Material("steel", 210e9, 0.3, 7850.0, 300e6)


@pytest.mark.parametrize(
    "text", ["angle 40x40x3 mm", "channel 60x40x2 mm", "multi_cell_tube 90x60x3 mm, cells 2x1"]
)
@pytest.mark.parametrize("axis", ["y", "z"])
def test_the_estimate_starts_at_the_plastic_moment_and_softens_as_a_tube(text, axis):
    section = written_section(text)
    law = build_law("estimate", section, STEEL, axis)
    plastic = 300e6 * section.plastic_section_modulus(axis)
    tube = RectangularTube(section.flange_width(axis), section.bending_depth(axis), section.thickness)
    around = build_law("kecman", tube, STEEL, "y")
    at = np.radians([0.0, 5.0, 20.0])
    softening = around.moment_capacity(at) / around.moment_capacity(0.0)
    np.testing.assert_allclose(law.moment_capacity(at), plastic * softening)
    assert law.source.trust is Trust.ESTIMATED
    assert law.validity.uncertainty is None
    said = law.validity.warning_at(0.01)
    assert said is not None
    assert "its law has no range of validity (an estimate; " in said


def test_auto_is_the_formula_of_the_shape_or_the_estimate():
    tube = RectangularTube(0.05, 0.03, 0.002)
    assert build_law("auto", tube, STEEL, "y") == build_law("kecman", tube, STEEL, "y")
    channel = written_section("channel 60x40x2 mm")
    assert build_law("auto", channel, STEEL, "z").name == "folded_profile"
    assert build_law("auto", channel, STEEL, "y").name == "folded_plates"
    strip = WallSection((Wall(((0.0, 0.0), (0.04, 0.0)), 0.003),))
    assert build_law("auto", strip, STEEL, "y").name == "estimate"


def test_laws_that_are_shown_side_by_side_do_not_contain_the_choice_between_them():
    assert not {"auto", "estimate"} & set(fitting_laws(RectangularTube(0.05, 0.03, 0.002), STEEL)[0])
