"""Range of a result from the bands of its hinge laws, as a table."""

from __future__ import annotations

import math

from crumple.report.drawing.scales import display_unit
from crumple.report.wording.wording import Table
from crumple.result import Result

SAME = 1e-6
"""Relative width below which a range is not listed: the laws do not change the quantity."""
_UNITS = {"rotation_max": "rad", "energy": "J"}


def range_rows(result: Result) -> list[tuple[str, str, str, str, str]]:
    """Quantity, unit, nominal, least and largest value; rotations first, then energies and displacements."""
    found = result.law_range
    if found is None:
        return []
    rows = []
    for name, (low, high) in sorted(found.ranges.items(), key=lambda item: _order(item[0])):
        head, _, rest = name.partition(".")
        hinge, _, key = rest.rpartition(".")
        if head == "hinge":
            value, si = float(getattr(result.hinges[hinge], key)), _UNITS[key]
        else:
            value, si = float(result[name][-1]), "J" if head == "energy" else "m"
        if high - low <= SAME * max(abs(low), abs(high)):
            continue
        angle = ("deg", math.radians(1.0))
        unit, factor = angle if si == "rad" else display_unit(si, max(abs(low), abs(high)))
        nominal, least, most = (f"{one / factor:.4g}" for one in (value, low, high))
        rows.append((name, unit, nominal, least, most))
    return rows


def range_table(result: Result) -> Table:
    """Rows of `range_rows` for the page."""
    heads = ("Quantity", "Unit", "Nominal laws", "Least", "Largest")
    caption = (
        "Range from the bands of the hinge laws: all laws low, all high, and alternating. "
        "It is a range, not a bound."
    )
    return Table(caption, heads, range_rows(result), frozenset({1}))


def _order(name: str) -> tuple[int, str]:
    keys = ("rotation_max", "energy", "dissipated")
    return next((i for i, key in enumerate(keys) if name.endswith(f".{key}")), len(keys)), name
