"""From the input's mapping to a function: every kind, every mistake, nothing evaluated."""

from __future__ import annotations

import numpy as np
import pytest

from crumple.errors import InputError
from crumple.function import Constant, Stop, Sum, Table, Transition, parse_time_function

STEP = {"step": {"x0": "0 ms", "h0": "0 N", "x1": "10 ms", "h1": "5 kN"}}
IMPACT = {
    "impact": {
        "x": {"havsin": {"x0": "0 s", "h0": "20 mm", "x1": "50 ms", "h1": "-10 mm"}},
        "x1": "0 mm",
        "k": "1 kN/mm",
        "e": 1,
        "cmax": "100 N*s/m",
        "d": "1 mm",
    }
}


def test_every_kind() -> None:
    assert parse_time_function("5 kN", "N") == Constant(5000.0)
    assert parse_time_function({"constant": "5 kN"}, "N") == Constant(5000.0)
    assert parse_time_function(0, "N") == Constant(0.0)
    assert parse_time_function(STEP, "N") == Transition("step", 0.0, 0.0, 0.01, 5000.0)
    for kind in ("step5", "havsin"):
        assert parse_time_function({kind: STEP["step"]}, "N") == Transition(kind, 0.0, 0.0, 0.01, 5000.0)
    rows = {"time": ["0 ms", "5 ms"], "value": ["0 N", "5 kN"]}
    heads = {"time": [0, 5], "value": [0, 5], "units": {"time": "ms", "value": "kN"}}
    for body in (rows, heads):
        assert parse_time_function({"table": body}, "N") == Table((0.0, 0.005), (0.0, 5000.0))
    assert parse_time_function({"sum": ["1 N", STEP]}, "N") == Sum(
        (Constant(1.0), Transition("step", 0.0, 0.0, 0.01, 5000.0))
    )
    stop = parse_time_function(IMPACT, "N")
    assert isinstance(stop, Stop)
    assert (stop.k, stop.cmax, stop.d, stop.x2) == (1e6, 100.0, 1e-3, None)
    bistop = {"bistop": {**IMPACT["impact"], "x2": "30 mm"}}
    assert parse_time_function(bistop, "N").x2 == 0.03


def test_moment_of_a_rotation_and_broken_exponent() -> None:
    body = {"x": "0 deg", "x1": "10 deg", "k": 2.0e3, "e": 1.5, "cmax": "1 N*m*s/rad", "d": 0}
    stop = parse_time_function({"impact": body}, "N*m")
    assert stop(0.0) == pytest.approx(2e3 * np.deg2rad(10.0) ** 1.5)
    square = parse_time_function({"impact": body | {"e": 2, "k": "3 kN*m/rad^2"}}, "N*m")
    assert square.k == 3000.0


@pytest.mark.parametrize(
    "spec",
    ["5 kN", STEP, {"sum": [STEP, "1 N"]}, IMPACT, {"table": {"time": ["0 s", "1 s"], "value": [0, 0]}}],
)
def test_plain_data_reads_back(spec) -> None:
    function = parse_time_function(spec, "N")
    assert parse_time_function(function.as_mapping(), "N", plain_numbers=True) == function
    assert parse_time_function(function, "N") is function


@pytest.mark.parametrize(
    ("spec", "where", "what"),
    [
        (5.0, "", "unit is missing"),
        (True, "", "not a text"),
        (None, "", "not a text"),
        ([1, 2], "", "not a text"),
        ("5 mm", "", "but a force is needed"),
        ("step(time, 0, 0, 1, 1)", "", "not a number"),
        ({}, "", "not a function of time"),
        ({"stp": {}}, "", "not a function of time"),
        ({"step": {}, "sum": []}, "", "not a function of time"),
        ({"step": "0 N"}, "step", "a group of keys is needed"),
        ({"step": {**STEP["step"], "x2": 0}}, "step", "unknown key: x2"),
        ({"step": {"x0": 0, "h0": 0, "x1": "1 s"}}, "step", "missing: h1"),
        ({"step": {**STEP["step"], "x0": "20 ms"}}, "step", "x0 < x1"),
        ({"step": {**STEP["step"], "h1": "9**9**9 N"}}, "step.h1", "not a product"),
        ({"sum": "5 N"}, "sum", "a list"),
        ({"sum": []}, "sum", "at least one"),
        ({"sum": ["1 N", "2 m"]}, "sum[1]", "but a force is needed"),
        ({"table": {"time": ["0 s", "0 s"], "value": ["0 N", "1 N"]}}, "table", "must increase"),
        (
            {"table": {"time": ["0 s", "1 m"], "value": ["0 N", "1 N"]}},
            "table.time[1]",
            "but a time is needed",
        ),
        (
            {"table": {"time": [0, 1], "value": [0, 1], "units": {"time": "mm", "value": "N"}}},
            "table.time",
            "time",
        ),
        ({"table": {"time": 5, "value": [0, 1]}}, "table.time", "a list"),
        ({"impact": {**IMPACT["impact"], "k": "1 kN"}}, "impact.k", "but a stiffness is needed"),
        ({"impact": {**IMPACT["impact"], "k": "-1 N/m"}}, "impact", ">= 0"),
        ({"bistop": {**IMPACT["impact"], "x2": "-1 mm"}}, "bistop", "x1 < x2"),
    ],
)
def test_mistakes_are_placed(spec, where: str, what: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_time_function(spec, "N")
    places = {problem.where: str(problem) for problem in caught.value.problems}
    assert where in places
    assert what in places[where]


@pytest.mark.parametrize(
    ("spec", "todo"),
    [
        ({"havsine": {}}, "did you mean 'havsin'?"),
        ({"pulse": {}}, "write it as {havsin: "),
        ({"step": "0 N"}, "write its keys with values: {x0: ...}"),
        ({"step": [0, 1]}, "write its keys with values: {x0: ...}"),
        ({"havsin": {"x0": 0, "h0": 0, "x1": "1 s"}}, "add it"),
        ({"havsin": {"x0": 0, "h0": 0}}, "add them"),
        ({"step": {**STEP["step"], "x2": 0}}, "remove it or correct its spelling"),
        ({"table": {"time": 5, "value": ["0 N"]}}, "write a list in brackets"),
        ({"table": {"time": {"a": 1}, "value": None}}, "write a list in brackets"),
        ({"sum": "3 N"}, "write a list in brackets"),
        ({"sum": []}, "add a function of time"),
        ({"impact": {**IMPACT["impact"], "d": "-1 mm"}}, "correct the sign"),
        ({"bistop": {**IMPACT["impact"], "x2": "-1 mm"}}, "exchange them"),
        ({"step": {**STEP["step"], "x0": "20 ms"}}, "exchange them"),
        ({"table": {"time": ["0 s"], "value": ["0 N"]}}, "give a value for each place"),
    ],
)
def test_every_mistake_says_what_to_do(spec, todo: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_time_function(spec, "N")
    assert all(problem.todo.startswith(todo) for problem in caught.value.problems)


def test_every_mistake_at_once() -> None:
    spec = {"sum": [{"step": {"x0": "1 m", "h0": "1 s", "x1": "1 N", "h1": "1 kg"}}, "5 mm", {"x": 1}]}
    with pytest.raises(InputError) as caught:
        parse_time_function(spec, "N")
    assert {problem.where for problem in caught.value.problems} == {
        "sum[0].step.x0",
        "sum[0].step.h0",
        "sum[0].step.x1",
        "sum[0].step.h1",
        "sum[1]",
        "sum[2]",
    }


def test_impact_needs_a_force() -> None:
    with pytest.raises(InputError, match="give a force or a moment") as caught:
        parse_time_function(IMPACT, "m")
    assert "use a table" in caught.value.problems[0].todo


def test_nesting_is_bounded() -> None:
    spec: object = "1 N"
    for _ in range(50):
        spec = {"sum": [spec]}
    with pytest.raises(InputError, match="nested more than") as caught:
        parse_time_function(spec, "N")
    assert caught.value.problems[0].todo == "write one sum of all its terms"
