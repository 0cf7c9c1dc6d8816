"""Studies: rows do not depend on workers or interruptions, failures are rows, mistakes have lines."""

import csv
import sqlite3
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from crumple.analysis import load, solve
from crumple.analysis.criteria import Measured, measure
from crumple.errors import InputError
from crumple.structure import changed
from crumple.study import LoadedStudy, Study, Table, run_study, study_of
from crumple.study import table as study_table
from crumple.study.formula import Formula
from crumple.study.rows import Model, Row, batch
from crumple.study.space import axes_of

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


AT_EARLIER = AT_THE_END.replace("100 ms", "43.7 ms")
DEFLECTION = "{channel: node.tip.displacement.z, take: max}"


@pytest.mark.parametrize("response", [ROTATION, AT_THE_END, AT_EARLIER, DEFLECTION, "{mass: true}"])
def test_rows_of_processes_have_the_bits_of_batches(tmp_path, response):
    """Whoever solves a row: the batch, a process, or an executor that is given."""
    file = written(tmp_path, "{type: grid}", WALL.replace("3 mm", "3 mm, steps: 3"), response)
    with ThreadPoolExecutor(1) as executor:
        for name, given in (("batch", None), ("alone", executor)):
            (tmp_path / name).mkdir()
            table, _ = run_study(LoadedStudy(file), tmp_path / name, executor=given)
            assert all(row.ok for row in table.rows)
    assert rows_of(tmp_path / "batch") == rows_of(tmp_path / "alone")


def test_single_runs_agree_with_batches_within_their_error(tmp_path):
    """A rate of rotation is not among what batches give, so these rows are those of `solve`.

    That solves at a quarter of the accuracy, with steps that end at its outputs: the difference is the error
    of the run at the accuracy itself, which it reports.
    """
    more = "\n  s: {channel: node.tip.rotation_rate.y, take: max}"
    for name, response in (("a", ROTATION), ("b", ROTATION + more)):
        file = written(tmp_path, "{type: grid}", WALL.replace("3 mm", "3 mm, steps: 3"), response)
        (tmp_path / name).mkdir()
        run_study(LoadedStudy(file), tmp_path / name, 2)
    a, b = (list(csv.reader(rows_of(tmp_path / name).decode().splitlines())) for name in "ab")
    assert [row[1] for row in a] == [row[1] for row in b]
    for wall, one, other in zip(
        *([row[k] for row in t[1:]] for t, k in ((a, 1), (a, 2), (b, 2))), strict=True
    ):
        analysis = load(BASE)
        structure = changed(analysis.structure, {"sections.tube.thickness": float(wall)})
        result = solve(analysis.model_copy(update={"structure": structure}))
        assert float(other) == result.hinges["root"].rotation_max
        assert 0.0 < abs(float(one) - float(other)) <= result.hinges["root"].rotation_error


DERIVED = {
    "filtered": "{channel: smooth, take: max}",
    "filtered_end": "{channel: smooth}",
    "filtered_at": "{channel: smooth, take: at, time: 31.3 ms}",
    "turned": "{channel: turned, take: max}",
    "mean": "{channel: node.tip.acceleration.z, take: max}",
    "speed": "{channel: node.tip.velocity.z, take: max}",
    "speed_end": "{channel: node.tip.velocity.z}",
    "speed_at": "{channel: node.tip.velocity.z, take: at, time: 31.3 ms}",
}


def derived(folder, base):
    """Rows of a batch, and of single runs at the accuracy of the batch."""
    file = written(folder, "{type: grid}", WALL.replace("3 mm}", "3 mm, steps: 2}"), ROTATION)
    text = file.read_text().replace(f"base: {BASE}", f"base: {base}")
    text = text.replace(f"r: {ROTATION}", "\n  ".join(f"{name}: {given}" for name, given in DERIVED.items()))
    file.write_text(text, encoding="utf-8")
    loaded = LoadedStudy(file)
    table, _ = run_study(loaded, folder, 1)
    analysis = loaded.base.analysis
    for (wall,), row in zip(table.points, table.rows, strict=True):
        structure = changed(analysis.structure, {"sections.tube.thickness": wall})
        result = solve(analysis.model_copy(update={"structure": structure}))
        measured = [
            measure(result, Measured(name, given.channel, given.take, 0.0313))
            for name, given in loaded.study.responses.items()
        ]
        yield dict(zip(DERIVED, row.values, strict=True)), dict(zip(DERIVED, measured, strict=True))


@pytest.mark.parametrize("space", [False, True])
def test_batches_give_velocities_accelerations_and_filtered_channels(tmp_path, space, monkeypatch):
    """As single runs do, at a quarter of the accuracy of 1e-3: the largest difference is 2e-5."""
    from crumple.study.rows import process

    base = tmp_path / "base.yaml"
    filters = (
        "  filters:\n    smooth: {channel: node.tip.acceleration.z, cfc: 60}\n"
        "    turned: {channel: hinge.root.rotation, cfc: 60}\n  nodes: [tip]"
    )
    text = BASE.read_text().replace("  nodes: [tip]", filters)
    if space:
        text = text.replace("{accuracy: 1e-3}", "{accuracy: 1e-3, kernel: spatial}")
    base.write_text(text, encoding="utf-8")
    monkeypatch.setattr(process, "solve", None)  # single runs are not needed
    for rows, single in derived(tmp_path, base):
        for name, value in rows.items():
            scale = max(abs(value) for key, value in single.items() if key[:4] == name[:4])
            assert value == pytest.approx(single[name], abs=1e-4 * scale), name


def test_long_studies_of_walls_are_shared_by_processes(tmp_path, monkeypatch):
    """The same rows as without them."""
    file = written(tmp_path, "{type: sobol, rows: 64}", WALL, DEFLECTION)
    monkeypatch.setattr(batch, "SHARED_FROM", 0.0)
    for name, workers in (("one", 1), ("two", 2)):
        (tmp_path / name).mkdir()
        table, answer = run_study(LoadedStudy(file), tmp_path / name, workers)
        assert answer.solved == len(table.rows) == 64
    assert rows_of(tmp_path / "one") == rows_of(tmp_path / "two")


def test_slow_rows_are_kept_while_others_are_in_work(tmp_path, monkeypatch):
    """A row that is known is in the file before the next one is."""
    monkeypatch.setattr(study_table, "LATEST", 0.0)
    kept = []

    class Slow(Model):
        def rows(self, points):
            for i in range(len(points)):
                yield [(i, Row((float(i),), "complete", ""))]
                kept.append(count(tmp_path))

    study = LoadedStudy(written(tmp_path, "{type: sobol, rows: 2}"))
    axes = axes_of(study.study, study.base.document.data)
    table = Table(axes, ["r"], Slow(), tmp_path / "study.sqlite", "x")
    table.solve([(0.1,), (0.2,), (0.3,)])
    assert kept == [1, 2, 3]
    table.close()
    assert count(tmp_path) == 3


def test_a_killed_study_goes_on(tmp_path, run_command):
    file = written(tmp_path, "{type: monte_carlo, rows: 600, seed: 4}", WALL)
    killed, whole = tmp_path / "killed", tmp_path / "whole"
    command = [sys.executable, "-m", "crumple", "study", file, "--out", killed]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while process.poll() is None and count(killed) == 0:
        time.sleep(0.01)
    process.kill()
    process.wait()
    known = count(killed)
    assert 0 < known < 600
    assert f"{600 - known} solved now" in run_command("study", file, "--out", killed, "--resume")[1]
    assert run_command("study", file, "--out", whole, "--workers", "1")[0] == 0
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
    frame = table.to_pandas()
    assert list(frame.columns) == ["v", "r", "status", "reason"]
    assert frame["v"].tolist() == [0.002, 0.014, 0.002]
    assert frame["r"].isna().tolist() == [False, True, False]


def test_names_are_varied(tmp_path):
    file = written(tmp_path, "{type: grid}", "{path: members.tube.hinges.0.law, values: [kecman, nothing]}")
    table, _ = run_study(LoadedStudy(file), tmp_path, 1)
    assert [point[0] for point in table.points] == ["kecman", "nothing"]
    assert [row.ok for row in table.rows] == [True, False]


def test_values_that_connect_other_parts_are_solved_as_structures_of_their_own(tmp_path):
    """Members that meet in a corner with one wall have one hinge there, with two walls two hinges."""
    base = Path("examples/studies/two_storeys.yaml").resolve()
    file = written(
        tmp_path,
        "{type: grid}",
        "{path: sections.roof.thickness, values: [3 mm, 4 mm]}"
        "\n  s: {path: initial_velocity, values: [1, 0.7]}",
        "{channel: node.left_roof.displacement.x, take: max}\n  m: {mass: true}",
    )
    file.write_text(file.read_text().replace(str(BASE), str(base)))
    table, _ = run_study(LoadedStudy(file), tmp_path)
    assert [row.ok for row in table.rows] == [True] * 4
    analysis = load(base)
    for (wall, speed), row in zip(table.points, table.rows, strict=True):
        structure = changed(analysis.structure, {"sections.roof.thickness": wall})
        assert row.values[1] == pytest.approx(structure.mass_of_members, rel=1e-12)
        if speed == 1.0:
            result = solve(analysis.model_copy(update={"structure": structure}))
            swayed = np.abs(result["node.left_roof.displacement.x"]).max()
            assert row.values[0] == pytest.approx(swayed, abs=1e-3)
    assert table.rows[3].values[0] < 0.7 * table.rows[2].values[0]
    with ThreadPoolExecutor(1) as executor:
        (tmp_path / "other").mkdir()
        run_study(LoadedStudy(file), tmp_path / "other", executor=executor)
    assert rows_of(tmp_path) == rows_of(tmp_path / "other")


def test_points_come_from_a_file(tmp_path):
    (tmp_path / "points.csv").write_text("v\n1.0\n0.9\n", encoding="utf-8")
    table, _ = run_study(LoadedStudy(written(tmp_path, "{type: points, file: points.csv}")), tmp_path)
    assert table.points == [(1.0,), (0.9,)]
    (tmp_path / "points.csv").write_text("v\n1.0\nx\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"points.csv:3: this is not a point"):
        run_study(LoadedStudy(tmp_path / "study.yaml"), tmp_path)


def test_rows_are_followed_one_by_one(tmp_path):
    shares = []
    loaded = LoadedStudy(written(tmp_path, "{type: sobol, rows: 32}"))
    run_study(loaded, tmp_path, progress=shares.append)
    assert shares == sorted(shares)
    assert len(shares) > 1
    assert (shares[0], shares[-1]) == (4 / 32, 1.0)


def test_a_full_disk_is_no_defect(run_command, tmp_path, monkeypatch):
    def small(path):
        file = connect(path)
        # of one table each, and of all names: the rows do not fit
        file.execute("PRAGMA max_page_count = 3")
        return file

    connect = sqlite3.connect
    monkeypatch.setattr("crumple.study.table.sqlite3.connect", small)
    file = written(tmp_path, "{type: sobol, rows: 256}")
    code, _, err = run_command("study", file, "--out", tmp_path / "out", "--workers", 1)
    assert code == 2
    assert f"the results cannot be written to {tmp_path / 'out'}: No space left on device" in err


@pytest.mark.parametrize(
    ("changes", "line", "said"),
    [
        ({"variable": WALL.replace("2 mm", "2 kg")}, 4, "kg is the unit of a mass"),
        ({"variable": WALL.replace("2 mm", "2")}, 4, "the unit is missing"),
        ({"variable": "{path: sections.tub.thickness, low: 1 mm, high: 2 mm}"}, 4, "nothing at this path"),
        ({"variable": WALL.replace("tube.thickness", "tueb.thickness")}, 4, "'sections.tube.thickness'?"),
        (
            {"variable": WALL.replace("sections.tube", "structure.sections.tube")},
            4,
            "'sections.tube.thickness'?",
        ),
        ({"variable": WALL.replace("thickness", "colour")}, 4, "correct the path"),
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
