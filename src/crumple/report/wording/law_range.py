"""Range of a result from the bands of its hinge laws, as a table."""

from __future__ import annotations

import math

from crumple.report.drawing.scales import display_unit
from crumple.report.wording.wording import Table
from crumple.result import Result

LEAST = 1e-3
"""Width of a range over the widest of its kind below which it is not listed, and a value is shown as 0."""
ROUNDING = 1e-6
"""Relative width of a range that is rounding."""
_UNITS = {"rotation_max": "rad", "energy": "J"}


def range_rows(result: Result) -> list[tuple[str, str, str, str, str]]:
    """Quantity, unit, nominal, least and largest value; by kind, the widest first."""
    found = result.law_range
    if found is None:
        return []
    kinds: dict[str, list[tuple[str, float, float]]] = {"rad": [], "J": [], "m": []}
    for name, (low, high) in found.ranges.items():
        kinds[_unit(name)].append((name, low, high))
    rows = []
    for si, ranges in kinds.items():
        ranges.sort(key=lambda one: (one[1] - one[2], one[0]))
        for name, low, high in ranges:
            least = LEAST * (ranges[0][2] - ranges[0][1])
            if high - low <= max(least, ROUNDING * max(abs(low), abs(high))):
                continue
            angle = ("deg", math.radians(1.0))
            unit, factor = angle if si == "rad" else display_unit(si, max(abs(low), abs(high)))
            values = (_nominal(result, name), low, high)
            nominal, lowest, highest = (f"{one / factor if abs(one) > least else 0.0:.4g}" for one in values)
            rows.append((name, unit, nominal, lowest, highest))
    return rows


def range_table(result: Result) -> Table:
    """Rows of `range_rows` for the page."""
    heads = ("Quantity", "Unit", "Nominal laws", "Least", "Largest")
    caption = (
        "Range from the bands of the hinge laws: all laws low, all high, and alternating. "
        "It is a range, not a bound."
    )
    return Table(caption, heads, range_rows(result), frozenset({1}))


def _unit(name: str) -> str:
    """SI unit of a quantity with a range."""
    if name.startswith("hinge."):
        return _UNITS[name.rpartition(".")[2]]
    return "J" if name.startswith("energy.") else "m"


def _nominal(result: Result, name: str) -> float:
    """Value of a quantity with the nominal laws."""
    head, _, rest = name.partition(".")
    hinge, _, key = rest.rpartition(".")
    return float(getattr(result.hinges[hinge], key) if head == "hinge" else result[name][-1])
