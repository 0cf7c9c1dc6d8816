"""Mitred corners: limits of the law, its senses, and where automatic hinges have it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from crumple.analysis import loads
from crumple.errors import InputError
from crumple.hinge import Trust, build_law
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube
from crumple.structure import plastic_hinges

STEEL = Material("steel", 210e9, 0.3, 7850.0, 350e6)
TUBE = RectangularTube(0.050, 0.050, 0.002)
RIGHT = math.radians(90.0)
FRAME = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections:
  tube: {type: SECTION, thickness: 2 mm}
nodes: {foot: [0 m, 0 m, 0 m], corner: [0 m, 0 m, 0.5 m], tip: [0.5 m, 0 m, 0.5 m]}
members:
  post: {nodes: [foot, corner], section: tube, material: steel}
  arm: {nodes: ARM, section: tube, material: steel}
hinges: auto
supports: {clamp: {node: foot, fix: all}}
masses: {payload: {node: tip, mass: 20 kg}}
initial_velocity: [{nodes: [tip], translation: [0 m/s, 0 m/s, -5 m/s]}]
analysis: {duration: 20 ms}
"""


def frame(section: str = "square_tube, side: 50 mm", arm: str = "[corner, tip]") -> str:
    return FRAME.replace("SECTION", section).replace("ARM", arm)


def test_a_corner_in_line_is_the_straight_member():
    law = build_law("mitred_corner", TUBE, STEEL, "y", angle=math.radians(5.0))
    straight = build_law("kecman", TUBE, STEEL, "y")
    at = np.radians([0.0, 2.0, 10.0, 30.0])
    for sense in (1, -1):
        np.testing.assert_allclose(law.moment_capacity(at, sense), straight.moment_capacity(at), rtol=0.04)


def test_the_moment_at_the_start_is_that_of_webs_and_strips_of_the_flanges():
    law = build_law("mitred_corner", TUBE, STEEL, "y", angle=RIGHT)
    side, wall = 0.048, 0.002
    webs = side**2 / 2.0 * (1.0 - 0.56 / 2.0) / (1.0 - 1.0 / 2.0)
    flanges = side**2 * 2.44 * wall / (side * math.sqrt(0.5))
    assert float(law.moment_capacity(0.0, 1)) == pytest.approx(350e6 * wall * (webs + flanges))
    assert law.elastic_stiffness == pytest.approx(0.34 * 210e9 * wall * side**2)
    assert law.source.trust is Trust.FITTED


def test_no_corner_carries_more_than_its_members():
    thick = RectangularTube(0.050, 0.050, 0.010)
    plastic = float(build_law("kecman", thick, STEEL, "y").moment_capacity(0.0))
    law = build_law("mitred_corner", thick, STEEL, "y", angle=math.radians(20.0))
    for sense in (1, -1):
        assert float(law.moment_capacity(0.0, sense)) <= plastic * (1.0 + 1e-12)


def test_the_closing_sense_is_the_weaker_one_and_can_be_either():
    at = np.radians([0.0, 5.0, 20.0])
    one = build_law("mitred_corner", TUBE, STEEL, "y", angle=RIGHT)
    other = build_law("mitred_corner", TUBE, STEEL, "y", angle=RIGHT, closing="negative")
    np.testing.assert_array_equal(one.moment_capacity(at, 1), other.moment_capacity(at, -1))
    assert (one.moment_capacity(at, 1) < one.moment_capacity(at, -1)).all()


def test_kinks_are_where_the_slope_jumps():
    law = build_law("mitred_corner", TUBE, STEEL, "y", angle=RIGHT)
    for sense in (1, -1):
        # the first one is where the mechanism begins to govern
        first = next(at for at in law.kinks(sense) if 0.0 < at < np.radians(40.0))
        before, after = law.moment_capacity(np.array([0.98, 1.02]) * first, sense)
        assert after < before == pytest.approx(float(law.moment_capacity(0.0, sense)), rel=0.05)


@pytest.mark.parametrize("degrees", [2.0, 110.0])
def test_other_angles_are_refused(degrees):
    with pytest.raises(InputError, match="no mitred corner has this angle"):
        build_law("mitred_corner", TUBE, STEEL, "y", angle=math.radians(degrees))


def test_other_sections_are_refused():
    with pytest.raises(InputError, match="rectangular tubes"):
        build_law("mitred_corner", CircularTube(0.05, 0.002), STEEL, "y", angle=RIGHT)


@pytest.mark.parametrize("arm", ["[corner, tip]", "[tip, corner]"])
def test_automatic_hinges_have_it_at_corners(arm):
    structure = loads(frame(arm=arm)).structure
    hinge = next(one for one in plastic_hinges(structure) if one.name == "corner-corner")
    assert hinge.law.name == "mitred_corner"
    # pushed down at its tip the corner closes: the hinge turns in the sense that the law names
    turned = np.array([0.0, 1.0, 0.0]) @ hinge.direction
    weak = 1 if turned > 0.0 else -1
    assert hinge.law.moment_capacity(0.2, weak) < hinge.law.moment_capacity(0.2, -weak)
    assert {one.name for one in plastic_hinges(structure)} == {"post-foot", "corner-corner"}


def test_a_corner_without_an_estimate_has_candidates_in_its_members():
    structure = loads(frame("circular_tube, diameter: 50 mm")).structure
    names = {one.name for one in plastic_hinges(structure)}
    assert {"post-corner", "arm-corner"} <= names


def test_out_of_its_plane_a_corner_carries_part_of_the_torque_of_bredt():
    law = build_law("mitred_corner_across", TUBE, STEEL, "y")
    torque, slenderness = 2.0 * 0.048**2 * 0.002 * 350e6 / math.sqrt(3.0), 0.002 / 0.048
    start = torque * slenderness / (0.0356 + 0.942 * slenderness)
    assert float(law.moment_capacity(0.0)) == pytest.approx(start)
    decay = 0.797 * (1.0 + 296.0 * slenderness**2)
    np.testing.assert_allclose(law.moment_capacity([decay, 2.0 * decay], -1), start * np.exp([-1.0, -2.0]))
    assert law.source.trust is Trust.FITTED


def test_thin_corners_carry_nothing_out_of_their_plane_and_thick_ones_no_more_than_their_members():
    thin = build_law("mitred_corner_across", RectangularTube(0.050, 0.050, 0.0001), STEEL, "y")
    bredt = 2.0 * 0.0499**2 * 0.0001 * 350e6 / math.sqrt(3.0)
    assert thin.start < 0.06 * bredt
    flat = RectangularTube(0.200, 0.012, 0.0055)
    law = build_law("mitred_corner_across", flat, STEEL, "y")
    assert law.start <= 350e6 * flat.plastic_section_modulus("y")


def test_only_rectangular_tubes_have_an_estimate_out_of_the_plane():
    with pytest.raises(InputError, match="no estimate of a corner out of its plane"):
        build_law("mitred_corner_across", CircularTube(0.050, 0.002), STEEL, "y")


@pytest.mark.parametrize(
    ("tip", "estimated"), [("[0.5 m, 0 m, 0.5 m]", True), ("[0.5 m, 0 m, 0.8 m]", False)]
)
def test_in_space_a_right_angled_corner_has_the_estimate_about_both_axes_of_its_plane(tip, estimated):
    text = (
        frame().replace("[0.5 m, 0 m, 0.5 m]", tip).replace("[0 m/s, 0 m/s, -5 m/s]", "[0 m/s, 5 m/s, 0 m/s]")
    )
    hinge = next(h for h in plastic_hinges(loads(text).structure) if h.name == "corner-corner")
    found = {c.freedom.name: float(c.record.positive.moment[0]) for c in hinge.spatial.components}
    start = build_law("mitred_corner_across", TUBE, STEEL, "y").start
    assert (found["X"] == pytest.approx(start)) is estimated
    assert (found["Z"] == pytest.approx(start)) is estimated
