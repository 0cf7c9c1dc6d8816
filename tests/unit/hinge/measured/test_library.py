"""Stores of laws: which place a law is for, what is read, which of several laws is taken, frozen files."""

from dataclasses import replace

import pytest
from tests.support.stored_laws import law_text, store_of

from crumple.errors import InputError
from crumple.hinge.measured.law_file import read_law, stored_law, write_law
from crumple.hinge.measured.library import (
    by_place,
    frozen,
    is_of_joint,
    mirrored,
    read_store,
    without_checksum,
)
from crumple.hinge.measured.place_hash import place_hash
from crumple.hinge.registry import build_law
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 300e6)
TUBE = RectangularTube(0.05, 0.03, 0.002)


def test_a_place_is_its_metal_and_geometry_not_their_names_or_units():
    here = place_hash(TUBE, STEEL)
    assert here == place_hash(RectangularTube(50 * 1e-3, 3e-2, 2e-3), replace(STEEL, name="other"))
    others = [
        place_hash(TUBE, STEEL, "z"),
        place_hash(TUBE, STEEL, "y", 1.5708),
        place_hash(TUBE, replace(STEEL, yield_stress=301e6)),
        place_hash(replace(TUBE, thickness=0.0021), STEEL),
        place_hash(replace(TUBE, corner_radius=0.004), STEEL),
    ]
    assert len({here, *others}) == 6


def test_tubes_that_are_the_same_about_both_axes_have_one_place():
    for section in (RectangularTube(0.05, 0.05, 0.002), CircularTube(0.05, 0.002)):
        assert place_hash(section, STEEL, "y") == place_hash(section, STEEL, "z")


def test_a_store_is_a_folder_or_the_file_that_freezes_it(tmp_path):
    texts = [law_text("a" * 16), law_text("b" * 16, corner="90 deg")]
    own = write_law(stored_law(build_law("kecman", TUBE, STEEL), {"method": "formula"}))
    folder = store_of(tmp_path / "laws", *texts, own)
    # a law without a place is used where a hinge names it
    assert read_store(folder) == tuple(sorted(texts))
    file = tmp_path / "frozen.yaml"
    file.write_text(frozen(texts, ["a note"]), encoding="utf-8")
    assert read_store(file) == tuple(sorted(texts))


def test_of_several_laws_the_one_with_a_known_error_and_the_longest_is_taken():
    short, long, sure = law_text("p"), law_text("p", reach=0.7), law_text("p", error=0.03, reach=0.4)
    assert by_place([short, long]) == by_place([long, short]) == {"p": long}
    assert by_place([short, long, sure]) == {"p": sure}


def test_a_law_seen_from_the_other_side_has_its_senses_exchanged():
    law = read_law(law_text("p", 400.0, 300.0, corner="90 deg"))
    other = mirrored(law)
    assert [float(other.moment_capacity(0.1, sense)) for sense in (1, -1)] == [300.0, 400.0]
    assert mirrored(other) == law
    assert is_of_joint(law)
    assert not is_of_joint(read_law(law_text("p")))


def test_stores_that_cannot_be_read_are_refused_with_their_file(tmp_path):
    with pytest.raises(InputError, match="no such store"):
        read_store(tmp_path / "none")
    folder = store_of(tmp_path / "laws", law_text("a"), "crumple_law: 7\n")
    with pytest.raises(InputError, match="known format") as error:
        read_store(folder)
    assert error.value.problems[0].file.endswith("1.law.yaml")


@pytest.mark.parametrize(
    ("content", "what"),
    [
        (b"", "is empty"),
        (b"# A collapse law\n", "is empty"),
        (b"\x9e\x8b\x12", "not a text in UTF-8"),
        (b"a: 1", "not a law file"),
        (None, "cannot be read: Is a directory"),
    ],
)
def test_a_file_of_a_store_that_holds_no_law_is_named(content, what, tmp_path):
    folder = store_of(tmp_path / "laws", law_text("a"))
    bad = folder / "bad.law.yaml"
    if content is None:
        bad.mkdir()
    else:
        bad.write_bytes(content)
    with pytest.raises(InputError, match=what) as caught:
        read_store(folder)
    (problem,) = caught.value.problems
    assert problem.file == str(bad)
    assert problem.todo


def test_a_store_of_which_nothing_can_be_used_is_refused(tmp_path):
    empty = store_of(tmp_path / "laws")
    (empty / "notes.txt").write_text("", encoding="utf-8")
    with pytest.raises(InputError, match="no law file in this folder") as caught:
        read_store(empty)
    assert caught.value.problems[0].todo
    assert read_store(empty, filling=True) == ()
    own = write_law(stored_law(build_law("kecman", TUBE, STEEL), {"method": "formula"}))
    with pytest.raises(InputError, match="for which place it is") as caught:
        read_store(store_of(tmp_path / "own", own))
    assert "law: {type: file" in caught.value.problems[0].todo


def test_a_file_that_froze_formulas_alone_has_no_laws(tmp_path):
    file = tmp_path / "frozen.yaml"
    file.write_text(frozen([], ["hinge h: formula"]), encoding="utf-8")
    assert read_store(file) == ()


def test_a_law_of_several_in_a_file_is_refused_at_its_line(tmp_path):
    texts = [law_text("a"), law_text("b").replace("400.0", "401.0")]
    file = tmp_path / "frozen.yaml"
    file.write_text(frozen(texts), encoding="utf-8")
    with pytest.raises(InputError, match="checksum does not fit") as caught:
        read_store(file)
    (problem,) = caught.value.problems
    assert file.read_text(encoding="utf-8").splitlines()[problem.line - 1] == f'checksum: "{problem.came}"'
    assert problem.came in texts[1]


def test_laws_without_a_checksum_are_counted():
    sure = law_text("a")
    edited = "".join(line for line in sure.splitlines(True) if not line.startswith("checksum"))
    assert without_checksum([sure, edited]) == 1
