"""Sub-models that a structure needs, what they cost, and several of them in processes of their own."""

import math
from pathlib import Path

import pytest
from typer.testing import CliRunner

from crumple.analysis import load
from crumple.characterisation import Bending, OutOfPlane
from crumple.characterisation.needed import left_out, needed
from crumple.characterisation.out_of_plane import usual_resolution
from crumple.characterisation.parallel import characterise_all
from crumple.characterisation.resolution import Resolution
from crumple.cli.main import app
from crumple.hinge.measured.library import by_place, read_store
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube

LARGEST = math.radians(30.0)
STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
COARSE = Resolution(3.0, 4.0)


def test_every_distinct_member_and_corner_is_needed_once():
    found = needed(load("examples/04_portal_frame.yaml").structure, LARGEST)
    where = {one.model.angle is None: set(one.where) for one in found}
    assert where == {True: {"left_column", "right_column"}, False: {"left_knee", "right_knee"}}
    assert len({one.place for one in found}) == len(found) == 2


@pytest.mark.parametrize(("depth", "needs"), [(0.025, True), (0.070, False)])
def test_members_whose_folds_have_the_table_of_clamped_tubes_need_no_law(depth, needs):
    frame = load("examples/12_l_frame.yaml").structure
    (name,) = frame.sections
    tube = {"type": "rectangular_tube", "width": 0.050, "depth": depth, "thickness": 0.00265}
    changed = frame.model_copy(update={"sections": {name: tube}})
    loads = [(one.model.load, one.model.angle is None, one.where) for one in needed(changed, LARGEST)]
    assert (("bending", True, ("post",)) in loads) == needs
    assert ("bending", False, ("corner",)) in loads


def test_joints_of_more_than_two_members_are_listed_with_the_reason():
    whole = load("examples/09_box_frame.yaml").structure
    assert set(left_out(whole).values()) == {"3 members meet"}
    assert not any(isinstance(one.model, Bending) and one.model.angle for one in needed(whole, LARGEST))


def test_the_estimate_grows_with_both_senses_and_finer_meshes():
    frame = needed(load("examples/12_l_frame.yaml").structure, LARGEST)
    straight, corner = sorted(frame, key=lambda one: one.model.angle is not None)
    assert corner.seconds() > 2.0 * straight.seconds()
    more = sum(ratio**3 for ratio in (1.25, 1.5625))
    assert straight.seconds(converge=True) == pytest.approx(straight.seconds() * (1.0 + more))


def test_corners_about_their_bisector_have_a_coarser_mesh_if_their_pieces_are_long():
    square, ring = RectangularTube(0.050, 0.050, 0.002), CircularTube(0.050, 0.002)
    for section, about, elements in (
        (square, "bisector", 5.0),
        (square, "tangent", 8.0),
        (ring, "bisector", 8.0),
    ):
        assert usual_resolution(section, about).elements == elements
    frame = needed(load("tests/concordance/structures/l_across.yaml").structure, LARGEST)
    across = {one.model.about: one.model for one in frame if isinstance(one.model, OutOfPlane)}
    assert across["bisector"].resolution.elements == 5.0
    assert across["tangent"].resolution.elements == 8.0


def test_the_list_states_what_is_missing_and_solves_nothing(tmp_path):
    store = tmp_path / "laws"
    arguments = ["characterise", "examples/12_l_frame.yaml", "--list", "--store", str(store)]
    found = CliRunner().invoke(app, arguments)
    assert found.exit_code == 0, found.output
    assert "2 of 2 laws are missing" in found.output
    assert "corner of 90 deg: missing, about" in found.output
    assert not store.exists()


def test_laws_are_stored_one_by_one_and_a_failure_has_its_reason(tmp_path):
    section = RectangularTube(0.050, 0.025, 0.00265)
    good = Bending(section, STEEL, largest=math.radians(8.0), resolution=COARSE)
    # a negative length ends its process
    bad = Bending(section, STEEL, largest=math.radians(8.0), length_factor=-1.0, resolution=COARSE)
    ended = {done.number: done for done in characterise_all([good, bad], tmp_path, workers=2)}
    assert ended[0].path is not None
    assert ended[0].path.is_file()
    assert ended[1].path is None
    assert ended[1].reason
    (place,) = by_place(read_store(tmp_path))
    assert place


def test_a_section_without_a_material_is_refused():
    found = CliRunner().invoke(app, ["characterise", "rectangular_tube 50x25x2 mm"])
    assert "a section needs its material" in str(found.exception)
    assert Path("laws").exists() is False


def test_small_elements_of_corners_get_mass_and_those_of_straight_members_do_not():
    structure = load("examples/12_l_frame.yaml").structure
    for one in needed(structure, LARGEST):
        model = one.model
        speed = math.sqrt(model.material.youngs_modulus / model.material.density)
        corner = isinstance(model, OutOfPlane) or model.angle is not None
        expected = pytest.approx(0.8 * model.size / speed) if corner else None
        assert model.analysis().shell.mass_scaling == expected
