"""Caution about sections that bend about axes which are not principal; none for others and examples."""

import math
from pathlib import Path

import pytest
from tests.concordance.suite import FOLDER
from typer.testing import CliRunner

from crumple.analysis import load, loads, solve
from crumple.cli.main import app
from crumple.structure import with_elastic_members
from crumple.structure.checks.oblique_sections import oblique_sections

EXAMPLES = Path(__file__).parents[4] / "examples"
ARM = """crumple: 1
materials: {s: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 355 MPa}}
sections: {leg: SHAPE}
nodes: {a: [0 m, 0 m, 0 m], b: [1.2 m, 0 m, 0 m]}
members: {arm: {nodes: [a, b], section: leg, material: s}}
HINGES
supports: {a: {node: a, fix: all}}
masses: {p: {node: b, mass: 5 kg}}
loads: [{node: b, force: {z: -100 N}}]
analysis: {duration: 2 ms, multibody: {members: KIND}}
"""
ANGLE = "{type: angle, width: 40 mm, depth: 60 mm, thickness: 3 mm}"
SYMMETRIC = (
    "{type: channel, width: 40 mm, depth: 60 mm, thickness: 3 mm}",
    "{type: hat, width: 60 mm, depth: 50 mm, thickness: 1.5 mm, flange: 20 mm}",
    "{type: rectangular_tube, width: 40 mm, depth: 60 mm, thickness: 3 mm}",
    "{type: circular_tube, diameter: 40 mm, thickness: 3 mm}",
)


def arm(shape, kind="elastic", hinges="hinges: auto"):
    return ARM.replace("SHAPE", shape).replace("KIND", kind).replace("HINGES", hinges)


def found(analysis):
    bent = with_elastic_members(analysis.structure, analysis.multibody, analysis.duration)
    return list(oblique_sections(bent))


@pytest.mark.parametrize("kind", ["elastic", "rigid"])
def test_an_angle_bends_further_and_aside(kind):
    (one,) = found(loads(arm(ANGLE, kind)))
    assert (one.code, one.place) == ("oblique_section", "section leg")
    # by hand, mid-lines of 38.5 and 58.5 mm: I_y 10.985, I_z 4.026, I_yz 3.914 cm^4
    assert one.value == pytest.approx(math.atan(3.914 / 4.026), rel=2e-3)
    assert "1.53 times as far, and up to 44.2 deg aside" in one.text


def test_bars_without_hinges_do_not_bend():
    assert found(loads(arm(ANGLE, "rigid", "hinges: auto").replace("hinges: auto\n", ""))) == []


@pytest.mark.parametrize("shape", SYMMETRIC)
def test_sections_with_an_axis_of_symmetry_have_none(shape):
    assert found(loads(arm(shape))) == []


def test_the_multibody_result_has_it_and_that_of_shells_does_not():
    codes = [one.code for one in solve(loads(arm(ANGLE)), checks=False).cautions]
    assert codes.count("oblique_section") == 1
    short = loads(arm(ANGLE).replace("duration: 2 ms", "duration: 0.02 ms"))
    assert "oblique_section" not in [one.code for one in solve(short, "shell").cautions]


def test_check_says_it(tmp_path):
    file = tmp_path / "arm.yaml"
    file.write_text(arm(ANGLE), encoding="utf-8")
    told = CliRunner().invoke(app, ["check", str(file)]).output
    assert told.count("are not its principal axes") == 1


def test_examples_and_structures_of_the_suite_have_none():
    files = [*EXAMPLES.glob("*.yaml"), *(EXAMPLES / "layouts").glob("*.yaml"), *FOLDER.glob("**/*.yaml")]
    assert len(files) > 40
    for file in files:
        assert found(load(file)) == [], file
