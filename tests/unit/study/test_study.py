"""Studies: rows do not depend on workers or interruptions, failures are rows, mistakes have lines."""

import csv
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from tests.unit.cli.test_cli import run_command  # noqa: F401  (a fixture)

from crumple.errors import InputError
from crumple.study import LoadedStudy, Study, run_study, study_of
from crumple.study.formula import Formula

BASE = Path("examples/01_tube_bending.yaml").resolve()
SPEED = "{path: initial_velocity, low: 0.5, high: 1.5}"
WALL = "{path: sections.tube.thickness, low: 2 mm, high: 3 mm}"
AT_THE_END = "{channel: hinge.root.rotation, take: at, time: 100 ms}"
ROTATION = "{channel: hinge.root.rotation, take: max}"


def written(folder, method, variable=SPEED, response=ROTATION, more=""):
    file = folder / "study.yaml"
    lines = [
        "crumple_study: 1",
        f"base: {BASE}",
        "variables:",
        f"  v: {variable}",
        "responses:",
        f"  r: {response}",
        f"method: {method}",
        more,
    ]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def rows_of(folder):
    return (folder / "study.csv").read_bytes()


@pytest.mark.parametrize("kind", ["latin_hypercube", "sobol", "monte_carlo"])
def test_rows_do_not_depend_on_workers(tmp_path, kind):
    file = written(tmp_path, f"{{type: {kind}, rows: 200, seed: 4}}")
    for workers in (1, 3):
        (tmp_path / str(workers)).mkdir()
        run_study(LoadedStudy(file), tmp_path / str(workers), workers)
    assert rows_of(tmp_path / "1") == rows_of(tmp_path / "3")


def test_processes_give_the_rows_of_batches(tmp_path):
    """A value at a time is not among what batches give; the last one is both.

    They agree to the accuracy of the base's settings, 1e-3: a single run's steps end at its output times.
    """
    for name, response in (("a", "{channel: hinge.root.rotation}"), ("b", AT_THE_END)):
        file = written(tmp_path, "{type: grid}", WALL.replace("3 mm", "3 mm, steps: 3"), response)
        (tmp_path / name).mkdir()
        table, _ = run_study(LoadedStudy(file), tmp_path / name, 2)
        assert all(row.ok for row in table.rows)
    a, b = (list(csv.reader(rows_of(tmp_path / name).decode().splitlines())) for name in "ab")
    assert [row[1] for row in a] == [row[1] for row in b]
    for one, other in zip(a[1:], b[1:], strict=True):
        assert float(one[2]) == pytest.approx(float(other[2]), rel=1e-3)


def test_a_killed_study_goes_on(tmp_path):
    file = written(tmp_path, "{type: monte_carlo, rows: 600, seed: 4}", WALL)
    killed, whole = tmp_path / "killed", tmp_path / "whole"
    command = [sys.executable, "-m", "crumple", "study", file, "--out"]
    process = subprocess.Popen([*command, killed], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while process.poll() is None and count(killed) == 0:
        time.sleep(0.01)
    process.kill()
    process.wait()
    known = count(killed)
    assert 0 < known < 600
    again = subprocess.run([*command, killed, "--resume"], check=True, capture_output=True, text=True)
    assert f"{600 - known} solved now" in again.stdout
    subprocess.run([*command, whole, "--workers", "1"], check=True, capture_output=True)
    assert rows_of(killed) == rows_of(whole)
    assert (killed / "study.json").read_bytes() == (whole / "study.json").read_bytes()


def count(folder):
    try:
        with sqlite3.connect(folder / "study.sqlite") as file:
            number = file.execute("SELECT count(*) FROM rows").fetchone()[0]
        file.close()
    except sqlite3.OperationalError:
        return 0
    return number


def test_rows_of_another_study_are_refused(tmp_path):
    run_study(LoadedStudy(written(tmp_path, "{type: sobol, rows: 2}")), tmp_path)
    with pytest.raises(InputError, match="another study"):
        run_study(LoadedStudy(written(tmp_path, "{type: sobol, rows: 4}")), tmp_path)


def test_a_resumed_optimisation_asks_for_known_rows(tmp_path):
    solved = []

    def function(x):
        solved.append(len(x["x"]))
        return {"y": (x["x"] - 0.3) ** 2}

    study = Study(
        variables={"x": {"low": 0.0, "high": 1.0}},
        responses={"y": {}},
        objective={"minimise": "y"},
        method={"type": "optimise", "rows": 200},
    )
    first, _ = study_of(function, study, tmp_path)
    solved.clear()
    second, answer = study_of(function, study, tmp_path)
    assert sum(solved) == 0
    assert answer.solved == 0
    assert second.points == first.points


def test_failed_rows_are_rows(tmp_path):
    """A wall thicker than half the depth of 25 mm is refused."""
    file = written(tmp_path, "{type: grid}", "{path: sections.tube.thickness, values: [2 mm, 14 mm, 2 mm]}")
    table, answer = run_study(LoadedStudy(file), tmp_path)
    assert [row.ok for row in table.rows] == [True, False, True]
    assert (answer.complete, answer.solved) == (2, 2)
    assert "thickness" in table.rows[1].reason
    assert "refused" in rows_of(tmp_path).decode()


def test_names_are_varied(tmp_path):
    file = written(tmp_path, "{type: grid}", "{path: members.tube.hinges.0.law, values: [kecman, nothing]}")
    table, _ = run_study(LoadedStudy(file), tmp_path, 1)
    assert [point[0] for point in table.points] == ["kecman", "nothing"]
    assert [row.ok for row in table.rows] == [True, False]


def test_points_come_from_a_file(tmp_path):
    (tmp_path / "points.csv").write_text("v\n1.0\n0.9\n", encoding="utf-8")
    table, _ = run_study(LoadedStudy(written(tmp_path, "{type: points, file: points.csv}")), tmp_path)
    assert table.points == [(1.0,), (0.9,)]
    (tmp_path / "points.csv").write_text("v\n1.0\nx\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"points.csv:3: this is not a point"):
        run_study(LoadedStudy(tmp_path / "study.yaml"), tmp_path)


def test_the_command(run_command, tmp_path):  # noqa: F811
    file = written(tmp_path, "{type: sobol, rows: 8}", more="constraints: [{response: r, at_most: 9 rad}]")
    code, out, err = run_command("study", file, "--out", tmp_path / "out", "--workers", 1)
    assert (code, err) == (0, "")
    assert "8 rows, 8 complete, 8 solved now" in out
    code, out, _ = run_command("study", file, "--out", tmp_path / "out", "--resume")
    assert "0 solved now" in out
    assert run_command("check", file)[0] == 0
    code, out, _ = run_command("schema", "--study")
    assert '"sobol_indices"' in out


@pytest.mark.parametrize(
    ("changes", "line", "said"),
    [
        ({"variable": WALL.replace("2 mm", "2 kg")}, 4, "kg is the unit of a mass"),
        ({"variable": WALL.replace("2 mm", "2")}, 4, "the unit is missing"),
        ({"variable": "{path: sections.tub.thickness, low: 1 mm, high: 2 mm}"}, 4, "nothing at this path"),
        ({"variable": "{path: initial_velocity}"}, 4, "the range is missing"),
        ({"variable": "{path: initial_velocity, low: 2, high: 1}"}, 4, "low must be below high"),
        ({"response": "{channel: hinge.rot.rotation}"}, 6, "no such channel"),
        ({"response": "{formula: 'v + q'}"}, 6, "unknown name"),
        ({"response": "{formula: '__import__(1)'}"}, 6, "not a formula"),
        ({"method": "{type: optimise}"}, 7, "the objective is missing"),
        ({"method": "{type: sobol_indices, rows: 3}"}, 7, "power of 2"),
        ({"method": "{type: magic}"}, 7, "type"),
        ({"more": "constraints: [{response: r}]"}, 8, "the limit is missing"),
        ({"more": "constraints: [{response: r, at_most: 3 mm}]"}, 8, "unit of a length"),
    ],
)
def test_mistakes_have_lines(tmp_path, changes, line, said):
    file = written(tmp_path, **({"method": "{type: sobol, rows: 2}"} | changes))
    with pytest.raises(InputError) as refused:
        run_study(LoadedStudy(file), tmp_path)
    assert said in str(refused.value)
    assert f"study.yaml:{line}: " in str(refused.value)


def test_formulas():
    values = {"a": np.array([1.0, 4.0]), "b": np.array([2.0, 0.0])}
    found = Formula("max(sqrt(a), b) / -2 + a ** 2")(values)
    assert found.tolist() == [0.0, 15.0]
    for text in ("a.b", "a[0]", "'a'", "lambda: 1", "sqrt(a, b)", "True", "a if b else a", "1 +", "a" * 600):
        with pytest.raises(InputError, match="not a formula"):
            Formula(text)
