"""A frame that is pushed out of its plane folds at its corner, as its shell model does.

An L of two tubes 50x25x2.65 mm (488 MPa, 0.4 m each), clamped at the foot of its post and pushed by 200 mm
across its plane at the tip of its arm within 100 ms. Automatic hinges with formulas and estimates alone,
rigid and elastic members. Expected: work of the push at 60, 80 and 100 ms and rotations of the arm about the
post and about the normal of the frame's plane in the shell model of the same input (5 mm elements, energy
residual 6e-8), solved once by this program. Tolerance: the band of 15 % of the law of the corner, and 2
degrees (found: 4 % and 0.1 degrees); with rigid members, which do not bend before the corner folds, 15 % and
5 degrees (found: 12 % and 4.5 degrees). (Without a law of the corner the work is 689 J, and without twist of
the post 1320 J. Without the shift of its set the corner opened by 4 degrees.)

Round tubes, drawn and solved with shells after the law of their corners (10 and 12 mm elements, half of that
in the folds): an L of 50x2 mm whose tip is thrown across its plane, and an arm of three pieces of 60x2.5 mm
in space. Tolerance: the targets of the concordance, 10 % of displacements and 15 % of rotations or 2 degrees;
6 mm of the small displacement p (found: 5.4). (With the law of the member about the bisector the corner of
the L did not turn, its foot by 16 degrees; q of the L was 18 % too small, and p of the arm 17 mm too large.)

Kind: independent calculation.  Source: run here.
"""

import math

import numpy as np
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
analysis:
  duration: 100 ms
  multibody: {members: rigid}
  shell: {element_size: 10 mm, fine_size: 5 mm, fine_length: 70 mm}
outputs: {every: 20 ms, nodes: [tip]}
"""
WORK = {60: 324.0, 80: 477.0, 100: 534.0}
"""Work [J] at times [ms] in shells."""
ARM, NORMAL = 31.2, 6.4
"""Rotations of the arm about the post, and about the normal, at the end in shells [deg]."""
WITHIN = {"rigid": (0.15, 5.0), "elastic": (0.15, 2.0)}
"""Tolerances of work [-] and rotations [deg]."""


@pytest.fixture(scope="module", params=["rigid", "elastic"])
def frame(request):
    source = crumple.loads(FRAME.replace("members: rigid", f"members: {request.param}"))
    return crumple.solve(source), *WITHIN[request.param]


@pytest.mark.parametrize("time", WORK)
def test_work_is_that_of_the_shells(frame, time, record_figure):
    result, share, _ = frame
    found = float(np.interp(time * 1e-3, result.time, result["energy.external_work"]))
    record_figure(f"work at {time} ms", found, WORK[time], share, "J", relative=True)


def test_the_arm_turns_as_in_shells(frame, record_figure):
    result, _, within = frame
    for axis, name, expected in (("z", "post", ARM), ("y", "normal", NORMAL)):
        turned = math.degrees(result[f"node.tip.rotation.{axis}"][-1])
        record_figure(f"rotation of the arm about the {name} at 100 ms", turned, expected, within, "deg")


ROUND = """
crumple: 1
title: bent round tube
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections: {tube: {type: circular_tube, SIZE}}
"""
ELL = (
    ROUND.replace("SIZE", "diameter: 50 mm, thickness: 2 mm")
    + """
nodes: {o: [0 m, 0 m, 0 m], p: [0 m, 0 m, 0.5 m], q: [0.45 m, 0 m, 0.5 m]}
members:
  post: {nodes: [o, p], section: tube, material: steel}
  arm: {nodes: [p, q], section: tube, material: steel}
hinges: auto
supports: {clamp: {node: o, fix: all}}
masses: {tip: {node: q, mass: 12 kg}}
initial_velocity: [{translation: [0 m/s, 8 m/s, 0 m/s], nodes: [q]}]
analysis: {duration: 50 ms, multibody: {mechanism_check: off}}
outputs: {every: 0.5 ms, nodes: [p, q]}
"""
)
ARM_IN_SPACE = (
    ROUND.replace("SIZE", "diameter: 60 mm, thickness: 2.5 mm")
    + """
nodes: {o: [0 m, 0 m, 0 m], p: [0.45 m, 0 m, 0 m], q: [0.45 m, 0.3 m, 0.3 m], e: [0.8 m, 0.3 m, 0.3 m]}
members:
  first: {nodes: [o, p], section: tube, material: steel}
  second: {nodes: [p, q], section: tube, material: steel}
  third: {nodes: [q, e], section: tube, material: steel}
hinges: auto
supports: {clamp: {node: o, fix: all}}
masses: {tip: {node: e, mass: 15 kg}}
initial_velocity: [{translation: [0 m/s, -2 m/s, -7 m/s], nodes: [e]}]
analysis: {duration: 60 ms, multibody: {mechanism_check: off}}
outputs: {every: 0.5 ms, nodes: [p, q, e]}
"""
)


def displacement(result, node):
    """Largest displacement of a node [m]."""
    moved = [result[f"node.{node}.displacement.{axis}"] for axis in "xyz"]
    return float(np.linalg.norm(moved, axis=0).max())


def test_an_l_of_round_tubes_folds_at_its_corner_as_in_shells(record_figure):
    result = crumple.solve(crumple.loads(ELL))
    assert result.status.ok, result.reason
    record_figure("displacement of the tip", displacement(result, "q"), 0.2317, 0.10, "m", relative=True)
    corner = result.hinges["corner-p"].rotation_max
    record_figure("rotation of the corner", corner, 0.575, 0.15, "rad", relative=True)
    assert result.hinges["post-o"].rotation_max < 0.1 * corner


def test_a_bent_arm_of_round_tubes_in_space_folds_at_both_corners_as_in_shells(record_figure):
    result = crumple.solve(crumple.loads(ARM_IN_SPACE))
    assert result.status.ok, result.reason
    for node, shells, within in (("p", 0.0114, 0.006), ("q", 0.0728, 0.0073), ("e", 0.1448, 0.0145)):
        record_figure(f"displacement {node}", displacement(result, node), shells, within, "m")
    for node, shells in (("p", 0.1447), ("q", 0.127)):
        corner = result.hinges[f"corner-{node}"].rotation_max
        record_figure(f"rotation of corner {node}", corner, shells, math.radians(2.0), "rad")
