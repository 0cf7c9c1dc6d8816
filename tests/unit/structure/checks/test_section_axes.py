"""Cautions about sections that bend aside or twist in shells alone."""

from pathlib import Path

import pytest
from tests.concordance.suite import FOLDER
from typer.testing import CliRunner

from crumple.analysis import load, loads, solve
from crumple.cli.main import app
from crumple.structure import with_elastic_members
from crumple.structure.checks.section_axes import section_doubts, turned_posts

EXAMPLES = Path(__file__).parents[4] / "examples"
BAR = """crumple: 1
materials: {s: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 355 MPa}}
sections: {c: {SECTION, thickness: 2 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [1.2 m, 0 m, 0 m]}
members: {bar: {nodes: [a, b], section: c, material: s, elastic: true}}
supports: {clamp: {node: a, fix: all}}
loads: [{node: b, force: {z: {step5: {x0: 0 s, h0: 0 N, x1: 1 s, h1: -100 N}}}}]
analysis: {stages: [{name: q, kind: quasi-static, duration: 1 s}]}
outputs: {nodes: [b]}
"""
ANGLE = "type: angle, width: 40 mm, depth: 60 mm"
CHANNEL = "type: channel, width: 40 mm, depth: 80 mm"


def doubts(source):
    analysis = source if not isinstance(source, str) else loads(source)
    whole = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
    return section_doubts(whole)


def bar(section, text=BAR):
    return text.replace("SECTION", section)


def test_an_angle_has_oblique_axes():
    """Of mid-lines b = 39, h = 59 mm: I_yz/sqrt(I_y I_z) = 0.55, so that it is 1.5 times as soft."""
    b, h = 39.0, 59.0
    y, z = b * b / 2.0 / (b + h), h * h / 2.0 / (b + h)
    i_y = h**3 / 12.0 + h * (h / 2.0 - z) ** 2 + b * z * z
    i_z = b**3 / 12.0 + b * (b / 2.0 - y) ** 2 + h * y * y
    i_yz = abs(h * y * (h / 2.0 - z) + b * z * (b / 2.0 - y))
    (one,) = [doubt for doubt in doubts(bar(ANGLE)) if doubt.code == "oblique_axes"]
    assert one.place == "member bar"
    assert one.value == pytest.approx(i_yz / (i_y * i_z) ** 0.5, rel=0.02)
    softer = 1.0 / (1.0 - i_yz**2 / (i_y * i_z))
    assert f"{softer:.2f}"[:3] in one.text
    assert "deg from y and z" in one.text


@pytest.mark.parametrize(
    "section",
    [
        "type: rectangular_tube, width: 40 mm, depth: 60 mm",
        "type: hat, width: 40 mm, depth: 30 mm, flange: 15 mm",
        "type: circular_tube, diameter: 40 mm",
    ],
)
def test_sections_that_are_symmetric_about_the_load_have_none(section):
    assert doubts(bar(section)) == ()


def test_a_rigid_member_without_automatic_hinges_has_none():
    assert doubts(bar(ANGLE).replace("elastic: true", "hinges: []")) == ()
    assert doubts(bar(ANGLE).replace("elastic: true", "hinges: auto"))


def test_a_channel_loaded_beside_its_shear_centre_has_a_caution():
    """Of mid-lines b = 39, h = 78: 3 b^2/(h + 6 b) behind the web, the centroid b^2/(2 b + h) before it."""
    b, h = 39e-3, 78e-3
    arm = 3.0 * b**2 / (h + 6.0 * b) + b**2 / (2.0 * b + h)
    (one,) = doubts(bar(CHANNEL))
    assert one.code == "beside_shear_centre"
    assert one.value == pytest.approx(arm, rel=0.02)
    # along y it meets the shear centre
    assert doubts(bar(CHANNEL).replace("force: {z:", "force: {y:")) == ()
    # along the member it does not shear
    assert doubts(bar(CHANNEL).replace("force: {z:", "force: {x:")) == ()


def test_a_closed_section_carries_the_torque_of_such_a_load():
    """A box with a fin: its centroid is beside its shear centre, but the cell hardly twists."""
    points = "[0 mm, 0 mm], [40 mm, 0 mm], [40 mm, 20 mm], [40 mm, 40 mm], [0 mm, 40 mm]"
    box = f"{{points: [{points}], closed: true, thickness: 1.5 mm}}"
    fin = "{points: [[40 mm, 20 mm], [100 mm, 20 mm]], thickness: 1.5 mm}"
    text = bar(f"type: walls, walls: [{box}, {fin}]").replace(", thickness: 2 mm", "")
    assert abs(loads(text).structure.section_of("bar").shear_centre[0]) > 0.1 * 100e-3
    assert doubts(text) == ()


def test_check_and_results_of_multibody_have_them_and_shells_do_not(tmp_path):
    file = tmp_path / "bar.yaml"
    file.write_text(bar(ANGLE))
    said = CliRunner().invoke(app, ["check", str(file), "--fidelity", "multibody"]).output
    assert "principal axes" in said
    assert "principal axes" not in CliRunner().invoke(app, ["check", str(file), "--fidelity", "shell"]).output
    result = solve(loads(bar(ANGLE)))
    assert "oblique_axes" in {caution.code for caution in result.cautions}
    assert any("principal axes" in text for text in result.warnings)


def test_examples_and_structures_of_the_suite_have_none():
    files = [*EXAMPLES.glob("*.yaml"), *(EXAMPLES / "layouts").glob("*.yaml"), *FOLDER.glob("**/*.yaml")]
    assert len(files) > 40
    for file in files:
        assert doubts(load(file)) == (), file


POSTS = """crumple: 1
materials: {s: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 355 MPa}}
sections: {c: {SECTION, thickness: 2 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [LEAN, 1 m], c: [1 m, 0 m, 0 m], d: [1 m, 0 m, 1 m], e: [0 m, 1 m, 0 m]}
members:
  leaning: {nodes: [a, b], section: c, material: s KEYS}
  upright: {nodes: [c, d], section: c, material: s}
  sill: {nodes: [a, e], section: c, material: s}
hinges: auto
supports: {clamp: {node: a, fix: all}, foot: {node: c, fix: all}}
masses: {m: {node: b, mass: 10 kg}}
initial_velocity: [{translation: [1 m/s, 1 m/s, 0 m/s]}]
analysis: {duration: 1 ms}
"""


def posts(lean="0.1 m, 0.124 m", keys="", section="type: square_tube, side: 40 mm"):
    return POSTS.replace("LEAN", lean).replace("KEYS", keys).replace("SECTION", section)


def test_a_post_that_leans_obliquely_without_up_is_named_by_check(tmp_path):
    """atan(0.124/0.1) = 51.1 deg, 38.9 from y."""
    path = tmp_path / "posts.yaml"
    path.write_text(posts(), encoding="utf-8")
    found = CliRunner().invoke(app, ["check", str(path)])
    assert found.exit_code == 0, found.output
    said = "leaning leans and has no 'up': its section is turned with the direction of the lean, by 38.9 deg"
    assert said in " ".join(found.output.split())


@pytest.mark.parametrize(
    "keys",
    [
        {"keys": ", up: [1, 0, 0]"},
        {"keys": ", roll: 10 deg"},
        {"lean": "0.1 m, 0.005 m"},
        {"lean": "2 m, 2.5 m"},
        {"lean": "0.0005 m, 0.0006 m"},
        {"section": "type: circular_tube, diameter: 40 mm"},
    ],
)
def test_posts_whose_sections_are_where_one_expects_them_are_not(keys):
    assert turned_posts(loads(posts()).structure) is not None
    assert turned_posts(loads(posts(**keys)).structure) is None


PORTAL = """
crumple: 1
materials: {steel: {grade: S355}}
sections: {tube: {type: square_tube, side: 40 mm, thickness: 2 mm}}
nodes: {a: [0 m, 0 m, 0 m], b: [0 m, 0 m, 0.5 m], c: [0 m, 0.5 m, 0.5 m]}
members:
  post: {nodes: [a, b], section: tube, material: steel, hinges: [{name: foot, at: a AXES}]}
  beam: {nodes: [b, c], section: tube, material: steel}
supports: {foot: {node: a, fix: all}}
masses: {tip: {node: c, mass: 10 kg}}
initial_velocity: [{translation: [SIDE m/s, 2 m/s, 0 m/s]}]
analysis: {duration: 10 ms}
"""


@pytest.mark.parametrize(
    ("axes", "side", "named"),
    [
        ("", "3", True),
        ("", "0", False),
        (", axes: [y, z]", "3", False),
        (", axis: z", "3", False),
        (", axial: true", "3", False),
    ],
)
def test_hinges_that_name_no_axes_in_space_are_named_by_check(axes, side, named, tmp_path):
    path = tmp_path / "portal.yaml"
    path.write_text(PORTAL.replace("AXES", axes).replace("SIDE", side), encoding="utf-8")
    found = CliRunner().invoke(app, ["check", str(path)])
    assert found.exit_code == 0, found.output
    said = "Hinge foot names no axes and bends about one axis alone, though the structure moves in space."
    assert (said in " ".join(found.output.split())) == named
