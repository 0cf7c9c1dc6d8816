"""An obstacle dents the wall of a tube: the work of the dent takes the energy of the blow.

A tube that does not bend is struck by a mass m at v.  A round one with the flow stress s and the wall t takes
(8/3) s t^1.5 (2 pi/3)^0.5 d^1.5 up to the depth d, and its force is then 4 s t^1.5 (2 pi d/3)^0.5; a
rectangular one takes s t^2 times the area under the curve of its force.  Tolerance 1 %: the force is straight
between 40 depths, the face is 0.1 % of the structure's mass, and hinges stretch by some micrometres.  Two
tubes under one obstacle share the energy.

Kind: closed form.  Source: derived here.
"""

from math import pi, sqrt

import numpy as np
import pytest

import crumple
from crumple.hinge.dent import CRUSHED, RISE
from crumple.report.wording.along import dent_table
from crumple.report.wording.answer import three_sentences
from crumple.report.wording.wording import verdict
from crumple.result import read, write

YOUNG, STRESS, WALL, MASS, SPEED = 210e9, 350e6, 2e-3, 20.0, 6.0
BLOW = MASS * SPEED**2 / 2.0
TEXT = """
crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections: {tube: SECTION}
nodes: {left: [0 m, 0 m, 0 m], middle: [400 mm, 0 m, 0 m], right: [800 mm, 0 m, 0 m]}
members:
  a: {nodes: [left, middle], section: tube, material: steel}
  b: {nodes: [middle, right], section: tube, material: steel}
hinges: {law: {type: constant, moment: 1 MN*m}}
supports: {l: {node: left, fix: all}, r: {node: right, fix: all}}
obstacles: {pole: {OBSTACLE}}
analysis: {duration: 20 ms, multibody: {members: rigid}}
outputs: {every: 0.05 ms, nodes: [middle]}
"""
ROUND = "{type: circular_tube, diameter: 60 mm, thickness: 2 mm}"
SQUARE = "{type: square_tube, side: 60 mm, thickness: 2 mm}"
POLE = "type: cylinder, point: [400 mm, 0 m, 81 mm], axis: [0, 1, 0], radius: 50 mm"
BALL = "type: sphere, point: [400 mm, 0 m, 81 mm], radius: 50 mm"
THROWN = f"mass: {MASS:g} kg, velocity: [0 m/s, 0 m/s, -{SPEED:g} m/s], guide: [0, 0, -1]"


def analysis_of(section, obstacle, change=("", "")):
    text = TEXT.replace("SECTION", section).replace("OBSTACLE", obstacle)
    return crumple.loads(text.replace(*change))


def round_depth(work):
    """Depth [m] of a dent in a round tube that takes some work [J]."""
    return (work / (8.0 / 3.0 * STRESS * WALL**1.5 * sqrt(2.0 * pi / 3.0))) ** (2.0 / 3.0)


def square_depth(work):
    """The same in the square tube."""
    depths, forces = 60e-3 * np.array(CRUSHED[0]), STRESS * WALL**2 * np.array(CRUSHED[1])
    fine = np.linspace(0.0, depths[-1], 20001)
    force = np.minimum(np.interp(fine, depths, forces), RISE * YOUNG * WALL * fine)
    taken = np.concatenate([[0.0], np.cumsum((force[1:] + force[:-1]) / 2.0 * np.diff(fine))])
    return float(np.interp(work, taken, fine))


@pytest.mark.parametrize(
    ("section", "obstacle", "depth_of"),
    [(ROUND, POLE, round_depth), (ROUND, BALL, round_depth), (SQUARE, POLE, square_depth)],
)
def test_the_dent_takes_the_energy_of_a_thrown_obstacle(section, obstacle, depth_of):
    result = crumple.solve(analysis_of(section, f"{obstacle}, {THROWN}"))
    assert result.status.ok
    (dent,) = result.dents
    assert dent.depth == pytest.approx(depth_of(BLOW), rel=0.01)
    assert dent.energy == pytest.approx(BLOW, rel=0.01)
    assert result["member.a.energy"][-1] == pytest.approx(dent.energy, rel=1e-5)
    moved = -result["obstacle.pole.displacement.z"]
    assert moved.max() == pytest.approx(dent.depth + 1e-3, rel=0.01)
    assert result["obstacle.pole.dent"].max() == pytest.approx(dent.depth, rel=1e-6)


@pytest.mark.parametrize(
    ("section", "faster", "limit", "deep"),
    [
        (SQUARE, 1.0, 30e-3, False),
        (SQUARE, 2.5, 30e-3, True),
        (ROUND, 0.9, 18e-3, False),
        (ROUND, 1.5, 18e-3, True),
    ],
)
def test_a_dent_beyond_the_comparison_with_shells_is_a_caution(section, faster, limit, deep):
    thrown = THROWN.replace(f"-{SPEED:g} m/s", f"-{faster * SPEED:g} m/s")
    result = crumple.solve(analysis_of(section, f"{POLE}, {thrown}"))
    (dent,) = result.dents
    assert (dent.depth > limit) == deep
    found = [caution.limit for caution in result.cautions if caution.code == "deep_dent"]
    assert found == pytest.approx([limit] * deep)


def test_a_dent_counts_from_the_position_at_the_start():
    """A pole that overlaps the tube by 1 mm is in contact: the overlap is no dent, and takes no energy."""
    inside = POLE.replace("81 mm", "79 mm")
    result = crumple.solve(analysis_of(ROUND, f"{inside}, {THROWN}"))
    assert result["obstacle.pole.dent"][0] == 0.0
    (dent,) = result.dents
    assert dent.depth == pytest.approx(round_depth(BLOW), rel=0.01)
    assert (-result["obstacle.pole.displacement.z"]).max() == pytest.approx(dent.depth, rel=1e-3)


def test_the_force_is_that_of_the_dent():
    result = crumple.solve(analysis_of(ROUND, f"{POLE}, {THROWN}"))
    depth, force = result["obstacle.pole.dent"], result["obstacle.pole.force.z"]
    # the force is the mean since the last output
    middle = (depth[1:] + depth[:-1]) / 2.0
    pressed = (np.diff(depth) > 1e-6) & (middle > 2e-3)
    expected = 4.0 * STRESS * WALL**1.5 * np.sqrt(2.0 * pi * middle / 3.0)
    assert pressed.sum() > 20
    np.testing.assert_allclose(force[1:][pressed], expected[pressed], rtol=0.02)


def test_the_tube_may_fly_to_a_fixed_pole():
    """The energy is that of the tube and its masses, which the pole stops."""
    thrown = "supports: {l: {node: left, fix: all}, r: {node: right, fix: all}}"
    masses = (
        "masses: {l: {node: left, mass: 10 kg}, r: {node: right, mass: 10 kg}}\n"
        "initial_velocity: [{translation: [0 m/s, 0 m/s, 6 m/s]}]"
    )
    result = crumple.solve(analysis_of(ROUND, POLE, (thrown, masses)))
    (dent,) = result.dents
    energy = result["energy.kinetic"][0]
    assert energy > BLOW
    assert dent.energy == pytest.approx(energy, rel=0.01)
    assert dent.depth == pytest.approx(round_depth(energy), rel=0.01)


def test_a_driven_pole_dents_by_its_travel():
    motion = "motion: {z: {havsin: {x0: 0 ms, h0: 0 mm, x1: 20 ms, h1: -16 mm}}}"
    result = crumple.solve(analysis_of(ROUND, f"{POLE}, {motion}"))
    (dent,) = result.dents
    assert dent.depth == pytest.approx(15e-3, rel=0.01)
    assert result["energy.external_work"][-1] == pytest.approx(dent.energy, rel=0.02)
    work = 8.0 / 3.0 * STRESS * WALL**1.5 * sqrt(2.0 * pi / 3.0) * 15e-3**1.5
    assert dent.energy == pytest.approx(work, rel=0.01)


def test_two_tubes_share_the_force():
    second = (
        "\n  a2: {nodes: [left2, middle2], section: tube, material: steel}"
        "\n  b2: {nodes: [middle2, right2], section: tube, material: steel}\nhinges:"
    )
    text = TEXT.replace("\nhinges:", second).replace(
        "right: [800 mm, 0 m, 0 m]}",
        "right: [800 mm, 0 m, 0 m], left2: [0 m, 0.2 m, 0 m], middle2: [400 mm, 0.2 m, 0 m], "
        "right2: [800 mm, 0.2 m, 0 m]}",
    )
    text = text.replace(
        "r: {node: right, fix: all}}",
        "r: {node: right, fix: all}, l2: {node: left2, fix: all}, r2: {node: right2, fix: all}}",
    )
    text = text.replace("SECTION", ROUND).replace("OBSTACLE", f"{POLE}, {THROWN}")
    result = crumple.solve(crumple.loads(text))
    assert [dent.member for dent in result.dents] == ["a", "a2"]
    for dent in result.dents:
        assert dent.depth == pytest.approx(round_depth(BLOW / 2.0), rel=0.01)
        assert dent.energy == pytest.approx(BLOW / 2.0, rel=0.01)


def test_a_node_in_the_dent_moves_with_the_mean_of_the_walls():
    """The tube itself stays, the arc 2 beta of its middle line becomes a chord."""
    result = crumple.solve(analysis_of(ROUND, f"{POLE}, {THROWN}"))
    radius, depth = 29e-3, float(result["obstacle.pole.dent"].max())
    around = np.linspace(0.0, 2.0 * pi, 200_001)[:-1]
    beyond = np.maximum(radius * np.cos(around) - (radius - depth), 0.0)
    moved = -result["node.middle.displacement.z"].min()
    assert moved == pytest.approx(beyond.mean(), rel=0.01)


def test_an_obstacle_need_not_dent():
    result = crumple.solve(analysis_of(ROUND, f"{POLE}, {THROWN}, dents: false"))
    assert result.dents == ()
    assert "obstacle.pole.dent" not in result.channels
    assert -result["node.middle.displacement.z"].min() < 1e-4


def test_an_obstacle_that_is_not_met_dents_nothing():
    assert crumple.solve(analysis_of(ROUND, f"{POLE}, {THROWN}".replace("-6", "6"))).dents == ()


def test_nothing_dents_where_a_stage_is_quasi_static():
    slow = ("duration: 20 ms", "stages: [{name: push, kind: quasi-static, duration: 20 ms}]")
    motion = "motion: {z: {havsin: {x0: 0 ms, h0: 0 mm, x1: 20 ms, h1: -0.9 mm}}}"
    result = crumple.solve(analysis_of(ROUND, f"{POLE}, {motion}", slow))
    assert result.status.ok
    assert result.dents == ()
    assert "obstacle.pole.dent" not in result.channels


def test_results_list_dents(tmp_path):
    result = crumple.solve(analysis_of(ROUND, f"{POLE}, {THROWN}"))
    write(result, tmp_path)
    assert read(tmp_path).dents == result.dents
    (dent,) = result.dents
    ((member, place, obstacle, _, energy),) = dent_table(result).rows
    assert (member, obstacle) == ("a", "pole")
    assert float(place) == 400.0
    assert "A dent in a of up to" in three_sentences(result, verdict(result, 1e-3, 1e-3))[0]
    assert float(energy) == pytest.approx(dent.energy, rel=1e-3)
