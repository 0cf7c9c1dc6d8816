"""Behaviour after the walls of a fold touch: an explicit option, never an unstated default.

A jammed fold is stiff; the moment rises until the member folds again next to it.  No published formula of
that rise was found, so the options are models: `SECOND_FOLD` restarts the curve as a hinge in series.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from crumple.numeric.arrays import Floats

# Ramp from the jammed moment to the next fold's curve, as a fraction of the jamming angle: short enough to
# cost little energy, long enough that the capacity is continuous and a time step can follow it.
RAMP_FRACTION = 0.02


class AfterJamming(Enum):
    """Capacity beyond the jamming angle."""

    SECOND_FOLD = "second_fold"
    """The curve starts again as a further hinge in series, after a short ramp; repeated at each jamming."""
    STOP = "stop"
    """The capacity keeps its last value and an elastic stop carries the load: there is no further fold."""
    HOLD = "hold"
    """The capacity keeps its last value."""


def continued(
    single_fold: Callable[[Floats], Floats], rotation: ArrayLike, jamming_angle: float, after: AfterJamming
) -> Floats:
    """Capacity before and beyond jamming.

    Parameters
    ----------
    single_fold
        Capacity [N m] of one fold for rotations from 0 to the jamming angle.
    rotation
        [rad], >= 0, any shape.
    jamming_angle
        [rad].
    after
        Option for the behaviour beyond jamming.

    Returns
    -------
    NDArray
        Capacity [N m], continuous, same shape as the rotation.
    """
    rotation = np.asarray(rotation, np.float64)
    if after is not AfterJamming.SECOND_FOLD:
        return single_fold(np.minimum(rotation, jamming_angle))
    folds = np.floor(rotation / jamming_angle)
    within = np.clip(rotation - folds * jamming_angle, 0.0, jamming_angle)
    # one call: the cost of a law depends on the number of calls more than on the number of rotations
    values = single_fold(np.append(within, jamming_angle))
    fresh, jammed = values[:-1].reshape(within.shape), float(values[-1])
    share = np.where(folds > 0.0, np.minimum(within / (RAMP_FRACTION * jamming_angle), 1.0), 1.0)
    return np.asarray(jammed + (fresh - jammed) * share, np.float64)


def continued_kinks(
    single_fold: tuple[float, ...], jamming_angle: float, after: AfterJamming
) -> tuple[float, ...]:
    """Kinks up to half a turn from those within one fold, rotations in [rad]."""
    if after is not AfterJamming.SECOND_FOLD:
        return (*single_fold, jamming_angle)
    ramp_end = RAMP_FRACTION * jamming_angle
    kinks = [*single_fold]
    for fold in range(1, math.ceil(math.pi / jamming_angle) + 1):
        start = fold * jamming_angle
        kinks += [start, start + ramp_end, *(start + kink for kink in single_fold)]
    return tuple(sorted(kink for kink in set(kinks) if kink <= math.pi))
