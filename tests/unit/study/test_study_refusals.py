"""Every mistake in a study file is refused with its line, before a row is solved."""

from concurrent.futures import BrokenExecutor, Executor, Future

import pytest
from tests.unit.study.test_study import ROTATION, SPEED, WALL, written

from crumple.errors import InputError
from crumple.study import LoadedStudy, run_study
from crumple.study.methods import asking

SCATTER = "{path: initial_velocity, distribution: {type: %s}}"
GRID, RANDOM, OPTIMISE = "{type: grid}", "{type: monte_carlo, rows: 2}", "{type: optimise, rows: 2}"
LIGHTEST = "{type: lightest, rows: 2}"
SAMPLE = "{type: sobol, rows: 2}"
AT = "{channel: hinge.root.rotation, take: at, time: 50 ms}"
SIZES = "{path: sections.tube.thickness, values: [%g mm, %g mm]}"


@pytest.mark.parametrize(
    ("method", "variable", "response", "more", "said"),
    [
        (GRID, SPEED.replace("}", ", steps: 10000}") + "\n  w: " + WALL.replace("}", ", steps: 999}"),
         ROTATION, "", "the grid has too many points"),
        ("{type: points, file: none.csv}", SPEED, ROTATION, "", "the points cannot be read"),
        (SAMPLE, SPEED, "{channel: node.tip.rotation_rate.y}", "", "a factor is possible only where"),
        (SAMPLE, "{path: members.tube.section, low: 1, high: 2}", ROTATION, "", "leads to no number"),
        (RANDOM, SCATTER % "table, values: [1, 2], cumulative: [0, 0.5]", ROTATION, "", "not a distribution"),
        (RANDOM, SCATTER % "normal, mean: 1", ROTATION, "", "a normal distribution needs 'deviation'"),
        (RANDOM, SCATTER % "uniform, low: 2, high: 1", ROTATION, "", "this is not a distribution"),
        (RANDOM, SCATTER % "lognormal, mean: -1, deviation: 1", ROTATION, "", "this is not a distribution"),
        (SAMPLE, WALL.replace("}", ", values: [2 mm]}"), ROTATION, "", "a variable has a range or values"),
        (SAMPLE, WALL + "\n  w: " + WALL, ROTATION, "", "the variable 'v' varies the same path"),
        (SAMPLE, SPEED, ROTATION, "constraints: [{response: r, at_most: 20 deg, at_least: 30 deg}]",
         "no value is within both limits"),
        (SAMPLE, "{low: 1, high: 2}", ROTATION, "", "the path is missing"),
        (SAMPLE, SPEED + "\n  V: " + SPEED, ROTATION, "", "two variables or responses have this name"),
        (RANDOM, "{path: initial_velocity}", ROTATION, "", "the distribution is missing"),
        (OPTIMISE, SCATTER % "normal, mean: 1, deviation: 1", ROTATION, "objective: {minimise: r}",
         "'optimise' needs a range"),
        (GRID, SPEED, ROTATION, "", "the number of grid values is missing"),
        (SAMPLE, SPEED, "{mass: true, formula: v}", "", "a response is one of three things"),
        (SAMPLE, SPEED, AT.replace("at,", "max,"), "", "'take: at' and 'time' belong together"),
        (SAMPLE, SPEED, AT.replace("50 ms", "5 s"), "", "after the end of the run"),
        (SAMPLE, SPEED, ROTATION, "constraints: [{response: q, at_most: 1}]", "there is no such response"),
        (SAMPLE, SPEED, ROTATION, "objective: {minimise: r, maximise: r}", "an objective has one goal"),
        (SAMPLE, SPEED, ROTATION, "objective: {minimise: q}", "there is no such response"),
        (LIGHTEST, WALL, "{mass: true}", "objective: {minimise: r}", "'lightest' needs values"),
        (LIGHTEST, SIZES % (2, 3), ROTATION, "objective: {minimise: r}", "'lightest' makes the mass small"),
    ],
)  # fmt: skip
def test_contradictions(tmp_path, method, variable, response, more, said):
    file = written(tmp_path, method, variable, response, more)
    with pytest.raises(InputError, match=said) as refused:
        run_study(LoadedStudy(file), tmp_path)
    assert all(problem.file == str(file) and problem.line > 1 for problem in refused.value.problems)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("crumple_study: 1", "crumple: 1", "this is not a study file"),
        ("crumple_study: 1", "crumple_study: '1'", "the format version is a text"),
        ("method:", "title: a\ntitle: b\nmethod:", "given twice"),
        ("base: ", "title: ", "the base input is missing"),
        (f"  v: {SPEED}", "  {}", "no variable is given"),
        (f"  r: {ROTATION}", "  {}", "no response is given"),
    ],
)
def test_missing_parts(tmp_path, old, new, said):
    file = written(tmp_path, SAMPLE)
    file.write_text(file.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
    with pytest.raises(InputError, match=said):
        run_study(LoadedStudy(file), tmp_path)


def test_too_many_combinations_to_weigh(tmp_path, monkeypatch):
    monkeypatch.setattr(asking, "MOST_COMBINATIONS", 1)
    file = written(tmp_path, LIGHTEST, SIZES % (2, 3), "{mass: true}", "objective: {minimise: r}")
    with pytest.raises(InputError, match="too many combinations"):
        run_study(LoadedStudy(file), tmp_path)


@pytest.mark.parametrize(("text", "said"), [("w\n1\n", "not the variables"), ("v\n", "has no points")])
def test_files_of_points(tmp_path, text, said):
    (tmp_path / "points.csv").write_text(text, encoding="utf-8")
    file = written(tmp_path, "{type: points, file: points.csv}")
    with pytest.raises(InputError, match=said):
        run_study(LoadedStudy(file), tmp_path)


def test_a_file_of_rows_that_is_none(tmp_path):
    (tmp_path / "study.sqlite").write_bytes(b"no rows " * 100)
    with pytest.raises(InputError, match="the rows cannot be read"):
        run_study(LoadedStudy(written(tmp_path, SAMPLE)), tmp_path)


class Dead(Executor):
    """Its worker ends with the first job."""

    def submit(self, fn, /, *args, **kwargs):
        future = Future()
        future.set_exception(BrokenExecutor())
        return future


def test_a_worker_that_ends(tmp_path):
    file = written(tmp_path, SAMPLE, WALL, AT)
    with pytest.raises(InputError, match="a worker process ended"):
        run_study(LoadedStudy(file), tmp_path, executor=Dead())
