"""Errors of the couplings of hinges: of a fold that combines its loads as a coupling says, they are zero."""

import math
from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

from crumple.characterisation import Bending, LawCurve, characterise
from crumple.characterisation.combined import Combined, FixedRatio
from crumple.characterisation.interaction import interaction_errors
from crumple.characterisation.resolution import Resolution
from crumple.cli.main import app
from crumple.hinge.bending.edge_fold import edge_relief
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube, plastic_interaction

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
TUBE = RectangularTube(width=0.050, depth=0.050, thickness=0.0015)
ROTATION = np.linspace(0.0, math.radians(30.0), 61)


def softening(factor=1.0, added=0.0):
    """A made-up fold whose moment falls from 2000 to 1000 N m."""
    moment = np.minimum((2000.0 - 1000.0 * ROTATION / ROTATION[-1]) * factor + added, 2000.0)
    energy = np.concatenate([[0.0], np.cumsum(0.5 * (moment[1:] + moment[:-1]) * np.diff(ROTATION))])
    return LawCurve(ROTATION, moment, energy)


def test_a_fold_about_its_tension_flange_has_no_error_of_that_coupling():
    arm = (0.050 - 0.0015) / 2.0

    def solved(model: Combined) -> LawCurve:
        return softening(added=model.force * arm)

    found = interaction_errors(Bending(TUBE, STEEL), solved)
    for key in ("axial_compression", "axial_tension"):
        assert found[key].endswith("tension-flange work +0% to 10 deg, +0% to 30 deg")
    words = "a radian: coupling tension-flange work +"
    half, quarter = found["axial_fixed_ratio"].split("; ")
    assert half == f"shortening of b/2 {words}0% to 10 deg, +0% to 30 deg"
    assert quarter.startswith(f"shortening of b/4 {words}")
    assert "coupling section work +" in found["axial_compression"]
    assert "coupling section work -" in found["axial_tension"]


def test_a_fold_that_interacts_like_its_walls_has_no_error_of_that_coupling():
    outline = plastic_interaction(TUBE, STEEL).force_moment_curve("y")
    upper = outline[outline[:, 1] > 0.0]
    upper = upper[np.argsort(upper[:, 0])]
    squash = plastic_interaction(TUBE, STEEL).squash_force
    left = float(np.interp(0.2 * squash, *upper.T)) / float(upper[:, 1].max())

    def solved(model: Combined) -> LawCurve:
        return softening(left if model.share else 1.0)

    found = interaction_errors(Bending(TUBE, STEEL), solved)
    assert "coupling section work +0% to 10 deg, +0% to 30 deg" in found["axial_tension"]


def test_a_fold_about_a_diagonal_that_softens_as_a_hinge_does_has_no_error():
    """A square tube turned about both axes alike: the other one counts half, and the edge is relieved."""
    outline = plastic_interaction(TUBE, STEEL).moment_curve()
    wider = float((outline / np.abs(outline).max(axis=0)).sum(axis=1).max()) * math.sqrt(0.5)
    plain = softening()
    share = (1.0 - edge_relief(TUBE)) * math.sqrt((1.0 + 0.5**2) / 2.0)
    assert share < 0.7
    slower = np.interp(share * wider * ROTATION, ROTATION, plain.moment)
    steps = np.diff(ROTATION) * (slower[1:] + slower[:-1]) / 2.0
    oblique = LawCurve(ROTATION, wider * slower, wider * np.concatenate([[0.0], np.cumsum(steps)]))

    def solved(model: Combined) -> LawCurve:
        return oblique if model.angle == pytest.approx(math.pi / 4.0) else plain

    found = interaction_errors(Bending(TUBE, STEEL), solved)
    assert found["oblique_45_deg"] == "coupling section work +0% to 10 deg, +0% to 30 deg"


def test_the_edge_is_relieved_less_where_both_axes_do_not_do_the_same_work():
    """A square tube that is half as strong about z: works as 2 to 1 at 45 degrees, so that q = 0.8."""
    plain, half = softening(), softening(0.5)
    outline = plastic_interaction(TUBE, STEEL).moment_curve()
    shares, turn = outline / np.abs(outline).max(axis=0), math.sqrt(0.5)
    relieved = 1.0 - 0.8**4 * edge_relief(TUBE)
    measure = turn * float((shares @ [1.0, 0.5]).max()) * relieved / math.hypot(1.0, 0.5)
    about_y = np.interp(measure * math.hypot(1.0, 0.5) * ROTATION, ROTATION, plain.moment)
    # half of the rotation about y counts about z, with the capacity of z
    about_z = np.interp(measure / 0.5 * math.hypot(0.5, 0.25) * ROTATION, ROTATION, half.moment)
    moment = turn * (shares @ np.array([about_y, about_z])).max(axis=0)
    steps = np.diff(ROTATION) * (moment[1:] + moment[:-1]) / 2.0
    oblique = LawCurve(ROTATION, moment, np.concatenate([[0.0], np.cumsum(steps)]))

    def solved(model: Combined) -> LawCurve:
        if model.angle == pytest.approx(math.pi / 4.0):
            return oblique
        return half if model.angle > 1.0 else plain

    found = interaction_errors(Bending(TUBE, STEEL), solved)
    assert found["oblique_45_deg"] == "coupling section work +0% to 10 deg, +0% to 30 deg"


def test_round_sections_have_no_oblique_axis():
    found = interaction_errors(Bending(CircularTube(0.05, 0.0015), STEEL), lambda model: softening())
    assert set(found) == {"axial_compression", "axial_tension", "axial_fixed_ratio"}


def test_the_force_acts_before_the_turn_and_the_moment_includes_its_arm():
    model = Combined(TUBE, STEEL, math.pi / 4.0, -0.2)
    structure = model.analysis().structure
    assert model.force == pytest.approx(-0.2 * plastic_interaction(TUBE, STEEL).squash_force)
    middle = structure.nodes["middle"]
    # the middle moves away from the line of the force, at right angles to the axis of rotation
    assert middle[1] == pytest.approx(-middle[2])
    zero = np.zeros(200)
    turned = np.linspace(0.0, 0.7, 200)
    history = {
        f"node.{n}.rotation.{a}": s * turned * math.sqrt(0.125)
        for n, s in (("held", -1), ("turned", 1))
        for a in "yz"
    }
    history |= {f"support.{n}.moment.{a}": zero for n in ("held", "turned") for a in "yz"}
    history |= {"support.held.force.x": zero + model.force}
    history |= {"node.middle.displacement.y": zero - 0.01, "node.middle.displacement.z": zero + 0.01}
    arm = math.hypot(0.01, 0.01) + model.half * math.tan(math.radians(0.1))
    assert model.curve(history).moment[5] == pytest.approx(-model.force * arm, rel=1e-6)


def test_a_fold_pushed_in_a_fixed_ratio_rotates_about_its_flange():
    """Prescribed motion against two rigid halves that turn about a line at a distance; sums of half waves."""
    model = FixedRatio(TUBE, STEEL, ratio=0.024)
    case = model.analysis()
    turned = case.structure.supports["turned"]
    times = np.linspace(0.0, case.duration, 41)
    theta = 2.0 * turned.driven["ry"](times)
    exact = 2.0 * model.half * (np.cos(theta / 2.0) - 1.0) - 2.0 * model.ratio * np.sin(theta / 2.0)
    moved = turned.driven["x"](times)
    assert theta[-1] == pytest.approx(model._turn)
    # the first term that is left out is theta^2/24 of the shortening
    assert np.abs(moved - exact).max() < theta[-1] ** 2 / 24.0 * np.abs(exact).max()
    plain = replace(model, ratio=0.0).analysis().structure.supports["turned"]
    assert plain.driven["x"](times) == pytest.approx(2.0 * model.half * (np.cos(theta / 2) - 1.0), abs=1e-4)


def test_the_work_in_a_fixed_ratio_is_that_of_moment_and_force_less_the_elastic_part():
    """Moment 900 N m and compression 40 kN, both constant after an elastic rise in a time step each."""
    model = FixedRatio(TUBE, STEEL, ratio=0.024)
    theta = np.linspace(0.0, 0.7, 701)
    force, moment = np.full(701, -40e3), np.full(701, 900.0)
    force[0] = moment[0] = 0.0
    zero = np.zeros(701)
    history = {
        "node.held.rotation.y": -theta / 2.0,
        "node.turned.rotation.y": theta / 2.0,
        "support.held.moment.y": moment,
        "support.turned.moment.y": -moment,
        "support.held.moment.z": zero,
        "support.turned.moment.z": zero,
        "support.held.force.x": force,
        "support.turned.force.x": -force,
        "node.held.displacement.x": zero,
        "node.turned.displacement.x": -0.024 * theta,
        "node.middle.displacement.y": zero,
        "node.middle.displacement.z": zero - model.half * math.tan(math.radians(0.1)),
    }
    history |= {f"node.{name}.rotation.z": zero for name in ("held", "turned")}
    curve = model.curve(history)
    # what was stored elastically is not plastic work, and not plastic rotation
    expected = 900.0 + 40e3 * 0.024
    assert curve.energy_at(0.5) - curve.energy_at(0.2) == pytest.approx(0.3 * expected, rel=1e-3)
    assert curve.moment_at(0.35) == pytest.approx(expected, rel=1e-3)


def test_a_coarse_law_states_the_errors_and_the_command_refuses_it_for_corners():
    model = Bending(TUBE, STEEL, largest=math.radians(10.0), resolution=Resolution(2.0, 5.0))
    origin = dict(characterise(model, interaction=True).law.origin)
    assert "tension-flange work" in origin["axial_compression"]
    assert "to 10 deg" in origin["oblique_45_deg"]
    assert "to 30 deg" not in origin["oblique_45_deg"]
    command = ["characterise", "rectangular_tube 50x50x1.5 mm", "--material", "yield 488 MPa, E 210 GPa"]
    found = CliRunner().invoke(app, [*command, "--interaction", "--angle", "90 deg"])
    assert "--interaction is for straight members" in str(found.exception)
