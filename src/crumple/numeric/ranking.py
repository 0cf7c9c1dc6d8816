"""Order by size that rounding does not change."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping
from typing import TypeVar

Name = TypeVar("Name", bound=Hashable)

EQUAL = 1e-4
"""Values within this part of a larger one count as equal to it: the two rails of a symmetric front differ by
rounding, on each processor in another way."""


def largest_first(values: Mapping[Name, float]) -> list[Name]:
    """Names in descending order of their values; equal ones in the order in which they came, NaN last."""
    order = {name: i for i, name in enumerate(values)}
    known = [name for name in values if not math.isnan(values[name])]
    ranked: list[Name] = []
    group: list[Name] = []
    for name in sorted(known, key=lambda name: -values[name]):
        if group and not math.isclose(values[group[0]], values[name], rel_tol=EQUAL):
            ranked += sorted(group, key=order.__getitem__)
            group = []
        group.append(name)
    ranked += sorted(group, key=order.__getitem__)
    return ranked + [name for name in values if math.isnan(values[name])]
