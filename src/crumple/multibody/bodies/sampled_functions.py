"""Functions of time as the kernels take them: piecewise linear, with a bounded error, and the ends of steps.

A structure is lowered many times with the same functions; each is sampled once.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

import numpy as np

from crumple.function import MAX_BREAKS, TimeFunction
from crumple.numeric.arrays import Floats
from crumple.structure import Structure

SAMPLING = 1e-7
"""Error of a sampled function of time, relative to its largest value; far below any accuracy used."""
DRIVE_SAMPLING = 1e-8
"""The same for driven motion, whose rate is sampled: its pieces then add up to the motion within 1e-6."""
KINK = 0.01
"""Jump of a driven rate between two samples, relative to the largest rate, that counts as a kink where a
motion has more than `MAX_BREAKS` of them.  Lesser ones are spread over the samples beside them."""
SMOOTH = 1e-6
"""The same where it has fewer: what is left of a smooth motion's rate at its samples."""
BRIEF = 1e-9
"""Time in which a driven rate passes a kink, relative to the duration."""
FUNCTIONS = 512
"""Largest number of sampled functions that are kept."""


@lru_cache(maxsize=FUNCTIONS)
def sampled(function: TimeFunction, duration: float, error: float = SAMPLING) -> tuple[Floats, Floats]:
    """Times and values of a function up to a time [s]; the error is relative to its largest value."""
    tolerance = max(error * function.largest(0.0, duration), 1e-12)
    times, values = function.sampled(0.0, duration, tolerance)
    return _fixed(times), _fixed(values)


@lru_cache(maxsize=FUNCTIONS)
def sampled_motion(function: TimeFunction, duration: float) -> tuple[Floats, Floats, Floats]:
    """Times, displacements and rates of a driven motion; the rate's straight pieces add up to the motion."""
    times, values = sampled(function, duration, DRIVE_SAMPLING)
    rates, steps = np.array(function.derivative(times)), np.diff(times)
    # the rate just before each sample that makes its piece end where the motion does; at a kink it differs
    before = 2.0 * np.diff(values) / steps - rates[:-1]
    jumps = np.abs(before - rates[1:]) / max(float(np.abs(rates).max()), 1e-300)
    # the run ends with the motion; values after its end do not matter
    rates[-1], jumps[-1] = before[-1], 0.0
    kinks = np.flatnonzero(jumps > SMOOTH)
    if kinks.size > MAX_BREAKS:
        kinks = np.flatnonzero(jumps > KINK)
        # a lesser jump is spread so that both pieces together end where the motion does
        spread = np.setdiff1d(np.arange(steps.size - 1), kinks)
        share = steps[spread] / (steps[spread] + steps[spread + 1])
        rates[spread + 1] = share * before[spread] + (1.0 - share) * rates[spread + 1]
    brief = np.minimum(BRIEF * duration, steps[kinks] / 2)
    times = np.insert(times, kinks + 1, times[kinks + 1] - brief)
    values = np.insert(values, kinks + 1, values[kinks + 1])
    return _fixed(times), _fixed(values), _fixed(np.insert(rates, kinks + 1, before[kinks]))


def breaks_of(structure: Structure, duration: float) -> Floats:
    """Times within a duration [s] at which steps end: jumps and isolated kinks of all functions of time."""
    found = [_breaks(function, duration) for function in _functions(structure)]
    return np.unique(np.concatenate([np.empty(0), *found]))


@lru_cache(maxsize=FUNCTIONS)
def _breaks(function: TimeFunction, duration: float) -> Floats:
    return function.breaks(0.0, duration)


def _functions(structure: Structure) -> Iterator[TimeFunction]:
    """Every function of time of a structure."""
    for load in structure.loads:
        for components in (load.force, load.moment):
            yield from (function for axis in "xyz" if (function := getattr(components, axis)) is not None)
    for support in structure.supports.values():
        yield from support.driven.values()
    for obstacle in structure.obstacles.values():
        yield from (function for axis in "xyz" if (function := getattr(obstacle.motion, axis)) is not None)
        if obstacle.turning is not None:
            yield obstacle.turning.angle


def _fixed(array: Floats) -> Floats:
    """An array that is shared and must not be changed."""
    array.setflags(write=False)
    return array
