"""Functions of time: values, derivatives, sampling within a tolerance, tables, refusals."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from crumple.errors import InputError
from crumple.function import Constant, Stop, Sum, Table, TimeFunction, Transition, table, table_slope

RAMP = Transition("step5", 0.01, 2.0, 0.03, -5.0)
TABLE = Table((0.0, 0.01, 0.04), (0.0, 4.0, 1.0))
BOUNCE = Stop(Transition("havsin", 0.0, 0.02, 0.05, -0.01), 0.0, None, 1e5, 1.5, 200.0, 1e-3)
FUNCTIONS: list[TimeFunction] = [
    Constant(3.0),
    Transition("step", 0.0, 0.0, 0.05, 10.0),
    RAMP,
    Transition("havsin", -0.01, 1.0, 0.02, 4.0),
    TABLE,
    Sum((RAMP, TABLE, Constant(-1.0))),
    Sum((RAMP, RAMP, RAMP)),
    BOUNCE,
    Stop(Transition("step", 0.0, -0.02, 0.05, 0.03), -0.01, 0.02, 1e5, 1.0, 50.0, 1e-3),
]


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda f: type(f).__name__)
@pytest.mark.parametrize("tolerance", [1.0, 1e-2, 1e-4])
def test_sampled_keeps_its_tolerance(function: TimeFunction, tolerance: float) -> None:
    times, values = function.sampled(-0.005, 0.06, tolerance)
    assert times[0] == -0.005
    assert times[-1] == 0.06
    assert np.all(np.diff(times) > 0.0)
    fine = np.linspace(-0.005, 0.06, 20_001)
    assert np.abs(np.interp(fine, times, values) - function(fine)).max() <= tolerance * (1.0 + 1e-9)


@given(
    kind=st.sampled_from(Transition.KINDS),
    height=st.floats(-1e4, 1e4),
    tolerance=st.floats(1e-3, 1e3),
    start=st.floats(-1.0, 0.9),
)
@settings(max_examples=50)
def test_sampled_passages_any_range(kind: str, height: float, tolerance: float, start: float) -> None:
    function = Transition(kind, 0.0, 0.0, 1.0, height)
    times, values = function.sampled(start, 1.5, tolerance)
    fine = np.linspace(start, 1.5, 3001)
    assert np.abs(np.interp(fine, times, values) - function(fine)).max() <= tolerance + 1e-12 * abs(height)


def test_sampling_is_sparse() -> None:
    times, _ = Transition("step", 0.0, 0.0, 1.0, 1.0).sampled(-1.0, 2.0, 1e-4)
    # sqrt(6/(8 1e-4)) = 86.6 pieces
    assert times.size == 87 + 1 + 2


@pytest.mark.parametrize("function", FUNCTIONS[:7], ids=lambda f: type(f).__name__)
def test_derivative_is_the_finite_difference(function: TimeFunction) -> None:
    times, small = np.linspace(-0.0049, 0.0583, 37), 1e-7
    difference = (function(times + small) - function(times - small)) / (2 * small)
    assert np.allclose(function.derivative(times), difference, rtol=1e-4, atol=1e-3)


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda f: type(f).__name__)
def test_frozen_picklable_and_shaped(function: TimeFunction) -> None:
    copy = pickle.loads(pickle.dumps(function))
    assert copy == function
    assert hash(copy) == hash(function)
    for shape in ((), (3,), (2, 3)):
        assert np.shape(function(np.full(shape, 0.02))) == shape
        assert np.shape(function.derivative(np.full(shape, 0.02))) == shape


def test_table_holds_its_ends_and_takes_the_slope_to_the_right() -> None:
    xs, ys = [0.0, 1.0, 3.0], [1.0, 3.0, -1.0]
    assert np.array_equal(table([-5.0, 0.5, 1.0, 2.0, 9.0], xs, ys), [1.0, 2.0, 3.0, 1.0, -1.0])
    assert np.array_equal(
        table_slope([-5.0, 0.0, 0.5, 1.0, 2.0, 3.0], xs, ys), [0.0, 2.0, 2.0, -2.0, -2.0, 0.0]
    )


def test_stop_of_a_motion_is_impact_of_place_and_speed() -> None:
    assert BOUNCE(0.0) == 0.0
    # the motion rests at -10 mm: the spring alone pushes
    assert BOUNCE(0.06) == pytest.approx(1e5 * 0.01**1.5, rel=1e-12)
    assert BOUNCE(0.04) > 1e5 * float(-BOUNCE.motion(0.04)) ** 1.5


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Transition("ramp", 0.0, 0.0, 1.0, 1.0), "not one of step, step5, havsin"),
        (lambda: Transition("step", 1.0, 0.0, 1.0, 1.0), "x0 < x1"),
        (lambda: Table((0.0,), (1.0,)), "at least 2"),
        (lambda: Table((0.0, 1.0), (1.0,)), "one length"),
        (lambda: Table((0.0, 2.0, 2.0), (1.0, 1.0, 1.0)), "2 .SI. after 2, at place 3"),
        (lambda: Table((0.0, 1.0), (1.0, float("nan"))), "finite"),
        (lambda: Sum(()), "at least one"),
        (lambda: Stop(Constant(0.0), 0.0, None, -1.0, 1.0, 0.0, 0.0), ">= 0"),
        (lambda: RAMP.sampled(1.0, 1.0, 1e-3), "start < end"),
        (lambda: RAMP.sampled(0.0, 1.0, 0.0), "tolerance"),
        (lambda: RAMP.sampled(0.0, 1.0, 1e-16), "more than"),
    ],
)
def test_refusals(make, message: str) -> None:
    with pytest.raises(InputError, match=message):
        make()


@pytest.mark.parametrize(
    "make",
    [
        lambda: Table((0.0, 1.0), (0.0, 1.0, 2.0)),
        lambda: Table((0.0, 0.0), (0.0, 1.0)),
        lambda: Transition("step", 0.005, 0.0, 0.001, 1.0),
    ],
)
def test_refusals_say_what_to_do_in_words(make):
    with pytest.raises(InputError) as refused:
        make()
    (problem,) = refused.value.problems
    assert all((problem.came, problem.allowed, problem.todo))
    assert "shape" not in str(problem)
