"""Rigid joints take a part of their members: hinges lie half a fold outside of it."""

from __future__ import annotations

import math

import pytest

from crumple.analysis import loads
from crumple.section import half_fold_length
from crumple.structure import hinge_places
from crumple.structure.hinges.joint_reach import LARGEST_SHARE, joint_reach

T_FRAME = """crumple: 1
materials:
  steel: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}}
sections:
  chord: {{type: rectangular_tube, width: 40 mm, depth: 60 mm, thickness: 2 mm}}
  stem: {{type: rectangular_tube, width: 30 mm, depth: 20 mm, thickness: 2 mm}}
nodes: {{left: [-0.4 m, 0 m, 0 m], middle: [0 m, 0 m, 0 m], right: [0.4 m, 0 m, 0 m], tip: {tip}}}
members:
  left_arm: {{nodes: [left, middle], section: chord, material: steel}}
  right_arm: {{nodes: [middle, right], section: chord, material: steel}}
  stem: {{nodes: [middle, tip], section: stem, material: steel}}
hinges: auto
supports:
  a: {{node: left, fix: all}}
  b: {{node: right, fix: all}}
masses: {{payload: {{node: tip, mass: 10 kg}}}}
initial_velocity: [{{nodes: [tip], translation: [5 m/s, 0 m/s, 0 m/s]}}]
analysis: {{duration: 1 ms}}
"""


def test_a_stem_begins_at_the_face_of_its_chord_and_the_chord_beside_the_stem():
    structure = loads(T_FRAME.format(tip="[0 m, 0 m, 0.4 m]")).structure
    assert joint_reach(structure, "stem", "middle") == pytest.approx(0.030)
    # the stem's z axis lies along the chord
    assert joint_reach(structure, "left_arm", "middle") == pytest.approx(0.010)
    assert joint_reach(structure, "stem", "tip") == 0.0
    assert joint_reach(structure, "left_arm", "left") == 0.0
    at = {place.name: place.station for place in hinge_places(structure)}
    half = half_fold_length(structure.section_of("stem"), "y")
    assert at["stem-middle"] == pytest.approx(0.030 + half)


@pytest.mark.parametrize("turn", [60.0, 120.0])
def test_an_oblique_stem_begins_where_its_nearer_wall_leaves_the_face(turn):
    angle = math.radians(turn)
    tip = f"[{0.5 * math.cos(angle)} m, 0 m, {0.5 * math.sin(angle)} m]"
    structure = loads(T_FRAME.format(tip=tip)).structure
    # half depths: 30 mm of the chord, 10 mm of the stem; the sharper side decides
    sharp = math.radians(60.0)
    expected = (0.030 + 0.010 * math.cos(sharp)) / math.sin(sharp)
    assert joint_reach(structure, "stem", "middle") == pytest.approx(expected)


def test_a_joint_takes_a_share_of_a_short_member_at_most():
    structure = loads(T_FRAME.format(tip="[0 m, 0 m, 0.05 m]")).structure
    assert joint_reach(structure, "stem", "middle") == pytest.approx(LARGEST_SHARE * 0.05)


def test_mitred_corners_have_no_joint_between_their_members():
    corner = T_FRAME.format(tip="[0 m, 0 m, 0.4 m]").replace("section: stem", "section: chord")
    corner = corner.replace("  right_arm: {nodes: [middle, right], section: chord, material: steel}\n", "")
    corner = corner.replace("  b: {node: right, fix: all}\n", "").replace("right: [0.4 m, 0 m, 0 m], ", "")
    structure = loads(corner).structure
    assert joint_reach(structure, "stem", "middle") == 0.0
