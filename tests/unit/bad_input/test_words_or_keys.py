"""Keys that take a word or a number as well as keys or a list: what else is refused, and with which words."""

from pathlib import Path

import pytest

from crumple.analysis import check
from crumple.errors import InputError
from crumple.structure import Member

GOOD = Path("examples/01_tube_bending.yaml").read_text(encoding="utf-8")
HINGES = GOOD[GOOD.index("    hinges:") : GOOD.index("\nsupports:")]
OF_A_HINGE = "law: kecman"
OF_A_MEMBER = "roll: 0 deg"
HINGE = "members.tube.hinges[0]"
LIST_OR_AUTO = "auto, a list of hinges, or keys such as axes: [y, z]"
ONLY_AUTO = "auto, or keys such as axes: [y, z]"
NUMBER_OF_BARS = "a whole number, or keys such as {number: 4, axis: y}"
SEGMENTS = "true, false, or a whole number of segments, 0 to 32"
PARTS = "true, false, or a list of parts such as [{from: 0 mm, to: 100 mm}]"
AXIAL = "true, false, or keys such as {law: NAME}"
UNQUOTED = "without quotation marks"


def of_member(text):
    """Another value of the member's hinges."""
    return HINGES, f"    hinges: {text}\n"


def of_all(text):
    """A value of the structure's hinges."""
    return "supports:", f"hinges: {text}\nsupports:"


# what is replaced by what; where the message points; what is allowed; words of what to do
CASES = {
    "misspelt auto": (*of_member("atuo"), "members.tube.hinges", LIST_OR_AUTO, "did you mean 'auto'?"),
    "auto in capitals": (*of_member("AUTO"), "members.tube.hinges", LIST_OR_AUTO, "write auto, or a list"),
    "word for hinges": (
        *of_member("manual"),
        "members.tube.hinges",
        LIST_OR_AUTO,
        "[{name: root, at: NODE}]",
    ),
    "number of hinges": (*of_member("3"), "members.tube.hinges", LIST_OR_AUTO, "write auto, or a list"),
    "hinges: true": (*of_member("true"), "members.tube.hinges", LIST_OR_AUTO, "write auto, or a list"),
    "misspelt auto of all": (*of_all("atuo"), "hinges", ONLY_AUTO, "did you mean 'auto'?"),
    "number of all hinges": (*of_all("3"), "hinges", ONLY_AUTO, "write auto"),
    "list of all hinges": (*of_all("[{name: h, at: root}]"), "hinges", ONLY_AUTO, "members.NAME.hinges"),
    "word for bars": (OF_A_MEMBER, "bars: few", "members.tube.bars", NUMBER_OF_BARS, UNQUOTED),
    "half a bar": (OF_A_MEMBER, "bars: 2.5", "members.tube.bars", NUMBER_OF_BARS, "for example 4"),
    "bars as a text": (OF_A_MEMBER, 'bars: "4"', "members.tube.bars", NUMBER_OF_BARS, UNQUOTED),
    "bars: true": (OF_A_MEMBER, "bars: true", "members.tube.bars", NUMBER_OF_BARS, "for example 4"),
    "word for elastic": (OF_A_MEMBER, 'elastic: "yes"', "members.tube.elastic", SEGMENTS, UNQUOTED),
    "half a segment": (OF_A_MEMBER, "elastic: 2.5", "members.tube.elastic", SEGMENTS, "a whole number"),
    "list for elastic": (OF_A_MEMBER, "elastic: [1]", "members.tube.elastic", SEGMENTS, "a whole number"),
    "text for rigid": (OF_A_MEMBER, 'rigid: "true"', "members.tube.rigid", PARTS, UNQUOTED),
    "number for rigid": (OF_A_MEMBER, "rigid: 1", "members.tube.rigid", PARTS, "or a list"),
    "word for axial": (OF_A_HINGE, "axial: x", f"{HINGE}.axial", AXIAL, UNQUOTED),
    "number for axial": (OF_A_HINGE, "axial: 3", f"{HINGE}.axial", AXIAL, "or keys"),
    # unknown keys below them
    "key of a list of hinges": (OF_A_HINGE, "lw: kecman", f"{HINGE}.lw", "one of name, at, ", "'law'?"),
    "key of automatic hinges": (
        *of_member("{spcing: 9 mm}"),
        "members.tube.hinges.spcing",
        "fracture, spacing",
        "'spacing'?",
    ),
    "key of a rigid part": (
        OF_A_MEMBER,
        "rigid: [{frm: 9 mm, to: 20 mm}]",
        "members.tube.rigid[0].frm",
        "one of from, to",
        "'from'?",
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_what_is_allowed_and_what_to_do_are_said(tmp_path, case):
    old, new, where, allowed, todo = CASES[case]
    assert old in GOOD
    path = tmp_path / "a.yaml"
    path.write_text(GOOD.replace(old, new, 1), encoding="utf-8")
    (problem,) = check(path)
    assert (problem.where, problem.file) == (where, str(path))
    assert problem.line == GOOD[: GOOD.index(old)].count("\n") + 1
    assert allowed in problem.allowed
    assert todo in problem.todo


@pytest.mark.parametrize(
    ("old", "new", "where", "allowed", "todo"),
    [
        ("supports:", "supports: {other: clamp}\nx:", "supports.other", "node, fix, motion", "{node: ...}"),
        (
            "supports:",
            "obstacles: {p: wall}\nsupports:",
            "obstacles.p",
            "'type' among them",
            "{type: ...}",
        ),
        (
            "supports:",
            "obstacles: {p: {type: pole, point: [0 m, 0 m, 0 m]}}\nsupports:",
            "obstacles.p",
            "cylinder",
            "did you mean 'cylinder'?",
        ),
        (
            "supports:",
            "obstacles: {p: {type: plain, point: [0 m, 0 m, 0 m]}}\nsupports:",
            "obstacles.p",
            "cylinder",
            "did you mean 'plane'?",
        ),
        ("type: rectangular_tube", "type: RHS", "sections.tube", "square_tube", "'rectangular_tube'"),
    ],
)
def test_words_for_groups_and_types_are_answered_with_keys_and_types(
    old, new, where, allowed, todo, tmp_path
):
    assert old in GOOD
    path = tmp_path / "a.yaml"
    path.write_text(GOOD.replace(old, new, 1), encoding="utf-8")
    problem = next(one for one in check(path) if one.where == where)
    assert allowed in problem.allowed
    assert todo in problem.todo


@pytest.mark.parametrize("given", ["", " {}"])
def test_no_members_are_one_problem(given, tmp_path):
    path = tmp_path / "a.yaml"
    begin, end = GOOD.index("\nmembers:"), GOOD.index("\nsupports:")
    text = f"{GOOD[:begin]}\nmembers:{given}\n{GOOD[end : GOOD.index('  section_rotations:')]}"
    path.write_text(text, encoding="utf-8")
    assert [one.where for one in check(path)] == ["members"]


@pytest.mark.parametrize("value", ["4", "4.0", '"4"', "true", "false", "0"])
def test_numbers_of_segments_are_taken_as_they_were(tmp_path, value):
    path = tmp_path / "a.yaml"
    path.write_text(GOOD.replace(OF_A_MEMBER, f"elastic: {value}"), encoding="utf-8")
    assert check(path) == []


def test_a_number_of_segments_beyond_all_floats_is_refused():
    with pytest.raises(InputError, match="0 to 32"):
        Member(nodes=("a", "b"), section="t", material="s", elastic=10**400)
