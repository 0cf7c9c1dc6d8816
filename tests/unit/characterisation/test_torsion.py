"""Sub-models in torsion: what is solved, where the law is found, and what is refused."""

import json
import math

import numpy as np
import pytest
from typer.testing import CliRunner

from crumple.analysis import load
from crumple.characterisation import Bending, LawStore, Torsion, characterise
from crumple.characterisation.needed import needed
from crumple.characterisation.resolution import Resolution
from crumple.cli.characterise import _model, _Place
from crumple.cli.main import app
from crumple.errors import InputError
from crumple.hinge.measured.library import by_place, read_store
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube
from crumple.section.shapes.channel import Channel

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
TUBE = RectangularTube(width=0.050, depth=0.025, thickness=0.00265)
COARSE = Resolution(3.0, 4.0)


def test_the_curve_is_torque_over_plastic_twist_of_the_whole_length():
    model = Torsion(TUBE, STEEL, sense=-1)
    stiffness = STEEL.shear_modulus * TUBE.torsion_constant / model.length
    torque = np.concatenate([np.linspace(0.0, 1500.0, 50), np.linspace(1500.0, 900.0, 50)])
    plastic = np.concatenate([np.zeros(50), np.linspace(0.0, 0.55, 50)])
    twist = plastic + torque / stiffness
    history = {
        "node.turned.rotation.x": -twist,
        "support.held.moment.x": -torque,
        "support.turned.moment.x": torque,
    }
    curve = model.curve(history)
    assert curve.moment[0] == pytest.approx(1500.0, rel=1e-2)
    assert curve.moment_at(0.275) == pytest.approx(1500.0 - 600.0 * 0.5, rel=1e-3)
    assert curve.rotation[-1] == pytest.approx(math.radians(30.0))


def test_mirrored_sections_are_solved_in_one_sense_and_round_ones_have_another_place_than_bending():
    assert Torsion(TUBE, STEEL).one_law
    round_tube = CircularTube(0.05, 0.0015)
    assert Torsion(round_tube, STEEL).place != Bending(round_tube, STEEL).place
    assert Torsion(TUBE, STEEL).place == Torsion(TUBE, STEEL, sense=-1, length_factor=2.0).place


def test_an_open_section_is_refused():
    with pytest.raises(InputError, match="open section"):
        Torsion(Channel(0.04, 0.08, 0.002), STEEL)


def test_a_coarse_sub_model_gives_a_law_that_is_found_by_its_place(tmp_path):
    model = Torsion(TUBE, STEEL, largest=math.radians(6.0), resolution=COARSE)
    done = characterise(model)
    assert done.curve.moment.max() == pytest.approx(model.plastic_torque, rel=0.05)
    assert done.kinetic < 0.02
    LawStore(tmp_path).keep(model, done.law)
    assert list(by_place(read_store(tmp_path))) == [model.place]
    assert dict(done.law.origin)["load"] == "torsion"
    assert done.law.symmetric


def test_a_structure_in_space_needs_torsion_of_its_closed_sections():
    found = needed(load("examples/09_box_frame.yaml").structure, math.radians(30.0))
    loads = {one.model.load for one in found}
    assert loads == {"bending", "torsion"}
    flat = needed(load("examples/12_l_frame.yaml").structure, math.radians(30.0))
    assert {one.model.load for one in flat} == {"bending"}


def test_the_command_refuses_torsion_of_a_corner_and_unknown_loads():
    tube = ["characterise", "rectangular_tube 50x25x2.65 mm", "--material", "yield 488 MPa, E 210 GPa"]
    corner = CliRunner().invoke(app, [*tube, "--load", "torsion", "--angle", "90 deg"])
    assert "the load does not fit the place" in str(corner.exception)
    other = CliRunner().invoke(app, [*tube, "--load", "shear"])
    assert "the load is unknown" in str(other.exception)


def test_the_command_finds_a_stored_law(tmp_path):
    material = Material("", 210e9, 0.3, 7850.0, 488e6)
    model = Torsion(TUBE, material, largest=math.radians(5.0))
    tube = ["characterise", "rectangular_tube 50x25x2.65 mm", "--material", "yield 488 MPa, E 210 GPa"]
    asked = _model(tube[1], tube[3], _Place("torsion", "y", "+", None, "5 deg"))
    coarse = characterise(Torsion(TUBE, material, largest=model.largest, resolution=COARSE))
    LawStore(tmp_path).keep(asked, coarse.law)
    arguments = [*tube, "--load", "torsion", "--to", "5 deg", "--store", str(tmp_path), "--json"]
    found = CliRunner().invoke(app, arguments)
    assert found.exit_code == 0, found.output
    assert json.loads(found.output)["origin"]["load"] == "torsion"
