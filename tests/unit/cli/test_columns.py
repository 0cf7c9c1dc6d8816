"""Columns in one unit, tables of outputs, and the terminal chart."""

from __future__ import annotations

import io
import math
from dataclasses import replace

import numpy as np
import pytest
from rich.console import Console

import crumple
from crumple.cli.console.chart import HEIGHT, WIDTH, chart
from crumple.cli.console.columns import in_one_unit
from crumple.cli.tables import _table, most_yielding, output_tables

FALLING = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections:
  tube: {type: square_tube, side: 40 mm, thickness: 2 mm}
nodes: {foot: [0 m, 0 m, 0 m], tip: [0.6 m, 0 m, 0 m]}
members: {arm: {nodes: [foot, tip], section: tube, material: steel}}
hinges: auto
supports: {clamp: {node: foot, fix: all}}
obstacles:
  ball: {type: sphere, point: [0.55 m, 0 m, 0.051 m], radius: 30 mm, mass: 20 kg,
         velocity: [0 m/s, 0 m/s, -5 m/s]}
analysis: {duration: 30 ms, multibody: {mechanism_check: off, members: elastic}}
outputs:
  every: 0.5 ms
  nodes: [tip]
  distances: {reach: {from: foot, to: tip}}
"""


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


def printed(tables) -> list[list[str]]:
    console = Console(width=100, record=True, file=io.StringIO())
    for table in tables:
        console.print(table)
    rows = (line.split("│") for line in console.export_text().splitlines() if line.startswith("│"))
    return [[cell.strip() for cell in row[1:-1]] for row in rows]


def test_outputs_that_were_asked_for_and_forces_have_tables() -> None:
    result = crumple.solve(crumple.loads(FALLING))
    (node, reach, ball) = printed(output_tables(result, ()))
    moved = np.linalg.norm([result[f"node.tip.displacement.{axis}"] for axis in "xyz"], axis=0)
    at = int(np.argmax(moved))
    assert 0.01 < moved[-1] <= moved[at]
    assert node == [
        "node tip",
        f"{1e3 * moved[at]:.2f}",
        f"{1e3 * result.time[at]:.2f}",
        f"{1e3 * moved[-1]:.2f}",
    ]
    # a distance keeps its sign: the ends approach
    assert reach[0] == "change of reach"
    assert float(reach[1]) == pytest.approx(1e3 * result["reach"].min(), abs=0.01)
    pushed = np.linalg.norm([result[f"obstacle.ball.force.{axis}"] for axis in "xyz"], axis=0)
    assert ball[0] == "ball"
    assert float(ball[1]) == pytest.approx(1e-3 * pushed.max(), rel=1e-3)


def test_of_a_clearance_the_smallest_value_is_its_extreme() -> None:
    result = crumple.solve(crumple.loads(FALLING))
    (_, room, _) = printed(output_tables(result, {"reach"}))
    assert room[0] == "clearance reach"
    assert float(room[1]) == pytest.approx(1e3 * result["reach"].min(), abs=0.01)
    grown = replace(
        result,
        channels={**result.channels, "reach": replace(result.channels["reach"], values=-result["reach"])},
    )
    assert float(printed(output_tables(grown, {"reach"}))[1][1]) == 0.0


def test_members_that_yield_most_between_hinges_are_named() -> None:
    result = crumple.solve(crumple.loads(FALLING))
    assert most_yielding(replace(result, yielded={})) == ""
    yielded = {"a": ((0.1, 2.0), (0.2, 3.0)), "b": ((0.1, 40.0),), "c": ((0.3, 0.5),), "d": ((0.3, 1.0),)}
    assert most_yielding(replace(result, yielded=yielded)) == " (most: b 40 J, a 5 J, d 1 J)"
    assert most_yielding(replace(result, yielded={"c": ((0.3, 0.5),)})) == " (c 0.5 J)"


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
