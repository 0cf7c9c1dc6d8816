"""Hinges whose automatic law is of another type in other rows: table, console and page say between which."""

import json
from pathlib import Path

from tests.unit.study.test_study import BASE

from crumple.analysis import load, load_input
from crumple.analysis.explore import explore, law_cautions, sliders_of
from crumple.analysis.law_changes import NO_HINGE, law_changes
from crumple.structure import law_types_of
from crumple.study import LoadedStudy, run_study

EXAMPLE = "hinges:\n      - {name: root, at: root, law: kecman}"
"""How the base names its law."""
CHANGES = "caution: the law of hinge tube-root changes between rows, from clamped_tube"


def base_of(folder, hinges="hinges: auto"):
    text = BASE.read_text(encoding="utf-8").replace(EXAMPLE, hinges).replace("depth: 25 mm", "depth: 60 mm")
    file = folder / "base.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def study_of(
    folder, hinges="hinges: auto", variable="{path: sections.tube.thickness, values: [2 mm, 3 mm, 7 mm]}"
):
    base_of(folder, hinges)
    file = folder / "study.yaml"
    lines = [
        "crumple_study: 1",
        "base: base.yaml",
        f"variables:\n  wall: {variable}",
        "responses:\n  r: {channel: energy.dissipated, take: max}",
        "method: {type: grid}",
    ]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def test_table_console_and_page_say_between_which_rows_a_law_changes(tmp_path, run_command):
    out = tmp_path / "out"
    code, said, _ = run_command("study", study_of(tmp_path), "--out", out, "--shapes", 0)
    assert code == 0
    assert (
        f"{CHANGES} (2 rows) to kecman (1 row); the closest are row 1 (wall 3 mm) and row 2 (wall 7 mm)"
        in said
    )
    (change,) = json.loads((out / "study.json").read_text())["law_changes"]
    assert change["text"] in said
    del change["text"]
    assert change == {
        "hinges": ["tube-root"],
        "laws": ["clamped_tube", "kecman"],
        "rows": [1, 2],
        "counts": [2, 1],
    }
    assert "Caution: the law of hinge tube-root changes between rows" in (out / "study.html").read_text()


def test_they_are_those_of_a_run(tmp_path):
    """Types without building the laws: as those that hinges of the run have."""
    structure = load(base_of(tmp_path)).structure
    assert law_types_of(structure) == {"tube-root": "clamped_tube"}
    assert law_types_of(load(BASE).structure) == {"root": "kecman"}


def test_a_law_that_is_named_and_factors_are_silent(tmp_path):
    named = study_of(tmp_path, "hinges: {law: kecman}")
    assert not run_study(LoadedStudy(named), tmp_path)[1].law_changes
    factor = study_of(tmp_path, variable="{path: initial_velocity, values: [0.5, 1]}")
    (tmp_path / "factor").mkdir()
    assert not run_study(LoadedStudy(factor), tmp_path / "factor")[1].law_changes


def test_words_change_laws_too(tmp_path):
    variable = "{path: members.tube.section, values: [tube, thick]}"
    file = study_of(tmp_path, variable=variable)
    base = tmp_path / "base.yaml"
    thick = "sections:\n  thick: {type: rectangular_tube, width: 50 mm, depth: 60 mm, thickness: 7 mm}\n"
    base.write_text(base.read_text(encoding="utf-8").replace("sections:\n", thick), encoding="utf-8")
    (change,) = run_study(LoadedStudy(file), tmp_path)[1].law_changes
    assert "row 0 (wall tube) and row 1 (wall thick)" in change["text"]


def test_of_three_types_the_closest_changes_connect_them():
    types = dict(enumerate([{"h": "a"}, {"h": "b"}, {"h": "b"}, {"h": "c"}, {}]))
    found = law_changes(types, {i: [float(i)] for i in types}, dict.fromkeys(types, 1))
    assert [(one.laws, one.variants) for one in found] == [
        (("a", "b"), (0, 1)),
        (("b", "c"), (2, 3)),
        (("c", NO_HINGE), (3, 4)),
    ]


def test_hinges_that_change_alike_are_one_caution():
    types = {0: {"g": "a", "h": "a"}, 1: {"g": "b", "h": "b"}}
    (one,) = law_changes(types, {0: [0.0], 1: [1.0]}, {0: 3, 1: 1})
    assert one.sentence("row", ("v 1", "v 2")) == (
        "caution: the laws of hinges g, h change between rows, from a (3 rows) to b (1 row); the closest are "
        "row 0 (v 1) and row 1 (v 2): results may jump there; a law that the input names is the same in all "
        "of them"
    )


def test_a_grid_of_sliders_says_it_on_its_page_and_console(tmp_path, run_command):
    file = base_of(tmp_path)
    source = load_input(Path(file))
    sliders = sliders_of("thickness=4 mm..8 mm", source.analysis, source.document.data)
    (caution,) = law_cautions(source.analysis, sliders, explore(source.analysis, sliders))
    assert "variant 4 (sections.tube.thickness 6 mm) and variant 5" in caution
    out = tmp_path / "out"
    said = run_command("run", file, "--out", out, "--explore", "thickness=4 mm..8 mm")[1]
    assert caution in said
    assert "The law of hinge tube-root" in (out / "explore.html").read_text().replace("Caution: the", "The")
