"""Sub-models that are crushed: fold count, end of the stroke, what is solved and refused."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

from crumple.characterisation import Crush, LawStore, characterise
from crumple.characterisation.crush import fold_count, stroke
from crumple.characterisation.resolution import Resolution
from crumple.cli.main import app
from crumple.errors import InputError, Status
from crumple.material import Material
from crumple.section import RectangularTube

STEEL = Material("", 210e9, 0.3, 7850.0, 488e6)
SQUARE = RectangularTube(width=0.050, depth=0.050, thickness=0.0015)


def test_the_stroke_ends_where_closed_folds_let_the_force_rise():
    slip = np.linspace(0.0, 0.16, 2000)
    force = 50e3 + 20e3 * np.sin(2.0 * np.pi * slip / 0.02)
    assert stroke(slip, force, 0.02) == pytest.approx(0.16)
    closed = force + np.where(slip > 0.12, (slip - 0.12) * 2e7, 0.0)
    assert stroke(slip, closed, 0.02) == pytest.approx(0.125, abs=0.01)


def test_folds_are_counted_outwards_and_inwards():
    x = np.linspace(0.0, 0.2, 81)
    points = np.concatenate(
        [np.column_stack([x, np.full(81, side), np.zeros(81)]) for side in (0.025, -0.025)]
    )
    wave = 0.008 * np.sin(2.0 * np.pi * x / 0.08)
    moved = np.zeros((1, 162, 3))
    moved[0, :81, 1], moved[0, 81:, 1] = wave, -wave
    states = SimpleNamespace(points=points, displacement=moved, contour=np.repeat([0, 1], 81))
    assert fold_count(SimpleNamespace(states=states), 0.0015) == 5
    states.displacement = 0.1 * moved
    assert fold_count(SimpleNamespace(states=states), 0.0015) == 0


def test_the_law_is_force_over_plastic_shortening_and_bending_sideways_is_refused():
    model = Crush(SQUARE, STEEL)
    stiffness = STEEL.youngs_modulus * SQUARE.area / model.length
    plastic = np.linspace(0.0, 0.7 * model.length, 500)
    force = np.full(500, 50e3)
    history = {
        "node.pushed.displacement.x": -(plastic + force / stiffness),
        "support.held.force.x": -force,
        "support.pushed.force.x": force,
        "node.middle.displacement.y": np.zeros(500),
        "node.middle.displacement.z": np.zeros(500),
    }
    curve = model.curve(history)
    assert curve.energy[-1] == pytest.approx(50e3 * 0.7 * model.length, rel=1e-3)
    assert curve.rotation[-1] == pytest.approx(0.7 * model.length, rel=1e-6)
    history["node.middle.displacement.z"] = np.linspace(0.0, 0.02, 500)
    with pytest.raises(InputError, match="bent sideways"):
        model.curve(history)


def test_a_run_that_fails_where_folds_close_is_repeated_less_far(monkeypatch):
    model = Crush(SQUARE, STEEL)
    reached = {"node.pushed.displacement.x": np.array([0.0, -0.7 * model.length])}
    assert model.less(reached) == pytest.approx(0.63)
    assert model.less({"node.pushed.displacement.x": np.array([0.0, -0.3 * model.length])}) is None
    asked = []

    class Failed(dict):
        status, reason = Status.INVERTED, "an element is inverted"

    def failing(analysis, *others, **options):
        asked.append(analysis)
        return Failed({"node.pushed.displacement.x": np.array([0.0, -0.6 * model.length])})

    monkeypatch.setattr("crumple.characterisation.solving.solve", failing)
    with pytest.raises(InputError, match="ended early: an element is inverted"):
        characterise(model)
    assert len(asked) == 3
    assert asked[1].structure.supports["pushed"].motion.x.h1 == pytest.approx(-0.54 * model.length)


def test_a_sub_model_that_stays_too_fast_is_refused():
    """Twenty times too fast, over less than half a stroke: slowed down twice it keeps 2.8 % kinetic energy.

    The share of kinetic energy in crushing falls more slowly than with the square of the time.
    """
    tube = RectangularTube(0.050, 0.025, 0.00265)
    with pytest.raises(InputError, match="kinetic energy is 2") as caught:
        characterise(Crush(tube, STEEL, largest=0.3, resolution=Resolution(3.0, 0.35)))
    assert caught.value.problems[0].allowed == "at most 2%"


def test_a_coarse_sub_model_gives_a_law_that_the_command_finds(tmp_path):
    coarse = Crush(SQUARE, STEEL, largest=0.4, resolution=Resolution(3.0, 7.0))
    done = characterise(coarse)
    assert done.law.slip
    assert done.law.points(1) == ((0.0,), (coarse.squash_force,))
    assert done.kinetic < 0.02
    assert 0.25 < done.curve.energy[-1] / done.curve.rotation[-1] / coarse.squash_force < 0.5
    store = LawStore(tmp_path)
    store.keep(Crush(SQUARE, STEEL), done.law)
    command = ["characterise", "rectangular_tube 50x50x1.5 mm", "--material", "yield 488 MPa, E 210 GPa"]
    table = CliRunner().invoke(app, [*command, "--load", "crush", "--store", str(tmp_path)])
    assert table.exit_code == 0, table.output
    assert "Force, kN" in table.output
    assert "folds" in table.output
    found = CliRunner().invoke(app, [*command, "--load", "crush", "--store", str(tmp_path), "--json"])
    assert json.loads(found.output)["units"]["force"] == "N"
