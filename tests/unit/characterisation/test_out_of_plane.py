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
from crumple.hinge.measured.place_hash import place_hash
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube, plastic_interaction
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
@pytest.mark.parametrize("about", ["bisector", "tangent"])
def test_the_moment_is_in_the_plane_and_along_a_line_of_symmetry(axis, degrees, about):
    structure = OutOfPlane(TUBE, STEEL, axis, math.radians(degrees), about).analysis().structure
    pieces = (("held", "middle"), ("middle", "turned"))
    before, after = (np.subtract(structure.nodes[b], structure.nodes[a]) for a, b in pieces)
    before, after = before / np.linalg.norm(before), after / np.linalg.norm(after)
    motion = structure.supports["turned"].motion
    turns = [getattr(motion, f"r{one}") for one in "xyz"]
    driven = np.array([0.0 if turn is None else 1.0 for turn in turns])
    assert driven["xyz".index(axis)] == 0.0
    assert before @ after == pytest.approx(math.cos(math.radians(degrees)))
    # the tangent halves the directions of the members, the bisector their difference
    sign = 1.0 if about == "tangent" else -1.0
    assert before @ driven == pytest.approx(sign * (after @ driven))
    half = math.radians(degrees / 2.0)
    part = math.cos(half) if about == "tangent" else math.sin(half)
    assert abs(after @ driven) == pytest.approx(part)


def test_about_the_bisector_pieces_are_longer_than_what_the_corner_distorts():
    """By 1.4 times the length a sqrt(a/t) of rectangular tubes; others have 2.75 sides."""
    thin, ring = RectangularTube(0.050, 0.050, 0.002), CircularTube(0.050, 0.002)
    distorted = 1.4 * 0.048 * math.sqrt(24.0)
    assert OutOfPlane(thin, STEEL).piece == pytest.approx(distorted)
    assert OutOfPlane(thin, STEEL, length_factor=2.0).piece == pytest.approx(2.0 * distorted)
    for other in (OutOfPlane(thin, STEEL, about="tangent"), OutOfPlane(ring, STEEL)):
        assert 2.75 * 0.048 <= other.piece < 0.8 * distorted


def test_the_pieces_yield_in_torsion_and_bending():
    walls = plastic_interaction(TUBE, STEEL)
    torque, bending = walls.plastic_torque, walls.scales[2]
    both = math.sqrt(2.0 / (1.0 / torque**2 + 1.0 / bending**2))
    for about, in_line in (("bisector", bending), ("tangent", torque)):
        assert OutOfPlane(TUBE, STEEL, about=about).strength == pytest.approx(both)
        assert OutOfPlane(TUBE, STEEL, angle=1e-6, about=about).strength == pytest.approx(in_line)


def test_a_corner_as_strong_as_its_members_is_refused():
    model = OutOfPlane(TUBE, STEEL)
    moment = np.linspace(0.0, 0.99 * model.strength, 100)
    # one that does not yield in the rise, and then turns
    moment = np.minimum(2.0 * moment, moment[-1])
    history = {f"node.turned.rotation.{axis}": np.linspace(0.0, 0.6, 100) for axis in "xz"}
    for axis in "xz":
        history |= {f"support.held.moment.{axis}": moment, f"support.turned.moment.{axis}": -moment}

    class Made(dict):
        time = np.zeros(100)

    with pytest.raises(InputError, match="as strong as its members"):
        model.curve(Made(history))
    # about its tangent it is expected to be
    twisted = OutOfPlane(TUBE, STEEL, about="tangent").curve(Made(history))
    assert twisted.moment.max() < model.strength
    with pytest.raises(InputError, match="mirror image"):
        OutOfPlane(Hat(width=0.060, depth=0.050, thickness=0.0015, flange=0.020), STEEL, "z")


@pytest.mark.parametrize("height", ["0.4", "0.6"])
def test_corners_of_structures_in_space_need_both_directions(height):
    models = [one.model for one in needed(loads(FRAME.replace("HEIGHT", height)).structure, 0.5)]
    found = [model.about for model in models if model.load == "out-of-plane"]
    assert found == ["bisector", "tangent"]


def test_a_coarse_law_is_found_by_its_place_and_has_the_spring_of_the_corner(tmp_path):
    model = OutOfPlane(TUBE, STEEL, largest=math.radians(6.0), resolution=Resolution(3.0, 5.0))
    done = characterise(model)
    assert done.kinetic < 0.02
    added = done.result.provenance.settings["added_mass"]
    assert dict(done.law.origin)["mass_scaling"] == f"{1e3 * added:.3g} g added at the smallest elements"
    assert done.law.symmetric
    assert is_of_joint(done.law)
    assert done.law.elastic_stiffness is not None
    # the walls of the mitre give way before the post yields in torsion
    assert 0.4 < done.curve.moment.max() / model.strength < 0.6
    LawStore(tmp_path).keep(model, done.law)
    assert list(by_place(read_store(tmp_path))) == [model.place]
    other = OutOfPlane(TUBE, STEEL, about="tangent")
    in_plane = Bending(TUBE, STEEL, angle=model.angle)
    former = place_hash(TUBE, STEEL, "y", model.angle, load="out-of-plane")
    assert len({model.place, other.place, in_plane.place, former}) == 4
