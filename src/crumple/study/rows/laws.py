"""Between which rows of a study hinges have automatic laws of other types."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from crumple.analysis import Analysis
from crumple.analysis.law_changes import as_solved, law_changes, law_types_at
from crumple.study.rows.layouts import layout_place
from crumple.study.space import Axis, Point
from crumple.units import parse_quantity, plain_number

LOOKED_AT = 400
"""Different structures of one base whose laws are looked at, each in a millisecond or so; of more they are
spread evenly."""


def changed_laws(
    axes: Sequence[Axis], points: Sequence[Point], bases: Mapping[str, Analysis]
) -> list[dict[str, Any]]:
    """Where laws change between rows of the same base.

    Parameters
    ----------
    axes
        Variables.
    points
        Of all rows.
    bases
        Inputs by the name that the variable which chooses among several has; one, of any name, without it.

    Returns
    -------
    list
        ``hinges``; ``laws``, their types on both sides; ``rows``, the two closest rows that have them;
        ``counts``, of rows that have them; and ``text``, all this as a sentence.
    """
    place, found = layout_place(axes), []
    for name, base in bases.items():
        rows = [i for i, point in enumerate(points) if place is None or point[place] == name]
        found += _of_base(axes, points, rows, base)
    return found


def _of_base(
    axes: Sequence[Axis], points: Sequence[Point], rows: Sequence[int], base: Analysis
) -> list[dict[str, Any]]:
    from crumple.multibody.variants.factors import quick  # noqa: PLC0415  (needs the kernels)

    # masses and factors leave laws as they are, and the name of the base is no path
    slow = [k for k, axis in enumerate(axes) if not all(quick(one) or "." not in one for one in axis.places)]
    own = {i: tuple(points[i][k] for k in slow) for i in rows}
    alike = Counter(own.values())
    first = sorted({values: i for i, values in reversed(own.items())}.values())
    if len(first) < 2:
        return []
    looked = sorted({first[i] for i in np.linspace(0, len(first) - 1, LOOKED_AT).round().astype(int)})
    structure, types = as_solved(base), {}
    for i in looked:
        values = {place: points[i][k] for k in slow for place in axes[k].places if not quick(place)}
        laws = law_types_at(structure, values)
        if laws is not None:
            types[i] = laws
    spread = _spread([own[i] for i in types])
    places = dict(zip(types, spread, strict=True))
    part = f" ({len(looked)} of {len(first)} different structures were looked at)"
    found = []
    for change in law_changes(types, places, {i: alike[own[i]] for i in types}):
        told = [", ".join(_told(axes[k], points[i][k]) for k in slow) for i in change.variants]
        text = change.sentence("row", (told[0], told[1])) + (part if len(looked) < len(first) else "")
        found.append(
            {
                "hinges": list(change.hinges),
                "laws": list(change.laws),
                "rows": list(change.variants),
                "counts": list(change.counts),
                "text": text,
            }
        )
    return found


def _spread(values: Sequence[tuple[float | str, ...]]) -> list[list[float]]:
    """Values over their range; those that are words count as one apart."""
    columns: list[list[float]] = []
    for column in zip(*values, strict=True):
        if isinstance(column[0], str):
            columns += [[0.5 * (one == word) for one in column] for word in dict.fromkeys(column)]
            continue
        low, high = min(column), max(column)
        columns.append([(one - low) / (high - low or 1.0) for one in column])
    return [list(row) for row in zip(*columns, strict=True)]


def _told(axis: Axis, value: float | str) -> str:
    """A value with its variable, in the unit of the input."""
    if isinstance(value, str) or axis.unit in {"", "1"}:
        return f"{axis.name} {value if isinstance(value, str) else plain_number(value, 6)}"
    return f"{axis.name} {plain_number(value / parse_quantity(f'1 {axis.unit}', axis.unit), 6)} {axis.unit}"
