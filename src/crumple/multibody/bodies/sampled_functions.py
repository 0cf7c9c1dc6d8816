"""Functions of time as the kernels take them: piecewise linear, with a bounded error."""

from __future__ import annotations

import numpy as np

from crumple.function import TimeFunction
from crumple.numeric.arrays import Floats

SAMPLING = 1e-5
"""Error of a sampled function of time, relative to its largest value; far below any accuracy asked for."""
DRIVE_SAMPLING = 1e-8
"""The same for driven motion, whose rate is sampled: its pieces then add up to the motion within 1e-6."""
KINK = 0.01
"""Jump of a driven rate between two samples, relative to the largest rate, that counts as a kink."""
BRIEF = 1e-9
"""Time in which a driven rate passes a kink, relative to the duration."""


def sampled(function: TimeFunction, duration: float, error: float = SAMPLING) -> tuple[Floats, Floats]:
    """Times and values of a function up to a time [s]; the error is relative to its largest value."""
    coarse = np.abs(function(np.linspace(0.0, duration, 257)))
    return function.sampled(0.0, duration, max(error * float(coarse.max()), 1e-12))


def sampled_motion(function: TimeFunction, duration: float) -> tuple[Floats, Floats, Floats]:
    """Times, displacements and rates of a driven motion; the rate's straight pieces add up to the motion."""
    times, values = sampled(function, duration, DRIVE_SAMPLING)
    rates = np.asarray(function.derivative(times))
    # the rate just before each sample that makes its piece end where the motion does; at a kink it differs
    before = 2.0 * np.diff(values) / np.diff(times) - rates[:-1]
    kinks = np.flatnonzero(np.abs(before - rates[1:]) > KINK * np.abs(rates).max())
    brief = np.minimum(BRIEF * duration, np.diff(times)[kinks] / 2)
    times = np.insert(times, kinks + 1, times[kinks + 1] - brief)
    return times, np.insert(values, kinks + 1, values[kinks + 1]), np.insert(rates, kinks + 1, before[kinks])
