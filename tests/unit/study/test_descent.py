"""Optimisation along gradients: slopes against differences of rows, optima against evolution, refusals."""

import math

import numpy as np
import pytest
from tests.unit.study.test_study import BASE, ROTATION, WALL, rows_of, written

from crumple.analysis import load
from crumple.errors import InputError
from crumple.study import LoadedStudy, Table, run_study
from crumple.study.methods.descent import _Search
from crumple.study.methods.optimise import optimise
from crumple.study.rows import BatchModel
from crumple.study.setting import setting_of
from crumple.study.space import Axis

WIDE = WALL.replace("3 mm", "6 mm")
MORE = "objective: {minimise: m}\nconstraints: [{response: r, at_most: 20 deg}]"
GRADIENT = "{type: optimise, rows: 60, gradient: true}"
MASS = ROTATION + "\n  m: {mass: true}"
THREE = (
    WIDE
    + "\n  y: {path: materials.steel.yield_stress, low: 300 MPa, high: 700 MPa}"
    + "\n  s: {path: initial_velocity, low: 0.5, high: 1.5}"
)
COST = MASS + "\n  cost: {formula: m * (1 + y / 4e8) + 0 * s}"


def test_slopes_are_those_of_rows(tmp_path):
    """Of a measured response, the mass and a formula of both with the variables."""
    response = ROTATION + "\n  m: {mass: true}\n  f: {formula: r * m + sqrt(y) * s}"
    loaded = LoadedStudy(written(tmp_path, GRADIENT, THREE, response, "objective: {minimise: f}"))
    setting = setting_of(loaded)
    model = BatchModel(loaded.base.analysis, setting.axes, setting.measured, 1)
    table = Table(setting.axes, ["r", "m"], model, None, "x")
    search = _Search(setting, table, lambda share: None)
    x = np.array([0.3, 0.6, 0.45])
    slopes, step = search._slope(x), 1e-4
    for k in range(3):
        ends = [search._values(x + way * step * (np.arange(3) == k)) for way in (1.0, -1.0)]
        for name in "rmf":
            slope = (ends[0][name] - ends[1][name]) / (2.0 * step)
            scale = np.abs(slopes[name]).max()
            assert slopes[name][k] == pytest.approx(slope, abs=2e-3 * scale), (name, k)


def test_the_lightest_wall_is_that_of_evolution_in_a_few_rows(tmp_path):
    found = {}
    for name, method in (("slope", GRADIENT), ("evolution", "{type: optimise, rows: 200, seed: 1}")):
        (tmp_path / name).mkdir()
        table, answer = run_study(LoadedStudy(written(tmp_path, method, WIDE, MASS, MORE)), tmp_path / name)
        found[name] = answer.best, len(table.rows)
    (slope, few), (evolution, many) = found.values()
    assert few < 20 < many
    # evolution stops a little above
    assert 0.999 < slope["responses"]["m"] / evolution["responses"]["m"] < 1.0 + 1e-6
    assert slope["responses"]["r"] == pytest.approx(np.radians(20.0), rel=1e-5)
    # replayed from its rows
    kept = rows_of(tmp_path / "slope")
    loaded = LoadedStudy(written(tmp_path, GRADIENT, WIDE, MASS, MORE))
    _, again = run_study(loaded, tmp_path / "slope")
    assert again.solved == 0
    assert rows_of(tmp_path / "slope") == kept


def test_it_begins_at_the_values_of_the_base_and_ends_with_its_rows(tmp_path):
    method = GRADIENT.replace("60", "3")
    loaded = LoadedStudy(
        written(tmp_path, method, THREE, COST, MORE.replace("minimise: m", "minimise: cost"))
    )
    table, _ = run_study(loaded, tmp_path)
    steel = load(BASE).structure.materials["steel"].yield_stress
    assert table.points[0] == pytest.approx((0.00265, steel, 1.0), rel=1e-9)
    assert len(table.rows) == 3


@pytest.mark.parametrize(
    ("method", "variable", "response", "more", "said"),
    [
        (
            GRADIENT,
            WALL.replace("low: 2 mm, high: 3 mm", "values: [2 mm, 3 mm]"),
            MASS,
            MORE,
            "has no gradient",
        ),
        (
            GRADIENT,
            WIDE,
            "{channel: node.tip.displacement.z, take: max}\n  m: {mass: true}",
            MORE.replace("20 deg", "90 mm"),
            "the gradient of 'r' is not known",
        ),
        (GRADIENT.replace("optimise", "sobol"), WIDE, MASS, MORE, "'gradient' is for 'optimise'"),
        (GRADIENT, WIDE, MASS, "objectives: [{minimise: m}, {minimise: r}]", "'gradient' is for 'optimise'"),
    ],
)
def test_what_has_no_gradient_is_refused(tmp_path, method, variable, response, more, said):
    with pytest.raises(InputError, match=said):
        run_study(LoadedStudy(written(tmp_path, method, variable, response, more)), tmp_path)


def test_an_optimum_is_found_although_half_of_the_range_fails():
    """The spread of a generation is a number, whatever a failed row stands for: no warning."""
    asked = []

    def judged(points):
        asked.extend(point[0] for point in points)
        x = np.array([point[0] for point in points])
        return (x - 0.4) ** 2, np.where(x > 0.5, math.inf, 0.0)

    optimise([Axis("x", (), "1", 0.0, 1.0, (), None, False, None)], judged, 320, 1)
    assert max(asked) > 0.5
    assert min(asked, key=lambda x: (x - 0.4) ** 2 if x <= 0.5 else math.inf) == pytest.approx(0.4, abs=1e-3)
