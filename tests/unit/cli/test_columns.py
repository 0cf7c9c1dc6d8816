"""Columns in one unit, and the terminal chart."""

from __future__ import annotations

import math

import numpy as np

from crumple.cli.console.chart import HEIGHT, WIDTH, chart
from crumple.cli.console.columns import in_one_unit


def test_one_unit_for_the_column() -> None:
    assert in_one_unit([1696.0, 921.3, 0.0], "N*m") == ("kN m", ["1.696", "0.921", "0.000"])
    assert in_one_unit([0.0795, None], "s", absent="turning") == ("ms", ["79.50", "turning"])
    assert in_one_unit([12345.6, 1.0], "rad/s") == ("rad/s", ["12346", "1"])
    assert in_one_unit([], "J") == ("J", [])
    assert in_one_unit([100.0, -1e-9, -5.0], "J") == ("J", ["100.0", "0.0", "-5.0"])
    assert in_one_unit([0.0, math.nan], "J") == ("J", ["0.000", "nan"])


def test_chart_marks_curves_where_they_are() -> None:
    x = np.linspace(0.0, 1.0, 50)
    lines = chart(x, [np.ones(50), x], ("0", "1"), "top").plain.split("\n")
    assert lines[0] == "top"
    assert lines[1] == "|" + "*" * WIDTH
    assert lines[HEIGHT][1] == "o"
    # the rising line ends at the top, under the first curve
    assert lines[2].rstrip().endswith("o")
    assert lines[-1].endswith("1")


def test_chart_of_zeros() -> None:
    assert "*" * WIDTH in chart(np.array([0.0, 1.0]), [np.zeros(2)], ("0", "1"), "0").plain
