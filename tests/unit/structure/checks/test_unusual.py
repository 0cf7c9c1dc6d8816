"""Cautions about values far outside of usual ranges: one for each kind, none for examples and the suite."""

from pathlib import Path

import pytest
from tests.concordance.suite import FOLDER
from typer.testing import CliRunner

from crumple.analysis import load, loads, solve
from crumple.cli.main import app
from crumple.structure.checks.unusual import USUAL, unusual_values

EXAMPLES = Path(__file__).parents[4] / "examples"
BAR = """crumple: 1
materials: {s: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa,
                ultimate_stress: 400 MPa, flow_stress: 350 MPa}}
sections: {t: {type: square_tube, side: 50 mm, thickness: 2 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [1 m, 0 m, 0 m], c: [2 m, 0 m, 0 m]}
members:
  ab: {nodes: [a, b], section: t, material: s, hinges: [{name: root, at: a, law: {type: kecman}}]}
  bc: {nodes: [b, c], section: t, material: s}
supports: {clamp: {node: a, fix: all}}
masses: {m: {node: b, mass: 10 kg}}
initial_velocity: [{translation: [0 m/s, 0 m/s, 5 m/s]}]
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
analysis: {duration: 10 ms}
outputs: {every: 1 ms}
"""
HINGE = ", hinges: [{name: root, at: a, law: {type: kecman}}]"
CHANGES = {
    "Young's modulus": ("210 GPa", "900 MPa"),
    "yield stress": ("yield_stress: 300 MPa", "yield_stress: 350 Pa"),
    "ultimate strength": ("400 MPa", "400 GPa"),
    "flow stress": ("flow_stress: 350 MPa", "flow_stress: 350 GPa"),
    "flow stress over the yield stress": ("flow_stress: 350 MPa", "flow_stress: 100 MPa"),
    "plastic strain of a hardening curve": (
        "flow_stress: 350 MPa",
        "hardening: {type: table, plastic_strain: [0, 5, 10], true_stress: [300 MPa, 400 MPa, 420 MPa]}",
    ),
    "at which a metal tears": ("flow_stress: 350 MPa", "failure_strain: 20"),
    "strain rate of 100/s": (
        "flow_stress: 350 MPa",
        "flow_rate: {type: cowper-symonds, D: 1e-9 1/s, q: 5}",
    ),
    "density": ("7850 kg", "7.85 kg"),
    "wall thickness": ("side: 50 mm, thickness: 2 mm", "side: 9 m, thickness: 200 mm"),
    "largest side": ("side: 50 mm", "side: 50 m"),
    "length of a member": ("[2 m,", "[2000 m,"),
    "a member's length": ("[2 m,", "[20 m,"),
    "largest rotation of a law": (
        "members:",
        "hinges: {law: {type: table, rotation: [0 rad, 45 rad, 90 rad], moment: [2 kN*m, 1 kN*m, 1 kN*m]}}"
        "\nmembers:",
    ),
    "mass": ("10 kg}", "1e9 kg}"),
    "offset of a mass": ("10 kg}", "10 kg, offset: [0 m, 0 m, 500 m]}"),
    "speed": ("5 m/s]", "600 m/s]"),
    "at the fastest node": (
        "translation: [0 m/s, 0 m/s, 5 m/s]",
        "rotation: 9000 rad/s, about: [0 m, 0 m, 0 m], axis: [0, -1, 0]",
    ),
    "where its curve is steepest": (
        "supports: {clamp",
        "obstacles: {w: {type: plane, point: [5 m, 0 m, 0 m], normal: [-1, 0, 0], motion: {x: {table: "
        "{time: [0 s, 1 us, 1 s], value: [0 m, -1 mm, -1 mm]}}}}}\nsupports: {clamp",
    ),
    "gravity": ("-9.81 m/s^2", "-9810 m/s^2"),
    "duration": ("duration: 10 ms", "duration: 1e6 s"),
}


def found(text):
    analysis = loads(text)
    return unusual_values(analysis.structure, analysis.duration)


@pytest.mark.parametrize("what", CHANGES)
def test_a_value_far_outside_of_its_range_is_named(what):
    free = BAR.replace(HINGE, "").replace("outputs: {every: 1 ms}", "")
    assert found(free) == ()
    assert CHANGES[what][0] in free
    texts = [one.text for one in found(free.replace(*CHANGES[what])) if what in one.text]
    assert len(texts) == 1
    assert "Check its unit." in texts[0]


def test_every_row_of_the_table_is_tried():
    assert len(CHANGES) == len(USUAL)


def test_alike_values_have_one_sentence():
    (one,) = found(BAR.replace("[1 m,", "[2000 m,").replace("[2 m,", "[4000 m,"))
    assert one.text.startswith("members.ab: 2000 m is far from usual (so are members.bc)")
    assert (one.value, one.limit, one.unit) == (2000.0, 1000.0, "m")


def test_a_node_in_metres_for_millimetres_is_a_member_without_thickness():
    """450 m is within a kilometre, but 9000 times a side of 50 mm; a wrong side has its own sentence."""
    (one,) = found(BAR.replace("[1 m,", "[450 m,").replace("[2 m,", "[451 m,"))
    assert one.text == (
        "members.ab: 9000 times the largest side of its section is far from usual; a member's length is at "
        "most 200. Check its unit."
    )
    assert (one.value, one.limit) == (9000.0, 200.0)
    small = BAR.replace("side: 50 mm, thickness: 2 mm", "side: 0.5 mm, thickness: 0.03 mm")
    assert [one.place for one in found(small)] == ["sections.t"]


def test_rotations_of_laws_that_hinges_name_or_have_are_looked_at():
    """Degrees that were written as rad, in a law of the list and in the one of a hinge."""
    table = "{type: table, rotation: [0 rad, ANGLE rad], moment: [2 kN*m, 1 kN*m]}"
    for angle, places in (
        ("90", ["hinge_laws.own.rotation", "members.ab.hinges[0].law.rotation"]),
        ("3", []),
    ):
        given = table.replace("ANGLE", angle)
        text = BAR.replace("law: {type: kecman}", f"law: {given}") + f"hinge_laws: {{own: {given}}}\n"
        places_found = [one.text for one in found(text)]
        assert len(places_found) == bool(places)
        assert all(place in said for place in places for said in places_found)


def test_of_a_rotation_the_speed_of_the_fastest_node_counts():
    """A node that is named turns its members: their far ends are a metre away."""
    moved = "translation: [0 m/s, 0 m/s, 5 m/s]"
    spin = "rotation: 9000 rad/s, about: [1 m, 0 m, 0 m], axis: [0, -1, 0]"
    (one,) = found(BAR.replace(moved, f"{spin}, nodes: [b]"))
    assert one.text == (
        "initial_velocity[0].rotation: 9000 m/s at the fastest node is far from usual; the speed of a crash "
        "is at most 500 m/s. Check its unit."
    )
    assert found(BAR.replace(moved, f"{spin.replace('9000', '200')}, members: [bc]")) == ()


def test_the_result_has_a_caution_and_the_commands_say_it(tmp_path):
    text = BAR.replace("yield_stress: 300 MPa", "yield_stress: 350 Pa")
    said = (
        "materials.s.yield_stress: 350 Pa is far from usual; the yield stress of a metal is 1 MPa to 5 GPa."
    )
    for fidelity in ("multibody", "shell"):
        short = text.replace("duration: 10 ms", "duration: 0.02 ms").replace("every: 1 ms", "every: 0.01 ms")
        result = solve(loads(short), fidelity)
        assert [c.place for c in result.cautions if c.code == "unusual_value"] == ["materials.s.yield_stress"]
        assert result.warnings[0].startswith(said)
    file = tmp_path / "bar.yaml"
    file.write_text(text, encoding="utf-8")
    assert f"Caution: {said}" in CliRunner().invoke(app, ["check", str(file)]).output
    output = CliRunner().invoke(app, ["run", str(file), "--out", str(tmp_path / "out")]).output
    assert f"Caution: {said}" in " ".join(output.split())
    assert said in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


def test_examples_and_structures_of_the_suite_are_usual():
    files = [*EXAMPLES.glob("*.yaml"), *(EXAMPLES / "layouts").glob("*.yaml"), *FOLDER.glob("**/*.yaml")]
    assert len(files) > 40
    for file in files:
        analysis = load(file)
        assert unusual_values(analysis.structure, analysis.duration) == (), file
