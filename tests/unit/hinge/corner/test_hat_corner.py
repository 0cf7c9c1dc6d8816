"""Mitred corners of closed hats: limits of the law, its senses, and where automatic hinges have it."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from tests.support.stored_laws import law_text, store_of

from crumple.analysis import loads
from crumple.characterisation import Bending
from crumple.characterisation.needed import needed
from crumple.characterisation.out_of_plane import OutOfPlane
from crumple.errors import InputError
from crumple.hinge import build_law
from crumple.hinge.corner.hat_corner import CLOSED_LIP, LIP, start_of
from crumple.material import Material
from crumple.material.hardening.voce import Voce
from crumple.section import ClosedHat
from crumple.structure import plastic_hinges
from crumple.structure.hinges.corners import corners

STEEL = Material("steel", 210e9, 0.3, 7850.0, 350e6)
HAT = ClosedHat(0.060, 0.050, 0.0015, 0.020)
RIGHT = math.radians(90.0)
PLATE, CROWN = "positive", "negative"
"""Sense that closes a corner with the plate and with the crown inside."""
FRAME = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections:
  hat: {type: closed_hat, width: 60 mm, depth: 50 mm, thickness: 1.5 mm, flange: 20 mm}
nodes: {foot: [0 m, 0 m, 0 m], corner: [0 m, 0 m, 0.5 m], tip: [X m, 0 m, 0.5 m]}
members:
  post: {nodes: POST, section: hat, material: steel, up: [UP, 0, 0]}
  arm: {nodes: ARM, section: hat, material: steel, up: [0, 0, ARMUP]}
hinges: auto
supports: {clamp: {node: foot, fix: all}}
masses: {payload: {node: tip, mass: 20 kg}}
initial_velocity: [{nodes: [tip], translation: [0 m/s, 0 m/s, -5 m/s]}]
analysis: {duration: 20 ms}
"""


DOWN = "[0 m/s, 0 m/s, -5 m/s]"


def frame(inside, *, side=1, arm="[corner, tip]", post="[foot, corner]", laws=None, velocity=DOWN):
    """L whose arm leads to +x or -x; the hats' crown or plate is on its inner side."""
    inwards = side if inside == CROWN else -side
    changes = {
        "ARMUP": -inwards * side,
        "UP": inwards,
        "ARM": arm,
        "POST": post,
        "X m": f"{0.5 * side} m",
        DOWN: velocity,
    }
    text = FRAME + ("" if laws is None else f"laws: {laws.name}\n")
    for old, new in changes.items():
        text = text.replace(old, str(new))
    where = {} if laws is None else {"directory": laws.parent}
    return loads(text, **where).structure


def corner(degrees=90.0, closing=PLATE, section=HAT, metal=STEEL):
    return build_law("mitred_corner", section, metal, "y", angle=math.radians(degrees), closing=closing)


def test_in_line_the_moment_at_the_start_is_the_plastic_one():
    for lip in (CLOSED_LIP, LIP):
        in_line = start_of(HAT, STEEL, 1e-9, lip)
        assert in_line == pytest.approx(350e6 * HAT.plastic_section_modulus("y"), rel=0.02)


@pytest.mark.parametrize("closing", [PLATE, CROWN])
@pytest.mark.parametrize("sense", [1, -1])
def test_nearly_in_line_a_corner_of_stocky_hats_is_the_straight_member(closing, sense):
    """Where neither the start nor the fold governs alone the transition is rounded."""
    stocky = ClosedHat(0.050, 0.050, 0.0035, 0.015)
    law, member = corner(5.0, closing, stocky), build_law("folded_profile", stocky, STEEL, "y")
    # a plate that is pressed keeps a part of the corner's weaker fold
    for degrees in (0.0, 60.0) if sense < 0 else (0.0,):
        found, straight = (float(one.moment_capacity(math.radians(degrees), sense)) for one in (law, member))
        assert found == pytest.approx(straight, rel=0.12)


def test_between_line_and_corner_the_fold_is_a_mean_of_both():
    law, whole = corner(7.5), corner(15.0)
    assert (law.bent, whole.bent) == (pytest.approx(0.5), pytest.approx(1.0))
    at = 0.2
    fold = 0.5 * (law.inner.moment(at) + law.tube.positive.mechanism.moment(at))
    expected = law.start * (1.0 + (law.start / ((1.0 - 0.45 * law.slope) * fold)) ** 6.0) ** (-1.0 / 6.0)
    assert float(law.moment_capacity(at, 1)) == pytest.approx(float(expected))


@pytest.mark.parametrize("lip", [0.65, 2.0 * math.sqrt(2.0)])
def test_the_moment_at_the_start_is_that_of_webs_and_of_sheets_that_bend(lip):
    wall, between, depth, flange, s = 0.0015, 0.0585, 0.0485, 0.02075, math.sqrt(0.5)

    def force(width, held):
        return 350e6 * wall * width / math.hypot(1.0, held * width * s / (2.44 * wall))

    webs = 350e6 * wall * depth**2 / 2.0 * (1.0 - 0.56 / 2.0) / (1.0 - 1.0 / 2.0)
    crown, lips = force(between, 1.0), 4.0 * force(flange, lip)
    plate = crown + lips
    # the outer lips and the plate lie a wall below the lips of the hat
    lever = (crown + lips / 2.0) * wall
    offset = lips**2 / (8.0 * 350e6 * wall)
    expected = webs + (crown + plate) * depth / 2.0 + lever - offset
    for closing, sense in ((PLATE, 1), (CROWN, -1)):
        law = corner(closing=closing)
        start = law.start if lip < 1.0 else law.opened
        assert start == pytest.approx(expected)
        turning = sense if lip < 1.0 else -sense
        assert float(law.moment_capacity(0.0, turning)) == pytest.approx(start, rel=1e-2)


@pytest.mark.parametrize(("closing", "sense", "power"), [(PLATE, 1, 6.0), (CROWN, -1, 2.0)])
def test_a_closing_corner_falls_from_its_start_and_holds_from_where_its_fold_jams(closing, sense, power):
    """Of a wide hat, whose walls do not come to lie on each other before."""
    law = corner(closing=closing, section=ClosedHat(0.060, 0.033, 0.0015, 0.020))
    assert law.jamming == 0.0
    at = np.radians(np.linspace(0.0, 60.0, 601))
    moment = law.moment_capacity(at, sense)
    assert (np.diff(moment) <= 1e-9 * law.start).all()
    fold = (1.1 if sense < 0 else 1.0) * (1.0 - 0.45 * law.slope) * law.inner.moment(at[1:])
    k = int(np.argmin(np.abs(fold - law.start))) + 1
    assert moment[k] == pytest.approx(2.0 ** (-1.0 / power) * law.start, rel=0.01)
    (jammed,) = law.kinks(sense)
    before, there, after = law.moment_capacity(np.array([0.98, 1.0, 1.02]) * jammed, sense)
    assert before > there == after
    assert (law.moment_capacity(0.2, sense) < law.moment_capacity(0.2, -sense)).all()


@pytest.mark.parametrize(("closing", "sense"), [(PLATE, 1), (CROWN, -1)])
def test_the_fold_of_a_deep_hat_jams_when_it_closes(closing, sense):
    law = corner(closing=closing)
    grown = 1.25 * (48.5 / 58.5 - 0.55) * (58.5 / (25.0 * 1.5)) ** 2
    at = law.inner.jamming_angle * np.array([0.27, 0.81, 1.35, 1.6])
    falls = replace(law, jamming=0.0)
    gain = law.moment_capacity(at, sense) / falls.moment_capacity(at, sense) - 1.0
    np.testing.assert_allclose(gain, grown * np.array([0.0, 0.5, 1.0, 1.0]))
    np.testing.assert_allclose(law.moment_capacity(at, -sense), falls.moment_capacity(at, -sense))
    # towards the line it is the member's fold
    assert corner(7.5, closing).jamming == pytest.approx(grown / 2.0)


def test_an_opened_corner_rises_towards_its_members_and_folds_at_last():
    law = corner(closing=PLATE)
    at = math.radians(4.0)
    member = law.tube.negative.peak
    risen = member - (member - law.opened) * math.exp(-at / (0.9 * law.slope))
    fold = (1.0 + 1.5 * law.slope) * float(law.outer.moment(at))
    expected = risen * (1.0 + (risen / fold) ** 4.0) ** -0.25
    assert float(law.moment_capacity(at, -1)) == pytest.approx(expected)
    early, late, last = law.moment_capacity(np.radians([1.0, 8.0, 25.0]), -1)
    assert early < late > last


@pytest.mark.parametrize("closing", [PLATE, CROWN])
@pytest.mark.parametrize("degrees", [10.0, 60.0, 100.0])
def test_no_corner_carries_more_than_its_members(closing, degrees):
    thick = ClosedHat(0.050, 0.040, 0.006, 0.020)
    member = build_law("folded_profile", thick, STEEL, "y")
    law = corner(degrees, closing, thick)
    for sense in (1, -1):
        most = float(member.moment_capacity(0.0, sense)) * (1.0 + 1e-12)
        assert float(law.moment_capacity(0.0, sense)) <= most


def test_a_plate_of_its_own_thickness_or_metal_counts_by_its_force():
    plain = corner()
    thin, soft = (
        corner(section=replace(HAT, plate_thickness=0.0008)),
        corner(section=replace(HAT, plate_material=replace(STEEL, yield_stress=200e6))),
    )
    assert thin.start < plain.start
    assert soft.start < plain.start
    same = corner(section=replace(HAT, plate_thickness=0.0015, plate_material=STEEL, hat_material=STEEL))
    assert same.start == pytest.approx(plain.start)


def test_a_metal_that_hardens_does_so_as_in_the_tube_around():
    hard = corner(metal=replace(STEEL, hardening=Voce(350e6, 150e6, 0.05)))
    share = hard.moment_capacity(0.3, -1) / corner().moment_capacity(0.3, -1)
    assert share == pytest.approx(float(hard.effect.at(0.3)))
    assert share > 1.1


def test_a_corner_across_the_hats_has_no_law():
    with pytest.raises(InputError, match="no law of a corner of closed hats about this axis"):
        build_law("mitred_corner", HAT, STEEL, "z", angle=RIGHT)


@pytest.mark.parametrize("inside", [PLATE, CROWN])
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("arm", ["[corner, tip]", "[tip, corner]"])
@pytest.mark.parametrize("post", ["[foot, corner]", "[corner, foot]"])
def test_automatic_hinges_have_it_whichever_side_is_inside(inside, side, arm, post):
    """The frame, its mirror image and any order of its nodes have one law; pushed down it closes."""
    structure = frame(inside, side=side, arm=arm, post=post)
    hinge = next(one for one in plastic_hinges(structure) if one.name == "corner-corner")
    expected = corner(closing=inside)
    assert hinge.law.start == pytest.approx(expected.start)
    assert hinge.law.closing is expected.closing
    # an arm to +x closes by a rotation of the tip about +y in the part beyond the hinge
    beyond = 1.0 if post == "[foot, corner]" else -1.0
    turned = np.array([0.0, beyond * side, 0.0]) @ hinge.direction
    weak = 1 if turned > 0.0 else -1
    assert hinge.law.moment_capacity(0.2, weak) < hinge.law.moment_capacity(0.2, -weak)


def test_both_ways_round_are_two_places_and_the_sub_model_has_the_angle_of_its_own():
    both = {inside: corners(frame(inside))["corner"] for inside in (PLATE, CROWN)}
    for inside, found in both.items():
        structure = frame(inside)
        assert found.turned is (inside == CROWN)
        model = Bending(HAT, STEEL, "y", angle=found.turn)
        assert model.place == found.place(structure)
        assert model.closes is (inside == PLATE)
        assert ("closed" if inside == PLATE else "opened") in model.title
    assert both[PLATE].place(frame(PLATE)) != both[CROWN].place(frame(CROWN))


@pytest.mark.parametrize(
    ("degrees", "section", "said"),
    [
        (60.0, HAT, None),
        (30.0, HAT, None),
        (25.0, HAT, "corners of 30 to 90 deg were solved"),
        (60.0, replace(HAT, thickness=0.003), "corners of other hats were solved by shells .width/thickness"),
        (60.0, replace(HAT, plate_thickness=0.001), "plate like the hat"),
    ],
)
def test_corners_unlike_those_that_were_solved_have_no_band(degrees, section, said):
    validity = corner(degrees, section=section).validity
    assert validity.uncertainty == (0.25 if said is None else None)
    told = [one for one in validity.warnings if "spot welds" not in one]
    assert len(told) == (said is not None)
    assert said is None or re.search(said, told[0])


@pytest.mark.parametrize(("inside", "closing", "opening"), [(PLATE, 400.0, 300.0), (CROWN, 300.0, 400.0)])
def test_a_stored_law_acts_about_the_axis_of_the_section_in_this_position(inside, closing, opening, tmp_path):
    place = corners(frame(inside))["corner"].place(frame(inside))
    stored = law_text(place, 400.0, 300.0, corner="made up")
    structure = frame(inside, laws=store_of(tmp_path / "laws", stored))
    hinge = next(one for one in plastic_hinges(structure) if one.name == "corner-corner")
    closes = 1 if hinge.direction[1] > 0.0 else -1
    assert float(hinge.law.moment_capacity(0.1, closes)) == closing
    assert float(hinge.law.moment_capacity(0.1, -closes)) == opening


@pytest.mark.parametrize(("inside", "across"), [(PLATE, 2), (CROWN, 0)])
def test_a_structure_needs_the_sub_model_of_its_side_inside(inside, across):
    structure = frame(inside, velocity="[0 m/s, 5 m/s, 0 m/s]")
    models = [one.model for one in needed(structure, 0.3) if one.where == ("corner",)]
    in_plane = next(one for one in models if isinstance(one, Bending))
    assert in_plane.angle == pytest.approx(RIGHT if inside == PLATE else -RIGHT)
    assert in_plane.piece > 0.2
    assert sum(isinstance(one, OutOfPlane) for one in models) == across
