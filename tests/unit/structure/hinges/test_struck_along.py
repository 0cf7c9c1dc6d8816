"""Members shorten where an obstacle meets a node in front of them."""

from __future__ import annotations

from crumple.analysis import loads
from crumple.structure.hinges.lengthening.struck import strikes_along

FRAME = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}
sections:
  rail: {type: square_tube, side: 40 mm, thickness: 2 mm}
  beam: {type: rectangular_tube, width: 40 mm, depth: 60 mm, thickness: 2.5 mm}
nodes:
  left_end: [0 m, 0.3 m, 0 m]
  left: [0 m, 0.2 m, 0 m]
  right: [0 m, -0.2 m, 0 m]
  left_rear: [0.4 m, 0.2 m, 0 m]
  right_rear: [0.4 m, -0.2 m, 0 m]
members:
  tip: {nodes: [left_end, left], section: beam, material: steel}
  front: {nodes: [left, right], section: beam, material: steel}
  left_rail: {nodes: [left, left_rear], section: rail, material: steel}
  right_rail: {nodes: [right, right_rear], section: rail, material: steel}
hinges: auto
masses: {car: {node: left_rear, mass: 100 kg}}
obstacles:
  wall: {type: plane, point: [-0.1 m, 0 m, 0 m], normal: [1, 0, 0]}
initial_velocity: [{translation: [-5 m/s, 0 m/s, 0 m/s]}]
analysis: {duration: 1 ms}
"""
RAIL = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}
sections: {rail: {type: square_tube, side: 40 mm, thickness: 2 mm}}
nodes: {front: [0 m, 0 m, 0 m], rear: [0.4 m, 0 m, 0 m]}
members: {rail: {nodes: [front, rear], section: rail, material: steel}}
hinges: auto
masses: {car: {node: rear, mass: 100 kg}}
obstacles:
  wall: {type: plane, point: [-0.1 m, 0 m, 0 m], normal: [1, 0, 0]}
initial_velocity: [{translation: [-5 m/s, 0 m/s, 0 m/s]}]
analysis: {duration: 1 ms}
"""
WALL = "normal: [1, 0, 0]"
CORNERS = [
    ("  left_end: [0 m, 0.3 m, 0 m]\n", ""),
    ("  tip: {nodes: [left_end, left], section: beam, material: steel}\n", ""),
    ("section: beam", "section: rail"),
]
"""A front beam that ends at its rails, of the same tube."""


def along(text, *changes):
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return strikes_along(loads(text).structure)


def test_a_joint_behind_a_beam_that_is_struck_along_its_length_counts():
    assert along(FRAME)


def test_a_wall_that_is_tilted_against_the_beam_meets_its_joint_later():
    # its tip comes first
    assert along(FRAME, (WALL, "normal: [1, -0.3, 0]"))
    # a floor meets the whole frame, with nothing behind its joints
    assert not along(
        FRAME, ("point: [-0.1 m, 0 m, 0 m]", "point: [0 m, 0 m, -0.1 m]"), (WALL, "normal: [0, 0, 1]")
    )


def test_a_free_end_that_meets_a_wall_along_its_axis_counts():
    assert along(RAIL)
    assert along(RAIL, (WALL, "normal: [1, 0.8, 0]"))
    assert not along(RAIL, (WALL, "normal: [1, 2, 0]"))


def test_a_clamp_stands_on_a_wall_and_does_not_meet_it():
    assert not along(RAIL, ("masses:", "supports: {foot: {node: front, fix: all}}\nmasses:"))


def test_a_mitred_corner_counts_for_a_plane_and_not_for_a_pole_which_dents_it():
    assert along(FRAME, *CORNERS)
    pole = "{type: cylinder, point: [-0.1 m, 0.2 m, 0 m], axis: [0, 0, 1], radius: 50 mm}"
    assert not along(FRAME, *CORNERS, ("{type: plane, point: [-0.1 m, 0 m, 0 m], normal: [1, 0, 0]}", pole))


def test_the_edge_of_a_plane_meets_only_what_is_nearest():
    tilted = "point: [-0.2 m, 0 m, 0 m], normal: [1, -0.3, 0]"
    assert along(FRAME, ("point: [-0.1 m, 0 m, 0 m], normal: [1, 0, 0]", tilted))
    assert not along(FRAME, ("point: [-0.1 m, 0 m, 0 m], normal: [1, 0, 0]", f"{tilted}, edge: [0, 0, 1]"))


def test_nothing_counts_that_does_not_move():
    assert not along(RAIL, ("initial_velocity: [{translation: [-5 m/s, 0 m/s, 0 m/s]}]\n", ""))
