"""Range of a result from the bands of its hinge laws, as a table; also beside the values of shells."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from crumple.report.drawing.scales import display_unit
from crumple.report.wording.wording import Table
from crumple.result import Result
from crumple.units import plain_number

if TYPE_CHECKING:
    from crumple.comparison import Comparison

LEAST = 1e-3
"""Width of a range over the widest of its kind below which it is not listed, and a value is shown as 0."""
ROUNDING = 1e-6
"""Width of a range over the largest value of its kind that is rounding."""
_UNITS = {"rotation_max": "rad", "energy": "J"}


@dataclass(frozen=True)
class _Range:
    """One range in SI: quantity, unit, value with the nominal laws, least and largest value, what is 0."""

    name: str
    unit: str
    nominal: float
    low: float
    high: float
    nothing: float

    @property
    def display(self) -> tuple[str, float]:
        """Unit in which it is shown, and its size in SI."""
        if self.unit == "rad":
            return "deg", math.radians(1.0)
        return display_unit(self.unit, max(abs(self.low), abs(self.high)))

    def shown(self, value: float) -> str:
        """A value in the unit of display."""
        return plain_number(value / self.display[1] if abs(value) > self.nothing else 0.0)

    @property
    def row(self) -> tuple[str, str, str, str, str]:
        """Its cells."""
        return (self.name, self.display[0], *map(self.shown, (self.nominal, self.low, self.high)))  # type: ignore[return-value]


def range_rows(result: Result) -> list[tuple[str, str, str, str, str]]:
    """Quantity, unit, nominal, least and largest value; by kind, the widest first."""
    return [one.row for one in _ranges(result)]


def _ranges(result: Result) -> Iterator[_Range]:
    """Ranges that are more than rounding; by kind, the widest first."""
    found = result.law_range
    if found is None:
        return
    kinds: dict[str, list[tuple[str, float, float]]] = {"rad": [], "J": [], "m": []}
    for name, (low, high) in found.ranges.items():
        kinds[_unit(name)].append((name, low, high))
    for si, ranges in kinds.items():
        ranges.sort(key=lambda one: (one[1] - one[2], one[0]))
        largest = max((max(abs(low), abs(high)) for _, low, high in ranges), default=0.0)
        for name, low, high in ranges:
            least = LEAST * (ranges[0][2] - ranges[0][1])
            if high - low > max(least, ROUNDING * largest):
                yield _Range(name, si, _nominal(result, name), low, high, least)


def range_table(result: Result) -> Table:
    """Rows of `range_rows` for the page."""
    heads = ("Quantity", "Unit", "Nominal laws", "Least", "Largest")
    caption = (
        "Range from the bands of the hinge laws: all laws low, all high, and alternating. "
        "It is a range, not a bound."
    )
    return Table(caption, heads, range_rows(result), frozenset({1}))


def shell_range_table(comparison: Comparison) -> Table:
    """The candidate's ranges beside the values of the reference, and whether these are inside."""
    rows = []
    for one in _ranges(comparison.candidate.result):
        value = comparison.in_ranges.get(one.name)
        cells = ("—", "—") if value is None else (one.shown(value), _side(one, value))
        rows.append((*one.row, *cells))
    first, second = comparison.candidate.name, comparison.reference.name
    told = shell_range_sentence(comparison)
    caption = f"Range of the {first} result from the bands of its hinge laws. {told}"
    heads = ("Quantity", "Unit", "Nominal laws", "Least", "Largest", second.capitalize(), "Inside")
    return Table(caption, heads, rows, frozenset({1, 6}))


def shell_range_sentence(comparison: Comparison) -> str:
    """For how many quantities the reference is within the candidate's range; empty without ranges."""
    ranges = list(_ranges(comparison.candidate.result))
    if not ranges:
        return ""
    values = [(one, comparison.in_ranges[one.name]) for one in ranges if one.name in comparison.in_ranges]
    inside = sum(_side(one, value) == "yes" for one, value in values)
    second = comparison.reference.name
    told = f"The {second} value is inside for {inside} of {len(values)} quantities."
    result = comparison.candidate.result
    if result.law_range is not None and result.law_range.without:
        lacking = len(result.law_range.without)
        told += f" {lacking} of {len(result.hinges)} hinges have no known band and keep their law."
    unknown = len(ranges) - len(values)
    if unknown:
        told += f" For {unknown} more the {second} run has no value of the same definition."
    return f"{told} The range contains the error of the laws alone; it is not a bound."


def _side(one: _Range, value: float) -> str:
    """Whether a value is inside; else on which side, and by how much of the nominal value."""
    if one.low <= value <= one.high:
        return "yes"
    by = value - one.high if value > one.high else one.low - value
    side = "above" if value > one.high else "below"
    share = f" by {100 * by / abs(one.nominal):.0f} %" if abs(one.nominal) > one.nothing else ""
    return f"{side}{share}"


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
