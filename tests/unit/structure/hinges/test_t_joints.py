"""Hinges at welded T-joints: where they are found, and with which stored law."""

import pytest
from tests.support.multibody.frames import STEEL
from tests.support.stored_laws import law_text, store_of
from typer.testing import CliRunner

from crumple.characterisation import TJoint
from crumple.characterisation.needed import left_out, needed
from crumple.cli.main import app
from crumple.material import Material
from crumple.section import RectangularTube
from crumple.structure import MultibodySettings, Structure, law_uses, placed_hinges, with_elastic_members
from crumple.structure.hinges.t_joints import t_places

METAL = Material("any name", 210e9, 0.3, 7850.0, 488e6)
BRANCH, CHORD = RectangularTube(0.036, 0.030, 0.003), RectangularTube(0.060, 0.080, 0.002)
TURNED = RectangularTube(0.030, 0.036, 0.003)
NODES = {"l": (-0.5, 0.0, 0.0), "m": (0.0, 0.0, 0.0), "r": (0.5, 0.0, 0.0), "t": (0.0, 0.0, 0.5)}
FACE, SPRING = 0.039, 3e4
MOMENTS = {"in": 250.0, "across": 220.0}


def frame(*, across=False, **parts):
    """A branch on a chord that lies along x, thrown in their plane or across it."""
    branch = {"section": "branch", "material": "steel", "up": (0.0, 1.0, 0.0)}
    chord = {"section": "chord", "material": "steel", "up": (0.0, 0.0, 1.0)}
    given = {
        "materials": {"steel": STEEL},
        "sections": {
            "branch": {"type": "rectangular_tube", "width": 0.036, "depth": 0.030, "thickness": 0.003},
            "chord": {"type": "rectangular_tube", "width": 0.060, "depth": 0.080, "thickness": 0.002},
        },
        "nodes": NODES,
        "members": {
            "left": {"nodes": ("l", "m"), **chord},
            "right": {"nodes": ("m", "r"), **chord},
            "stem": {"nodes": ("m", "t"), **branch},
        },
        "supports": {"l": {"node": "l", "fix": "all"}, "r": {"node": "r", "fix": "all"}},
        "hinges": "auto",
        "initial_velocity": [{"nodes": ["t"], "translation": (3.0, 1.0 if across else 0.0, 0.0)}],
        "masses": {"tip": {"node": "t", "mass": 10.0}},
    }
    return Structure(**given | parts)


def stored(tmp_path, *planes):
    texts = [
        law_text(TJoint(BRANCH, CHORD, METAL, p).place, MOMENTS[p], MOMENTS[p], joint="T", stiffness=SPRING)
        for p in planes
    ]
    return str(store_of(tmp_path / "laws", *texts))


def test_without_a_stored_law_the_branch_folds_as_a_member():
    whole = frame()
    assert set(t_places(whole)) == {"m"}
    # both are deep
    assert {hinge.law.name for hinge in placed_hinges(whole)} == {"clamped_tube"}
    command = law_uses(whole)["stem-m"].command
    assert command.split(" --material ")[0] == "crumple characterise INPUT:branch --chord INPUT:chord"


def test_in_a_plane_the_hinge_is_in_the_face_with_the_spring_of_the_joint(tmp_path):
    whole = frame(laws=stored(tmp_path, "in"))
    joint, *rest = (hinge for hinge in placed_hinges(whole) if hinge.member == "stem")
    assert (joint.name, joint.station, rest) == ("t-joint-m", pytest.approx(FACE), [])
    assert float(joint.law.moment_capacity(0.1)) == MOMENTS["in"]
    assert (joint.record.form.value, joint.record.elastic_stiffness) == ("elastic-plastic", SPRING)
    assert law_uses(whole)["t-joint-m"].origin == "stored"
    assert {hinge.law.name for hinge in placed_hinges(whole) if hinge.member != "stem"} == {"clamped_tube"}


def test_however_the_branch_is_numbered_the_hinge_is_in_the_face(tmp_path):
    stem = {"nodes": ("t", "m"), "section": "branch", "material": "steel", "up": (0.0, 1.0, 0.0)}
    members = {name: spec.model_dump(exclude_unset=True) for name, spec in frame().members.items()}
    members["stem"] = stem
    whole = frame(members=members, laws=stored(tmp_path, "in"))
    joint = next(hinge for hinge in placed_hinges(whole) if hinge.name == "t-joint-m")
    assert joint.station == pytest.approx(0.5 - FACE)


def test_in_space_each_axis_has_the_law_of_its_plane(tmp_path):
    whole = frame(across=True, laws=stored(tmp_path, "in", "across"))
    joint = next(hinge for hinge in placed_hinges(whole) if hinge.name == "t-joint-m")
    moments = {c.freedom.name: float(c.record.positive.moment[0]) for c in joint.spatial.components}
    # the branch's width lies along the chord: it turns about z in the plane
    assert (moments["Z"], moments["Y"]) == (MOMENTS["in"], MOMENTS["across"])


def test_tension_does_not_hold_the_fold_of_a_joint_whose_law_is_stored(tmp_path):
    whole = frame(across=True, laws=stored(tmp_path, "in", "across"))
    bent = with_elastic_members(whole, MultibodySettings(members="elastic"), 0.1)
    flanges = {hinge.name: hinge.flanges for hinge in placed_hinges(bent) if hinge.plastic}
    assert not flanges.pop("t-joint-m")
    assert flanges
    assert all(flanges.values())


def test_a_plane_without_a_stored_law_has_that_of_the_member(tmp_path):
    whole = frame(across=True, laws=stored(tmp_path, "in"))
    joint = next(hinge for hinge in placed_hinges(whole) if hinge.name == "t-joint-m")
    moments = {c.freedom.name: float(c.record.positive.moment[0]) for c in joint.spatial.components}
    assert moments["Z"] == MOMENTS["in"]
    assert moments["Y"] > 1000.0


def test_sections_are_turned_as_in_the_sub_model():
    """With the branch's depth along the chord, on a chord that lies on its side."""
    chord = {"section": "chord", "material": "steel", "up": (0.0, 1.0, 0.0)}
    whole = frame(
        members={
            "left": {"nodes": ("l", "m"), **chord},
            "right": {"nodes": ("m", "r"), **chord},
            "stem": {"nodes": ("m", "t"), "section": "branch", "material": "steel", "up": (1.0, 0.0, 0.0)},
        }
    )
    joint = t_places(whole)["m"]
    assert (joint.section, joint.axes["in"]) == (TURNED, "y")
    assert (joint.chord.width, joint.chord.depth) == (0.080, 0.060)


def both(**section):
    return {"sections": {"branch": section, "chord": section}}


@pytest.mark.parametrize(
    "parts",
    [
        {"nodes": {**NODES, "t": (0.25, 0.0, 0.43)}},
        {"nodes": {**NODES, "r": (0.4, 0.0, 0.3)}},
        {"nodes": {**NODES, "t": (0.0, 0.2, 0.5)}},
        {"supports": {"m": {"node": "m", "fix": "all"}}},
        both(type="rectangular_tube", width=0.05, depth=0.06, thickness=0.002),
        both(type="circular_tube", diameter=0.05, thickness=0.002),
    ],
    ids=["oblique", "bent chord", "beside the normal", "held", "too wide", "round"],
)
def test_other_joints_are_none(parts):
    assert t_places(frame(across=True, **parts)) == {}


def test_a_structure_needs_the_laws_of_its_joints():
    models = [one.model for one in needed(frame(across=True), 0.3) if isinstance(one.model, TJoint)]
    assert [model.plane for model in models] == ["across", "in"]
    assert {model.section for model in models} == {BRANCH}
    assert left_out(frame()) == {}
    flat = [one.model for one in needed(frame(), 0.3) if isinstance(one.model, TJoint)]
    assert [model.plane for model in flat] == ["in"]


def test_the_command_finds_the_law_of_a_joint(tmp_path):
    arguments = ["characterise", "rectangular_tube 36x30x3", "--material", "yield 488 MPa, E 210 GPa"]
    chord = ["--chord", "rectangular_tube 60x80x2"]
    other = CliRunner().invoke(app, [*arguments, "--chord", "circular_tube 60x2"])
    assert "welded T-joints are characterised for rectangular tubes" in str(other.exception)
    angle = CliRunner().invoke(app, [*arguments, *chord, "--angle", "90 deg"])
    assert "a T-joint is at a right angle" in str(angle.exception)
    wide = CliRunner().invoke(app, [*arguments, "--chord", "rectangular_tube 20x80x2"])
    assert "wider than the face" in str(wide.exception)
    assert tmp_path.is_dir()
