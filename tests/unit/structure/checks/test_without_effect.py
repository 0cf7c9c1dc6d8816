"""Cautions about what an input gives and what moves nothing; none for what acts, examples and the suite."""

from pathlib import Path

import pytest
from tests.concordance.suite import FOLDER
from typer.testing import CliRunner

from crumple.analysis import load, loads, solve
from crumple.cli.main import app
from crumple.structure.checks.doubtful import input_doubts

EXAMPLES = Path(__file__).parents[4] / "examples"
BAR = """crumple: 1
materials: {s: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}}
sections: {t: {type: circular_tube, diameter: 40 mm, thickness: 2 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [0.5 m, 0 m, 0 m], c: [1 m, 0 m, 0 m]}
members: {m: {nodes: [a, b], section: t, material: s}, n: {nodes: [b, c], section: t, material: s}}
hinges: auto
supports: {a: {node: a, fix: all}, c: {node: c, fix: [y]}}
masses: {p: {node: c, mass: 5 kg}}
analysis: {duration: 20 ms}
"""
UP = "translation: [0 m/s, 0 m/s, 1 m/s]"
GRAVITY = "gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]\n"
WITHOUT = {
    "velocity of a node without mass": (f"initial_velocity: [{{nodes: [b], {UP}}}]\n", 2),
    "one of two nodes": (f"initial_velocity: [{{nodes: [b, c], {UP}}}]\n", 1),
    "force into a clamp": ("loads: [{node: a, force: {z: 1 kN}}]\n", 2),
    "moment into a clamp": ("loads: [{node: a, moment: {y: 1 kN*m}}]\n", 2),
    "force along a held freedom": ("loads: [{node: c, force: {x: 0 N, y: 1 kN}}]\n", 2),
}
ACTS = {
    "velocity": f"initial_velocity: [{{nodes: [c], {UP}}}]\n",
    "velocity of a member with its node": f"initial_velocity: [{{nodes: [c], members: [n], {UP}}}]\n",
    "no velocity": f"initial_velocity: [{{nodes: [b], {UP.replace('1', '0')}}}]\n{GRAVITY}",
    "force aslant": "loads: [{node: c, force: {y: 1 kN, z: 1 kN}}]\n",
    "force of zero": f"loads: [{{node: a, force: {{z: 0 N}}}}]\ninitial_velocity: [{{{UP}}}]\n",
}


def said(text):
    analysis = loads(text)
    return input_doubts(analysis.structure, analysis.duration, analysis.stages)


@pytest.mark.parametrize("what", WITHOUT)
def test_what_moves_nothing_is_named(what):
    keys, number = WITHOUT[what]
    codes = [one.code for one in said(BAR + keys)]
    own = "held_load" if "loads" in keys else "thrown_without_mass"
    assert codes == (["nothing_acts"] if number == 2 else []) + [own]


@pytest.mark.parametrize("what", ACTS)
def test_what_acts_is_not_named(what):
    assert said(BAR + ACTS[what]) == ()


def test_the_sentences():
    (thrown,) = said(BAR + WITHOUT["one of two nodes"][0])
    assert thrown.text == (
        "An initial_velocity names node b, where there is no mass: 'nodes' throws masses at these nodes, "
        "and nothing moves there. Name 'members' to throw members, or give a mass."
    )
    held = said(BAR + WITHOUT["force along a held freedom"][0])[-1]
    assert held.text == (
        "Loads at node c act only along what support c holds: they go into the support and load no member. "
        "Move them to another node, or free this direction."
    )


def test_a_flow_stress_beside_a_hardening_curve_is_named():
    keys = "yield_stress: 350 MPa"
    both = f"{keys}, flow_stress: 600 MPa, hardening: {{type: voce, saturation: 100 MPa, strain: 0.05}}"
    text = BAR.replace(keys, both) + ACTS["velocity"]
    (one,) = said(text)
    assert one.code == "two_flow_stresses"
    assert "flow_stress, 600 MPa, and hardening, 436.5 MPa at a plastic strain of 0.1" in one.text
    assert one.text.endswith("Remove one of them.")
    assert said(text.replace("600 MPa", "440 MPa")) == ()
    assert said(BAR.replace(keys, f"{keys}, flow_stress: 600 MPa") + ACTS["velocity"]) == ()


def test_check_names_what_nothing_uses_and_a_run_does_not(tmp_path):
    more = BAR.replace("materials: {", "materials: {alu: {grade: EN AW-6060-T6}, ").replace(
        "sections: {", "sections: {spare: {type: square_tube, side: 30 mm, thickness: 2 mm}, "
    )
    laws = "hinge_laws: {own: {type: estimate}, other: {type: constant}}\n"
    used = "hinges: [{name: h, at: a, law: own}], section"
    texts = {
        BAR: "",
        more + laws: "Not used: section spare; material alu; hinge laws own, other.",
        BAR.replace("section", used, 2).replace(used, "section", 1) + laws: "Not used: hinge law other.",
    }
    for text, expected in texts.items():
        file = tmp_path / "bar.yaml"
        file.write_text(text + GRAVITY, encoding="utf-8")
        output = CliRunner().invoke(app, ["check", str(file)]).output
        assert "no mistakes found" in output
        assert (expected or "no mistakes") in output
        assert expected or "Not used" not in output
        assert not any("Not used" in one.text for one in said(text + GRAVITY))


def test_a_stage_throws_a_node_without_mass():
    stages = f"{{stages: [{{name: p, duration: 20 ms, initial_velocity: [{{nodes: [b], {UP}}}]}}]}}"
    codes = [one.code for one in said(BAR.replace("{duration: 20 ms}", stages))]
    assert codes == ["nothing_acts", "thrown_without_mass"]


def test_nothing_moves_there_and_the_result_says_so(tmp_path):
    text = BAR + WITHOUT["velocity of a node without mass"][0]
    result = solve(loads(text))
    assert result.channels["energy.kinetic"].values.max() == 0.0
    assert "thrown_without_mass" in [one.code for one in result.cautions]
    file = tmp_path / "bar.yaml"
    file.write_text(text, encoding="utf-8")
    assert "Caution: An initial_velocity names node b" in CliRunner().invoke(app, ["check", str(file)]).output


def test_examples_and_structures_of_the_suite_have_none():
    for file in [*EXAMPLES.glob("*.yaml"), *(EXAMPLES / "layouts").glob("*.yaml"), *FOLDER.glob("**/*.yaml")]:
        analysis = load(file)
        codes = {one.code for one in input_doubts(analysis.structure, analysis.duration, analysis.stages)}
        assert not codes & {"thrown_without_mass", "held_load", "nothing_acts"}, file
