"""What `crumple study` says: rows, constraints, indices, and how to go on."""

import json
import signal

import pytest
from tests.unit.study.test_study import ROTATION, WALL, rows_of, written

from crumple.study import Table


def test_no_feasible_row_names_the_nearest(tmp_path, run_command):
    more = "  m: {mass: true}\nconstraints: [{response: r, at_most: 0.1 deg}]\nobjective: {minimise: m}"
    file, out = written(tmp_path, "{type: optimise, rows: 16}", WALL, f"{ROTATION}\n{more}"), tmp_path / "out"
    said = run_command("study", file, "--out", out, "--shapes", 0)[1]
    assert "no row of 16 keeps all constraints; the nearest is row" in said
    answer = json.loads((out / "study.json").read_text())
    assert answer["best"] is None
    thickest = max(float(line.split(",")[1]) for line in rows_of(out).decode().splitlines()[1:])
    assert answer["nearest"]["variables"]["v"] == thickest
    assert "No row of 16 keeps all constraints" in (out / "study.html").read_text()


def test_rows_without_a_result_are_counted_beside_the_probability(tmp_path, run_command):
    wall = "{path: sections.tube.thickness, low: 1.5 mm, high: 40 mm}"
    more = "constraints: [{response: r, at_most: 40 deg}]"
    file, out = written(tmp_path, "{type: monte_carlo, rows: 16}", wall, ROTATION, more), tmp_path / "out"
    said = run_command("study", file, "--out", out, "--shapes", 0)[1]
    answer = json.loads((out / "study.json").read_text())
    lost = 16 - answer["complete"]
    assert 0 < lost < 16
    assert f"first of {lost} alike: " in said
    assert f"caution: {lost} of 16 rows have no result and are left out of probabilities" in said
    assert "are left out of probabilities" in (out / "study.html").read_text()


def test_the_command(run_command, tmp_path):
    file = written(tmp_path, "{type: sobol, rows: 8}", more="constraints: [{response: r, at_most: 9 rad}]")
    code, out, err = run_command("study", file, "--out", tmp_path / "out", "--workers", 1)
    assert (code, err) == (0, "")
    assert "8 rows, 8 complete, 8 solved now" in out
    code, out, _ = run_command("study", file, "--out", tmp_path / "out", "--resume")
    assert "0 solved now" in out
    assert run_command("check", file)[0] == 0
    code, out, _ = run_command("schema", "--study")
    assert '"sobol_indices"' in out


@pytest.mark.parametrize(("number", "exit_code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interrupted_study_says_how_to_go_on(number, exit_code, run_command, tmp_path, monkeypatch):
    store = Table._store

    def interrupted(*what):
        store(*what)
        signal.raise_signal(number)

    before = signal.getsignal(number)

    file = written(tmp_path, "{type: sobol, rows: 32}")
    monkeypatch.setattr("crumple.study.table.Table._store", interrupted)
    code, out, err = run_command("study", file, "--out", tmp_path / "my rows", "--workers", 1)
    assert (code, out) == (exit_code, "")
    assert "the rows so far are kept" in err
    assert signal.getsignal(number) is before
    assert f"crumple study {file} --out '{tmp_path / 'my rows'}' --resume" in " ".join(err.split())


@pytest.mark.parametrize("part", [(), ("--part", "2/2")])
def test_a_study_that_is_interrupted_before_its_first_row_keeps_none(
    part, run_command, tmp_path, monkeypatch
):
    def interrupted(*_):
        signal.raise_signal(signal.SIGINT)

    file, out = written(tmp_path, "{type: sobol, rows: 32}"), tmp_path / "out"
    command = ("study", file, "--out", out, "--workers", 1)
    if part:
        # rows of another part are not this one's
        run_command(*command, "--part", "1/2")
    with monkeypatch.context() as patch:
        patch.setattr("crumple.study.table.Table._store", interrupted)
        code, _, err = run_command(*command, *part)
    again = " ".join(map(str, ("crumple", "study", file, "--out", out, *part)))
    assert code == 130
    said = " ".join(err.split())
    assert said.endswith(f"Stopped before the first row was kept. Begin again with: {again}")
    if not part:
        # rows of an earlier run that --resume keeps
        run_command(*command, "--no-page")
        monkeypatch.setattr("crumple.cli.console.progress.progress_bar", interrupted)
        assert "the rows so far are kept" in run_command(*command, "--resume")[2]


def test_the_command_says_that_a_response_is_constant(run_command, tmp_path):
    """The mass does not depend on the speed."""
    response = ROTATION + "\n  m: {mass: true}"
    file = written(tmp_path, "{type: sobol_indices, rows: 64}", response=response)
    code, out, err = run_command("study", file, "--out", tmp_path / "out", "--workers", 1, "--no-page")
    assert (code, err) == (0, "")
    assert "Sobol' indices of r for v: first order" in out
    assert "no Sobol' indices of m: the response is constant" in out
    assert "Sobol' indices of m for v" not in out
    indices = json.loads((tmp_path / "out" / "study.json").read_text())["indices"]
    assert indices["m"]["v"] == {"first": None, "total": None, "reason": "the response is constant"}
    assert indices["r"]["v"]["total"] == pytest.approx(1.0, abs=0.1)
