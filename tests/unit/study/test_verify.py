"""Rows that are solved again: rank correlation and its interval, winners rejected, corrected; real shells."""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import kendalltau

from crumple.analysis import solve
from crumple.errors import InputError
from crumple.study import LoadedStudy, Study, check_study, run_study, study_of
from crumple.study.verify import kendall

EXAMPLE = Path("examples/studies/05_verified.yaml")


def study(best=3, sample=40, rows=200):
    return Study.model_validate(
        {
            "variables": {"x": {"low": 0.0, "high": 1.0}},
            "responses": {"y": {}, "cost": {}},
            "constraints": [{"response": "y", "at_most": 0.5}],
            "objective": {"minimise": "cost"},
            "method": {"type": "sobol", "rows": rows, "seed": 3},
            "verify": {"best": best, "sample": sample},
        }
    )


def fast(columns):
    return {"y": columns["x"], "cost": -columns["x"]}


def verified(slow, **changes):
    return study_of(fast, study(**changes), slow=slow)[1].verification


@pytest.mark.parametrize("digits", [6, 1])
def test_rank_correlation_is_tau_b_and_its_interval_holds_that_of_all(digits):
    """With one digit there are ties.  The population's value is that of 4000 rows."""
    rng = np.random.default_rng(5)
    x = rng.random(4000)
    y = x + 0.3 * rng.standard_normal(4000)
    x, y = x.round(digits), y.round(digits)
    tau, interval = kendall(x[:60], y[:60], 1)
    assert tau == pytest.approx(kendalltau(x[:60], y[:60]).statistic, rel=1e-12)
    assert interval[0] < kendalltau(x, y).statistic < interval[1]
    assert 0.05 < interval[1] - interval[0] < 0.5


def test_columns_without_ranks_have_none():
    assert kendall(np.ones(9), np.arange(9.0), 1) == (None, None)
    assert kendall(np.arange(9.0), np.arange(9.0), 1) == (1.0, [1.0, 1.0])


def test_a_winner_that_the_slower_model_refutes_is_rejected():
    found = verified(lambda columns: {"y": columns["x"] + 0.004, "cost": -columns["x"]}, best=3)
    best = found["rows"][:3]
    assert [row["chosen"] for row in best] == ["best"] * 3
    assert [row["fast"]["y"] for row in best] == sorted((row["fast"]["y"] for row in best), reverse=True)
    beyond = [row["row"] for row in best if row["fast"]["y"] + 0.004 > 0.5]
    assert 0 < len(beyond) < 3
    assert found["rejected"] == beyond
    kept = next(row for row in best if row["row"] not in beyond)
    assert found["best"] == kept
    errors = found["responses"]["y"]
    assert errors["mean_error"] == pytest.approx(-0.004)
    assert errors["rms_error"] == pytest.approx(0.004)
    assert errors["tau"] == 1.0
    assert (errors["rows"], errors["sample"]) == (43, 40)


def test_the_best_is_that_of_the_slower_models_values():
    """Its cost has the opposite order among the best rows."""
    found = verified(lambda columns: {"y": columns["x"], "cost": columns["x"]}, best=4)
    assert found["rejected"] == []
    assert found["best"]["row"] == found["rows"][3]["row"]
    assert found["responses"]["cost"]["tau"] == -1.0


def test_rows_that_the_slower_model_cannot_solve_are_rejected_with_a_reason():
    found = verified(lambda columns: {"y": np.full_like(columns["x"], np.nan), "cost": columns["x"]})
    assert found["best"] is None
    assert len(found["rejected"]) == 3
    assert "tau" not in found["responses"]["y"] or found["responses"]["y"]["tau"] is None
    assert {row["status"] for row in found["rows"]} == {"no value"}


def test_random_rows_are_not_the_best_and_depend_on_the_seed_alone():
    one, other = (verified(fast, sample=sample) for sample in (10, 10))
    numbers = [row["row"] for row in one["rows"]]
    assert numbers == [row["row"] for row in other["rows"]]
    assert len(set(numbers)) == 13
    assert len(verified(fast, sample=1000, rows=16)["rows"]) == 16


def test_shells_verify_rows_and_are_resumed(tmp_path):
    loaded = LoadedStudy(EXAMPLE)
    few = loaded.study.verify.model_copy(update={"best": 1, "sample": 0})
    loaded.study = loaded.study.model_copy(update={"verify": few})
    answer = run_study(loaded, tmp_path)[1]
    (row,) = answer.verification["rows"]
    assert row["status"] == "complete"
    # shells are another model: near, but not the same
    assert 1e-4 < abs(row["slow"]["deflection"] / row["fast"]["deflection"] - 1.0) < 0.1
    assert row["row"] == answer.best["row"]
    more = few.model_copy(update={"sample": 1})
    loaded.study = loaded.study.model_copy(update={"verify": more})
    again = run_study(loaded, tmp_path)[1]
    assert again.solved == 0
    assert again.verification["rows"][0] == row
    assert len(again.verification["rows"]) == 2
    assert json.loads((tmp_path / "study.json").read_text())["verification"]["rows"][0] == row


def test_factors_cannot_be_verified(tmp_path):
    file = tmp_path / "study.yaml"
    text = EXAMPLE.read_text().replace(
        "path: materials.steel.yield_stress, low: 300 MPa, high: 600 MPa",
        "path: initial_velocity, low: 0.9, high: 1.1",
    )
    file.write_text(text.replace("short_tube", str(EXAMPLE.parent.resolve() / "short_tube")))
    with pytest.raises(InputError, match="take no factors"):
        check_study(LoadedStudy(file))


def test_a_reserve_keeps_the_fast_model_clear_of_its_limits():
    """With 10 % the best fast row is below 0.45, and an error of 0.04 rejects none."""
    own = study(best=5)
    own = own.model_copy(update={"verify": own.verify.model_copy(update={"reserve": 0.1})})

    def slow(columns):
        return {"y": columns["x"] + 0.04, "cost": -columns["x"]}

    _, answer = study_of(fast, own, slow=slow)
    assert 0.44 < answer.best["responses"]["y"] <= 0.45
    assert answer.limits == [("y", -np.inf, pytest.approx(0.45))]
    assert answer.verification["rejected"] == []
    assert answer.verification["best"]["row"] == answer.best["row"]
    # without it the same error rejects all
    assert len(verified(slow, best=5)["rejected"]) == 5


@pytest.mark.slow
def test_shells_confirm_an_optimum_over_twelve_variables(tmp_path):
    """A frame of two storeys within its limit by shells too; equal tubes are heavier and exceed it."""
    loaded = LoadedStudy(Path("examples/studies/07_twelve_variables.yaml"))
    verify = loaded.study.verify.model_copy(update={"best": 1, "sample": 0})
    loaded.study = loaded.study.model_copy(update={"verify": verify})
    _, answer = run_study(loaded, tmp_path, 2)
    equal = loaded.base.analysis.structure.mass_of_members
    best = answer.verification["best"]
    assert best["row"] == answer.best["row"]
    assert len(best["variables"]) == 12
    assert best["slow"]["sway"] <= 0.12
    assert best["fast"]["sway"] <= 0.108
    assert best["slow"]["mass"] < equal
    base = solve(loaded.base.analysis)
    assert base["node.left_roof.displacement.x"].max() > 0.12
