"""A mass moves with members that are thrown if all at its node are, in both solvers; a caution if not."""

import numpy as np
import pytest
from tests.support.structures import STEEL
from typer.testing import CliRunner

from crumple.analysis import loads, solve
from crumple.cli.main import app
from crumple.multibody import Run, solve_multibody
from crumple.multibody.bodies.initial_motion import spatial_initial_motion
from crumple.multibody.bodies.linkage import link
from crumple.shell import lower
from crumple.structure import Outputs, ShellSettings, Structure
from crumple.structure.checks.standing import standing_doubts
from crumple.structure.hinges.lengthening.at_start import nodes_at_start
from crumple.structure.keys.stages import Stage

SPEED, LENGTH, LUMP, SIDE, WALL = 6.0, 0.8, 20.0, 0.04, 0.002
TUBE = STEEL["density"] * 4.0 * (SIDE - WALL) * WALL * LENGTH
"""Mass of one member [kg]."""
UP = {"translation": (0.0, 0.0, SPEED)}
HALF = {"translation": (0.0, 0.0, SPEED / 2.0)}
TURN = {"rotation": SPEED / LENGTH, "axis": (0.0, -1.0, 0.0)}
ARM, BEAM = {"members": ("arm",)}, {"members": ("beam",)}
BOTH = {"members": ("arm", "beam")}
COARSE = ShellSettings(element_size=20e-3)


def frame(*fields, fix=(), mass=None, node="b"):
    """Two free tubes in line, arm from a to b and beam from b to c, with a mass at one node."""
    tube = {"section": "tube", "material": "steel"}
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": {"type": "square_tube", "side": SIDE, "thickness": WALL}},
        nodes={name: (k * LENGTH, 0.0, 0.0) for k, name in enumerate("abc")},
        members={"arm": {"nodes": ("a", "b"), **tube}, "beam": {"nodes": ("b", "c"), **tube}},
        supports={f"at_{node}": {"node": node, "fix": fix}} if fix else {},
        masses={"lump": {"node": node, "mass": LUMP} | (mass or {})},
        initial_velocity=fields,
    )


def given(structure, solver):
    """Energy of the fields at the start [J]."""
    if solver == "shell":
        return lower(structure, COARSE).start.given_energy
    return spatial_initial_motion(structure, link(structure), structure.initial_velocity, ()).given_energy


def energy(*tubes, lump):
    """Energy [J] of so many moving tubes and of the lump, at full speed."""
    return (sum(tubes) * TUBE + lump * LUMP) * SPEED**2 / 2.0


SOLVERS = pytest.mark.parametrize("solver", ["multibody", "shell"])


@SOLVERS
@pytest.mark.parametrize(
    "fields",
    [
        [UP],
        [UP | BOTH],
        # the same motion of both members, written as three entries
        [UP | ARM, HALF | BEAM, HALF | BEAM],
        # and half of it of the whole
        [HALF, HALF | BOTH],
        # a node that is named has the entries that name it alone
        [UP | BOTH, UP | {"nodes": ("b",)}],
        [UP | BOTH | {"nodes": ("b",)}],
    ],
)
def test_a_mass_moves_with_all_members_at_its_node(solver, fields):
    assert given(frame(*fields), solver) == pytest.approx(energy(2.0, lump=1.0), rel=1e-6)


@SOLVERS
def test_a_mass_at_the_end_of_a_member_moves_with_it_alone(solver):
    """The tip of the beam is thrown; at the node that both share the mass keeps what it has, here half."""
    tip = frame(UP | BEAM, node="c")
    assert given(tip, solver) == pytest.approx(energy(1.0, lump=1.0), rel=2e-3)
    for fields, parts, of_lump in (
        ([UP | BEAM], 1.0, 0.0),
        ([HALF, HALF | BEAM], 1.0 + 0.25, 0.25),
        ([UP | BEAM, TURN | ARM], 1.0 + 1.0 / 3.0, 0.0),
        ([UP | BEAM | {"nodes": ("b",)}], 1.0, 1.0),
    ):
        expected = energy(parts, lump=of_lump)
        # shells: half of the section at the node moves with either, and the tube about itself has 0.1 %
        assert given(frame(*fields), solver) == pytest.approx(expected, rel=0.02)


@SOLVERS
def test_a_mass_turns_with_its_member(solver):
    turned = frame({**TURN, "about": (LENGTH, 0.0, 0.0)} | BEAM, node="c")
    assert given(turned, solver) == pytest.approx(energy(1.0 / 3.0, lump=1.0), rel=2e-3)


def test_the_tip_of_a_clamped_arm_has_the_speed_of_its_member():
    """Momentum about the clamp is kept, as far as the hinge beside it lets the arm turn."""
    tube = {
        "nodes": ("a", "b"),
        "section": "tube",
        "material": "steel",
        "hinges": [{"name": "root", "at": "a", "offset": 0.0}],
    }
    found = []
    for only in ({}, ARM):
        arm = Structure(
            materials={"steel": STEEL},
            sections={"tube": {"type": "square_tube", "side": SIDE, "thickness": WALL}},
            nodes={"a": (0.0, 0.0, 0.0), "b": (LENGTH, 0.0, 0.0)},
            members={"arm": tube},
            supports={"clamp": {"node": "a", "fix": "all"}},
            masses={"lump": {"node": "b", "mass": LUMP}},
            initial_velocity=[UP | only],
        )
        result = solve_multibody(arm, Run(1e-3, 1e-4, outputs=Outputs(nodes=("b",))))
        found.append((result["energy.kinetic"][0], result["node.b.velocity.z"][0]))
    # of the lump m v L, of the tube m v L/2 = (m L2/3) v/L 3/2: both over the inertia about the hinge
    speed = SPEED * (LUMP + TUBE / 2.0) / (LUMP + TUBE / 3.0)
    assert found[0] == pytest.approx(found[1], rel=1e-9)
    assert found[1][1] == pytest.approx(speed, rel=1e-3)
    assert found[1][0] == pytest.approx((LUMP + TUBE / 3.0) * speed**2 / 2.0, rel=2e-3)


def test_the_rule_of_hinges_sees_the_same_motion():
    mass, velocity = nodes_at_start(frame(UP | BOTH))["b"]
    assert mass == pytest.approx(LUMP + TUBE)
    assert velocity == pytest.approx([0.0, 0.0, SPEED])
    _, velocity = nodes_at_start(frame(UP | BEAM))["b"]
    assert velocity[2] == pytest.approx(SPEED * (TUBE / 2.0) / (LUMP + TUBE))


@SOLVERS
def test_a_mass_that_supports_hold_stays(solver):
    """A point at a pin and any mass at a clamp; one with an offset turns about the pin.

    In shells the section at the node belongs to both tubes: a bit over a hundredth of the beam.
    """
    assert given(frame(UP | BEAM, fix="all", node="c"), solver) == pytest.approx(
        energy(1.0, lump=0.0), rel=0.02
    )
    assert given(frame(UP | BEAM, fix="pin", node="c"), solver) == pytest.approx(
        energy(1.0, lump=0.0), rel=0.02
    )
    off = frame(
        TURN | {"about": (2.0 * LENGTH, 0.0, 0.0)} | BEAM, fix="pin", mass={"offset": (0.1, 0, 0)}, node="c"
    )
    lump = (0.1 / LENGTH) ** 2
    assert given(off, solver) == pytest.approx(energy(1.0 / 3.0, lump=lump), rel=0.03)


def doubts(*fields, stages=(), **parts):
    return list(standing_doubts(frame(*fields, **parts), stages))


def test_a_mass_that_stays_behind_is_a_caution():
    (one,) = doubts(UP | ARM)
    assert (one.code, one.place, one.value, one.unit) == ("standing_mass", "mass lump", LUMP, "kg")
    assert one.text == (
        "Mass not thrown with 'members' of initial_velocity: lump at node b (arm is thrown, beam is not "
        "thrown alike). A mass moves with members if all that end at its node have the same velocity. Where "
        "it should move, add its node to this entry: 'nodes: [b]'."
    )
    assert doubts(UP | ARM, TURN | BEAM)
    assert doubts(stages=[Stage(name="later", duration=1e-3, initial_velocity=[UP | ARM])])


@pytest.mark.parametrize(
    ("fields", "parts"),
    [
        ([], {}),
        ([UP], {}),
        ([UP | BOTH], {}),
        ([UP | BEAM], {"node": "c"}),
        # named, held, or about the node itself
        ([UP | ARM | {"nodes": ("b",)}], {}),
        ([UP | ARM], {"fix": "pin"}),
        ([UP | ARM], {"fix": ("z",)}),
        ([{**TURN, "about": (LENGTH, 0.0, 0.0)} | ARM], {}),
        ([{"translation": (0.0, 0.0, 0.0)} | ARM], {}),
    ],
)
def test_no_caution_where_nothing_stays_behind(fields, parts):
    assert not doubts(*fields, **parts)


def test_a_mass_with_an_offset_would_turn():
    turned = {**TURN, "about": (LENGTH, 0.0, 0.0)} | ARM
    assert doubts(turned, mass={"offset": (0.1, 0.0, 0.0)})


SEAT = """crumple: 1
materials: {s: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}}
sections: {t: {type: square_tube, side: 40 mm, thickness: 2 mm}}
nodes: {foot: [0 m, 0 m, 0 m], hip: [0 m, 0 m, 400 mm], head: [0 m, 0 m, 1 m]}
members:
  leg: {nodes: [foot, hip], section: t, material: s}
  back: {nodes: [hip, head], section: t, material: s}
hinges: auto
supports: {clamp: {node: foot, fix: all}}
masses: {chest: {node: head, mass: 20 kg}, pelvis: {node: hip, mass: 10 kg}}
initial_velocity: [{members: [back], translation: [6 m/s, 0 m/s, 0 m/s]}]
analysis: {duration: 0.02 ms}
outputs: {every: 0.01 ms}
"""


@SOLVERS
def test_results_and_check_have_the_caution(solver, tmp_path):
    result = solve(loads(SEAT), solver, checks=False)
    (one,) = [caution for caution in result.cautions if caution.code == "standing_mass"]
    assert one.place == "mass pelvis"
    assert one.text in result.warnings
    file = tmp_path / "seat.yaml"
    file.write_text(SEAT, encoding="utf-8")
    assert "Caution: Mass not thrown" in CliRunner().invoke(app, ["check", str(file)]).output
    assert float(np.max(result["energy.kinetic"])) > 20.0 * 6.0**2 / 2.0 * 0.9
