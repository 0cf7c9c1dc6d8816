"""Records of the multibody kernels compared column by column."""

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np


def columns(record: Any, within: str = "") -> Iterator[tuple[str, Any]]:
    """Every column of a record and of the records in it, with its dotted name."""
    for field in fields(record):
        value = getattr(record, field.name)
        if is_dataclass(value):
            yield from columns(value, f"{within}{field.name}.")
        elif not isinstance(value, dict):
            yield f"{within}{field.name}", value


def same(a: Any, b: Any) -> bool:
    """Whether two records have the same bits; NaN equals NaN."""
    return all(_same(x, y) for (_, x), (_, y) in zip(columns(a), columns(b), strict=True))


def _same(x: Any, y: Any) -> bool:
    if isinstance(x, str):
        return x == y
    return np.array_equal(x, y, equal_nan=True)
