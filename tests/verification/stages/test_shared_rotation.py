"""Hinges that equilibrium leaves free to share a rotation, in quasi-static stages.

- A cantilever whose end is turned slowly by phi carries one moment along its length.  Of n hinges with one
  law that hardens, M = M_0 + H theta, each turns by phi/n, and the moment is M_0 + H phi/n.  Where the law
  is constant any division is in equilibrium; they turn alike.
- A beam between clamps that is pushed at its middle has two equal hinges beside the ram, and later four that
  carry one axial force.  From rest it folds under F = 2 (M_1 + M_2)/l, the moments of the hinges at both
  ends of a bar of length l between them, with no axial force yet.
- Such a beam that has yielded along its axis is a string under the force N of its bars: a small force Q
  across it moves its middle by Q l/(2 N).

Kind: closed form.  Source: derived here.
"""

import numpy as np
import pytest

from crumple.analysis import loads, solve

FIRST, HARDENING, TURN = 1000.0, 2000.0, 0.3
BAR = """crumple: 1
materials: {steel: {grade: S355}}
sections:
  tube: {type: rectangular_tube, width: 40 mm, depth: 60 mm, thickness: 2.5 mm}
nodes:
  foot: [0 m, 0 m, 0 m]
  end: [0.6 m, 0 m, 0 m]
members:
  bar: {nodes: [foot, end], section: tube, material: steel, hinges: [HINGES]}
supports:
  foot: {node: foot, fix: all}
  hand: {node: end, motion: {ry: {table: {time: [0 s, 1 s], value: [0 rad, TURN rad]}}}}
analysis:
  stages: [{name: turn, kind: quasi-static, duration: 1 s}]
outputs: {every: 20 ms}
"""
BEAM = """crumple: 1
materials: {steel: {grade: S355}}
sections:
  tube: {type: rectangular_tube, width: 40 mm, depth: 60 mm, thickness: 2.5 mm}
nodes:
  a: [0 m, 0 m, 0 m]
  m: [0.6 m, 0 m, 0 m]
  b: [1.2 m, 0 m, 0 m]
members:
  left: {nodes: [a, m], section: tube, material: steel}
  right: {nodes: [m, b], section: tube, material: steel}
hinges: auto
supports:
  a: {node: a, fix: all}
  b: {node: b, fix: all}
  ram: {node: m, motion: {z: {table: {time: [0 s, 1 s], value: [0 mm, -200 mm]}}}}
analysis:
  stages: [{name: push, kind: quasi-static, duration: 1 s}]
  multibody: {members: MEMBERS}
outputs: {every: 10 ms, nodes: [m]}
"""


def turned(slope):
    top = FIRST + slope * np.pi
    law = f"{{type: table, rotation: [0 rad, {np.pi} rad], moment: [{FIRST} N m, {top} N m]}}"
    places = (0.1, 0.3, 0.5)
    hinges = (f"{{name: h{k}, at: {place} m, axis: y, law: {law}}}" for k, place in enumerate(places))
    return solve(loads(BAR.replace("HINGES", ", ".join(hinges)).replace("TURN", str(TURN))))


@pytest.mark.parametrize("slope", [HARDENING, 0.0])
def test_equal_hinges_in_series_turn_alike(slope, record_figure):
    result = turned(slope)
    assert result.status.ok, result.reason
    shares = [result[f"hinge.h{k}.rotation"][-1] / TURN for k in range(3)]
    # with a constant law nothing evens out how the first step was divided
    within = 1e-3 if slope else 0.01
    record_figure(f"share of one of three hinges, hardening {slope:g} N m/rad", shares[0], 1.0 / 3.0, within)
    assert shares == pytest.approx([1.0 / 3.0] * 3, abs=within)
    expected = FIRST + slope * TURN / 3.0
    moment = abs(result["hinge.h1.moment"][-1])
    record_figure(f"moment they carry, hardening {slope:g} N m/rad", moment, expected, 1e-3 * expected, "N m")
    assert moment == pytest.approx(expected, rel=1e-3)
    assert result.provenance.settings["steps"] < 1000


@pytest.mark.parametrize("members", ["rigid", "elastic"])
def test_a_beam_between_clamps_is_pushed_to_the_end(members, record_figure):
    """It stopped at 22 mm with members that bend, and at once with rigid bars."""
    result = solve(loads(BEAM.replace("MEMBERS", members)))
    assert result.status.ok, result.reason
    assert result.provenance.settings["members"] == members
    assert result.provenance.settings["steps"] < 3000
    assert result.energy_residual < 1e-6
    force = np.abs(result["support.ram.force.z"])
    ends = [result.hinges[f"left-{node}"].position[0] for node in "am"]
    at = 3  # 6 mm: members have yielded, and the axial force is still small
    moments = sum(np.abs(result[f"hinge.left-{node}.moment"][at]) for node in "am")
    expected = 2.0 * moments / (ends[1] - ends[0])
    record_figure(f"force on a clamped beam, {members}, 6 mm", force[at], expected, 0.03 * expected, "N")
    assert force[at] == pytest.approx(expected, rel=0.03)
    turns = [abs(result[f"hinge.{name}.rotation"][-1]) for name in ("left-a", "left-m", "right-m", "right-b")]
    # the bars turn by one angle against the clamps and against the ram
    assert turns[0] == pytest.approx(turns[3], rel=0.02)
    assert turns[1] + turns[2] == pytest.approx(turns[0] + turns[3], rel=0.02)


def test_a_stretched_beam_yields_across_as_a_string_does(record_figure):
    """Every pass of a step moved the beam further across than the one before, and back, in 480 000 solves."""
    across = 100.0
    text = BEAM.replace("MEMBERS", "elastic").replace(
        "analysis:", f"loads: [{{node: m, force: {{y: {across} N}}}}]\nanalysis:"
    )
    result = solve(loads(text), checks=False)
    assert result.status.ok, result.reason
    assert result.provenance.settings["newton_steps"] < 100_000
    ends = [result.hinges[f"left-{node}"].position[0] for node in "am"]
    length = np.hypot(ends[1] - ends[0], result["node.m.displacement.z"][-1])
    expected = across * length / 2.0 / np.abs(result["hinge.left-a.slip.x.force"][-1])
    moved = result["node.m.displacement.y"][-1]
    record_figure("displacement across a stretched beam", moved, expected, 0.03 * expected, "m")
    assert moved == pytest.approx(expected, rel=0.03)
