"""A frame that is pushed out of its plane folds in torsion, as its shell model does.

An L of two tubes 50x25x2.65 mm (488 MPa, 0.4 m each), clamped at the foot of its post and pushed by 200 mm
across its plane at the tip of its arm within 100 ms. Automatic hinges. The post twists: its plastic torque is
reached before the plastic moments. Expected: rotations of the knee in the shell model of the same input
(5 mm elements, energy residual 6e-8), solved once by this program, with `hinges: auto` for its zones.
Tolerance: 2 degrees, since the bars are rigid and the torque does not fall. Forces are overestimated for
the same reasons: the work is 708 J, that of the shells 534 J; without twist it was 1320 J.

Kind: independent calculation.  Source: run here.
"""

import math

import pytest

import crumple

FRAME = """
crumple: 1
title: L-frame out of its plane
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 488 MPa}
sections: {tube: {type: rectangular_tube, width: 50 mm, depth: 25 mm, thickness: 2.65 mm}}
nodes: {root: [0 m, 0 m, 0 m], knee: [0 m, 0 m, 0.4 m], tip: [0.4 m, 0 m, 0.4 m]}
members:
  post: {nodes: [root, knee], section: tube, material: steel}
  arm: {nodes: [knee, tip], section: tube, material: steel}
hinges: auto
supports:
  clamp: {node: root, fix: all}
  push: {node: tip, motion: {y: {havsin: {x0: 0 ms, h0: 0 mm, x1: 100 ms, h1: 200 mm}}}}
analysis: {duration: 100 ms, shell: {element_size: 10 mm, fine_size: 5 mm, fine_length: 70 mm}}
outputs: {every: 50 ms, nodes: [knee]}
"""
SHELLS = {"z": (10.5, 22.5), "x": (-3.4, -6.7)}
"""Rotations of the knee at 50 and 100 ms [deg]."""


@pytest.fixture(scope="module")
def frame():
    return crumple.solve(crumple.loads(FRAME))


@pytest.mark.parametrize("axis", SHELLS)
def test_knee_rotates_as_in_shells(frame, axis, record_figure):
    found = frame.channels[f"node.knee.rotation.{axis}"].values
    for value, expected, time in zip(found[1:], SHELLS[axis], (50, 100), strict=True):
        name = f"rotation of the knee about {axis} at {time} ms"
        record_figure(name, math.degrees(value), expected, 2.0, "deg")
