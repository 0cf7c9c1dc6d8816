"""A corner at which something acts has a rigid section: it folds in its members, outside of the mitre."""

from __future__ import annotations

import math

import pytest

from crumple.analysis import loads
from crumple.shell.mesh.mesh import mesh_of
from crumple.structure import ShellSettings, hinge_places
from crumple.structure.hinges.corners import corners, untreated
from crumple.structure.hinges.joint_reach import joint_reach
from crumple.structure.hinges.law_choice import distance_of_fold

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
