"""The unasked warning that a member would fold along its axis, where nothing in the model can shorten."""

from pathlib import Path

import numpy as np
import pytest
from tests.support.structures import STEEL

from crumple.analysis import loads, solve
from crumple.hinge import build_axial_law
from crumple.multibody import Run, solve_multibody
from crumple.multibody.checks.crushing import _strongest
from crumple.structure import MultibodySettings, Outputs, SectionForce, Stage, Structure
from crumple.units import plain_number

SIDE, WALL = 0.05, 0.0015
CRUSH = Path(__file__).parents[4] / "examples" / "07_axial_crush.yaml"


def column(force, axial=None, **parts):
    """Tube on its clamp under a force along it that rises in 10 ms and stays."""
    law = {"type": "constant", "moment": 5000.0, "rate": "off"}
    hinge = {"name": "foot", "at": 0.05, "law": law}
    hinge |= {"axis": "y"} if axial is None else {"axes": ("y", "z"), "axial": axial}
    member = {"nodes": ("a", "b"), "section": "tube", "material": "steel", "hinges": (hinge,)}
    rise = {"z": {"table": {"time": (0.0, 0.01, 1.0), "value": (0.0, -force, -force)}}}
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": {"type": "square_tube", "side": SIDE, "thickness": WALL}},
        nodes={"a": (0, 0, 0), "b": (0, 0, 0.4)},
        members={"ab": member},
        supports={"clamp": {"node": "a", "fix": "all"}},
        masses={"m": {"node": "b", "mass": 50.0}},
        loads=[{"node": "b", "force": rise}],
        **parts,
    )


def about(structure, kernel="spatial"):
    outputs = (
        Outputs(section_forces={"cut": SectionForce(member="ab", at=0.2)})
        if kernel == "spatial"
        else Outputs()
    )
    run = Run(0.02, 1e-3, MultibodySettings(kernel=kernel), outputs)
    return [text for text in solve_multibody(structure, run).warnings if "along its axis" in text]


@pytest.fixture
def peak():
    whole = column(1.0)
    return build_axial_law("square", whole.section_of("ab"), whole.material_of("ab")).peak_force


def test_a_column_pressed_beyond_its_folding_force_is_named(peak):
    (text,) = about(column(1.1 * peak))
    assert text.startswith(f"Member ab carries up to {plain_number(1.1 * peak / 1e3)} kN along its axis")
    assert f"{plain_number(peak / 1e3)} kN fold the walls (by the law square)" in text
    assert "'axial: {law: square}'" in text
    assert about(column(0.9 * peak)) == []
    # tension folds nothing, and what can shorten needs no warning
    assert about(column(-1.1 * peak)) == []
    assert about(column(1.1 * peak, axial={"law": "square"})) == []


@pytest.mark.parametrize("every", ["0.005 ms", "0.05 ms", "0.3 ms", "10 ms"])
def test_a_tube_thrown_at_a_wall_along_its_axis_is_named(every):
    """200 kg and the tube stop at once from 10 m/s: in the time of a wave along the tube and back."""
    result = solve(loads(CRUSH.read_text("utf-8").replace("every: 0.05 ms", f"every: {every}")))
    (text,) = [text for text in result.warnings if "along its axis" in text]
    carried = float(text.split("carries up to ")[1].split(" kN")[0])
    wave = 2.0 * 0.2 / np.sqrt(210e9 / 7850.0)
    assert carried == pytest.approx(200.0 * 10.0 / wave / 1e3, rel=0.01)
    assert "axial folding is not modelled" in text


@pytest.mark.parametrize("every", [0.1, 0.5, 2.0])
def test_a_force_that_lasts_is_its_own_mean(every):
    """It acts from 3 s to 5 s with 2 N: a blow of 1 s has 2 N, one of 4 s half of it."""
    time = np.arange(0.0, 8.0 + every / 2.0, every)
    impulse = 2.0 * np.clip(time - 3.0, 0.0, 2.0)
    force = np.zeros((len(time), 3))
    force[1:, 1] = np.diff(impulse) / every
    # the first value is that of one shortest step
    force[0] = 1e9
    assert _strongest(time, force, 1.0) == pytest.approx([0.0, 2.0, 0.0])
    assert _strongest(time, force, 4.0) == pytest.approx([0.0, 1.0, 0.0])


KINKED_RAIL = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections: {tube: {type: square_tube, side: 50 mm, thickness: 2 mm}}
nodes: {front: [0 m, 0 m, 0 m], bend: [0.3 m, 0 m, 0 m], rear: [0.6 m, 0 m, 0.15 m]}
members:
  first: {nodes: [front, bend], section: tube, material: steel}
  second: {nodes: [bend, rear], section: tube, material: steel}
hinges: {law: {type: constant, moment: 8 kN m}}
supports: {sled: {node: rear, fix: [y, z, rx, ry, rz]}}
masses: {sled: {node: rear, mass: 50 kg}}
obstacles: {wall: {type: plane, point: [0 m, 0 m, 0 m], normal: [1, 0, 0]}}
initial_velocity: [{translation: [-5 m/s, 0 m/s, 0 m/s]}]
analysis: {duration: 10 ms, multibody: {members: rigid, mechanism_check: off}}
"""
"""Its hinges are too strong, so that it is pressed together instead of bent."""


def test_members_that_sway_are_not_told_to_bend_which_would_not_shorten_them():
    result = solve(loads(KINKED_RAIL))
    (text,) = [text for text in result.warnings if "along their axes" in text]
    assert "Give them hinges with 'axial: {law: square}'" in text
    assert "members: elastic" not in text


def test_rigid_members_that_an_impact_would_stop_shorten():
    settings = "hinges: auto\nanalysis:\n  multibody: {members: rigid, mechanism_check: off}"
    result = solve(loads(CRUSH.read_text("utf-8").replace("analysis:", settings)))
    assert not any("along its axis" in text for text in result.warnings)
    assert result["hinge.tube-head.slip.x.travel"].min() < -0.1


@pytest.mark.parametrize("members", ["rigid", "auto"])
def test_members_without_hinges_are_told_that_they_are_rigid_and_what_gives_them_hinges(members):
    settings = f"multibody: {{members: {members}}}\n  shell:"
    result = solve(loads(CRUSH.read_text("utf-8").replace("shell:", settings)))
    (text,) = [text for text in result.warnings if "along its axis" in text]
    assert "but without hinges it is one rigid body: axial folding is not modelled" in text
    assert "or 'members: elastic' in analysis.multibody" in text


def test_members_that_the_input_calls_rigid_carry_everything_without_a_word():
    rigid = CRUSH.read_text("utf-8").replace("material: steel}", "material: steel, rigid: true}", 1)
    result = solve(loads(rigid))
    assert not [text for text in result.warnings if "along its axis" in text]


@pytest.mark.parametrize(
    ("share", "kind", "members", "named"),
    [
        (1.1, "quasi-static", "rigid", True),
        (0.9, "quasi-static", "rigid", False),
        (1.1, "dynamic", "rigid", False),
        (0.9, "quasi-static", "elastic", False),
    ],
)
def test_rigid_bars_that_would_buckle_under_slow_loading_are_named(share, kind, members, named):
    whole = column(0.0)
    section, steel = whole.section_of("ab"), whole.material_of("ab")
    euler = np.pi**2 * steel.youngs_modulus * section.second_moment("y") / 3.0**2
    long = column(share * euler).model_copy(update={"nodes": {"a": (0, 0, 0), "b": (0, 0, 3.0)}})
    stage = Stage.model_validate({"name": "push", "kind": kind, "duration": 0.02})
    run = Run(0.02, 1e-3, MultibodySettings(members=members), stages=(stage,))
    cautions = [one for one in solve_multibody(long, run).cautions if one.code == "buckling"]
    assert len(cautions) == named
    for one in cautions:
        assert one.value == pytest.approx(share * euler, rel=1e-3)
        assert one.limit == pytest.approx(euler)
        assert "1.1 times the load of Euler between pinned ends (ab: " in one.text
        assert "let members bend (analysis.multibody.members: elastic)" in one.text


@pytest.mark.parametrize(("speed", "ends", "named"), [(6.0, 2, True), (4.0, 2, False), (6.0, 1, False)])
def test_hinges_that_are_crushed_together_by_more_than_their_stroke_are_named(speed, ends, named):
    """50 kg at 6 m/s have 900 J: 90 mm at 10 kN, where folds of 50 mm are closed; at 4 m/s 40 mm."""
    thrown = [{"nodes": ["b"], "translation": (0.0, 0.0, -speed)}]
    whole = column(0.0, {"peak": 10e3, "mean": 10e3, "stroke": 0.05}, initial_velocity=thrown)
    (foot,) = whole.members["ab"].hinges
    hinges = (foot, foot.model_copy(update={"name": "head", "at": 0.35}))[:ends]
    member = whole.members["ab"].model_copy(update={"hinges": hinges})
    result = solve_multibody(whole.model_copy(update={"members": {"ab": member}}), Run(0.05, 1e-3))
    found = [one for one in result.cautions if one.place == "member ab" and one.code == "bottomed_out"]
    assert len(found) == named
    for one in found:
        assert one.limit == 0.05
        assert one.value == pytest.approx(0.09, rel=0.05)
        assert "crushed by" in one.text
