"""A straight tube between two clamps is pushed across at its middle: bending and membrane force together.

Hinges at four places turn by theta and share the stretch of the two bars evenly. With constant capacities M_p
and N_p on an ellipse, and the bars' length l between their hinges, s = sqrt(l^2 + W^2),

    P dW = 4 sqrt((M_p dtheta)^2 + (N_p de/2)^2),  dtheta = l/s^2 dW,  de = W/s dW

so that P = 4 M_p/l at the start and 2 N_p W/s, the string, at large W. The tube is pushed slowly: inertia is
below 0.1 % of the forces. Tolerance 1 %, up to rotations of 10 degrees: a hinge stretches along the part
before it, which differs from the bar by the rotation.

Kind: closed form.  Source: derived here.
"""

import math

import numpy as np
import pytest

from crumple.analysis import loads, solve
from crumple.errors import Status
from crumple.structure import plastic_hinges

MOMENT, TRAVEL, STRESS = 2000.0, 0.11, 350e6
TEXT = f"""crumple: 1
materials:
  steel: {{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 785 kg/m^3, yield_stress: {STRESS:g} Pa}}
sections:
  tube: {{type: rectangular_tube, width: 60 mm, depth: 40 mm, thickness: 2 mm}}
nodes: {{left: [0 m, 0 m, 0 m], middle: [0.6 m, 0 m, 0 m], right: [1.2 m, 0 m, 0 m]}}
members:
  first: {{nodes: [left, middle], section: tube, material: steel}}
  second: {{nodes: [middle, right], section: tube, material: steel}}
hinges: {{axial: true, coupling: ellipsoid, law: {{type: constant, moment: {MOMENT:g} N*m}}}}
supports:
  clamp_left: {{node: left, fix: all}}
  clamp_right: {{node: right, fix: all}}
  ram: {{node: middle, motion: {{z: {{table: {{time: [0 s, 0.5 s], value: [0 m, {TRAVEL:g} m]}}}}}}}}
analysis:
  duration: 0.5 s
  multibody: {{members: rigid}}
outputs: {{every: 10 ms}}
"""


@pytest.fixture(scope="module")
def pushed():
    analysis = loads(TEXT)
    return analysis.structure, solve(analysis)


@pytest.mark.parametrize("push", [0.002, 0.02, 0.05, 0.1])
def test_force_is_that_of_the_ellipse(pushed, push, record_figure):
    structure, result = pushed
    assert result.status is Status.COMPLETE, result.reason
    first, second, *_ = (hinge.station for hinge in plastic_hinges(structure))
    length, squash = second - first, STRESS * structure.section_of("first").area
    reach = math.hypot(length, push)
    expected = 4.0 * math.hypot(MOMENT * length / reach**2, squash * push / reach / 2.0)
    force = float(np.interp(push, 2.0 * TRAVEL * result.time, np.abs(result["support.ram.force.z"])))
    record_figure(f"force at {push * 1e3:g} mm", force, expected, 0.01, "N", relative=True)
