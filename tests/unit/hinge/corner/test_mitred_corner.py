"""Mitred corners: limits of the law, its senses, and where automatic hinges have it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from crumple.analysis import loads
from crumple.errors import InputError
from crumple.hinge import Trust, build_law, build_torsion_law
from crumple.hinge.tube_library.hardening import HardeningEffect
from crumple.hinge.tube_library.table import tube_table
from crumple.material import Material
from crumple.material.hardening.voce import Voce
from crumple.section import Channel, CircularTube, RectangularTube
from crumple.structure import plastic_hinges

STEEL = Material("steel", 210e9, 0.3, 7850.0, 350e6)
TUBE = RectangularTube(0.050, 0.050, 0.002)
WIDE = RectangularTube(0.080, 0.040, 0.002)
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
    """Opened at once; closed where neither the start nor the fold governs alone; before walls jam."""
    law = replace(build_law("mitred_corner", TUBE, STEEL, "y", angle=math.radians(5.0)), jamming=0.0)
    straight = build_law("kecman", TUBE, STEEL, "y")
    at = np.radians([0.0, 2.0, 10.0, 30.0])
    np.testing.assert_allclose(law.moment_capacity(at, -1), straight.moment_capacity(at), rtol=0.04)
    far = np.radians([0.0, 0.01, 30.0])
    np.testing.assert_allclose(law.moment_capacity(far, 1), straight.moment_capacity(far), rtol=0.06)


def test_a_closing_corner_falls_from_its_start_to_the_fold():
    """Where both would carry the same moment it carries 2^(-1/3) of it."""
    law = build_law("mitred_corner", WIDE, STEEL, "y", angle=RIGHT)
    at = np.radians(np.linspace(0.0, 60.0, 601))
    moment = law.moment_capacity(at)
    assert moment[0] == pytest.approx(law.start, rel=1e-3)
    assert (np.diff(moment) <= 1e-9 * law.start).all()
    fold = (1.0 - 0.45 * law.slope) * law.tube.mechanism.moment(at[1:])
    k = int(np.argmin(np.abs(fold - law.start))) + 1
    assert moment[k] == pytest.approx(2.0 ** (-1.0 / 3.0) * law.start, rel=0.01)


def test_a_fold_as_deep_as_wide_jams():
    """From 0.27 to 1.35 of the angle at which its walls meet, by half a smooth step in the middle."""
    law = build_law("mitred_corner", TUBE, STEEL, "y", angle=RIGHT)
    grown = 1.25 * (1.0 - 0.55) * (0.048 / (25.0 * 0.002)) ** 2
    end = law.tube.jamming_angle
    at = end * np.array([0.27, 0.81, 1.35, 2.0])
    falls = replace(law, jamming=0.0).moment_capacity(at)
    np.testing.assert_allclose(law.moment_capacity(at) / falls - 1.0, grown * np.array([0.0, 0.5, 1.0, 1.0]))
    # a wide one does not; thinner walls than were solved count as those, and carry no more than the members
    assert build_law("mitred_corner", WIDE, STEEL, "y", angle=RIGHT).jamming == 0.0
    thin = build_law("mitred_corner", RectangularTube(0.05, 0.05, 0.0006), STEEL, "y", angle=RIGHT)
    assert thin.jamming == pytest.approx(1.25 * (1.0 - 0.55) * 2.0**2)
    deep = build_law("mitred_corner", RectangularTube(0.03, 0.15, 0.0006), STEEL, "y", angle=RIGHT / 4.5)
    assert float(deep.moment_capacity(1.2)) == deep.plastic


def test_the_moment_at_the_start_is_that_of_webs_and_strips_of_the_flanges():
    law = build_law("mitred_corner", TUBE, STEEL, "y", angle=RIGHT)
    side, wall = 0.048, 0.002
    webs = side**2 / 2.0 * (1.0 - 0.56 / 2.0) / (1.0 - 1.0 / 2.0)
    flanges = side**2 / math.hypot(1.0, side * math.sqrt(0.5) / (2.44 * wall))
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
    law = build_law("mitred_corner", WIDE, STEEL, "y", angle=RIGHT)
    # opened, the first one is where the mechanism begins to govern
    first = next(at for at in law.kinks(-1) if 0.0 < at < np.radians(40.0))
    before, after = law.moment_capacity(np.array([0.98, 1.02]) * first, -1)
    assert after < before == pytest.approx(float(law.moment_capacity(0.0, -1)), rel=0.05)
    # closed, the only one is where the fold jams
    (jammed,) = law.kinks(1)
    before, at, after = law.moment_capacity(np.array([0.98, 1.0, 1.02]) * jammed, 1)
    assert before > at == after


@pytest.mark.parametrize("degrees", [2.0, 110.0])
def test_other_angles_are_refused(degrees):
    with pytest.raises(InputError, match="no mitred corner has this angle"):
        build_law("mitred_corner", TUBE, STEEL, "y", angle=math.radians(degrees))


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
    structure = loads(frame("channel, width: 50 mm, depth: 50 mm")).structure
    names = {one.name for one in plastic_hinges(structure)}
    assert {"post-corner", "arm-corner"} <= names


def across(degrees, about="bisector", tube=TUBE):
    return build_law("mitred_corner_across", tube, STEEL, "z", angle=math.radians(degrees), about=about)


def test_nearly_in_line_a_corner_bends_about_its_bisector_and_twists_about_its_tangent():
    at = np.radians([5.0, 10.0, 20.0])
    bent = build_law("kecman", TUBE, STEEL, "z", after_jamming="hold")
    np.testing.assert_allclose(across(5.0).moment_capacity(at), bent.moment_capacity(at), rtol=0.025)
    torque = 2.0 * 0.048**2 * 0.002 * 350e6 / math.sqrt(3.0)
    folding = 62.0 * (0.002 / 0.048) ** 2
    twisted = across(5.0, "tangent").moment_capacity([0.0, folding, 4.0 * folding])
    np.testing.assert_allclose(twisted, [torque, torque, (0.12 + 0.88 / 4.0) * torque], rtol=0.01)


def test_at_a_right_angle_bending_and_torsion_take_equal_parts_and_the_mitre_is_distorted():
    torque = 2.0 * 0.048**2 * 0.002 * 350e6 / math.sqrt(3.0)
    bending = float(build_law("kecman", TUBE, STEEL, "z").moment_capacity(0.0))
    member = math.sqrt(2.0 / (1.0 / torque**2 + 1.0 / bending**2))
    assert float(across(90.0, "tangent").moment_capacity(0.0)) == pytest.approx(member)
    distortion = 1.54 * (20.0 * 0.002 / 0.048) ** 0.22 * 350e6 * (0.048 * 0.002) ** 1.5
    start = 1.0 / math.sqrt(0.5 / (0.55 * distortion) ** 2 + 1.0 / member**2)
    assert float(across(90.0).moment_capacity(0.0, -1)) == pytest.approx(start)
    # before walls of the straight member fold
    at = 2.0 * 0.011
    grown = 1.0 / math.sqrt(0.5 / (distortion * (1.0 - 0.45 * math.exp(-2.0))) ** 2 + 1.0 / member**2)
    assert float(across(90.0).moment_capacity(at)) == pytest.approx(grown, rel=0.01)
    assert across(90.0).elastic_stiffness == pytest.approx(2.4 * 210e9 * 0.002**2.5 * 0.048**0.5)
    assert across(45.0).elastic_stiffness == pytest.approx(
        across(90.0).elastic_stiffness * math.tan(math.radians(22.5)) ** -1.4
    )
    assert across(90.0, "tangent").elastic_stiffness is None
    assert across(90.0).source.trust is Trust.FITTED


def test_thin_corners_carry_little_about_their_bisector_and_none_more_than_its_members():
    thin = RectangularTube(0.050, 0.050, 0.0001)
    whole = across(90.0, "tangent", thin).moment_capacity(0.0)
    assert float(across(90.0, tube=thin).moment_capacity(0.0)) < 0.15 * float(whole)
    for degrees in (10.0, 45.0, 100.0):
        thick = RectangularTube(0.050, 0.040, 0.010)
        start = float(across(degrees, tube=thick).moment_capacity(0.0))
        assert start <= float(build_law("kecman", thick, STEEL, "z").moment_capacity(0.0))


def test_other_sections_angles_and_directions_have_no_estimate_out_of_the_plane():
    with pytest.raises(InputError, match="no estimate of a corner out of its plane"):
        build_law("mitred_corner_across", Channel(0.050, 0.050, 0.002), STEEL, "y", angle=RIGHT)
    with pytest.raises(InputError, match="no estimate of a corner of this angle"):
        across(110.0)
    with pytest.raises(InputError, match="unknown choice"):
        across(90.0, "edge")
    with pytest.raises(InputError, match="angle"):
        build_law("mitred_corner_across", TUBE, STEEL)


@pytest.mark.parametrize("arm", ["[corner, tip]", "[tip, corner]"])
@pytest.mark.parametrize(("tip", "degrees"), [("[0.5 m, 0 m, 0.5 m]", 90.0), ("[0.3 m, 0 m, 0.9 m]", 36.87)])
def test_in_space_the_hinge_of_a_corner_has_the_axes_of_the_corner(arm, tip, degrees):
    text = frame(arm=arm).replace("[0.5 m, 0 m, 0.5 m]", tip)
    structure = loads(text.replace("[0 m/s, 0 m/s, -5 m/s]", "[0 m/s, 5 m/s, 0 m/s]")).structure
    hinge = next(h for h in plastic_hinges(structure) if h.name == "corner-corner")
    found = {c.freedom.name: float(c.record.positive.moment[0]) for c in hinge.spatial.components}
    assert found["X"] == pytest.approx(float(across(degrees, "tangent").moment_capacity(0.0)), rel=1e-4)
    across_plane = next(name for name in "YZ" if abs(hinge.axes[" YZ".index(name)] @ [0.0, 1.0, 0.0]) < 0.5)
    assert found[across_plane] == pytest.approx(float(across(degrees).moment_capacity(0.0)), rel=1e-4)
    assert hinge.spatial.surface.coupling.value == "ellipsoid"
    np.testing.assert_allclose(hinge.axes @ hinge.axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(hinge.axes) == pytest.approx(1.0)
    # the tangent is half the angle away from either member
    onward = np.subtract(structure.nodes["tip"], structure.nodes["corner"])
    onward /= np.linalg.norm(onward)
    half = math.cos(math.radians(degrees) / 2.0)
    assert hinge.axes[0] @ onward == pytest.approx(half, rel=1e-4)
    assert hinge.axes[0] @ [0.0, 0.0, 1.0] == pytest.approx(half, rel=1e-4)
    np.testing.assert_allclose(np.abs(hinge.direction), [0.0, 1.0, 0.0], atol=1e-12)


def test_elastic_corners_share_the_twist_of_their_first_member():
    text = frame().replace("hinges: auto", "hinges: {law: {type: auto, form: elastic-plastic}}")
    structure = loads(text.replace("[0 m/s, 0 m/s, -5 m/s]", "[0 m/s, 5 m/s, 0 m/s]")).structure
    hinge = next(h for h in plastic_hinges(structure) if h.name == "corner-corner")
    spring = {c.freedom.name: c.record.elastic_stiffness for c in hinge.spatial.components}
    # at a right angle half of the twist is about either direction
    own = across(90.0).elastic_stiffness
    bisector = next(spring[name] for name in "YZ" if name != hinge.axis.upper())
    assert 1.0 / bisector == pytest.approx(1.0 / own + 1.0 / spring["X"])


def test_a_hinge_that_does_not_twist_keeps_the_axes_of_its_member():
    text = frame().replace("hinges: auto", "hinges: {axes: [y, z]}")
    structure = loads(text.replace("[0 m/s, 0 m/s, -5 m/s]", "[0 m/s, 5 m/s, 0 m/s]")).structure
    assert next(h for h in plastic_hinges(structure) if h.name == "corner-corner").axes is None


HARDENING = replace(STEEL, hardening=Voce(STEEL.yield_stress, 150e6, 0.05))
TURNS = np.append(tube_table("rectangular_tube").rotation[:16], 0.5)


@pytest.mark.parametrize("section", [RectangularTube(0.05, 0.05, 0.003), CircularTube(0.05, 0.002)])
@pytest.mark.parametrize("sense", [1, -1])
def test_corners_in_their_plane_harden_as_the_straight_member_if_opened_and_less_if_closed(section, sense):
    angle = math.radians(60.0)
    hard, plain = (build_law("mitred_corner", section, one, "y", angle=angle) for one in (HARDENING, STEEL))
    effect = HardeningEffect.of(section, HARDENING).at(TURNS)
    assert effect.max() > 1.2
    share = 1.0 - 0.7 * math.sin(angle / 2.0) if sense > 0 else 1.0
    np.testing.assert_allclose(
        hard.moment_capacity(TURNS, sense),
        plain.moment_capacity(TURNS, sense) * (1.0 + share * (effect - 1.0)),
        rtol=1e-12,
    )


@pytest.mark.parametrize("section", [RectangularTube(0.05, 0.03, 0.002), CircularTube(0.05, 0.002)])
@pytest.mark.parametrize("about", ["bisector", "tangent"])
def test_corners_out_of_their_plane_harden_as_a_piece_that_is_twisted(section, about):
    """About the bisector one of the length that is distorted, about the tangent one of four sides."""
    hard, plain = (
        build_law("mitred_corner_across", section, one, "z", angle=1.2, about=about)
        for one in (HARDENING, STEEL)
    )
    round_tube = isinstance(section, CircularTube)
    side = math.pi * 0.048 / 4.0 if round_tube else math.sqrt(0.048 * 0.028)
    length = side * math.sqrt(side / section.thickness) if about == "bisector" else 4.0 * 0.05
    torsion = build_torsion_law("plastic", section, HARDENING, length)
    share = torsion.moment_capacity(TURNS) / torsion.initial_torque
    assert share[-1] > 1.15
    kept = plain.moment_capacity(TURNS)
    if about == "tangent":
        # and fold later: 1.5 times the excess of the flow stress over the yield stress
        later = 1.0 + 1.5 * (HARDENING.flow_stress / HARDENING.yield_stress - 1.0)
        folding, rest = (85.0, 0.0) if round_tube else (62.0, 0.12)
        folding *= later * (section.thickness / side) ** 2
        assert later > 1.2
        assert folding in [pytest.approx(kink) for kink in hard.kinks()]
        left = np.minimum(1.0, folding / np.maximum(TURNS, 1e-9))
        assert left[-1] < 0.9
        kept = float(plain.moment_capacity(0.0)) * (rest + (1.0 - rest) * left)
    np.testing.assert_allclose(hard.moment_capacity(TURNS), kept * share, rtol=1e-9)


def test_a_curve_delays_folds_about_the_tangent_and_a_flow_stress_does_not():
    flow = {"given_flow_stress": 1.4 * STEEL.yield_stress}
    plain, flowing, hard, both = (
        build_law("mitred_corner_across", TUBE, one, "z", angle=1.2, about="tangent").folding
        for one in (STEEL, replace(STEEL, **flow), HARDENING, replace(HARDENING, **flow))
    )
    assert flowing == plain
    # the curve goes before a flow stress
    assert both == hard
    assert hard > 1.2 * plain
