"""Scales of figures: readable units, limits of axes, fewer points, groups of outputs."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from crumple.errors import InputError
from crumple.numeric.arrays import Floats
from crumple.result import Channel, Result
from crumple.units import format_quantity, unit_factor

MAX_POINTS = 1200
"""Most points of one line; more cannot be seen at the size of the page."""

_NOTHING = 1e-9  # of the largest component of a vector, below which a component is rounding
_DIRECTION = re.compile(r"(.+)\.([xyz])((?:\.cfc\d+)?)")
_POWERS = str.maketrans({"2": "²", "3": "³", "4": "⁴"})


@dataclass(frozen=True)
class OutputGroup:
    """Requested outputs on shared axes: name without the direction, SI unit, label and channel of each."""

    name: str
    unit: str
    channels: tuple[tuple[str, Channel], ...]


def output_groups(result: Result) -> tuple[list[OutputGroup], list[str]]:
    """Requested outputs, the directions of one vector together.

    Returns
    -------
    groups, still
        Groups in the order of the request, and the names of outputs that are zero throughout.
    """
    gathered: dict[tuple[str, str], list[tuple[str, Channel]]] = {}
    for name in result.output_names:
        channel = result.channels.get(name)
        if channel is None:
            continue
        direction = _DIRECTION.fullmatch(name)
        stem, label = (direction[1] + direction[3], direction[2]) if direction else (name, "")
        gathered.setdefault((stem, channel.unit), []).append((label, channel))
    groups, still = [], []
    for (name, unit), members in gathered.items():
        most = largest([channel.values for _, channel in members])
        moving = tuple(m for m in members if largest([m[1].values]) > _NOTHING * most)
        still += [channel.name for label, channel in members if (label, channel) not in moving]
        if moving:
            groups.append(OutputGroup(name, unit, moving))
    return groups, still


def pretty_unit(unit: str) -> str:
    """Unit as printed: a space for a product, raised powers."""
    parts = unit.replace("*", " ").split("^")
    return parts[0] + "".join(part[:1].translate(_POWERS) + part[1:] for part in parts[1:])


def thinned(x: Floats, y: Floats, limit: int = MAX_POINTS) -> tuple[Floats, Floats]:
    """At most about `limit` points of a curve that keep the lowest and highest of every stretch."""
    n = len(x)
    if n <= limit:
        return x, y
    edges = np.linspace(0, n, limit // 2 + 1).astype(int)
    filled = np.where(np.isfinite(y), y, -np.inf)
    keep = {0, n - 1}
    for a, b in pairwise(edges.tolist()):
        keep.add(a + int(np.argmax(filled[a:b])))
        keep.add(a + int(np.argmin(np.where(np.isfinite(y[a:b]), y[a:b], np.inf))))
    chosen = np.array(sorted(keep))
    return x[chosen], y[chosen]


def spread(values: Sequence[Floats], *, zero: bool = True, margin: float = 0.05) -> tuple[float, float]:
    """Limits of an axis that shows all finite values, with zero if requested; never an empty range."""
    finite = [v[np.isfinite(v)] for v in values]
    parts = [v for v in finite if v.size]
    low = min((float(v.min()) for v in parts), default=0.0)
    high = max((float(v.max()) for v in parts), default=0.0)
    if zero:
        low, high = min(low, 0.0), max(high, 0.0)
    size = high - low
    if size <= 1e-12 * max(abs(low), abs(high), 1e-300):
        return low - 1.0, high + 1.0
    return low - margin * size if low < 0 or not zero else low, high + margin * size


def display_unit(unit: str, largest: float) -> tuple[str, float]:
    """Readable unit of a quantity of this size, and its value in SI; an unknown unit is kept."""
    try:
        name = format_quantity(abs(largest) if np.isfinite(largest) else 0.0, unit).partition(" ")[2]
        return (pretty_unit(name), unit_factor(name, unit)) if name else ("", 1.0)
    except InputError:
        return pretty_unit(unit), 1.0


def time_unit(end: float) -> tuple[str, float]:
    """Unit of a time axis that ends there [s], and its value in SI: ms for a crash."""
    return next((unit for unit in (("µs", 1e-6), ("ms", 1e-3)) if end <= 2e3 * unit[1]), ("s", 1.0))


def largest(values: Sequence[Floats]) -> float:
    """Largest finite magnitude among several arrays; 0 without any."""
    return max((float(np.abs(v[np.isfinite(v)]).max()) for v in values if np.isfinite(v).any()), default=0.0)
