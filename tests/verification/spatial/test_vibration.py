"""Vibration above the resolved frequency does not shorten steps, keeps its energy, and changes folds little.

A bar on an elastic hinge of stiffness k that turns with inertia J vibrates with sqrt(k/J)/(2 pi).  Where this
is above the resolved frequency, steps may be longer than its period; the trapezoidal rule keeps its energy.

A frame of two posts and a beam, struck across its plane, folds as with all vibration resolved, within the
accuracy of 1e-3 that both runs state and as much again, in fewer steps.

Kind: invariant.  Source: derived here.
"""

import math

import numpy as np

from crumple.analysis import loads, solve

SPINNER = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 3 GPa}
sections:
  tube: {type: rectangular_tube, width: 50 mm, depth: 25 mm, thickness: 2.65 mm}
nodes: {a: [0 m, 0 m, 0 m], b: [0 m, 0.2 m, 0 m]}
members:
  bar: {nodes: [a, b], section: tube, material: steel, hinges: [{name: h, at: 50 mm, axis: y, law: stiff}]}
hinge_laws:
  stiff: {type: constant, moment: 100 kN*m, form: elastic-plastic, elastic_stiffness: 2000 kN*m/rad}
supports: {clamp: {node: a, fix: all}}
impulses: [{node: b, impulse: [0 N*s, 0 N*s, 1 N*s]}]
analysis:
  duration: 50 ms
  multibody: {kernel: spatial, resolved_frequency: FREQUENCY}
"""
FRAME = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}
sections:
  tube: {type: square_tube, side: 40 mm, thickness: 2.5 mm}
nodes: {a: [0 m, 0 m, 0 m], b: [0 m, 0 m, 0.6 m], c: [0.8 m, 0 m, 0.6 m], d: [0.8 m, 0 m, 0 m]}
members:
  left: {nodes: [a, b], section: tube, material: steel, hinges: auto}
  beam: {nodes: [b, c], section: tube, material: steel, hinges: auto}
  right: {nodes: [d, c], section: tube, material: steel, hinges: auto}
supports: {left: {node: a, fix: all}, right: {node: d, fix: all}}
masses: {one: {node: b, mass: 20 kg}}
impulses: [{node: b, impulse: [20 N*s, 150 N*s, 0 N*s]}]
analysis: {duration: 40 ms, multibody: {members: elastic, resolved_frequency: FREQUENCY}}
"""


def solved(text, frequency):
    result = solve(loads(text.replace("FREQUENCY", frequency)), checks=False)
    assert result.status.ok, result.reason
    return result


def test_a_vibration_that_is_not_resolved_keeps_its_energy(record_figure):
    coarse, fine = solved(SPINNER, "20 Hz"), solved(SPINNER, "1 MHz")
    steps, all_steps = (run.provenance.settings["steps"] for run in (coarse, fine))
    record_figure("steps over those that resolve the vibration", steps / all_steps, 0.0, 0.1)
    total = sum(coarse.channels[name].values for name in ("energy.kinetic", "energy.elastic"))
    record_figure("energy at the end over that at the start", total[-1] / total[1], 1.0, 1e-3)


def test_a_frame_folds_as_if_all_vibration_were_resolved(record_figure):
    coarse, fine = solved(FRAME, "500 Hz"), solved(FRAME, "1 MHz")
    rotations = np.array([[run.hinges[name].rotation_max for name in fine.hinges] for run in (coarse, fine)])
    assert rotations.max() > math.radians(8)
    error = np.abs(rotations[0] - rotations[1]).max() / rotations.max()
    record_figure("change of a rotation over the largest", error, 0.0, 2e-3)
    steps, all_steps = (run.provenance.settings["steps"] for run in (coarse, fine))
    record_figure("steps over those that resolve the vibration", steps / all_steps, 0.0, 0.7)
