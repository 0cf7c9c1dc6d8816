"""Bad input files: each is refused with one clear message that gives the path and what is allowed."""

import os
from pathlib import Path

import pytest

from crumple.analysis import check, load
from crumple.analysis.reading import LARGEST_FILE
from crumple.errors import InputError

GOOD = Path("examples/01_tube_bending.yaml").read_text(encoding="utf-8")

# what is replaced by what; where the message points; words that it contains
CASES = {
    "misspelt key": (
        "yield_stress: 488",
        "yeild_stress: 488",
        "materials.steel.yeild_stress",
        "did you mean 'yield_stress'?",
    ),
    "misspelt group": ("supports:", "suports:", "suports", "did you mean 'supports'?"),
    "misspelt section type": (
        "rectangular_tube",
        "rectangular_tub",
        "sections.tube",
        "did you mean 'rectangular_tube'?",
    ),
    "misspelt law": ("law: kecman", "law: kekman", "members.tube.hinges[0].law", "did you mean 'kecman'?"),
    "wrong unit": (
        "488 MPa",
        "488 mm",
        "materials.steel.yield_stress",
        "mm is the unit of a length, but a stress is needed",
    ),
    "no unit": ("width: 50 mm", "width: 50", "sections.tube.width", "the unit is missing"),
    "unknown unit": ("width: 50 mm", "width: 50 mmm", "sections.tube.width", "unknown unit 'mmm'"),
    "two quantities": (
        "width: 50 mm",
        "width: 50 mm + 3 m",
        "sections.tube.width",
        "not a product of unit names",
    ),
    "hostile number": (
        "width: 50 mm",
        "width: 9**9**9 mm",
        "sections.tube.width",
        "not a product of unit names",
    ),
    "endless number": (
        "width: 50 mm",
        f"width: {'9' * 5000} mm",
        "sections.tube.width",
        "at most 80 characters",
    ),
    "huge number": ("width: 50 mm", "width: 1e999 mm", "sections.tube.width", "too large"),
    "big number": (
        "width: 50 mm",
        "width: 1e30 mm",
        "sections.tube.width",
        "too large or too small for any structure",
    ),
    "code": (
        "width: 50 mm",
        "width: __import__('os').getcwd()",
        "sections.tube.width",
        "not a number with a unit",
    ),
    "negative thickness": ("2.65 mm", "-2.65 mm", "sections.tube.thickness", "it must be more than 0"),
    "thick wall": ("2.65 mm", "12.5 mm", "sections.tube.thickness", "not thinner than half the smaller side"),
    "missing node": ("[root, tip]\n", "[root, tipp]\n", "members.tube.nodes[1]", "there is no node 'tipp'"),
    "three nodes": ("[root, tip]\n", "[root, tip, tip]\n", "members.tube.nodes", "too long"),
    "zero length": ("tip: [1 m,", "tip: [0 m,", "members.tube", "the member has no length"),
    "falling strain": (
        "yield_stress: 488 MPa",
        "yield_stress: 488 MPa\n    hardening:\n      type: table\n"
        "      plastic_strain: [0, 0.1, 0.05]\n      true_stress: [488 MPa, 500 MPa, 510 MPa]",
        "materials.steel.hardening.plastic_strain",
        "point 3: 0.05 after 0.1",
    ),
    "falling stress": (
        "yield_stress: 488 MPa",
        "yield_stress: 488 MPa\n    hardening:\n      type: table\n"
        "      plastic_strain: [0, 0.1]\n      true_stress: [488 MPa, 480 MPa]",
        "materials.steel.hardening.true_stress",
        "point 2: 4.8e+08 after 4.88e+08",
    ),
    "uneven table": (
        "yield_stress: 488 MPa",
        "yield_stress: 488 MPa\n    hardening:\n      type: table\n"
        "      plastic_strain: [0, 0.1, 0.2]\n      true_stress: [488 MPa, 500 MPa]",
        "materials.steel.hardening.true_stress",
        "3 strains, 2 stresses",
    ),
    "short axis": ("axis: [0, -1, 0]", "axis: [0, -1]", "initial_velocity[0].axis", "3 entries"),
    "short nodes": ("[root, tip]\n", "[root]\n", "members.tube.nodes", "2 entries"),
    "impulse on a clamp": (
        "masses:",
        "impulses: [{node: root, impulse: [0, 0, 3 N*s]}]\nmasses:",
        "impulses[0].impulse[2]",
        "the support 'clamp' fixes z",
    ),
    "zero mass": ("mass: 6 kg", "mass: 0 kg", "masses.payload.mass", "no inertia"),
    "zero density": ("7850 kg/m^3", "0 kg/m^3", "materials.steel.density", "it must be more than 0"),
    "zero inertia": ("at: root", "at: tip", "members.tube.hinges[0].at", "zero inertia beyond the hinge"),
    "not a number": (
        "poissons_ratio: 0.3",
        "poissons_ratio: .nan",
        "materials.steel.poissons_ratio",
        "not finite",
    ),
    "nan with a unit": ("488 MPa", "nan MPa", "materials.steel.yield_stress", "not a number with a unit"),
    "next to no duration": (
        "duration: 100 ms",
        "duration: 1e-17 s",
        "analysis.duration",
        "it must be at least 1e-09 s",
    ),
    "infinite": ("duration: 100 ms", "duration: .inf", "analysis.duration", "not finite"),
    "incompressible": (
        "poissons_ratio: 0.3",
        "poissons_ratio: 0.5",
        "materials.steel.poissons_ratio",
        "less than 0.5",
    ),
    "true": (
        "poissons_ratio: 0.3",
        "poissons_ratio: true",
        "materials.steel.poissons_ratio",
        "a number is needed here",
    ),
    "empty value": ("duration: 100 ms", "duration:", "analysis.duration", "the duration is missing"),
    "group for a value": (
        "duration: 100 ms",
        "duration: {a: 1}",
        "analysis.duration",
        "a time is needed here",
    ),
    "value for a group": (
        "{node: root, fix: all}",
        "root",
        "supports.clamp",
        "a group of keys is needed here",
    ),
    "list for a group": (
        "{node: root, fix: all}",
        "[root]",
        "supports.clamp",
        "a group of keys is needed here",
    ),
    "missing key": ("node: tip, mass: 6 kg", "node: tip", "masses.payload.mass", "the key 'mass' is missing"),
    "missing group": (
        "analysis:\n  duration: 100 ms\n  multibody: {accuracy: 1e-3}\n",
        "",
        "analysis",
        "is missing",
    ),
    "twice": ("roll: 0 deg", "roll: 0 deg\n    roll: 0 deg", "members.tube.roll", "is given twice"),
    "anchor and alias": (
        "{node: tip, mass: 6 kg}",
        "&p {node: tip, mass: 6 kg}\n  more: *p",
        "",
        "anchors are refused",
    ),
    "alias": ("{node: tip, mass: 6 kg}", "*p", "", "aliases are refused"),
    "merge key": (
        "{node: tip, mass: 6 kg}",
        "{node: tip, mass: 6 kg, <<: {offset: 3}}",
        "masses.payload.<<",
        "unknown key",
    ),
    "tag": ("7850 kg/m^3", "!!float 7850", "", "tags are refused"),
    "python tag": ("7850 kg/m^3", "!!python/object/apply:os.system [ls]", "", "tags are refused"),
    "directive": ("crumple: 1", "%YAML 1.1\n---\ncrumple: 1", "", "directives are not allowed"),
    "two documents": ("analysis:", "---\nanalysis:", "", "a second document starts here"),
    "not YAML": ("roll: 0 deg", "roll: {0 deg", "", "this is not YAML"),
    "tab": ("    roll: 0 deg", "\troll: 0 deg", "", "this is not YAML"),
    "list as key": ("roll: 0 deg", "[a]: 0 deg", "", "cannot be a key"),
    "deep": ("roll: 0 deg", "roll: " + "[" * 100 + "]" * 100, "", "nested too deeply"),
    "other format": ("crumple: 1", "crumple: 2", "crumple", "format version is not known"),
    "format as a text": ("crumple: 1", "crumple: '1'", "crumple", "format version is a text"),
    "no format": ("crumple: 1", "", "crumple", "format version is missing"),
    "long title": ("Steel tube", "Steel tube" * 30, "title", "the text is too long"),
    "no such curve": (
        "law: kecman",
        "law: {type: table, file: none.csv}",
        "members.tube.hinges[0].law.file",
        "no such file",
    ),
    "device as curve": (
        "law: kecman",
        "law: {type: table, file: /dev/zero}",
        "members.tube.hinges[0].law.file",
        "outside the folder of the input file",
    ),
    "odd curve": (
        "law: kecman",
        "law: {type: table, rotation: [0 deg, 9 deg], moment: [1 kN*m]}",
        "members.tube.hinges[0].law",
        "as many moments",
    ),
    "rising from nothing": (
        "law: kecman",
        "law: {type: table, rotation: [1 deg, 2 deg], moment: [1 kN*m, 1 kN*m]}",
        "members.tube.hinges[0].law",
        "from 0",
    ),
    "too many bars": ("roll: 0 deg", "bars: 1000000", "members.tube.bars.number", "too large"),
}


def mistakes(path: Path, content: str | bytes):
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return check(path)


@pytest.mark.parametrize("case", CASES)
def test_one_mistake_gives_one_clear_message(tmp_path, case):
    old, new, where, words = CASES[case]
    assert old in GOOD
    bad = GOOD.replace(old, new, 1)
    (problem,) = mistakes(tmp_path / "a.yaml", bad)
    assert problem.where == where
    assert words in str(problem)
    assert problem.file == str(tmp_path / "a.yaml")
    changed = GOOD[: GOOD.index(old)].count("\n") + 1
    # the message points at the change; what is missing belongs to the group above
    assert 1 <= problem.line <= bad.count("\n") + 1
    if "missing" not in problem.what and "no length" not in problem.what:
        assert changed <= problem.line <= changed + new.count("\n") + 1
    assert problem.todo or problem.allowed
    assert "Traceback" not in str(problem)
    assert all(len(line) < 400 for line in str(problem).splitlines())


def test_an_unconnected_mass_is_named(tmp_path):
    text = GOOD.replace("tip: [1 m, 0 m, 0 m]\n", "tip: [1 m, 0 m, 0 m]\n  far: [2 m, 0 m, 0 m]\n")
    (problem,) = mistakes(tmp_path / "a.yaml", text.replace("node: tip, mass", "node: far, mass"))
    assert problem.where == "masses.payload.node"
    assert "the mass is not connected" in problem.what


FILES = {
    "empty": (b"", "the file is empty"),
    "blank": (b"\n\n   \n", "the file is empty"),
    "comments": (b"# nothing\n", "the file is empty"),
    "null": (b"null\n", "the file is empty"),
    "a list": (b"- 1\n- 2\n", "the file has no keys"),
    "a text": (b"hello\n", "the file has no keys"),
    "zeros": (b"\0" * 1000, "the file is binary"),
    "program": (b"\x7fELF\x02\x01\x01\0\0\0", "the file is binary"),
    "picture": (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", "the file is binary"),
    "latin": ("title: Stoßstange\n".encode("latin-1"), "the text is not UTF-8"),
    "utf-16": (GOOD.encode("utf-16"), "the text is not UTF-8"),
    "escape": (b"title: \x1b[31mred\n", "the file is binary"),
}


@pytest.mark.parametrize("case", FILES)
def test_a_file_that_is_no_description_is_refused(tmp_path, case):
    content, what = FILES[case]
    (problem,) = mistakes(tmp_path / "a.yaml", content)
    assert problem.what == what
    assert problem.line >= 1


def test_the_first_letter_that_is_not_utf_8_has_its_line(tmp_path):
    (problem,) = mistakes(tmp_path / "a.yaml", (GOOD + "# Stoßstange\n").encode("latin-1"))
    assert (problem.line, problem.came) == (GOOD.count("\n") + 1, "the byte 0xdf")


def test_a_study_file_is_named_with_its_command(tmp_path):
    path = tmp_path / "my study.yaml"
    (problem,) = mistakes(path, "title: a\ncrumple_study: 1\n")
    assert (problem.what, problem.line) == ("this is a study file, not an input file", 2)
    assert problem.todo == f"use: crumple study '{path}'"


def test_a_large_file_is_refused_unread(tmp_path):
    path = tmp_path / "large.yaml"
    with path.open("wb") as file:
        file.truncate(100_000_000)
    (problem,) = check(path)
    assert problem.what == "the file is too large for an input file"
    assert problem.came == "100.0 MB"
    (problem,) = mistakes(path, GOOD + "#" * (LARGEST_FILE + 1 - len(GOOD.encode())))
    assert "too large" in problem.what
    assert mistakes(path, GOOD + "#" * (LARGEST_FILE - len(GOOD.encode()))) == []


@pytest.mark.parametrize(
    ("name", "what"),
    [("none.yaml", "there is no such file"), (".", "this is a folder"), ("/dev/zero", "not a regular file")],
)
def test_what_is_no_file_is_refused(tmp_path, name, what):
    (problem,) = check(tmp_path / name)
    assert what in problem.what


def test_refusals_of_hostile_texts_take_no_time(tmp_path):
    # each would take minutes where something grows faster than the text
    for text in (
        "[" * 900_000,
        "{" * 900_000,
        "? " * 400_000,
        "- " * 400_000,
        "a: " * 300_000,
        "a:\n" * 300_000,
    ):
        assert mistakes(tmp_path / "a.yaml", text)


def test_load_raises_what_check_returns(tmp_path):
    (tmp_path / "a.yaml").write_text(GOOD.replace("488 MPa", "488 mm"), encoding="utf-8")
    with pytest.raises(InputError) as refusal:
        load(tmp_path / "a.yaml")
    assert refusal.value.problems == check(tmp_path / "a.yaml")


@pytest.mark.parametrize("kind", ["type: table, file", "type: file, file"])
def test_a_curve_outside_the_folder_of_the_input_file_is_refused(tmp_path, kind):
    folder = tmp_path / "models"
    folder.mkdir()
    outside = tmp_path / "curve.csv"
    outside.write_text("rotation [deg], moment [kN*m]\n0, 2\n90, 1\n")
    (folder / "link.csv").symlink_to(outside)
    file = folder / "model.yaml"
    for name in (str(outside), "../curve.csv", "link.csv", "/dev/null"):
        file.write_text(GOOD.replace("law: kecman", f"law: {{{kind}: '{name}'}}"))
        [problem] = check(file)
        assert "outside the folder of the input file" in problem.what
        assert problem.where == "members.tube.hinges[0].law.file"
        assert problem.line > 1
    below = folder / "curves"
    below.mkdir()
    (below / "curve.csv").write_text(outside.read_text())
    file.write_text(GOOD.replace("law: kecman", "law: {type: table, file: curves/../curves/curve.csv}"))
    assert check(file) == []


def test_a_path_that_is_not_a_regular_file_is_reported(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path in (pipe, Path("/dev/null")):
        [problem] = check(path)
        assert problem.what == "this is not a regular file"
    file = tmp_path / "model.yaml"
    file.write_text(GOOD.replace("law: kecman", "law: {type: table, file: pipe}"))
    [problem] = check(file)
    assert problem.what == "this is not a regular file"


def test_a_table_needs_two_points_and_a_refused_inertia_is_shown(tmp_path):
    file = tmp_path / "model.yaml"
    file.write_text(GOOD.replace("law: kecman", "law: {type: table, rotation: [0 deg], moment: [1 kN*m]}"))
    [problem] = check(file)
    assert problem.what == "the table has one point"
    inertia = "[0, 0, 5 kg*m^2]"
    file.write_text(GOOD.replace("mass: 6 kg", f"mass: 6 kg, rotary_inertia: {inertia}"))
    [problem] = check(file)
    assert problem.came == inertia
