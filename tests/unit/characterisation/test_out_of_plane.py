"""Sub-models of corners out of their plane: direction of the moment, strength of the pieces, use."""

import math

import numpy as np
import pytest

from crumple.analysis import loads
from crumple.characterisation import Bending, LawStore, OutOfPlane, characterise
from crumple.characterisation.needed import needed
from crumple.characterisation.resolution import Resolution
from crumple.errors import InputError
from crumple.hinge.measured.library import by_place, is_of_joint, read_store
from crumple.material import Material
from crumple.section import RectangularTube, plastic_interaction
from crumple.section.shapes.hat import Hat

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
TUBE = RectangularTube(width=0.050, depth=0.025, thickness=0.00265)
FRAME = """
crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 488 MPa}
sections: {tube: {type: rectangular_tube, width: 50 mm, depth: 25 mm, thickness: 2.65 mm}}
nodes: {root: [0 m, 0 m, 0 m], knee: [0 m, 0 m, 0.4 m], tip: [0.4 m, 0 m, HEIGHT m]}
members:
  post: {nodes: [root, knee], section: tube, material: steel}
  arm: {nodes: [knee, tip], section: tube, material: steel}
hinges: auto
supports: {clamp: {node: root, fix: all}}
initial_velocity: [{nodes: [tip], translation: [0 m/s, 1 m/s, 0 m/s]}]
masses: {tip: {node: tip, mass: 10 kg}}
analysis: {duration: 10 ms}
"""


@pytest.mark.parametrize("axis", ["y", "z"])
@pytest.mark.parametrize("degrees", [60.0, 90.0])
def test_the_moment_is_in_the_plane_and_perpendicular_to_the_second_piece(axis, degrees):
    structure = OutOfPlane(TUBE, STEEL, axis, math.radians(degrees)).analysis().structure
    along = np.subtract(structure.nodes["turned"], structure.nodes["middle"])
    motion = structure.supports["turned"].motion
    turns = [getattr(motion, f"r{one}") for one in "xyz"]
    driven = np.array([0.0 if turn is None else turn.h1 for turn in turns])
    assert driven @ along == pytest.approx(0.0, abs=1e-9)
    assert driven["xyz".index(axis)] == 0.0
    # at 90 degrees it is the axis of the first piece, which is twisted
    assert driven[0] / np.linalg.norm(driven) == pytest.approx(math.sin(math.radians(degrees)))


def test_the_pieces_yield_in_torsion_at_a_right_angle():
    walls = plastic_interaction(TUBE, STEEL)
    assert OutOfPlane(TUBE, STEEL).strength == pytest.approx(walls.plastic_torque)
    # about its weak axis the second piece is bent by less than the first is twisted by
    assert OutOfPlane(TUBE, STEEL, "z").strength == pytest.approx(min(walls.plastic_torque, walls.scales[1]))
    assert OutOfPlane(TUBE, STEEL, angle=1e-6).strength == pytest.approx(walls.scales[2])


def test_a_corner_as_strong_as_its_members_is_refused():
    model = OutOfPlane(TUBE, STEEL)
    moment = np.linspace(0.0, 0.99 * model.strength, 100)
    history = {"node.turned.rotation.x": np.linspace(0.0, 0.6, 100)}
    history |= {"support.held.moment.x": moment, "support.turned.moment.x": -moment}

    class Made(dict):
        time = np.zeros(100)

    with pytest.raises(InputError, match="as strong as its members"):
        model.curve(Made(history))
    with pytest.raises(InputError, match="mirror image"):
        OutOfPlane(Hat(width=0.060, depth=0.050, thickness=0.0015, flange=0.020), STEEL, "z")


def test_right_angled_corners_of_structures_in_space_need_it():
    loads_of = [one.model.load for one in needed(loads(FRAME.replace("HEIGHT", "0.4")).structure, 0.5)]
    assert loads_of.count("out-of-plane") == 1
    oblique = needed(loads(FRAME.replace("HEIGHT", "0.6")).structure, 0.5)
    assert "out-of-plane" not in [one.model.load for one in oblique]


def test_a_coarse_law_is_found_by_its_place_and_has_the_spring_of_the_corner(tmp_path):
    model = OutOfPlane(TUBE, STEEL, largest=math.radians(6.0), resolution=Resolution(3.0, 5.0))
    done = characterise(model)
    assert done.kinetic < 0.02
    assert done.law.symmetric
    assert is_of_joint(done.law)
    assert done.law.elastic_stiffness is not None
    # the walls of the mitre give way before the post yields in torsion
    assert 0.5 < done.curve.moment.max() / model.strength < 0.9
    LawStore(tmp_path).keep(model, done.law)
    assert list(by_place(read_store(tmp_path))) == [model.place]
    assert model.place != Bending(TUBE, STEEL, angle=model.angle).place
