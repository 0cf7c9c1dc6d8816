"""Plain mistakes of single values that the other tables of this folder do not have."""

import pytest
from tests.support.stored_laws import law_text

from crumple.analysis import loads
from crumple.errors import InputError
from crumple.hinge import read_law

GOOD = """crumple: 1
materials: {steel: {grade: S355}}
sections: {tube: {type: square_tube, side: 40 mm, thickness: 2 mm}}
nodes: {root: [0 m, 0 m, 0 m], tip: [0.4 m, 0 m, 0 m]}
members:
  beam: {nodes: [root, tip], section: tube, material: steel, hinges: [{name: h, at: root, law: constant}]}
supports: {clamp: {node: root, fix: all}}
masses: {load: {node: tip, mass: 2 kg}}
loads: [{node: tip, force: {z: 1 kN}}]
analysis: {duration: 8 ms}
outputs: {nodes: [tip]}
"""


@pytest.mark.parametrize(
    ("old", "new", "where", "words"),
    [
        ("at: root", "at: ''", "members.beam.hinges[0].at", "neither a node nor a distance"),
        ("at: root", f"at: {'x' * 65}", "members.beam.hinges[0].at", "neither a node nor a distance"),
        ("section: tube,", "section: tube, up: [0, 0, 0],", "members.beam.up", "the direction is zero"),
        (
            "analysis:",
            "obstacles: {o: {type: plane, point: [0 m, 0 m, 9 m], normal: [0, 0, 0], mass: 9 kg}}\nanalysis:",
            "obstacles.o.normal",
            "the direction is zero",
        ),
        ("law: constant", "law: {type: measured, files: 3}", "law.files", "a list of files is needed"),
        (
            "outputs: {",
            "outputs: {section_forces: {f: {member: beam, at: 9 m}}, ",
            "outputs.section_forces.f.at",
            "outside the member",
        ),
        (
            "8 ms}",
            "8 ms, shell: {fine_size: 2 mm, fine_at: [{member: beam, at: 9 m}]}}",
            "analysis.shell.fine_at[0].at",
            "outside the member",
        ),
        ("crumple: 1\n", "crumple: 1\nlaws: ..\n", "laws", "outside the folder of the input file"),
        ("crumple: 1\n", "crumple: 1\nlaws: no_such_store\n", "laws", "no such store of laws"),
        (
            "{type: square_tube, side: 40 mm, thickness: 2 mm}",
            "3",
            "sections.tube",
            "a group of keys is needed",
        ),
    ],
)
def test_the_value_is_refused_where_it_is(old, new, where, words, tmp_path):
    loads(GOOD, directory=tmp_path)
    assert old in GOOD
    with pytest.raises(InputError, match=words) as refused:
        loads(GOOD.replace(old, new), directory=tmp_path)
    assert any(where in problem.where for problem in refused.value.problems)


def test_the_store_of_an_input_may_be_empty_until_its_laws_are_solved(tmp_path):
    (tmp_path / "laws").mkdir()
    text = GOOD.replace("crumple: 1\n", "crumple: 1\nlaws: laws\n")
    assert loads(text, directory=tmp_path).structure.laws.texts == ()


LAW = law_text("0" * 16)


@pytest.mark.parametrize(
    ("start", "line", "words"),
    [
        ("title:", "title: [a]", "a text is needed"),
        ("  warnings:", "  warnings: 3", "a list of texts is needed"),
        ("origin:", "origin: 3", "a group of keys is needed"),
        ("  positive:", "  positive: 3", "a list of pairs is needed"),
        ("crumple_law:", "%YAML 1.1\n---\ncrumple_law: 1", "directives and further documents"),
        ("crumple_law:", "crumple_law: 1\n? [a]\n: b", "cannot be a key"),
        ("crumple_law:", f"crumple_law: 1\nx: {'[' * 40}{']' * 40}", "nested too deeply"),
    ],
)
def test_a_law_file_names_what_it_cannot_read(start, line, words):
    read_law(LAW)
    lines = LAW.splitlines()
    at = next(i for i, one in enumerate(lines) if one.startswith(start))
    # with what belongs to it: the lines further to the right
    depth = len(lines[at]) - len(lines[at].lstrip()) + 1
    after = at + 1
    while after < len(lines) and lines[after].startswith(" " * depth):
        after += 1
    changed = "\n".join([*lines[:at], line, *lines[after:]])
    with pytest.raises(InputError, match=words):
        read_law(changed)


def test_a_wrong_word_in_fix_says_what_to_write():
    with pytest.raises(InputError) as caught:
        loads(GOOD.replace("fix: all", "fix: everything"))
    (problem,) = caught.value.problems
    assert problem.what == "'everything' is not a degree of freedom"
    assert "write 'fix: all' for a clamp" in problem.todo


@pytest.mark.parametrize(
    ("given", "where", "count", "example"),
    [
        ("gravity: -9.81 m/s^2", "gravity", 3, ", as [0 m/s^2, 0 m/s^2, -9.81 m/s^2]"),
        ("gravity: down", "gravity", 3, ""),
        ("gravity: {z: -9.81 m/s^2}", "gravity", 3, ""),
    ],
)
def test_a_value_for_a_list_is_told_how_many_entries_it_has(given, where, count, example):
    with pytest.raises(InputError) as caught:
        loads(GOOD.replace("\nsupports:", f"\n{given}\nsupports:"))
    (problem,) = caught.value.problems
    assert problem.where == where
    assert problem.allowed == f"a list of {count} entries in brackets"
    assert problem.todo == f"write a list of {count} entries in brackets{example}"


def test_a_list_of_any_length_has_no_number_of_entries():
    with pytest.raises(InputError) as caught:
        loads(GOOD.replace("\nsupports:", "\nimpulses: 5 N*s\nsupports:"))
    (problem,) = caught.value.problems
    assert (problem.allowed, problem.todo) == ("a list in brackets", "write a list in brackets")


def test_a_freedom_that_is_fixed_and_driven_is_named():
    moved = "{havsin: {x0: 0 s, h0: 0 m, x1: 1 ms, h1: 3 mm}}"
    support = f"{{node: tip, fix: [x, rx], motion: {{x: {moved}, y: {moved}}}}}"
    with pytest.raises(InputError) as caught:
        loads(GOOD.replace("supports: {clamp", f"supports: {{push: {support}, clamp"))
    (problem,) = caught.value.problems
    assert problem.what == "x is both fixed and driven"
    assert problem.where == "supports.push.motion"
