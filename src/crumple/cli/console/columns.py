"""Columns of a table: one unit, named in the head, that of the largest value."""

from __future__ import annotations

import math
from collections.abc import Sequence

from crumple.units import format_quantity, unit_factor


def in_one_unit(
    values: Sequence[float | None], unit: str, digits: int = 4, absent: str = ""
) -> tuple[str, list[str]]:
    """Name of the readable unit of these values, and the values in it.

    Parameters
    ----------
    values
        In SI; None for a missing value.
    unit
        SI unit.
    digits
        Significant digits of the largest value; all values get the same decimals.
    absent
        Text in place of None.

    Returns
    -------
    tuple
        Unit and texts; what is rounded to zero has no sign.
    """
    largest = max((abs(v) for v in values if v is not None and math.isfinite(v)), default=0.0)
    name = format_quantity(largest, unit, digits).partition(" ")[2]
    factor = unit_factor(name, unit)
    whole = math.floor(math.log10(largest / factor)) + 1 if largest > 0.0 else 1
    decimals = max(0, digits - max(whole, 1))
    return name, [absent if v is None else f"{v / factor:z.{decimals}f}" for v in values]
