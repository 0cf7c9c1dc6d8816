"""A strut that is pressed slowly, in a quasi-static stage with elastic members.

A pinned strut of length L whose middle lies off its line by a: a kink, whose Fourier series is
8 a/pi^2 (sin(pi x/L) - sin(3 pi x/L)/9 + ...).  Under the share r of Euler's load P_E = pi^2 E I/L^2 the
first term grows to 1/(1 - r) of itself, the third to 1/(1 - r/9), so the middle moves by

    w = 8 a/pi^2 (r/(1 - r) + r/(9 (9 - r))),

and past the load by bending into an elastica, P = P_E (1 + pi^2/8 (w/L)^2).  Steps are bounded because the
deflection of a step decides what presses the member further: they used to shrink without end near P_E.

Euler's load and the growth of an initial curvature are in any book on stability of elastic bars; the term
in the square of the deflection is the elastica's first.

Kind: closed form.  Source: textbook.
"""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from crumple.analysis import loads, solve
from crumple.structure.hinges.joint_reach import joint_reach

STEEL = "{youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: YIELD}"
STRUT = """crumple: 1
materials: {steel: STEEL}
sections:
  tube: {type: circular_tube, diameter: 25.4 mm, thickness: 1.6 mm}
nodes:
  foot: [0 m, 0 m, 0 m]
  middle: [0.6 m, 0 m, OFF mm]
  head: [1.2 m, 0 m, 0 m]
members:
  first: {nodes: [foot, middle], section: tube, material: steel}
  second: {nodes: [middle, head], section: tube, material: steel}
hinges: auto
supports:
  foot: {node: foot, fix: pin}
  head: {node: head, fix: [y, z], motion: {x: {table: {time: [0 s, 1 s], value: [0 mm, -5 mm]}}}}
analysis:
  stages: [{name: push, kind: quasi-static, duration: 1 s}]
  multibody: {members: elastic, segments: 12}
outputs: {every: 20 ms, nodes: [middle]}
"""
BRACE = """crumple: 1
materials: {steel: STEEL}
sections:
  tube: {type: circular_tube, diameter: 25.4 mm, thickness: 1.6 mm}
  post: {type: square_tube, side: 50 mm, thickness: 4 mm}
nodes:
  a: [0 m, 0 m, 0 m]
  k: [0.7 m, 0 m, 1.0 m]
  p: [0.7 m, 0 m, 0 m]
members:
  brace: {nodes: [a, k], section: tube, material: steel}
  post: {nodes: [p, k], section: post, material: steel}
hinges: auto
supports:
  a: {node: a, fix: pin}
  p: {node: p, fix: all}
  drive: {node: k, motion: {x: {table: {time: [0 s, 0.4 s], value: [0 mm, -60 mm]}}}}
analysis:
  stages: [{name: push, kind: quasi-static, duration: 0.4 s}]
outputs: {every: 4 ms}
"""
MOST_STEPS = 1500


def _read(text, yields="2 GPa"):
    return loads(text.replace("STEEL", STEEL.replace("YIELD", yields)))


@pytest.mark.parametrize("off", [1.0, 0.05])
def test_a_strut_carries_the_load_of_euler(off, record_figure):
    case = _read(STRUT.replace("OFF", str(off)))
    result = solve(case)
    assert result.status.ok, result.reason
    bending = 210e9 * case.structure.section_of("first").second_moment("y")
    euler = math.pi**2 * bending / 1.2**2
    moved = result["node.middle.displacement.z"]
    force = result["support.head.force.x"] / euler
    shares = np.linspace(0.0, 1.0, 200_001)[:-1]
    kinks = 8e-3 * off / math.pi**2 * (shares / (1.0 - shares) + shares / (9.0 * (9.0 - shares)))
    for at in (10, 25, 50):
        expected = np.interp(moved[at], kinks, shares) * (1.0 + math.pi**2 / 8.0 * (moved[at] / 1.2) ** 2)
        name = (
            f"force on a strut, {off:g} mm off its line, bent by {1e3 * moved[at]:.3g} mm, over Euler's load"
        )
        # a chain of twelve bars buckles at (sin x/x)^2 of Euler's load, x = pi/24: 0.6 % below
        record_figure(name, float(force[at]), float(expected), 0.012)
        assert force[at] == pytest.approx(expected, rel=0.012)
    assert result.provenance.settings["steps"] < MOST_STEPS


def test_a_brace_buckles_and_yields_with_members_that_bend(record_figure):
    """It stopped at 11.3 kN, and was solved with rigid bars, which buckle only at the squash load."""
    case = _read(BRACE, "350 MPa")
    result = solve(case)
    assert result.status.ok, result.reason
    assert result.provenance.settings["members"] == "auto"  # not rigid instead
    assert result.provenance.settings["steps"] < MOST_STEPS
    along = np.abs(result["hinge.brace-1.slip.x.force"]).max()
    bending = 210e9 * case.structure.section_of("brace").second_moment("y")
    pinned = math.pi**2 * bending / (0.7**2 + 1.0)
    # one end pinned, the other held by the post, which turns: between pinned and clamped (2.05) ends
    # held by the post at the face of their joint: tan u = u/(1 + u^2/k), k = 4 E I_post/h over E I/L
    clear = math.hypot(0.7, 1.0) - joint_reach(case.structure, "brace", "k")
    post = 210e9 * case.structure.section_of("post").second_moment("y")
    stiff = 4.0 * post / 1.0 * clear / bending
    root = brentq(lambda u: math.sin(u) * (1.0 + u**2 / stiff) - u * math.cos(u), 3.5, 4.5)
    elastic = (root / clear) ** 2 * bending / pinned
    # a chain of six bars whose walls yield is 8 % below (12: 4 %, 24: 2.5 %)
    name = "largest force on a brace over Euler's load between pinned ends"
    record_figure(name, along / pinned, elastic, 0.09, relative=True)
    assert result["hinge.brace-1.rotation"][-1] == pytest.approx(-0.47, abs=0.05)
