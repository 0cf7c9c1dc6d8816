"""Order of layouts within the bands of their laws: overlapping ranges, laws that err alike, no known band."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

from crumple.report.wording.layout_order import layout_order, order_sentences, order_table
from crumple.result import Channel
from crumple.result.nearby import LawRange

NAME = "node.tip.displacement.x"


@dataclass
class _Result:
    law_range: LawRange | None
    channels: dict[str, Channel]
    hinges: ClassVar = {"h": None, "k": None}

    def __getitem__(self, name):
        return self.channels[name].values


def solved(value, low=None, high=None, *, cases=None, without=()):
    """Result of a layout whose tip moves by a value, from low to high within the bands."""
    law_range = None if low is None else LawRange({NAME: (low, high)}, {"h": 0.2}, without, (), cases or {})
    return _Result(law_range, {NAME: Channel(NAME, "m", np.array([0.0, value]))})


def alike(low, high):
    return {"all laws low": {NAME: low}, "all laws high": {NAME: high}}


def test_ranges_apart_leave_the_order_alone():
    order = layout_order({"weak": solved(0.3, 0.25, 0.35), "stiff": solved(0.1, 0.08, 0.12)}, NAME)
    assert order.nominal == ("stiff", "weak")
    assert order.open_pairs == ()
    (sentence,) = order_sentences({"a": solved(0.3, 0.25, 0.35), "b": solved(0.1, 0.08, 0.12)}, [NAME])
    assert "the same anywhere within the ranges" in sentence


def test_sizes_are_compared_whatever_the_direction():
    order = layout_order({"left": solved(-0.2, -0.25, -0.15), "right": solved(0.3, -0.1, 0.4)}, NAME)
    assert order.nominal == ("left", "right")
    assert order.ranges == {"left": (0.15, 0.25), "right": (0.0, 0.4)}
    assert order.open_pairs == (("left", "right"),)


@pytest.mark.parametrize(
    ("lows", "changed", "told"),
    [
        ((0.26, 0.23), ("all laws low",), "another one with all laws low"),
        ((0.26, 0.28), (), "the same with all laws low and with all laws high"),
    ],
)
def test_laws_that_err_alike_are_told_from_laws_that_do_not(lows, changed, told):
    """All laws low: 0.26 m beside 0.23 or 0.28 m, where the nominal laws have 0.20 and 0.21 m."""
    results = {
        "one": solved(0.20, 0.15, lows[0], cases=alike(lows[0], 0.15)),
        "two": solved(0.21, 0.16, lows[1], cases=alike(lows[1], 0.16)),
    }
    assert layout_order(results, NAME).changed == changed
    assert any(told in sentence for sentence in order_sentences(results, [NAME]))


def test_a_run_that_did_not_reach_its_end_changes_no_order():
    results = {"one": solved(0.2, 0.1, 0.3, cases={}), "two": solved(0.25, 0.1, 0.3, cases=alike(0.1, 0.3))}
    assert layout_order(results, NAME).changed == ()


def test_layouts_without_bands_are_named_as_uncertain():
    results = {"banded": solved(0.2, 0.1, 0.3, without=("k",)), "bare": solved(0.25)}
    order = layout_order(results, NAME)
    assert order.ranges["bare"] == (0.25, 0.25)
    assert order.open_pairs == (("banded", "bare"),)
    assert "(banded 1 of 2, bare 2 of 2)" in order_sentences(results, [NAME])[-1]
    assert layout_order({"bare": solved(0.25), "other": solved(0.2)}, NAME) is None
    assert order_sentences({"bare": solved(0.25), "other": solved(0.2)}, [NAME]) == []


def test_the_table_has_one_unit_a_quantity_and_names_each_layout():
    table = order_table({"weak": solved(0.3, 0.25, 0.35), "stiff": solved(0.1, 0.08, 0.12)}, [NAME])
    assert [row[:3] for row in table.rows] == [
        (f"{NAME}, mm", "1", "stiff"),
        (f"{NAME}, mm", "2", "weak"),
    ]
    values = [[float(cell) for cell in row[3:]] for row in table.rows]
    assert values == [[100.0, 80.0, 120.0], [300.0, 250.0, 350.0]]
    assert order_table({"bare": solved(0.25)}, [NAME]).rows == []
