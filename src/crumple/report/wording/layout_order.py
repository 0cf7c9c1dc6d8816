"""Order of layouts by one quantity, and whether it changes within the bands of their hinge laws.

Two layouts are in order within the bands if their ranges of the quantity do not overlap.  The laws of all
layouts may err alike, which moves all of them together: the order is then that of one run of each, with all
laws low or all high.  Sizes are compared, so a displacement to the left counts like one to the right.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

from crumple.numeric.ranking import EQUAL, largest_first
from crumple.report.wording.wording import Table, column
from crumple.result import Result

COMMON = ("all laws low", "all laws high")
"""Runs in which the laws of all layouts err alike, by their names in `crumple.multibody.law_range`."""
MOST_PAIRS = 4
"""Pairs of layouts that are named; the table of ranges shows all."""


@dataclass(frozen=True)
class LayoutOrder:
    """Order of layouts by the size of one quantity at the end of the run.

    Attributes
    ----------
    nominal
        Names, the smallest value first.
    values, ranges
        Value with the nominal laws, and least and largest one, by layout, in SI.
    open_pairs
        Pairs of layouts whose ranges overlap, in the nominal order.
    changed
        Names of the common runs in which the order is another one.
    """

    nominal: tuple[str, ...]
    values: Mapping[str, float]
    ranges: Mapping[str, tuple[float, float]]
    open_pairs: tuple[tuple[str, str], ...]
    changed: tuple[str, ...]


def layout_order(results: Mapping[str, Result], quantity: str) -> LayoutOrder | None:
    """Order of layouts by a quantity.

    Parameters
    ----------
    results
        By name of the layout; those without a band of a law have a range of no width.
    quantity
        Name of a channel.

    Returns
    -------
    LayoutOrder or None
        None for fewer than two layouts, or if no layout has a range of the quantity.
    """
    values = {name: abs(float(result[quantity][-1])) for name, result in results.items()}
    known = {name: _known(result, quantity) for name, result in results.items()}
    if len(values) < 2 or not any(known.values()):
        return None
    ranges = {name: _sizes(*(known[name] or (value, value))) for name, value in values.items()}
    nominal = _ascending(values)
    pairs = tuple(
        (a, b)
        for a, b in combinations(nominal, 2)
        if max(ranges[a][0], ranges[b][0]) <= min(ranges[a][1], ranges[b][1])
    )
    changed = tuple(case for case in COMMON if _swaps(values, _common(results, quantity, case, values)))
    return LayoutOrder(nominal, values, ranges, pairs, changed)


def order_table(results: Mapping[str, Result], quantities: Sequence[str]) -> Table:
    """One row per quantity and layout with a range, the smallest value first."""
    rows = []
    for name in quantities:
        order = layout_order(results, name)
        if order is None:
            continue
        flat = [value for one in order.nominal for value in (order.values[one], *order.ranges[one])]
        unit, cells = column(flat, next(iter(results.values())).channels[name].unit)
        for i, one in enumerate(order.nominal):
            rows.append((f"{name}, {unit}" if unit else name, str(i + 1), one, *cells[3 * i : 3 * i + 3]))
    heads = ("At the end", "Place", "Layout", "Nominal laws", "Least", "Largest")
    caption = (
        "Order of the layouts by size, smallest first, and the range of each from the bands of its hinge "
        "laws (a range, not a bound)."
    )
    return Table(caption, heads, rows, frozenset({2}))


def order_sentences(results: Mapping[str, Result], quantities: Sequence[str]) -> list[str]:
    """Whether the order by each quantity changes within the bands of the laws."""
    found = []
    for name in quantities:
        order = layout_order(results, name)
        if order is None:
            continue
        if not order.open_pairs:
            found.append(f"{name}: the order of the layouts is the same anywhere within the ranges.")
            continue
        shown = ", ".join(f"{a} and {b}" for a, b in order.open_pairs[:MOST_PAIRS])
        more = len(order.open_pairs) - MOST_PAIRS
        told = f"{name}: ranges overlap, so the order is open, for {shown}"
        told += f" and {more} more pairs. " if more > 0 else ". "
        cases = " and with ".join(order.changed)
        alike = f"another one with {cases}" if cases else "the same with all laws low and with all laws high"
        found.append(f"{told}If the laws of all layouts err alike, it is {alike}.")
    if found and (lacking := _without(results)):
        found.append(
            f"Hinges without a known band keep their law in these runs ({lacking}): the order is less "
            "certain than stated."
        )
    return found


def _without(results: Mapping[str, Result]) -> str:
    """Number of hinges without a known band, by layout."""
    counts = {
        name: len(result.hinges) if result.law_range is None else len(result.law_range.without)
        for name, result in results.items()
    }
    told = (f"{name} {count} of {len(results[name].hinges)}" for name, count in counts.items() if count)
    return ", ".join(told)


def _known(result: Result, quantity: str) -> tuple[float, float] | None:
    return None if result.law_range is None else result.law_range.of(quantity)


def _sizes(low: float, high: float) -> tuple[float, float]:
    """Least and largest size of values between two."""
    least = 0.0 if low <= 0.0 <= high else min(abs(low), abs(high))
    return least, max(abs(low), abs(high))


def _ascending(values: Mapping[str, float]) -> tuple[str, ...]:
    return tuple(largest_first({name: -value for name, value in values.items()}))


def _common(
    results: Mapping[str, Result], quantity: str, case: str, nominal: Mapping[str, float]
) -> dict[str, float]:
    """Sizes of a quantity in one run of each layout; NaN where the run did not reach its end."""
    found = {}
    for name, result in results.items():
        if _known(result, quantity) is None or result.law_range is None:
            found[name] = nominal[name]
        else:
            found[name] = abs(result.law_range.cases.get(case, {}).get(quantity, math.nan))
    return found


def _swaps(first: Mapping[str, float], second: Mapping[str, float]) -> bool:
    """Whether two layouts that differ are in another order; equal ones have none."""
    for a, b in combinations(first, 2):
        one, two = first[b] - first[a], second[b] - second[a]
        least = EQUAL * max(first[a], first[b])
        if abs(one) > least and abs(two) > least and one * two < 0.0:
            return True
    return False
