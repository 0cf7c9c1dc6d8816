"""Mitred corners of round tubes: limits of the law, its senses, and where automatic hinges have it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from crumple.analysis import loads
from crumple.errors import InputError
from crumple.hinge import Coupling, Trust, build_law
from crumple.material import Material
from crumple.section import Channel, CircularTube
from crumple.structure import plastic_hinges
from crumple.structure.hinges.corners import corners

STEEL = Material("steel", 210e9, 0.3, 7850.0, 350e6)
TUBE = CircularTube(0.050, 0.002)
RIGHT = math.radians(90.0)
FRAME = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections:
  tube: {type: circular_tube, diameter: 50 mm, thickness: 2 mm}
nodes: {foot: [0 m, 0 m, 0 m], corner: [0 m, 0 m, 0.5 m], tip: [0.5 m, 0 m, 0.5 m]}
members:
  post: {nodes: [foot, corner], section: tube, material: steel, up: UP}
  arm: {nodes: ARM, section: tube, material: steel, up: ARM_UP}
hinges: HINGES
supports: {clamp: {node: foot, fix: all}}
masses: {payload: {node: AT, mass: 20 kg}}
initial_velocity: [{nodes: [tip], translation: MOVING}]
OBSTACLES
analysis: {duration: 20 ms}
"""
UPS = {"across": "[1, 0, 0]", "normal": "[0, 1, 0]", "diagonal": "[1, 1, 0]"}
ARM_UPS = {"across": "[0, 0, 1]", "normal": "[0, 1, 0]", "diagonal": "[0, 1, -1]"}
FALLING, ASIDE = "[0 m/s, 0 m/s, -5 m/s]", "[0 m/s, 5 m/s, 0 m/s]"


def corner(degrees=90.0, tube=TUBE, **options):
    return build_law("mitred_corner", tube, STEEL, angle=math.radians(degrees), **options)


def across(degrees=90.0, about="bisector", tube=TUBE):
    return build_law("mitred_corner_across", tube, STEEL, angle=math.radians(degrees), about=about)


def frame(moving=FALLING, arm="[corner, tip]", up="across", hinges="auto", at="tip", obstacles=""):
    ups = {"ARM_UP": ARM_UPS[up], "UP": UPS[up]}
    parts = {"MOVING": moving, **ups, "ARM": arm, "HINGES": hinges, "AT": at, "OBSTACLES": obstacles}
    text = FRAME
    # ARM_UP holds the other two words
    for word, part in parts.items():
        text = text.replace(word, part)
    return loads(text).structure


def hinge_at(structure):
    return next((one for one in plastic_hinges(structure) if one.name == "corner-corner"), None)


def test_nearly_in_line_it_is_the_straight_member():
    """Opened near the formula of the straight tube where start or fold governs, closed near its library."""
    straight, solved = (
        build_law("circular", TUBE, STEEL, after_jamming="hold"),
        build_law("library", TUBE, STEEL),
    )
    law = corner(5.0)
    far = np.radians([0.0, 40.0])
    np.testing.assert_allclose(law.moment_capacity(far, -1), straight.moment_capacity(far), rtol=0.15)
    at = np.radians([1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 40.0])
    np.testing.assert_allclose(law.moment_capacity(at, 1), solved.moment_capacity(at), rtol=0.18)
    fold = (0.75 + 1.09 * law.slope) * 0.024 / (12.0 * 0.002)
    assert law.share == pytest.approx(1.0 + (fold - 1.0) / 3.0)
    assert law.spread == pytest.approx(0.27 / 3.0)


@pytest.mark.parametrize("degrees", [5.0, 45.0, 100.0])
def test_thick_walls_carry_nearly_the_plastic_moment_and_no_corner_carries_more(degrees):
    solid = CircularTube(0.050, 0.0249)
    law = corner(degrees, solid)
    assert law.plastic * 0.85 < law.opened <= law.plastic
    assert law.start <= law.plastic
    assert law.moment_capacity(np.radians(60.0), -1) <= law.plastic


def test_thin_rings_carry_the_third_root_of_their_slenderness():
    one, other = corner(90.0, CircularTube(0.0508, 0.0008)), corner(90.0, CircularTube(0.1008, 0.0008))
    shares = [law.opened / law.plastic for law in (one, other)]
    assert shares[0] / shares[1] == pytest.approx(2.0 ** (1.0 / 3.0), rel=0.02)


def ring(k):
    """Share y of a right-angled corner of the tube."""
    return (12.0 * k * math.sqrt(0.002 / 0.024)) ** (2.0 / 3.0) / 2.0


def test_the_figures_of_a_closed_right_angle():
    law, strain, y = corner(), 350e6 / 210e9 * 12.0, ring(0.385)

    def moment(at):
        flat = y / (1.0 + (1.23 * at / law.slope + 16.3 * strain) / math.sqrt(y))
        return law.plastic * flat / (1.0 + flat**3) ** (1.0 / 3.0)

    assert law.start == pytest.approx(0.73 * moment(0.0))
    assert float(law.moment_capacity(0.0, 1)) == pytest.approx(law.start, rel=1e-3)
    at, fold = np.radians(20.0), law.tube.fold.mechanism.moment(np.radians(20.0))
    closed = (moment(at) ** -3 + fold**-3) ** (-1.0 / 3.0)
    assert float(law.moment_capacity(at, 1)) == pytest.approx(closed)
    assert law.elastic_stiffness == pytest.approx(0.48 * 210e9 * 0.002**2 * 0.024 * 2.0**2.5)
    assert law.source.trust is Trust.FITTED
    assert "90 deg" in law.title


def test_the_figures_of_an_opened_right_angle():
    law, y = corner(), ring(0.245)
    assert law.opened == pytest.approx(law.plastic * y / (1.0 + y**3) ** (1.0 / 3.0))
    assert float(law.moment_capacity(0.0, -1)) == pytest.approx(law.opened, rel=1e-3)
    at, fold = np.radians(20.0), law.tube.fold.mechanism.moment(np.radians(20.0))
    stretched = law.plastic - (law.plastic - law.opened) * math.exp(-at / (0.24 * law.slope))
    opened = (stretched**-6 + ((0.75 + 1.09 * law.slope) * fold) ** -6) ** (-1.0 / 6.0)
    assert float(law.moment_capacity(at, -1)) == pytest.approx(opened)


def test_a_closed_corner_softens_once_it_has_yielded_and_an_opened_one_first_stiffens():
    at = np.radians(np.linspace(0.0, 40.0, 161))
    law = corner()
    for sense, least, most in ((1, 1.0, 4.0), (-1, 10.0, 20.0)):
        moment = law.moment_capacity(at, sense)
        peak = int(np.argmax(moment))
        assert least < np.degrees(at[peak]) < most
        assert (np.diff(moment[:peak]) > 0.0).all()
        assert (np.diff(moment[peak:]) < 0.0).all()
    other = corner(closing="negative")
    np.testing.assert_array_equal(law.moment_capacity(at, 1), other.moment_capacity(at, -1))


def test_a_closed_corner_flattens_sooner_if_its_metal_yields_later():
    soft, hard = (
        build_law("mitred_corner", TUBE, replace(STEEL, yield_stress=stress), angle=RIGHT)
        for stress in (300e6, 600e6)
    )
    assert hard.start / hard.plastic < 0.9 * soft.start / soft.plastic
    assert hard.opened / hard.plastic == pytest.approx(soft.opened / soft.plastic)


def test_walls_of_other_proportions_have_a_warning_and_no_band():
    assert corner().validity.uncertainty == pytest.approx(0.20)
    assert corner().validity.warnings == ()
    for wall in (0.0010, 0.0050):
        validity = corner(tube=CircularTube(0.050, wall)).validity
        assert validity.uncertainty is None
        assert "diameter over thickness" in validity.warnings[0]
    strong = replace(STEEL, yield_stress=900e6)
    validity = build_law("mitred_corner", TUBE, strong, angle=RIGHT).validity
    assert validity.uncertainty is None
    assert "yield strain times radius over thickness is 0.0514" in validity.warnings[0]


def test_other_angles_and_sections_are_refused():
    for degrees in (2.0, 110.0):
        with pytest.raises(InputError, match="no mitred corner has this angle"):
            corner(degrees)
    with pytest.raises(InputError, match="rectangular tubes"):
        corner(tube=Channel(0.05, 0.03, 0.002))


@pytest.mark.parametrize("arm", ["[corner, tip]", "[tip, corner]"])
@pytest.mark.parametrize("up", UPS)
def test_in_a_plane_automatic_hinges_have_it_in_the_right_sense(arm, up):
    structure = frame(arm=arm, up=up)
    hinge = hinge_at(structure)
    assert {one.name for one in plastic_hinges(structure)} == {"post-foot", "corner-corner"}
    np.testing.assert_allclose(np.abs(hinge.direction), [0.0, 1.0, 0.0], atol=1e-12)
    # pushed down at its tip the corner closes
    weak = 1 if hinge.direction[1] > 0.0 else -1
    assert hinge.law.moment_capacity(0.1, weak) < hinge.law.moment_capacity(0.1, -weak)


@pytest.mark.parametrize("up", UPS)
def test_in_space_the_hinge_turns_about_the_normal_and_keeps_the_laws_of_the_member_about_others(up):
    hinge = hinge_at(frame(ASIDE, up=up))
    found = {c.freedom.name: float(c.record.positive.moment[0]) for c in hinge.spatial.components}
    normal = next(name for name in "YZ" if abs(hinge.axes[" YZ".index(name)] @ [0.0, 1.0, 0.0]) > 1.0 - 1e-9)
    assert any(found[normal] == pytest.approx(one, rel=1e-3) for one in (corner().start, corner().opened))
    assert found["Z" if normal == "Y" else "Y"] == pytest.approx(float(across().moment_capacity(0.0)))
    assert found["X"] == pytest.approx(float(across(about="tangent").moment_capacity(0.0)), rel=0.01)
    assert [component.freedom.name for component in hinge.spatial.components if component.shift] == [normal]


def test_a_hinge_that_does_not_turn_about_the_normal_keeps_the_law_of_the_member():
    for up, there in (("across", True), ("diagonal", False)):
        structure = frame(ASIDE, up=up, hinges="{axes: [y, z]}")
        assert "corner" in corners(structure)
        assert (hinge_at(structure) is not None) == there
    assert hinge_at(frame(ASIDE, up="diagonal", hinges="{axes: [y, z, x]}")) is not None
    assert hinge_at(frame(ASIDE, up="diagonal", hinges="{axis: y}")) is None


def test_a_loaded_corner_keeps_the_law_of_the_member():
    assert hinge_at(frame(at="corner")) is None


def test_a_pressed_round_corner_yields_as_its_members_do_and_not_about_a_tension_flange():
    wall = "obstacles: {wall: {type: plane, point: [0 m, 0 m, -1 m], normal: [0, 0, 1]}}"
    assert hinge_at(frame()).spatial is None
    surface = hinge_at(frame(obstacles=wall)).spatial.surface
    assert surface.coupling is Coupling.SECTION
    assert surface.arm == 0.0


def test_nearly_in_line_it_bends_about_its_bisector_and_twists_about_its_tangent():
    straight = build_law("library", TUBE, STEEL)
    at = np.radians([0.0, 5.0, 20.0])
    np.testing.assert_allclose(across(5.0).moment_capacity(at), straight.moment_capacity(at), rtol=0.05)
    torque = 2.0 * math.pi * 0.024**2 * 0.002 * 350e6 / math.sqrt(3.0)
    np.testing.assert_allclose(across(5.0, "tangent").moment_capacity(at[:2]), torque, rtol=0.01)


def test_its_ring_distorts_as_quarters_of_its_mid_line():
    """Far behind its start by k sigma (a t)^(3/2); before, the ring is weaker by (t/R)^(1/3)."""
    quarter = math.pi * 0.024 / 2.0
    assert across().distortion == pytest.approx(1.75 * STEEL.yield_stress * (quarter * 0.002) ** 1.5)
    assert across().early == pytest.approx(1.30 * (0.002 / 0.024) ** (1.0 / 3.0))
    bent = build_law("library", TUBE, STEEL).moment_capacity

    def distorted(at):
        members = 0.5 / across().torque ** 2 + 0.5 / float(bent(at)) ** 2
        return math.sqrt(0.5 / (float(across().moment_capacity(at)) ** -2 - members))

    assert distorted(0.5) == pytest.approx(across().distortion, rel=1e-4)
    assert distorted(0.0) == pytest.approx(across().early * across().distortion, rel=1e-4)
    assert across().elastic_stiffness == pytest.approx(
        0.51 * 210e9 * 0.002**2 * 0.024 / (0.5 * math.sqrt(0.5))
    )


def test_its_moment_about_the_tangent_is_constant_until_walls_fold_and_then_its_work_is_spent():
    side, law = math.pi * 0.024 / 2.0, across(5.0, "tangent")
    folding = 85.0 * (0.002 / side) ** 2
    assert folding in law.kinks()
    twisted = law.moment_capacity([0.99 * folding, 2.0 * folding])
    np.testing.assert_allclose(twisted, [law.torque, law.torque / 2.0], rtol=0.01)
    # about the bisector the torque of the members does not fall
    kept = across(90.0).moment_capacity(2.0 * folding)
    bending = float(build_law("library", TUBE, STEEL).moment_capacity(2.0 * folding))
    parts = 0.5 / across().distortion ** 2 + 0.5 / across().torque ** 2 + 0.5 / bending**2
    assert float(kept) == pytest.approx(parts**-0.5, rel=1e-3)


def test_a_thick_tube_out_of_the_range_of_the_library_has_the_fold_of_the_formula():
    thick = CircularTube(0.050, 0.006)
    law = across(tube=thick)
    assert law.tube.name == "circular"
    assert law.validity.uncertainty is None
    assert any("diameter over thickness" in warning for warning in law.validity.warnings)
    assert float(law.moment_capacity(0.0)) < float(law.tube.moment_capacity(0.0))
