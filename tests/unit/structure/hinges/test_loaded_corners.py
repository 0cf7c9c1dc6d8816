"""A corner at which something acts has a rigid section: it folds in its members, outside of the mitre."""

from __future__ import annotations

import math

import pytest

from crumple.analysis import loads
from crumple.hinge.tube_library.clamped import clamped_fold_distance
from crumple.shell.mesh.mesh import mesh_of
from crumple.structure import ShellSettings, hinge_places
from crumple.structure.hinges.corners import corners, untreated
from crumple.structure.hinges.joint_reach import joint_reach
from crumple.structure.hinges.law_choice import distance_of_fold
from crumple.structure.hinges.places import law_spec

BENT = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections:
  tube: {type: rectangular_tube, width: 40 mm, depth: 60 mm, thickness: 2 mm}
nodes: {foot: [0 m, 0 m, 0 m], corner: [0 m, 0 m, 0.45 m], tip: TIP}
members:
  post: {nodes: [foot, corner], section: tube, material: steel}
  arm: {nodes: [corner, tip], section: tube, material: steel}
hinges: auto
supports: {clamp: {node: foot, fix: all}SUPPORT}
initial_velocity: [{nodes: [tip], translation: [0 m/s, 0 m/s, 1 m/s]}]
analysis: {duration: 1 ms}
"""
ACTING = {
    "mass": "masses: {at: {node: corner, mass: 5 kg}}\n",
    "impulse": "impulses: [{node: corner, impulse: [1 N*s, 0 N*s, 0 N*s]}]\n",
    "load": "loads: [{node: corner, force: {x: 1 kN}}]\n",
    "support": "",
}


def bent(acting="", turn=90.0):
    angle = math.radians(turn)
    tip = f"[{0.5 * math.sin(angle)} m, 0 m, {0.45 + 0.5 * math.cos(angle)} m]"
    held = ", guide: {node: corner, fix: [y]}" if acting == "support" else ""
    return loads(BENT.replace("TIP", tip).replace("SUPPORT", held) + ACTING.get(acting, "")).structure


@pytest.mark.parametrize("acting", ACTING)
def test_a_loaded_corner_folds_in_either_member_outside_of_its_mitre(acting):
    structure = bent(acting)
    assert "rigid" in untreated(structure)["corner"]
    assert not corners(structure)
    # the inner edges of two tubes of 60 mm meet 30 mm from the node
    assert joint_reach(structure, "post", "corner") == pytest.approx(0.030)
    at = {place.name: place.station for place in hinge_places(structure)}
    inside = distance_of_fold(structure, "post", "y", "clamped")
    assert at["arm-corner"] == pytest.approx(0.030 + inside)
    assert at["post-corner"] == pytest.approx(0.45 - 0.030 - inside)


def test_the_inner_edge_of_a_flat_mitre_is_nearer():
    assert joint_reach(bent("mass", 50.0), "post", "corner") == pytest.approx(
        0.030 * math.tan(math.radians(25))
    )


def test_a_corner_at_which_nothing_acts_folds_at_its_node():
    structure = bent()
    assert set(corners(structure)) == {"corner"}
    assert [place.name for place in hinge_places(structure)] == ["post-foot", "corner-corner"]


@pytest.mark.parametrize("acting", ["", *ACTING])
def test_shells_hold_the_same_sections_in_shape(acting):
    structure = bent(acting)
    assert (structure.loaded_nodes >= {"corner"}) == bool(acting)
    mesh = mesh_of(structure, ShellSettings(element_size=0.02))
    assert mesh.joints["corner"].rigid_ring == bool(acting)


def test_automatic_hinges_beside_joints_lie_where_the_law_has_the_fold():
    """Of a metal that hardens further out; not where the formula stands for the fold."""
    plain = bent("mass")
    hard = BENT.replace("yield_stress: 350 MPa", "yield_stress: 350 MPa, hardening: HARD").replace(
        "HARD", "{type: swift, prestrain: 0.01, exponent: 0.18}"
    )
    hard = loads(
        hard.replace("TIP", "[0.5 m, 0 m, 0.45 m]").replace("SUPPORT", "") + ACTING["mass"]
    ).structure
    at = [next(one for one in hinge_places(each) if one.name == "post-foot") for each in (plain, hard)]
    section, metal = hard.section_of("post"), hard.material_of("post")
    assert at[1].station == pytest.approx(clamped_fold_distance(section, metal, at[1].axis))
    assert at[1].station > 1.3 * at[0].station
    keys = law_spec(hard, at[1])
    assert keys.own["distance"] == at[1].station
    # half of what lies between the clamp and the face of the joint
    assert keys.own["span"] == pytest.approx((0.45 - 0.030) / 2.0)
