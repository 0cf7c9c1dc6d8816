"""Where the rings of nodes lie along a member: fine where requested, growing smoothly elsewhere.

The target length h(s) of an element is `fine` inside the fine zones and grows with the distance d from the
nearest one, h = min(coarse, fine + ln(growth) d), which makes each element longer than its neighbour by at
most the growth.  Between fixed places (ends, zone ends, requested stations) lie n = round(integral ds / h)
elements, at equal steps of that integral.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats

Zone = tuple[float, float]

MOST_RINGS = 1_000_000
"""Elements along a member."""
TOO_NEAR = 0.5
"""Share of the target length below which two fixed places are one: a very short element would determine the
time step."""
SAMPLES_PER_ELEMENT = 8
"""Points per finest element at which the integral of 1/h is taken."""


@dataclass(frozen=True)
class Sizes:
    """Target lengths [m]: far from and inside the fine zones; and how fast they change (growth > 1)."""

    coarse: float
    fine: float
    growth: float

    def at(self, s: Floats, zones: Sequence[Zone]) -> Floats:
        """Target length at stations [m], (n,)."""
        if not zones:
            return np.full(s.shape, self.coarse)
        distance = np.min([np.maximum(np.maximum(a - s, s - b), 0.0) for a, b in zones], axis=0)
        target: Floats = np.minimum(self.coarse, self.fine + math.log(self.growth) * distance)
        return target


def stations(ends: Zone, asked: Iterable[float], zones: Sequence[Zone], sizes: Sizes) -> Floats:
    """Rings of one member.

    Parameters
    ----------
    ends
        First and last ring [m].
    asked
        Stations at which a ring shall lie [m].
    zones
        Fine stretches [m].
    sizes
        Target lengths.

    Returns
    -------
    NDArray
        Increasing from the first to the last [m], at least two.
    """
    zones = _merged(zones)
    fixed = _fixed_places(ends, asked, zones, sizes)
    rings = [np.array([fixed[0]])]
    for a, b in pairwise(fixed):
        rings.append(_divided(a, b, zones, sizes)[1:])
    return np.concatenate(rings)


def _merged(zones: Sequence[Zone]) -> list[Zone]:
    """Zones that overlap as one, in order."""
    merged: list[Zone] = []
    for a, b in sorted(zones):
        if merged and a <= merged[-1][1]:
            merged[-1] = (merged[-1][0], max(b, merged[-1][1]))
        else:
            merged.append((a, b))
    return merged


def _fixed_places(ends: Zone, asked: Iterable[float], zones: Sequence[Zone], sizes: Sizes) -> list[float]:
    """Places that get a ring: the ends, then requested stations, then ends of zones, if far enough apart."""
    kept = list(ends)
    for place in [*asked, *(end for zone in zones for end in zone)]:
        if not ends[0] < place < ends[1]:
            continue
        apart = TOO_NEAR * float(sizes.at(np.array([place]), zones)[0])
        if all(abs(place - other) >= apart for other in kept):
            kept.append(place)
    return sorted(kept)


def _divided(a: float, b: float, zones: Sequence[Zone], sizes: Sizes) -> Floats:
    """Rings from a to b, both included."""
    finest = min(sizes.coarse, sizes.fine) if zones else sizes.coarse
    number = min(100_000, max(2, math.ceil((b - a) / finest * SAMPLES_PER_ELEMENT)))
    s = np.linspace(a, b, number + 1)
    density = 1.0 / sizes.at(s, zones)
    integral = np.concatenate([[0.0], np.cumsum((density[1:] + density[:-1]) / 2 * np.diff(s))])
    if integral[-1] > MOST_RINGS:
        what, todo = (
            f"a member has {integral[-1]:.3g} elements along it",
            "give larger elements, or a shorter member",
        )
        raise InputError(Problem(what, "", f"at most {MOST_RINGS}", todo, "analysis.shell.element_size"))
    elements = max(1, round(float(integral[-1])))
    rings = np.interp(np.linspace(0.0, integral[-1], elements + 1), integral, s)
    rings[0], rings[-1] = a, b
    return np.asarray(rings, float)
