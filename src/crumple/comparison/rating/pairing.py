"""Selection of the histories of two sources that are compared, and their ratings."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from crumple.comparison.rating.rating import Rating, rating
from crumple.comparison.rating.signal import Signal, at
from crumple.errors import InputError
from crumple.numeric.arrays import Floats

MOST = 60
"""Most histories rated against one reference; a rating takes about 50 ms for 100 ms of history."""
NOTHING = 1e-6
"""Share of the largest history of its unit below which a reference counts as rounding."""

_ORDER = (
    re.compile(r"hinge\..+\.rotation"),
    re.compile(r"hinge\..+\.rotation_rate"),
    re.compile(r"member\..+_rotation"),
    re.compile(r"member\..+_rotation_rate"),
    re.compile(r"hinge\..+\.(plastic_rotation|energy|moment)"),
    re.compile(r"energy\.(kinetic|elastic|dissipated)"),
    re.compile(r"node\..+\.(displacement|velocity|rotation)\..*"),
)
"""Kinds of histories that are rated, most relevant first; then requested outputs with other names."""
RELEVANT = 4
"""Number of these kinds, from the first, by which a further model is rated."""
_NEVER = re.compile(r"(energy|cut|support|hinge|node)\..*")


@dataclass(frozen=True, eq=False)
class Pair:
    """One history of a candidate against that of a reference.

    Attributes
    ----------
    channel, unit
        Name and SI unit.
    candidate, reference
        Names of the sources.
    rating
        After ISO/TS 18571, or None.
    why_not
        Why there is no rating, in one sentence; empty if there is one.
    peak, reference_peak
        Values of largest magnitude in the common interval, with their sign.
    largest_difference, at_time
        Largest magnitude of the difference, and when [s].
    """

    channel: str
    unit: str
    candidate: str
    reference: str
    rating: Rating | None
    why_not: str
    peak: float
    reference_peak: float
    largest_difference: float
    at_time: float


def pairs_of(
    candidate: tuple[str, Mapping[str, Signal]],
    reference: tuple[str, Mapping[str, Signal]],
    *,
    ranks: int = len(_ORDER) + 1,
) -> list[Pair]:
    """Pairs of histories that are rated, most relevant first.

    Parameters
    ----------
    candidate, reference
        Name of the source and its histories.
    ranks
        Kinds of histories that are rated, most relevant first.
    """
    (name, first), (other, second) = candidate, reference
    common = [c for c in first if c in second and first[c].unit == second[c].unit]
    sizes: dict[str, float] = {}
    for channel in common:
        signal = second[channel]
        size = float(np.nanmax(np.abs(signal.values), initial=0.0))
        sizes[signal.unit] = max(sizes.get(signal.unit, 0.0), size)
    ranked = sorted((c for c in common if _rank(c) < ranks), key=_rank)
    found = []
    for channel in ranked:
        a, b = first[channel], second[channel]
        if np.nanmax(np.abs(b.values), initial=0.0) > NOTHING * sizes[b.unit]:
            found.append(_pair(channel, (name, a), (other, b)))
        if len(found) == MOST:
            break
    return found


def _rank(channel: str) -> int:
    place = next((i for i, pattern in enumerate(_ORDER) if pattern.fullmatch(channel)), None)
    if place is not None:
        return place
    return len(_ORDER) + 1 if _NEVER.fullmatch(channel) else len(_ORDER)


def _pair(channel: str, candidate: tuple[str, Signal], reference: tuple[str, Signal]) -> Pair:
    (name, a), (other, b) = candidate, reference
    rated, why = None, ""
    end, start = min(a.time[-1], b.time[-1]), max(a.time[0], b.time[0])
    try:
        rated = rating(b.time, b.values, a.time, a.values)
    except InputError as error:
        why = error.problems[0].what
    time = np.union1d(a.time, b.time)
    time = time[(time >= start) & (time <= end)]
    x, y = at(a, time), at(b, time)
    difference = np.abs(x - y)
    worst = int(np.argmax(np.nan_to_num(difference))) if time.size else 0
    return Pair(
        channel=channel,
        unit=b.unit,
        candidate=name,
        reference=other,
        rating=rated,
        why_not=why,
        peak=_peak(x),
        reference_peak=_peak(y),
        largest_difference=float(difference[worst]) if time.size else float("nan"),
        at_time=float(time[worst]) if time.size else float("nan"),
    )


def _peak(values: Floats) -> float:
    """Value of largest magnitude, with its sign; NaN without any."""
    if not np.isfinite(values).any():
        return float("nan")
    return float(values[int(np.nanargmax(np.abs(values)))])
