"""Rigid joints take a part of their members: hinges lie outside; members yield where one is struck."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from crumple.analysis import loads
from crumple.hinge import Freedom
from crumple.section import fold_distance
from crumple.structure import Structure, hinge_places, plastic_hinges, with_elastic_members
from crumple.structure.hinges.joint_reach import LARGEST_SHARE, joint_reach, strikes_joint
from crumple.structure.hinges.lengthening.stopped import stopped

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
    half = fold_distance(structure.section_of("stem"), "y")
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


STRUCK = """crumple: 1
materials:
  steel: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}}
sections: {{tube: {{type: square_tube, side: 40 mm, thickness: 2 mm}}}}
nodes: {{left: [-0.4 m, 0 m, 0 m], middle: [0 m, 0 m, 0 m], right: [0.4 m, 0 m, 0 m], tip: [0 m, 0 m, 0.4 m]}}
members:
  left_arm: {{nodes: [left, middle], section: tube, material: steel}}
  right_arm: {{nodes: [middle, right], section: tube, material: steel}}
  stem: {{nodes: [middle, tip], section: tube, material: steel}}
hinges: {hinges}
masses: {{payload: {{node: tip, mass: 10 kg}}}}
obstacles: {{ball: {{type: sphere, point: {at}, radius: 50 mm, mass: 20 kg, guide: [0, 0, 1], {more}}}}}
analysis: {{duration: 1 ms}}
"""
RISES = "velocity: [0 m/s, 0 m/s, 5 m/s]"


def struck(at, more=RISES, hinges="auto"):
    """The T-frame, free and at rest, and a ball below it."""
    return loads(STRUCK.format(at=at, more=more, hinges=hinges))


def test_a_joint_is_struck_where_it_is_nearest_to_what_moves():
    assert strikes_joint(struck("[0 m, 0 m, -0.1 m]").structure)
    # the wall of an arm, and the free end of one
    assert not strikes_joint(struck("[0.16 m, 0 m, -0.1 m]").structure)
    assert not strikes_joint(struck("[0.4 m, 0 m, -0.1 m]").structure)
    # above the joint's node, but within its reach of the stem, 20 mm
    assert strikes_joint(struck("[0.1 m, 0 m, 0.012 m]", more=f"{RISES}, members: [stem]").structure)
    assert not strikes_joint(struck("[0.1 m, 0 m, 0.04 m]", more=f"{RISES}, members: [stem]").structure)
    # nothing moves; it touches the stem alone
    assert not strikes_joint(struck("[0 m, 0 m, -0.1 m]", more="friction: 0.1").structure)
    assert strikes_joint(struck("[0 m, 0 m, -0.1 m]", more=f"{RISES}, members: [stem]").structure)


@pytest.mark.parametrize("turn", [0.0, 5.0, 21.0, 37.0, 83.0, 111.0, 160.0])
@pytest.mark.parametrize("swapped", [False, True])
def test_a_pole_along_a_member_is_as_near_to_its_joint_as_to_its_middle(turn, swapped):
    """Rounding decided which of the places along the arm was the nearest one."""
    axis = np.array([1.0, 2.0, -1.0])
    turned = Rotation.from_rotvec(math.radians(turn) * axis / np.linalg.norm(axis)).as_matrix()
    nodes = {"left": (-0.4, 0, 0), "middle": (0, 0, 0), "tip": (0, 0, 0.4), "foot": (0, 0.4, 0)}
    ends = {"arm": ("middle", "left"), "stem": ("middle", "tip"), "leg": ("middle", "foot")}
    pole = {
        "type": "cylinder",
        "point": (-0.2, 0.0, -0.1),
        "axis": (1.0, 0.0, 0.0),
        "velocity": (0.0, 0.0, 5.0),
    }
    steel = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 350e6}
    structure = Structure(
        materials={"steel": steel},
        sections={"tube": {"type": "square_tube", "side": 0.04, "thickness": 0.002}},
        nodes={name: tuple(turned @ place) for name, place in nodes.items()},
        members={
            name: {"nodes": pair[::-1] if swapped else pair, "section": "tube", "material": "steel"}
            for name, pair in ends.items()
        },
        hinges="auto",
        obstacles={
            "pole": {
                key: tuple(turned @ np.array(value)) if isinstance(value, tuple) else value
                for key, value in (pole | {"radius": 0.05, "mass": 20.0}).items()
            }
        },
    )
    assert strikes_joint(structure)


@pytest.mark.parametrize(
    ("arm", "stem"), [(arm, stem) for arm in ("left, middle", "middle, left") for stem in "st"]
)
@pytest.mark.parametrize(("x", "joint"), [(0.06, True), (0.14, True), (-0.26, False)])
def test_a_face_that_meets_an_arm_flush_strikes_the_joint_at_its_end_however_members_are_named(
    x, joint, arm, stem
):
    """The wedge lies below the arm up to x: its face ends beyond the node, or short of it."""
    text = STRUCK.format(at="[0 m, 0 m, 0 m]", more="", hinges="auto")
    start = text.index("obstacles:")
    plane = f"{{type: plane, point: [{x} m, 0 m, -0.1 m], normal: [0, 0, 1], edge: [1, 0, 0], {RISES}}}"
    text = text[:start] + f"obstacles: {{plane: {plane}}}\nanalysis: {{duration: 1 ms}}\n"
    text = text.replace("nodes: [left, middle]", f"nodes: [{arm}]")
    if stem == "s":
        line = "  stem: {nodes: [middle, tip], section: tube, material: steel}\n"
        text = text.replace(line, "").replace("members:\n", "members:\n" + line)
    assert strikes_joint(loads(text).structure) is joint


@pytest.mark.parametrize(
    ("at", "hinges", "yields"),
    [
        ("[0 m, 0 m, -0.1 m]", "auto", True),
        ("[0 m, 0 m, -0.1 m]", "{axial: false}", False),
        ("[0.16 m, 0 m, -0.1 m]", "auto", False),
    ],
)
def test_elastic_members_yield_along_their_axes_where_a_joint_is_struck(at, hinges, yields):
    analysis = struck(at, hinges=hinges)
    bends = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
    assert {Freedom.AXIAL in freedoms(hinge) for hinge in plastic_hinges(bends)} == {yields}
    # rigid bars do so where the impact would stop the structure, as it does these 10 kg on the stem
    assert {Freedom.AXIAL in freedoms(hinge) for hinge in plastic_hinges(analysis.structure)} == {yields}
    assert stopped(analysis.structure) is (at == "[0 m, 0 m, -0.1 m]")


@pytest.mark.parametrize(
    ("section", "folds"),
    [
        ("square_tube, side: 40 mm", True),
        ("circular_tube, diameter: 40 mm", True),
        ("angle, width: 40 mm, depth: 40 mm", False),
    ],
)
def test_tubes_fold_by_the_law_of_their_section_and_others_yield(section, folds):
    begin, end = STRUCK.split("square_tube, side: 40 mm")
    text = (begin + section + end).format(at="[0 m, 0 m, -0.1 m]", more=RISES, hinges="auto")
    analysis = loads(text)
    bends = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
    for hinge in plastic_hinges(bends):
        axial = hinge.spatial.components[hinge.spatial.freedoms.index(Freedom.AXIAL)].record
        least, most = axial.negative.moment.min(), axial.negative.moment.max()
        assert (least < 0.7 * most) == folds
        assert axial.positive.moment.min() == axial.positive.moment.max()


def freedoms(hinge):
    return set() if hinge.spatial is None else {component.freedom for component in hinge.spatial.components}


BOXES = """crumple: 1
materials:
  steel: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}}
sections:
  box: {{type: square_tube, side: 60 mm, thickness: 1.8 mm}}
  beam: {{type: square_tube, side: {side} mm, thickness: 4 mm}}
nodes: {{l0: [0 m, 0.4 m, 0 m], l1: [-0.2 m, 0.4 m, 0 m], r0: [0 m, -0.4 m, 0 m], r1: [-0.2 m, -0.4 m, 0 m]}}
members:
  bl: {{nodes: [l1, l0], section: box, material: steel, hinges: {{axial: {{law: square}}}}}}
  br: {{nodes: [r1, r0], section: box, material: steel, hinges: {{axial: {{law: square}}}}}}
  beam: {{nodes: [l0, r0], section: beam, material: steel}}
  tie: {{nodes: [l1, r1], section: beam, material: steel}}
hinges: auto
masses: {{ml: {{node: l1, mass: 500 kg}}, mr: {{node: r1, mass: 500 kg}}}}
initial_velocity: [{{translation: [7 m/s, 0 m/s, 0 m/s]}}]
analysis: {{duration: 1 ms}}
"""


def test_a_tube_between_joints_folds_over_what_lies_between_them():
    """200 mm between nodes; beams of 60 and 40 mm leave 140 and 160 mm."""

    def strokes(side):
        hinges = plastic_hinges(loads(BOXES.format(side=side)).structure)
        axial = (
            part.record
            for hinge in hinges
            if hinge.member == "bl"
            for part in hinge.spatial.components
            if part.freedom == Freedom.AXIAL
        )
        return {record.stop_negative.rotation for record in axial}

    (short,), (long,) = strokes(60), strokes(40)
    assert short / long == pytest.approx(140.0 / 160.0)
    # folds are solid when a tenth of the length is left
    assert short == pytest.approx(0.9 * 0.140)
