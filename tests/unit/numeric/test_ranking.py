from __future__ import annotations

import math

import pytest

from crumple.numeric.ranking import largest_first


@pytest.mark.parametrize("rounding", [1e-15, -1e-15, 5e-5, -5e-5])
def test_equal_values_keep_their_order(rounding):
    assert largest_first({"left": 1.0, "right": 1.0 + rounding, "middle": 2.0}) == ["middle", "left", "right"]


def test_other_values_come_in_descending_order():
    assert largest_first({"a": 1.0, "b": 1.001, "c": -3.0, "d": -2.0, "e": 0.0}) == ["b", "a", "e", "d", "c"]


def test_unknown_values_come_last():
    assert largest_first({"a": math.nan, "b": -math.inf, "c": math.inf}) == ["c", "b", "a"]


def test_nothing_to_rank():
    assert largest_first({}) == []
