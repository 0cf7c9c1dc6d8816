"""Caution about a structure that nothing loads or moves; none for what acts, examples and the suite."""

from pathlib import Path

import pytest
from tests.concordance.suite import FOLDER
from typer.testing import CliRunner

from crumple.analysis import load, loads, solve
from crumple.cli.main import app
from crumple.structure.checks.at_rest import nothing_acts

EXAMPLES = Path(__file__).parents[4] / "examples"
BAR = """crumple: 1
materials: {s: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}}
sections: {t: {type: circular_tube, diameter: 40 mm, thickness: 2 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [0.5 m, 0 m, 0 m]}
members: {m: {nodes: [a, b], section: t, material: s}}
hinges: auto
supports: {a: {node: a, fix: all}}
masses: {p: {node: b, mass: 5 kg}}
analysis: {duration: 20 ms}
"""
FLOOR = "type: plane, point: [0 m, 0 m, -1 m], normal: [0, 0, 1]"
STEP = "{step: {x0: 0 ms, h0: 0 mm, x1: 20 ms, h1: 9 mm}}"
LATE = "{step: {x0: 12 ms, h0: 0 N, x1: 15 ms, h1: 9 kN}}"
TURN = "{about: [0 m, 0 m, 0 m], axis: [0, 1, 0], angle: {step: {x0: 0 ms, h0: 0 deg, x1: 20 ms, h1: 9 deg}}}"


def said(text):
    analysis = loads(text)
    return [one.code for one in nothing_acts(analysis.structure, analysis.duration, analysis.stages)]


def staged(first="", second=""):
    """The bar in two stages of 10 ms with further keys."""
    one, two = (f"{{name: {name}, duration: 10 ms{keys}}}" for name, keys in (("p", first), ("q", second)))
    return BAR.replace("{duration: 20 ms}", f"{{stages: [{one}, {two}]}}")


NOTHING = {
    "alone": "",
    "velocity of zero": "initial_velocity: [{translation: [0 m/s, 0 m/s, 0 m/s]}]\n",
    "rotation of zero": "initial_velocity: [{rotation: 0 rad/s, axis: [0, 1, 0]}]\n",
    "impulse of zero": "impulses: [{node: b, impulse: [0 N*s, 0 N*s, 0 N*s]}]\n",
    "gravity of zero": "gravity: [0 m/s^2, 0 m/s^2, 0 m/s^2]\n",
    "load without components": "loads: [{node: b}]\n",
    "load of zero": "loads: [{node: b, force: {z: 0 N}, moment: {y: {constant: 0 N*m}}}]\n",
    "load after the end": "loads: [{node: b, force: {z: {step: {x0: 1 s, h0: 0 N, x1: 2 s, h1: 9 kN}}}}]\n",
    "fixed obstacle": f"obstacles: {{floor: {{{FLOOR}}}}}\n",
    "obstacle with a mass at rest": f"obstacles: {{floor: {{{FLOOR}, mass: 5 kg}}}}\n",
    "obstacle driven nowhere": f"obstacles: {{floor: {{{FLOOR}, motion: {{z: 0 mm}}}}}}\n",
}
ACTS = {
    "velocity": "initial_velocity: [{nodes: [b], translation: [0 m/s, 0 m/s, 1 m/s]}]\n",
    "rotation": "initial_velocity: [{rotation: 1 rad/s, axis: [0, 1, 0]}]\n",
    "impulse": "impulses: [{node: b, impulse: [0 N*s, 0 N*s, 1 N*s]}]\n",
    "angular impulse": "impulses: [{node: b, angular_impulse: [0 N*m*s, 1 N*m*s, 0 N*m*s]}]\n",
    "force": "loads: [{node: b, force: {z: 1 N}}]\n",
    "moment": "loads: [{node: b, moment: {y: 1 N*m}}]\n",
    "short force": "loads: [{node: b, force: {z: {table: {time: [1.01 ms, 1.02 ms, 1.03 ms], "
    "value: [0 N, 1 N, 0 N]}}}}]\n",
    "gravity": "gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]\n",
    "driven obstacle": f"obstacles: {{floor: {{{FLOOR}, motion: {{z: {STEP}}}}}}}\n",
    "turned obstacle": f"obstacles: {{floor: {{{FLOOR}, turning: {TURN}}}}}\n",
    "obstacle at constant speed": f"obstacles: {{floor: {{{FLOOR}, velocity: [0 m/s, 0 m/s, 1 m/s]}}}}\n",
    "obstacle thrown": f"obstacles: {{floor: {{{FLOOR}, mass: 5 kg, velocity: [0 m/s, 0 m/s, 1 m/s]}}}}\n",
}


@pytest.mark.parametrize("what", NOTHING)
def test_a_structure_that_nothing_acts_on_is_named(what):
    assert said(BAR + NOTHING[what]) == ["nothing_acts"]


@pytest.mark.parametrize("what", ACTS)
def test_whatever_acts_is_seen(what):
    assert said(BAR + ACTS[what]) == []


@pytest.mark.parametrize("motion", [f"z: {STEP}", "ry: {step: {x0: 0 ms, h0: 0 deg, x1: 9 ms, h1: 9 deg}}"])
def test_driven_supports_act(motion):
    driven = BAR.replace("fix: all", f"motion: {{{motion}}}")
    assert said(driven) == []
    assert said(driven.replace("9 mm", "0 mm").replace("9 deg", "0 deg")) == ["nothing_acts"]


def test_stages_act_at_their_start():
    assert said(staged()) == ["nothing_acts"]
    for keys in (
        ", impulses: [{node: b, impulse: [0 N*s, 0 N*s, 1 N*s]}]",
        ", initial_velocity: [{nodes: [b], translation: [0 m/s, 0 m/s, 1 m/s]}]",
    ):
        assert said(staged(second=keys)) == []
        assert said(staged(second=keys.replace("1 N*s", "0 N*s").replace("1 m/s", "0 m/s"))) == [
            "nothing_acts"
        ]


def test_functions_of_time_count_from_the_start_of_each_stage():
    load_at = f"loads: [{{node: b, force: {{z: {LATE}}}}}]\n"
    assert said(BAR + load_at) == []
    assert said(staged() + load_at) == ["nothing_acts"]


@pytest.mark.parametrize("what", ["driven obstacle", "obstacle at constant speed"])
def test_stages_may_leave_out_drives_and_obstacles(what):
    none, last = (", drive: []", ", obstacles: []"), ", drive: [floor]"
    for keys in none:
        assert said(staged(keys, keys) + ACTS[what]) == ["nothing_acts"]
        assert said(staged(keys, last) + ACTS[what]) == []
    thrown = ACTS["obstacle thrown"]
    assert said(staged(none[0], none[0]) + thrown) == []
    assert said(staged(none[1], none[1]) + thrown) == ["nothing_acts"]


@pytest.mark.parametrize("fidelity", ["multibody", "shell"])
def test_results_have_the_caution(fidelity):
    result = solve(loads(BAR.replace("duration: 20 ms", "duration: 0.02 ms")), fidelity, checks=False)
    (one,) = [caution for caution in result.cautions if caution.code == "nothing_acts"]
    assert one.text in result.warnings


def test_check_says_it_and_what_to_do(tmp_path):
    file = tmp_path / "bar.yaml"
    file.write_text(BAR, encoding="utf-8")
    told = CliRunner().invoke(app, ["check", str(file)]).output
    assert told.count("Caution: Nothing loads or moves the structure, so that all results are zero") == 1
    assert "give an initial_velocity, impulses, loads, gravity" in told


def test_examples_and_structures_of_the_suite_have_none():
    files = [*EXAMPLES.glob("*.yaml"), *(EXAMPLES / "layouts").glob("*.yaml"), *FOLDER.glob("**/*.yaml")]
    assert len(files) > 40
    for file in files:
        analysis = load(file)
        assert list(nothing_acts(analysis.structure, analysis.duration, analysis.stages)) == [], file
