"""The node of a mitred corner is the middle of both members' ends, whichever of them the file names first."""

from __future__ import annotations

import numpy as np
import pytest

from crumple.analysis import loads, solve

RAIL = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections: {tube: {type: square_tube, side: 50 mm, thickness: 2 mm}}
nodes: {front: [0 m, 0 m, 0 m], bend: [0.3 m, 0 m, 0 m], rear: [0.6 m, 0 m, 0.1 m]}
members:
MEMBERS
supports: {sled: {node: rear, fix: [y, z, rx, ry, rz]}}
masses: {sled: {node: rear, mass: 50 kg}}
initial_velocity: [{translation: [-5 m/s, 0 m/s, 0 m/s]}]
obstacles: {wall: {type: plane, point: [-1 mm, 0 m, 0 m], normal: [1, 0, 0], friction: 0.3}}
analysis: {duration: 10 ms, multibody: {members: elastic, mechanism_check: off}}
outputs: {nodes: [bend], distances: {gap: {from: bend, to: rear}}}
"""
FIRST = "  first: {nodes: [front, bend], section: tube, material: steel}"
SECOND = "  second: {nodes: [bend, rear], section: tube, material: steel}"


def run(*members):
    return solve(loads(RAIL.replace("MEMBERS", "\n".join(members))))


def test_the_order_of_the_members_does_not_move_the_node():
    one, other = run(FIRST, SECOND), run(SECOND, FIRST)
    # the corner shortens by far more than the results may differ
    assert np.abs(one["hinge.corner-bend.slip.x.travel"]).max() > 3e-3
    names = [f"node.bend.{kind}.{axis}" for kind in ("displacement", "rotation") for axis in "xyz"]
    # the legs vibrate after the impact, in another phase if the slip turns with the other member
    later = one.time > 5e-3
    for name in [*names, "gap"]:
        scale = np.abs(one[name]).max()
        found, expected = (result[name][later].mean() for result in (one, other))
        assert found == pytest.approx(expected, abs=0.02 * scale + 1e-12), name


def test_the_node_turns_by_the_mean_of_both_sides():
    found = run(FIRST, SECOND)
    turned = np.abs(found["hinge.corner-bend.rotation"])[-1]
    assert turned > 0.1
    # the legs turn in opposite senses by half each, but for what they bend
    assert abs(found["node.bend.rotation.y"][-1]) < 0.3 * turned
