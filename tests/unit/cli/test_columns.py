"""Columns in one unit, and the terminal chart."""

from __future__ import annotations

import io
import math

import numpy as np
from rich.console import Console

from crumple.cli.console.chart import HEIGHT, WIDTH, chart
from crumple.cli.console.columns import in_one_unit
from crumple.cli.run import _table


def test_one_unit_for_the_column() -> None:
    assert in_one_unit([1696.0, 921.3, 0.0], "N*m") == ("kN m", ["1.696", "0.921", "0.000"])
    assert in_one_unit([0.0795, None], "s", absent="turning") == ("ms", ["79.50", "turning"])
    assert in_one_unit([12345.6, 1.0], "rad/s") == ("rad/s", ["12346", "1"])
    assert in_one_unit([], "J") == ("J", [])
    assert in_one_unit([100.0, -1e-9, -5.0], "J") == ("J", ["100.0", "0.0", "-5.0"])
    assert in_one_unit([0.0, math.nan], "J") == ("J", ["0.000", "nan"])


def test_names_of_hinges_are_whole_at_80_columns() -> None:
    names = ["left_shoulder-left_elb", "right_shoulder-right_elbow", "root"]
    heads = ("Largest rotation", "Final rotation", "At rest from", "Peak moment", "Energy absorbed")
    units = ("rad", "rad", "s", "N*m", "J")
    columns = tuple((head, [0.3, 0.2, 0.1], unit) for head, unit in zip(heads, units, strict=True))
    console = Console(width=80, record=True, file=io.StringIO())
    console.print(_table("Hinge", names, columns))
    text = console.export_text()
    assert max(map(len, text.splitlines())) <= 80
    assert "…" not in text
    first = [line.split("│")[1].strip() for line in text.splitlines() if line.startswith("│")]
    assert first == ["left_shoulder-left_elb", "right_shoulder-right_e", "lbow", "root"]


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
