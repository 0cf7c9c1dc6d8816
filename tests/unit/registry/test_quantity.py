"""Quantities: SI floats inside, units at the door, bounds with a reason."""

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from crumple.registry import quantity

FILE = {"file": True}


def accepted(kind, value, **how):
    return TypeAdapter(kind).validate_python(value, **how)


def test_texts_are_converted_and_numbers_are_si():
    assert accepted(quantity.Length, "50 mm") == 0.05
    assert accepted(quantity.Length, 50) == 50.0
    assert accepted(quantity.Stress, "488 N/mm^2") == 488e6


def test_a_file_needs_units_except_for_zero_and_plain_numbers():
    assert accepted(quantity.Length, 0, context=FILE) == 0.0
    assert accepted(quantity.Length, quantity.Converted(0.3), context=FILE) == 0.3
    assert accepted(quantity.Number, 0.3, context=FILE) == 0.3
    with pytest.raises(ValidationError, match="the unit is missing"):
        accepted(quantity.Length, 50, context=FILE)


@pytest.mark.parametrize(
    "value",
    [float("nan"), float("inf"), 10**400, "1e999 m", 1e30, 1e-30, True, None, [], {}, "50", "50 kg", "m"],
)
def test_what_is_no_length_is_refused(value):
    with pytest.raises(ValidationError) as refusal:
        accepted(quantity.Length, value)
    assert refusal.value.errors()[0]["ctx"]["allowed"]


def test_bounds_are_kept_and_named():
    assert accepted(quantity.NonNegativeLength, 0) == 0.0
    for kind, value in ((quantity.PositiveLength, 0), (quantity.NonNegativeLength, "-1 mm")):
        with pytest.raises(ValidationError, match=r"out of range: it must be (more than|at least) 0"):
            accepted(kind, value)
    with pytest.raises(ValidationError, match=r"at least 0 and less than 0\.5"):
        accepted(quantity.PoissonsRatio, 0.5)


def test_words_stand_in_for_numbers_only_where_allowed():
    assert accepted(quantity.DampingOrCritical, "critical") == "critical"
    assert accepted(quantity.DampingOrCritical, "2 N*m*s/rad") == 2.0
    with pytest.raises(ValidationError):
        accepted(quantity.PositiveMoment, "critical")


def test_plain_numbers_are_not_texts():
    with pytest.raises(ValidationError, match="not a text"):
        accepted(quantity.Number, "0.3")


@pytest.mark.parametrize("kind", [np.int32, np.int64, np.float32, np.float64])
def test_numbers_of_numpy_are_numbers(kind):
    value = accepted(quantity.Length, kind(2))
    assert (type(value), value) == (float, 2.0)
    with pytest.raises(ValidationError, match="the unit is missing"):
        accepted(quantity.Length, kind(2), context=FILE)
    with pytest.raises(ValidationError):
        accepted(quantity.Length, np.bool_(True))


@pytest.mark.parametrize("value", ["1.1 km/s", "-1.1 km/s", 1e6])
def test_velocities_beyond_every_crash_are_refused(value):
    with pytest.raises(ValidationError) as refusal:
        accepted(quantity.Velocity, value)
    assert "1000 m/s" in refusal.value.errors()[0]["ctx"]["allowed"]
    assert accepted(quantity.Velocity, "-1 km/s") == -1000.0
