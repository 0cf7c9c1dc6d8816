"""Reading an input file: what it gives, and every mistake with its line."""

import pickle
from pathlib import Path

import pytest

from crumple.analysis import Analysis, check, input_hash, load, load_input, loads
from crumple.errors import InputError, Problem

EXAMPLE = Path("examples/01_tube_bending.yaml")


@pytest.fixture(scope="module")
def text():
    return EXAMPLE.read_text(encoding="utf-8")


def refused(text, **how):
    with pytest.raises(InputError) as refusal:
        loads(text, file="a.yaml", **how)
    return refusal.value.problems


def test_the_example_loads_complete():
    analysis = load(EXAMPLE)
    assert isinstance(analysis, Analysis)
    assert analysis.duration == 0.1
    assert analysis.structure.section_of("tube").title == "rectangular tube 50 x 25 x 2.65 mm"
    assert analysis.structure.masses["payload"].mass == 6.0
    assert analysis.outputs.section_rotations["tip_rotation"].end == 1.0
    assert analysis.outputs.pictures == (0.0, 0.02, 0.04, 0.06, 0.08, 0.1)
    assert analysis.output_interval == 0.5e-3
    assert check(EXAMPLE) == []


def test_an_analysis_travels(text):
    analysis = loads(text)
    again = pickle.loads(pickle.dumps(analysis))
    assert again == analysis
    assert input_hash(again) == input_hash(analysis)


def test_every_mistake_comes_with_its_line_in_the_order_of_the_file(text):
    changes = {
        "yield_stress: 488 MPa": "yield_stress: 488 mm",
        "width: 50 mm": "widht: 50 mm",
        "nodes: [root, tip]\n": "nodes: [root, tipp]\n",
        "fix: all": "fix: some",
        "duration: 100 ms": "duration: -1 s",
        "{accuracy: 1e-3}": "{acuracy: 1e-3}",
        "nodes: [tip]": "nodes: [tup]",
        "roll: 0 deg": "roll: 0 deg\n    roll: 1 deg",
    }
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new, 1)
    lines = text.splitlines()
    problems = refused(text)
    assert len(problems) == len(changes)
    message = [new.splitlines()[-1].strip() for new in changes.values()]
    assert all(problem.file == "a.yaml" for problem in problems)
    assert [problem.line for problem in problems] == sorted(problem.line for problem in problems)
    for part in message:
        assert any(part in lines[problem.line - 1] for problem in problems), part


def test_lines_of_entries_in_lists_are_their_own(text):
    problems = refused(text.replace("- {name: root, at: root, law: kecman}", "- name: root\n        at: 5 m"))
    (problem,) = problems
    assert (
        "at: 5 m"
        in text.replace(
            "- {name: root, at: root, law: kecman}", "- name: root\n        at: 5 m"
        ).splitlines()[problem.line - 1]
    )
    assert problem.where == "members.tube.hinges[0].at"


def test_a_refused_part_does_not_hide_nor_invent_other_mistakes(text):
    problems = refused(text.replace("thickness: 2.65 mm", "thickness: -1 mm").replace("at: root", "at: rot"))
    assert [problem.where for problem in problems] == ["sections.tube.thickness", "members.tube.hinges[0].at"]


def test_curve_files_are_relative_to_the_input_file(tmp_path):
    folder = tmp_path / "case"
    folder.mkdir()
    text = Path("examples/03_measured_hinge.yaml").read_text(encoding="utf-8")
    (folder / "a.yaml").write_text(text, encoding="utf-8")
    (problem,) = check(folder / "a.yaml")
    assert problem.what == "there is no such file"
    curve = Path("examples/03_measured_hinge.csv").read_text(encoding="utf-8")
    (folder / "03_measured_hinge.csv").write_text(curve, encoding="utf-8")
    analysis = load(folder / "a.yaml")
    assert analysis == load("examples/03_measured_hinge.yaml")
    (folder / "03_measured_hinge.csv").write_text(curve.replace("1456", "x"), encoding="utf-8")
    (problem,) = check(folder / "a.yaml")
    assert (problem.file, problem.line) == ("03_measured_hinge.csv", 8)
    assert problem.where == "hinge_laws.measured"


def test_numbers_are_those_of_yaml_1_2(text):
    assert loads(text.replace("accuracy: 1e-3", "accuracy: 1.0E-4")).multibody.accuracy == 1e-4
    assert "12:30" in refused(text.replace("accuracy: 1e-3", "accuracy: 12:30"))[0].came
    assert loads(text.replace("title: Steel", "title: on")).title.startswith("on tube")


def test_quoted_texts_and_block_styles_are_the_same(text):
    quoted = text.replace("yield_stress: 488 MPa", 'yield_stress: "488 MPa"').replace(
        ": [root, tip]", ":\n      - root\n      - 'tip'"
    )
    assert loads(quoted) == loads(text)


def test_windows_line_ends_and_byte_order_marks_are_read(tmp_path, text):
    (tmp_path / "a.yaml").write_bytes(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
    assert load(tmp_path / "a.yaml") == loads(text)


def test_filters_need_a_channel_and_enough_samples(text):
    for line, what in (
        ("{channel: node.tip.accel.z, cfc: 60}", "no channel"),
        ("{channel: node.root.acceleration.z, cfc: 60}", "no channel"),
        ("{channel: node.tip.acceleration.z, cfc: 1000}", "too coarse"),
        ("{channel: node.tip.acceleration.z, cfc: 61}", "permitted values"),
    ):
        (problem,) = refused(f"{text}  filters: {{f: {line}}}\n")
        assert what in problem.what
        assert problem.line == len(text.splitlines()) + 1
    assert loads(f"{text}  filters: {{f: {{channel: node.tip.acceleration.z, cfc: 60}}}}\n")


def test_more_problems_than_anyone_mends_at_once_are_counted(text):
    nodes = "".join(f"  n{i}: [{i} kg, 0 m, 0 m]\n" for i in range(200))
    problems = refused(text.replace("nodes:\n", "nodes:\n" + nodes, 1))
    assert len(problems) == 101
    assert problems[-1].what == "and 100 more problems"


def test_what_the_solver_refuses_is_found_by_check_with_its_line(text, tmp_path):
    hinges = text.index("    hinges:")
    held = text[:hinges] + text[text.index("\nsupports:") :]
    turned = text.replace(
        "law: kecman}", "law: kecman}\n      - {name: second, at: 500 mm, law: kecman, axis: z}"
    )
    turned = turned.replace("  multibody: {", "  multibody: {kernel: tree, ")
    for name, content, where, what in (
        ("held.yaml", held, "members", "nothing can move"),
        ("turned.yaml", turned, "members.tube.hinges", "different axes"),
    ):
        file = tmp_path / name
        file.write_text(content)
        [problem] = check(file)
        assert what in problem.what
        assert problem.where.startswith(where)
        key = where.rpartition(".")[2]
        assert content.splitlines()[problem.line - 1].strip().startswith(key)
        assert problem.file == str(file)


def test_a_hinge_that_the_solver_names_is_found_in_its_member(text, tmp_path):
    file = tmp_path / "a.yaml"
    file.write_text(text)
    refusal = InputError([Problem("idle", where="hinges.root"), Problem("idle", where="hinges.of a support")])
    loaded = load_input(file)
    # lines are those of the file as it was read
    file.unlink()
    problems = loaded.with_lines(refusal).problems
    assert {problem.where for problem in problems} == {"members", "members.tube.hinges[0]"}
    assert "name: root" in text.splitlines()[max(problem.line for problem in problems) - 1]


def test_too_many_samples_are_refused_with_the_number_and_what_to_write(text):
    [problem] = refused(text.replace("every: 0.5 ms", "every: 3 ns"))
    assert problem.where == "outputs.every"
    assert "3.33e+07 samples" in problem.what
    shortest = problem.todo.split("at least ")[1].split(",")[0]
    assert loads(text.replace("every: 0.5 ms", f"every: {shortest}")).output_interval == 1e-7
    for duration in ("3.3333 s", "99.99 ms", "1.01 ms"):
        short = text.replace("duration: 100 ms", f"duration: {duration}")
        short = short[: short.index("  pictures:")]
        [problem] = refused(short.replace("every: 0.5 ms", "every: 1 ns"))
        shortest = problem.todo.split("at least ")[1].split(",")[0]
        assert loads(short.replace("every: 0.5 ms", f"every: {shortest}"))


def test_an_interval_longer_than_the_run_is_refused(text):
    """A unit too large, as s for ms, would leave the first and the last sample alone."""
    [problem] = refused(text.replace("every: 0.5 ms", "every: 0.5 s"))
    assert problem.where == "outputs.every"
    assert problem.what == "this interval is longer than the run"
    assert problem.allowed == "at most 0.1 s, the duration"
    assert loads(text.replace("every: 0.5 ms", "every: 100 ms"))


def test_pictures_after_the_end_are_refused(text):
    [problem] = refused(text.replace("duration: 100 ms", "duration: 99 ms"))
    assert problem.where == "outputs.pictures[5]"
    assert "after the end" in problem.what
    analysis = loads(text)
    with pytest.raises(InputError, match="after the end"):
        analysis.model_copy(update={"duration": 0.099})


@pytest.mark.parametrize("title", ["\\e[31mred", "bell \\a", "two\\nlines", "\\u202e", "\\x9b31m"])
def test_a_title_is_one_line_of_printable_text(text, title):
    lines = text.splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith("title:"))
    [problem] = refused("\n".join([*lines[:at], f'title: "{title}"', *lines[at + 1 :]]))
    assert (problem.where, problem.line) == ("title", at + 1)
    assert "\x1b" not in str(problem)


def test_a_title_may_be_in_any_language(text):
    assert loads(text.replace("title: ", "title: Träger 梁 – ", 1)).title.startswith("Träger 梁 –")


@pytest.mark.parametrize("name", ["\\e[31m", "a\\u202e", "a b"])
def test_a_name_has_no_control_characters(text, name):
    problems = refused(text.replace("  payload: {", f'  "{name}": {{', 1))
    assert any("not a name" in problem.what for problem in problems)
    assert not any("\x1b" in str(problem) or "\u202e" in str(problem) for problem in problems)


STAGES = """analysis:
  stages:
    - {name: push, kind: quasi-static, duration: 1 s, drive: [ram], until: [{force: 20 kN, of: ram}]}
    - {name: fall, duration: 50 ms, obstacles: [ground]}
"""
OBSTACLES = """obstacles:
  ram: {type: plane, point: [0 m, 0 m, 1 m], normal: [0, 0, -1], velocity: [0 m/s, 0 m/s, -10 mm/s]}
  ground: {type: plane, point: [0 m, 0 m, -1 m], normal: [0, 0, 1], friction: 0.3}
"""


def staged(text):
    return text.replace("analysis:\n  duration: 100 ms\n", OBSTACLES + STAGES)


def test_stages_and_obstacles_load(text):
    analysis = loads(staged(text))
    assert analysis.duration == pytest.approx(1.05)
    assert [stage.name for stage in analysis.stages] == ["push", "fall"]
    assert analysis.structure.obstacles["ground"].friction == 0.3
    assert input_hash(analysis) != input_hash(loads(text))
    assert pickle.loads(pickle.dumps(analysis)) == analysis


@pytest.mark.parametrize(
    ("right", "wrong", "line"),
    [("of: ram}", "of: rem}", "- {name"), ("friction: 0.3", "friction: -1", "ground")],
)
def test_mistakes_of_stages_and_obstacles_come_with_their_lines(text, right, wrong, line):
    mistaken = staged(text).replace(right, wrong)
    (problem,) = refused(mistaken)
    assert mistaken.splitlines()[problem.line - 1].split(":")[0].strip() == line


def test_a_run_has_one_duration(text):
    twice = refused(staged(text).replace("  stages:", "  duration: 1 s\n  stages:"))
    assert "have their own durations" in str(twice[0])
    none = refused(text.replace("  duration: 100 ms\n", ""))
    assert "the duration is missing" in str(none[0])
    analysis = loads(staged(text))
    with pytest.raises(InputError, match="differs from the sum of the stages"):
        analysis.model_copy(update={"duration": 2.0})
