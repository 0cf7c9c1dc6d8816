"""Studies of functions with known answers, and of the tube on a fine grid.

Ishigami and Homma (1990): sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1 on [-pi, pi]^3 has the first-order indices
V1 = (1 + b pi^4/5)^2/2, V2 = a^2/8, V3 = 0 over V = a^2/8 + b pi^4/5 + b^2 pi^8/18 + 1/2, and total indices
(V1 + V13)/V, V2/V and V13/V with V13 = 8 b^2 pi^8/225.  A normal variable exceeds its mean by 1.5 deviations
with probability 0.066807.  A quadratic has its optimum at its centre, or where a constraint cuts it.

Kind: closed form.  Source: derived here.
"""

import math
from pathlib import Path

import numpy as np
import pytest

from crumple import load
from crumple.multibody import Run, solve_variants
from crumple.study import LoadedStudy, Study, run_study, study_of

A, B = 7.0, 0.1


def ishigami(x):
    return {"y": np.sin(x["x1"]) + A * np.sin(x["x2"]) ** 2 + B * x["x3"] ** 4 * np.sin(x["x1"])}


def study(variables, method, responses=("y",), **more):
    return Study(variables=variables, responses={name: {} for name in responses}, method=method, **more)


def ishigami_study(rows=2048):
    span = {"low": -math.pi, "high": math.pi}
    return study(dict.fromkeys(("x1", "x2", "x3"), span), {"type": "sobol_indices", "rows": rows, "seed": 3})


def exact_indices():
    first = 0.5 * (1 + B * math.pi**4 / 5) ** 2
    second, both = A**2 / 8, 8 * B**2 * math.pi**8 / 225
    total = first + second + both
    return {
        "x1": (first / total, (first + both) / total),
        "x2": (second / total, second / total),
        "x3": (0.0, both / total),
    }


def test_indices_of_ishigamis_function():
    _, answer = study_of(ishigami, ishigami_study())
    for name, (first, total) in exact_indices().items():
        # the error of quasi-random estimates with 2048 blocks
        assert answer.indices["y"][name]["first"] == pytest.approx(first, abs=0.02)
        assert answer.indices["y"][name]["total"] == pytest.approx(total, abs=0.02)


def failing(share):
    def function(x):
        y = ishigami(x)["y"]
        return {"y": np.where(np.abs(x["x1"]) < share * math.pi, np.nan, y)}

    return function


def test_failed_rows_drop_their_blocks():
    table, answer = study_of(failing(0.002), ishigami_study())
    assert answer.rows - answer.complete > 0
    assert answer.failures == {"no value": answer.rows - answer.complete}
    for name, (first, total) in exact_indices().items():
        assert answer.indices["y"][name]["first"] == pytest.approx(first, abs=0.03)
        assert answer.indices["y"][name]["total"] == pytest.approx(total, abs=0.03)
    assert len(table.rows) > 5 * 2048


def test_above_five_percent_there_are_no_indices():
    _, answer = study_of(failing(0.2), ishigami_study(256))
    assert isinstance(answer.indices, str)
    assert "no indices" in answer.indices


@pytest.mark.parametrize("noise", [0.0, 1e-14])
def test_a_response_that_does_not_vary_has_no_indices(noise):
    """Nor one that varies by rounding alone; another response of the same study has its own."""

    def function(x):
        return ishigami(x) | {"z": 3.0 + noise * np.sin(x["x1"])}

    variables = ishigami_study().variables
    method = {"type": "sobol_indices", "rows": 2048, "seed": 3}
    _, answer = study_of(function, study(variables, method, ("y", "z")))
    assert set(answer.indices["z"]) == {"x1", "x2", "x3"}
    for found in answer.indices["z"].values():
        assert found == {"first": None, "total": None, "reason": "the response is constant"}
    assert answer.indices["y"]["x2"]["first"] == pytest.approx(exact_indices()["x2"][0], abs=0.02)
    _, answer = study_of(
        lambda x: ishigami(x) | {"z": 3.0 + 1e-9 * np.sin(x["x1"])}, study(variables, method, ("y", "z"))
    )
    assert answer.indices["z"]["x1"]["total"] == pytest.approx(1.0, abs=0.02)


def test_a_failure_probability_is_in_its_interval():
    scatter = {"distribution": {"type": "normal", "mean": 2.0, "deviation": 0.5}}
    given = study(
        {"x": scatter},
        {"type": "monte_carlo", "rows": 20_000, "seed": 5},
        constraints=[{"response": "y", "at_most": 2.75}],
    )
    _, answer = study_of(lambda x: {"y": x["x"]}, given)
    low, high = answer.probabilities[0]["interval"]
    assert low < 0.0668072 < high
    assert high - low < 0.008


@pytest.mark.parametrize(("limit", "x", "y"), [(9.0, 1.0, -2.0), (-2.0, -0.5, -3.5 + 2.0)])
def test_the_optimum_of_a_quadratic(limit, x, y):
    """(x - 1)^2 + (y + 2)^2; the constraint x + y <= -2 moves it by half of the excess along (1, 1)."""

    def function(p):
        return {"f": (p["x"] - 1) ** 2 + (p["y"] + 2) ** 2, "sum": p["x"] + p["y"]}

    if limit < 9.0:
        excess = (1.0 - 2.0) - limit
        x, y = 1.0 - excess / 2, -2.0 - excess / 2
    span = {"low": -5.0, "high": 5.0}
    given = study(
        {"x": span, "y": span},
        {"type": "optimise", "rows": 4000, "seed": 2},
        ("f", "sum"),
        constraints=[{"response": "sum", "at_most": limit}],
        objective={"minimise": "f"},
    )
    _, answer = study_of(function, given)
    assert answer.best["variables"]["x"] == pytest.approx(x, abs=0.01)
    assert answer.best["variables"]["y"] == pytest.approx(y, abs=0.01)


@pytest.mark.slow
def test_the_lightest_tube_is_that_of_a_fine_grid(tmp_path):
    loaded = LoadedStudy(Path("examples/studies/02_lightest_tube.yaml"))
    _, answer = run_study(loaded, tmp_path)
    tube = load("examples/01_tube_bending.yaml")
    grid = np.arange(2.0e-3, 6.0e-3, 0.01e-3)
    run = Run(tube.duration, tube.output_interval, settings=tube.multibody, outputs=tube.outputs)
    table = solve_variants(tube.structure, run, {"sections.tube.thickness": grid})
    sound = np.abs(table["hinge.root.rotation_max"]) <= math.radians(20.0)
    wall = answer.best["variables"]["wall"]
    # between the first sound wall of the grid and the one before it
    assert grid[sound][0] - 0.01e-3 < wall <= grid[sound][0]
    assert abs(answer.best["responses"]["rotation"]) <= math.radians(20.0)
