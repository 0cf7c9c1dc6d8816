"""`crumple characterise --joint FILE:NODE`: laws of one joint, by the keys that structures look up."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from crumple.analysis import load
from crumple.characterisation.needed import is_joint, needed
from crumple.cli.main import app
from crumple.errors import InputError
from crumple.hinge import read_law
from crumple.hinge.measured.place_hash import PLACE

CAB = "examples/layouts/middle_post.yaml"
FRAME = "examples/12_l_frame.yaml"


def invoke(*arguments):
    return CliRunner().invoke(app, ["characterise", *arguments], catch_exceptions=False)


def listed(*arguments):
    found = invoke(*arguments, "--list")
    assert found.exit_code == 0, found.output
    return found.output


def test_one_joint_of_several_is_listed_with_its_loads():
    told = listed("--joint", f"{CAB}:left_knee")
    assert "left_knee: " in told
    assert "corner of 90 deg" in told
    assert "1 of 1 laws are missing" in told
    told = listed("--joint", f"{CAB}:middle")
    assert "middle: " in told
    assert "corner" not in told


def test_a_file_with_one_joint_needs_no_node_and_section_and_material_may_stand_beside_it():
    alone = listed("--joint", FRAME)
    assert "corner of 90 deg" in alone
    assert listed(f"{FRAME}:tube", "--material", f"{FRAME}:steel", "--joint", FRAME) == alone


def test_the_law_is_kept_where_structures_find_it(tmp_path, monkeypatch):
    # a coarse and fast sub-model: what is tested is the way of the law, not its figures
    monkeypatch.setattr("crumple.characterisation.resolution.Resolution.element_size", lambda *_: 0.012)
    models = []

    def solve(asked, folder, **_):
        from crumple.characterisation import LawStore, characterise
        from crumple.characterisation.parallel import Done

        models.extend(asked)
        for number, model in enumerate(asked):
            yield Done(number, LawStore(folder).keep(model, characterise(model).law))

    monkeypatch.setattr("crumple.characterisation.parallel.characterise_all", solve)
    store = tmp_path / "laws"
    found = invoke("--joint", FRAME, "--to", "10 deg", "--store", str(store))
    assert found.exit_code == 0, found.output
    (file,) = store.glob("*.law.yaml")
    structure = load(Path(FRAME)).structure
    (wanted,) = (one for one in needed(structure, 0.1745) if is_joint(one.model))
    assert dict(read_law(file.read_text(encoding="utf-8"), file.name).origin)[PLACE] == wanted.place
    assert [model.place for model in models] == [wanted.place]
    assert "All 1 laws are in" in listed("--joint", FRAME, "--store", str(store))


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (["--joint", "frame.txt"], "the joint is in no input file"),
        (["--joint", FRAME, "--angle", "90 deg"], "the file gives the joint and its loads"),
        (["--joint", FRAME, "--load", "torsion"], "the file gives the joint and its loads"),
        (["--joint", CAB], "does not have exactly one joint"),
        (["--joint", "examples/01_tube_bending.yaml"], "does not have exactly one joint"),
        (["--joint", f"{CAB}:nowhere"], "there is no such node"),
        (["--joint", f"{CAB}:left_foot"], "no law of this joint can be computed: no two members meet"),
        (["square_tube 40x40x2 mm", "--joint", FRAME], "the joint has another section"),
        (["--material", "S355", "--joint", FRAME], "the joint has another material"),
        ([], "there is nothing to characterise"),
    ],
)
def test_what_cannot_be_is_refused(arguments, what):
    with pytest.raises(InputError, match=what):
        invoke(*arguments)
