"""Obstacles that no member can come to are named where the motion is known; elsewhere nothing is said."""

from pathlib import Path

import pytest
from tests.concordance.suite import FOLDER
from typer.testing import CliRunner

from crumple.analysis import load, loads, solve
from crumple.cli.main import app
from crumple.structure.checks.never_met import never_met

EXAMPLES = Path(__file__).parents[4] / "examples"
BAR = """crumple: 1
materials: {s: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}}
sections: {t: {type: circular_tube, diameter: 40 mm, thickness: 2 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [0.5 m, 0 m, 0 m], c: [1 m, 0 m, 0 m]}
members: {m: {nodes: [a, b], section: t, material: s}, n: {nodes: [b, c], section: t, material: s}}
hinges: auto
masses: {p: {node: c, mass: 5 kg}}
analysis: {duration: 20 ms, shell: {element_size: 12 mm}}
"""
THROWN = "initial_velocity: [{translation: [10 m/s, 0 m/s, 0 m/s]}]\n"
WALL = "obstacles: {wall: {type: plane, point: [-100 mm, 0 m, 0 m], normal: [1, 0, 0]}}\n"
GUIDE = "supports: {a: {node: a, fix: [y, z]}, c: {node: c, fix: [ry]}}\n"
CLAMP = "supports: {a: {node: a, fix: all}}\n"
POLE = "obstacles: {pole: {type: cylinder, point: [0.5 m, 0 m, 0.1 m], axis: [0, 1, 0], radius: 30 mm, "
DOWN = "{table: {time: [0 s, 1 s], value: [0 mm, -10 mm]}}"
AROUND = (
    "{about: [0 m, 0 m, 0 m], axis: [0, 1, 0], angle: {table: {time: [0 s, 1 s], value: [0 deg, 90 deg]}}}"
)
MISSED = {
    "thrown away from a wall": THROWN + WALL,
    "thrown away from a wall that it touches": THROWN + WALL.replace("-100 mm", "0 mm"),
    "guided, and thrown away from a near wall": GUIDE + THROWN + WALL.replace("-100 mm", "-1 mm"),
    "a pole that moves away": f"{CLAMP}{POLE}velocity: [0 m/s, 0 m/s, 5 m/s]}}}}\n",
    "a driven pole that stops short": f"{CLAMP}{POLE}motion: {{z: {DOWN}}}}}}}\n",
    "a mass that flies past": f"{CLAMP}{POLE}mass: 5 kg, velocity: [0 m/s, 9 m/s, 0 m/s]}}}}\n",
}
MET_OR_NOT_KNOWN = {
    "thrown at a wall": THROWN.replace("[10", "[-10") + WALL,
    "gravity": f"gravity: [-9.81 m/s^2, 0 m/s^2, 0 m/s^2]\n{THROWN}{WALL}",
    "a turning velocity": THROWN.replace("translation", "axis: [0, 1, 0], rotation: 1 rad/s, translation")
    + WALL,
    "held and thrown": CLAMP + THROWN + WALL,
    "guided across the motion": GUIDE.replace("[y, z]", "[x, y]") + THROWN + WALL,
    "a near wall in front": THROWN + WALL.replace("-100 mm", "1001 mm").replace("[1, 0", "[-1, 0"),
    "thrown along a wall that it touches": THROWN
    + WALL.replace("-100 mm, 0 m, 0 m], normal: [1, 0, 0]", "0 m, 0 m, -15 mm], normal: [0, 0, 1]")
    + "gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]\n",
    "nothing moves": CLAMP + WALL,
    "a load": f"loads: [{{node: c, force: {{x: -1 kN}}}}]\n{THROWN}{WALL}",
    "a pole that comes": f"{CLAMP}{POLE}velocity: [0 m/s, 0 m/s, -5 m/s]}}}}\n",
    "a pole that turns": f"{CLAMP}{POLE}turning: {AROUND}}}}}\n",
}


def said(text):
    analysis = loads(text)
    return list(never_met(analysis.structure, analysis.duration))


@pytest.mark.parametrize("what", MISSED)
def test_what_is_missed_is_named_and_touches_nothing_in_the_run(what):
    (text,) = said(BAR + MISSED[what])
    name = "wall" if "wall" in what else "pole"
    assert text.startswith(f"Obstacle {name} is met by no member in 20 ms: ")
    result = solve(loads(BAR + MISSED[what]))
    assert max(abs(result[f"obstacle.{name}.force.{axis}"]).max() for axis in "xyz") == 0.0


@pytest.mark.parametrize("what", MET_OR_NOT_KNOWN)
def test_what_may_be_met_is_not_named(what):
    assert said(BAR + MET_OR_NOT_KNOWN[what]) == []


def test_check_says_both_that_nothing_is_met_and_that_shells_are_coarse(tmp_path):
    file = tmp_path / "bar.yaml"
    file.write_text(BAR + MISSED["a pole that moves away"], encoding="utf-8")
    told = CliRunner().invoke(app, ["check", str(file)]).output
    assert "Caution: Obstacle pole is met by no member in 20 ms: nothing moves the structure, which" in told
    assert "Warning for --fidelity shell: The mesh has as few as" in told
    without = BAR.replace(", shell: {element_size: 12 mm}", "")
    file.write_text(without + MISSED["a pole that moves away"], encoding="utf-8")
    assert "--fidelity" not in CliRunner().invoke(app, ["check", str(file)]).output


def test_examples_and_structures_of_the_suite_meet_their_obstacles():
    for file in [*EXAMPLES.glob("*.yaml"), *FOLDER.glob("**/*.yaml")]:
        analysis = load(file)
        assert analysis.stages or not list(never_met(analysis.structure, analysis.duration)), file
