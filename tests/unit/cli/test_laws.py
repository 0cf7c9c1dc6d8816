"""Stores of laws on the command line: used, frozen, and the same answer from the frozen file."""

import json
import math
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
from tests.support.stored_laws import law_text, store_of
from typer.testing import CliRunner

import crumple.cli.run as run_command
from crumple.analysis import load
from crumple.cli.console.laws import range_lines
from crumple.cli.main import app
from crumple.errors import InputError
from crumple.hinge.measured.place_hash import place_hash
from crumple.result.nearby import LawRange

FRAME = Path("examples/12_l_frame.yaml")


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def corner_store(tmp_path):
    whole = load(FRAME).structure
    place = place_hash(whole.section_of("post"), whole.material_of("post"), "y", math.pi / 2)
    unused = law_text("0" * 16)
    return store_of(
        tmp_path / "laws", law_text(place, 800.0, 600.0, corner="90 deg", stiffness=6e4, reach=1.5), unused
    )


def test_a_store_is_used_where_it_is_named_and_frozen_with_the_same_answer(tmp_path):
    store, frozen = corner_store(tmp_path), tmp_path / "used.yaml"
    first = run("run", FRAME, "--laws", store, "--freeze-laws", frozen, "--out", tmp_path / "a")
    assert first.exit_code == 0, first.output
    assert f"Store of laws: {store}, 1 used" in first.output
    assert "Law of corner-corner: file: stored" in first.output
    assert "Law of post-foot: kecman: formula, band" in first.output
    assert frozen.read_text(encoding="utf-8").count("crumple_law: 1") == 1
    assert run("run", FRAME, "--laws", frozen, "--out", tmp_path / "b").exit_code == 0
    histories = [(tmp_path / name / "histories.csv").read_bytes() for name in "ab"]
    assert histories[0] == histories[1]
    summary = json.loads((tmp_path / "a" / "summary.json").read_text(encoding="utf-8"))
    uses = {name: hinge["law_use"]["origin"] for name, hinge in summary["hinges"].items()}
    assert uses == {"post-foot": "formula", "corner-corner": "stored"}


def test_rigid_members_and_corners_without_laws_are_said_by_check_and_run(tmp_path):
    text = FRAME.read_text(encoding="utf-8")
    plain, long = tmp_path / "plain.yaml", tmp_path / "long.yaml"
    plain.write_text(text, encoding="utf-8")
    other = "  other: {type: square_tube, side: 40 mm, thickness: 2 mm}\n"
    changed = text.replace("sections:\n", f"sections:\n{other}")
    arm = "arm: {nodes: [corner, tip], section: "
    changed = changed.replace(f"{arm}tube", f"{arm}other").replace("duration: 60 ms", "duration: 501 ms")
    long.write_text(changed, encoding="utf-8")
    said = (
        "Corner corner has no law of its own, since the sections of the members differ: ",
        "Members are rigid between their hinges, since the motion is longer than 500 ms; "
        "analysis.multibody.members: elastic lets them bend.",
    )
    for command in (("check",), ("run", "--out", tmp_path / "out", "--no-law-range", "--no-modes")):
        assert not any(sentence in run(*command, plain).output for sentence in said)
        assert all(sentence in run(*command, long).output for sentence in said)


def test_layouts_use_and_freeze_stores_too(tmp_path):
    store, frozen = corner_store(tmp_path), tmp_path / "used.yaml"
    found = run("layouts", FRAME, "--laws", store, "--freeze-laws", frozen, "--out", tmp_path / "out")
    assert found.exit_code == 0, found.output
    assert "hinge corner-corner: stored" in frozen.read_text(encoding="utf-8")


def test_a_store_that_is_not_there_is_refused(tmp_path):
    found = run("run", FRAME, "--laws", tmp_path / "none", "--out", tmp_path / "a")
    assert found.exit_code != 0
    assert not (tmp_path / "a").exists()


def test_a_law_without_a_checksum_is_used_and_says_so(tmp_path):
    store = corner_store(tmp_path)
    for file in store.iterdir():
        lines = file.read_text(encoding="utf-8").splitlines(True)
        file.write_text("".join(line for line in lines if not line.startswith("checksum")), encoding="utf-8")
    found = run("run", FRAME, "--laws", store, "--out", tmp_path / "a", "--no-law-range", "--no-modes")
    assert found.exit_code == 0, found.output
    assert f"Store of laws: {store}, 1 used, 1 without a checksum (edited, or" in found.output
    assert "Law of corner-corner: file: stored, from shells, without a checksum" in found.output
    summary = json.loads((tmp_path / "a" / "summary.json").read_text(encoding="utf-8"))
    sure = {name: hinge["law_use"]["has_checksum"] for name, hinge in summary["hinges"].items()}
    assert sure == {"post-foot": True, "corner-corner": False}


def test_a_store_without_a_law_for_the_structure_says_so(tmp_path):
    store = store_of(tmp_path / "laws", law_text("0" * 16))
    found = run("run", FRAME, "--laws", store, "--out", tmp_path / "a", "--no-law-range", "--no-modes")
    assert found.exit_code == 0, found.output
    assert "0 used: it has no law that a hinge of this structure could use" in found.output
    assert f"`crumple characterise {FRAME} --list`" in found.output


def test_a_file_for_frozen_laws_that_cannot_be_written_is_refused_with_what_to_do(tmp_path):
    (tmp_path / "file").write_text("", encoding="utf-8")
    found = run("run", FRAME, "--freeze-laws", tmp_path / "file" / "f.yaml", "--out", tmp_path / "a")
    assert isinstance(found.exception, InputError)
    (problem,) = found.exception.problems
    assert "cannot be written: a file has this name" in problem.what
    assert (problem.todo, problem.where) == ("choose another file", "--freeze-laws")
    assert not (tmp_path / "a").exists()


def test_a_range_whose_runs_all_stopped_is_no_empty_line():
    hinges = {"h": SimpleNamespace(rotation_max=0.1, energy=5.0)}

    def lines(ranges, failed, cases=None, without=()):
        found = LawRange(ranges, {"h": 0.2}, without, failed, cases or {})
        return list(range_lines(SimpleNamespace(law_range=found, hinges=hinges)))

    name = "hinge.h.energy"
    (none,) = lines({name: (5.0, 5.0)}, ("nominal", "all laws low"))
    assert none.startswith("No range from the laws, runs that stopped early")
    assert none.endswith(": nominal; all laws low")
    some = lines({name: (4.0, 5.0)}, ("nominal",), {"all laws low": {name: 4.0}})
    assert some[0].endswith("hinge.h.energy 4 to 5 J")
    assert some[1].startswith("Not in the range, runs that stopped early")
    (same,) = lines({name: (5.0, 5.0)}, (), {"all laws low": {name: 5.0}})
    assert same.endswith("nothing changes by more than rounding")
    # as if it were certain: what turns has no band
    none, lacking = lines({name: (5.0, 5.0)}, (), {"all laws low": {name: 5.0}}, without=("k",))
    assert none.startswith("No range from the laws: ")
    assert lacking == "Without a band: k"


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ([], "Without the range from the laws and the modes of collapse, since the run took"),
        (["--no-law-range"], "Without the modes of collapse, since the run took"),
        (["--no-law-range", "--no-modes"], None),
    ],
)
def test_a_run_that_takes_long_says_what_it_goes_without(tmp_path, monkeypatch, options, said):
    monkeypatch.setattr(run_command, "QUICK", 0.0)
    found = run("run", FRAME, "--out", tmp_path / "a", *options)
    assert found.exit_code == 0, found.output
    assert ("Without" in found.output) == (said is not None)
    assert said is None or said in found.output
    summary = json.loads((tmp_path / "a" / "summary.json").read_text(encoding="utf-8"))
    assert (summary["law_range"], summary["modes"]) == (None, None)


@pytest.mark.parametrize("spent", [0.0, 100.0])
def test_whether_a_run_takes_long_is_decided_by_its_processor_time(tmp_path, monkeypatch, spent):
    """On a busy machine the wall time is longer than the limit although the run takes milliseconds."""
    clock = iter((0.0, spent))
    own = SimpleNamespace(process_time=lambda: next(clock), perf_counter=time.perf_counter)
    monkeypatch.setattr(run_command, "time", own)
    found = run("run", FRAME, "--out", tmp_path / "a", "--no-modes")
    assert found.exit_code == 0, found.output
    said = "since the run took 100 s of processor time (5 s at most): --law-range"
    assert (said in " ".join(found.output.split())) == (spent > 5.0)
    summary = json.loads((tmp_path / "a" / "summary.json").read_text(encoding="utf-8"))
    assert (summary["law_range"] is None) == (spent > 5.0)
