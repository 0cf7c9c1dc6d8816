"""Several objectives: the front by hand, generations that resume, and what is refused."""

import csv
import importlib.util
import json
import sys

import numpy as np
import pytest
from tests.unit.study.test_study import ROTATION, WALL, rows_of, written

from crumple.errors import InputError
from crumple.study import LoadedStudy, Study, run_study, study_of
from crumple.study.front import nondominated

optuna = pytest.mark.skipif(importlib.util.find_spec("optuna") is None, reason="Optuna is not installed")
BOTH = "objectives: [{minimise: r}, {minimise: m}]"
MASS = ROTATION + "\n  m: {mass: true}"


def test_the_front_of_rows_by_hand():
    goals = np.array([[1.0, 2.0, 3.0, 2.0, 0.5, 1.0, 3.0], [3.0, 2.0, 1.0, 2.0, 9.0, 4.0, 0.0]])
    # row 3 equals row 1, row 5 is worse than row 0, row 2 than row 6
    assert nondominated(goals, np.arange(7)) == [4, 0, 1, 6]
    assert nondominated(goals, np.array([2, 5])) == [5, 2]
    assert nondominated(goals, np.array([], int)) == []


def test_the_front_is_that_of_all_pairs():
    goals = np.random.default_rng(1).integers(0, 30, (3, 400)).astype(float)
    found = nondominated(goals, np.arange(400))
    better = (goals[:, :, None] <= goals[:, None, :]).all(axis=0) & (
        goals[:, :, None] < goals[:, None, :]
    ).any(axis=0)
    expected = np.flatnonzero(~better.any(axis=0))
    assert {tuple(goals[:, i]) for i in found} == {tuple(goals[:, i]) for i in expected}
    assert goals[0, found].tolist() == sorted(goals[0, found])


def parabolas(x):
    """Goals x^2 + k and (x - 2)^2 + k, whose front is k = 0 with x from 0 to 2."""
    return {"a": x["x"] ** 2 + x["k"], "b": -((x["x"] - 2.0) ** 2) - x["k"]}


def several(rows=600, seed=2, **more):
    return Study(
        variables={"x": {"low": -3.0, "high": 5.0}, "k": {"values": [0.0, 1.0, 2.0]}},
        responses={"a": {}, "b": {}},
        objectives=[{"minimise": "a"}, {"maximise": "b"}],
        method={"type": "optimise", "rows": rows, "seed": seed},
        **more,
    )


@optuna
def test_two_parabolas():
    """On the front sqrt(a) + sqrt(-b) = 2 (Schaffer's first function)."""
    table, answer = study_of(parabolas, several())
    assert len(table.rows) == 592  # generations of 16
    a, b = (np.array([one["responses"][name] for one in answer.front]) for name in "ab")
    assert np.sqrt(a) + np.sqrt(-b) == pytest.approx(2.0, abs=1e-3)
    assert len(a) > 50
    assert np.diff(np.sort(np.sqrt(a))).max() < 0.2
    assert {one["variables"]["k"] for one in answer.front} == {0.0}
    assert answer.best is None


@optuna
def test_constraints_hold_on_the_front():
    _, answer = study_of(parabolas, several(constraints=[{"response": "a", "at_least": 1.0}]))
    assert len(answer.front) > 20
    assert 1.0 <= min(one["responses"]["a"] for one in answer.front) < 1.02


@optuna
def test_generations_are_replayed_from_their_rows(tmp_path):
    """Cut after some rows, the study asks for the same points and solves those that are missing."""
    solved, limit = [], [200]

    def function(x):
        if len(solved) + len(x["x"]) > limit[0]:
            raise KeyboardInterrupt
        solved.extend(x["x"])
        failing = np.abs(x["x"] - 1.0) < 0.1
        return {name: np.where(failing, np.nan, values) for name, values in parabolas(x).items()}

    (tmp_path / "cut").mkdir()
    (tmp_path / "whole").mkdir()
    with pytest.raises(KeyboardInterrupt):
        study_of(function, several(), tmp_path / "cut")
    known, limit[0] = len(solved), 10_000
    assert 0 < known <= 200
    table, answer = study_of(function, several(), tmp_path / "cut")
    assert answer.solved == len(set(table.points)) - known
    assert answer.complete < len(table.rows)
    study_of(function, several(), tmp_path / "whole")
    for name in ("study.csv", "study.json", "front.csv"):
        assert (tmp_path / "cut" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()


@optuna
def test_a_study_file_with_two_objectives(run_command, tmp_path):
    file = written(tmp_path, "{type: optimise, rows: 48}", WALL, MASS, BOTH)
    code, out, err = run_command("study", file, "--out", tmp_path / "one", "--workers", 1)
    assert (code, err) == (0, "")
    assert "Pareto front of" in out
    front = json.loads((tmp_path / "one" / "study.json").read_text())["front"]
    rows = list(csv.DictReader((tmp_path / "one" / "front.csv").read_text().splitlines()))
    assert [int(row["row"]) for row in rows] == [one["row"] for one in front]
    assert [float(row["m"]) for row in rows] == [one["responses"]["m"] for one in front]
    # thicker walls turn less: every wall is a compromise
    rotations = [one["responses"]["r"] for one in front]
    assert rotations == sorted(rotations)
    masses = [one["responses"]["m"] for one in front]
    assert masses == sorted(masses, reverse=True)
    assert run_command("study", file, "--out", tmp_path / "two", "--workers", 2)[0] == 0
    assert rows_of(tmp_path / "one") == rows_of(tmp_path / "two")


def test_other_methods_have_a_front_and_verify_some_of_it(tmp_path):
    more = BOTH + "\nverify: {best: 3, sample: 0, fidelity: multibody}"
    file = written(tmp_path, "{type: latin_hypercube, rows: 9}", WALL, MASS, more)
    _, answer = run_study(LoadedStudy(file), tmp_path)
    assert len(answer.front) == 9
    verified = [one["row"] for one in answer.verification["rows"]]
    assert verified == [answer.front[i]["row"] for i in (0, 4, 8)]
    assert answer.verification["best"] is None
    # without objectives the file of an earlier front does not stay
    assert (tmp_path / "front.csv").exists()
    (tmp_path / "study.sqlite").unlink()
    run_study(LoadedStudy(written(tmp_path, "{type: sobol, rows: 2}", WALL)), tmp_path)
    assert not (tmp_path / "front.csv").exists()


def test_without_optuna_the_extra_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "optuna", None)
    file = written(tmp_path, "{type: optimise, rows: 32}", WALL, MASS, BOTH)
    with pytest.raises(InputError, match=r"install crumple\[study\]"):
        run_study(LoadedStudy(file), tmp_path)


@pytest.mark.parametrize(
    ("more", "method", "said"),
    [
        ("objectives: [{minimise: r}]", "optimise", "several objectives are several responses"),
        (
            "objectives: [{minimise: r}, {maximise: r}]",
            "optimise",
            "several objectives are several responses",
        ),
        ("objectives: [{minimise: r}, {minimise: q}]", "optimise", "there is no such response"),
        ("objectives: [{minimise: r}, {}]", "optimise", "an objective has one goal"),
        (BOTH + "\nobjective: {minimise: r}", "optimise", "there are 'objective' and 'objectives'"),
        (BOTH, "lightest", "'lightest' has one objective"),
    ],
)
def test_mistakes_of_objectives(tmp_path, more, method, said):
    wall = "{path: sections.tube.thickness, values: [2 mm, 3 mm]}"
    with pytest.raises(InputError, match=said) as refused:
        run_study(LoadedStudy(written(tmp_path, f"{{type: {method}}}", wall, MASS, more)), tmp_path)
    assert "study.yaml:" in str(refused.value)
