"""A capacity curve as few straight pieces whose error is bounded.

A chord of length l over a curve of curvature M'' errs by l^2 |M''|/8, so pieces of equal relative error have
lengths ~ sqrt(8 error M/|M''|): points are spread by the integral of its inverse, between kinks.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np

from crumple.errors import CrumpleError
from crumple.hinge.law import Floats, HingeLaw
from crumple.hinge.record import Envelope

DENSE = 257
"""Points per smooth piece on which the error is measured."""
MOST_PIECES = 4096
"""More than this for one smooth piece means that the curve is not smooth; kinks are missing."""


def sampled_envelope(
    law: HingeLaw, sense: int = 1, error: float = 1e-4, rotation_max: float = math.pi
) -> Envelope:
    """Piecewise linear capacity of a law.

    Parameters
    ----------
    law
        Its kinks become points.
    sense
        +1 or -1.
    error
        Bound of |sampled - exact|/exact [-].
    rotation_max
        Rotation [rad] of the last point; the envelope is constant beyond.  Half a turn by default: no member
        bends further.

    Returns
    -------
    Envelope
        First point at 0.

    Raises
    ------
    CrumpleError
        If the law's capacity is not smooth between its kinks.
    """

    def capacity(rotation: Floats) -> Floats:
        return law.moment_capacity(rotation, sense)

    inner = sorted({kink for kink in law.kinks(sense) if 0.0 < kink < rotation_max})
    ends = [0.0, *inner, rotation_max]
    pieces = [_piece(capacity, low, high, error) for low, high in pairwise(ends)]
    # a piece begins where the one before it ended
    rotation, moment = (
        np.concatenate([part[0][:1], *(piece[1:] for piece in part)]) for part in zip(*pieces, strict=True)
    )
    return Envelope(rotation, moment)


def _piece(
    capacity: Callable[[Floats], Floats], low: float, high: float, error: float
) -> tuple[Floats, Floats]:
    """Rotations and capacities of one smooth piece, ends included."""
    dense = np.linspace(low, high, DENSE)
    exact = capacity(dense)
    # a pure choice of places: the bound itself is checked below
    bend = np.abs(np.gradient(np.gradient(exact, dense), dense)) / exact
    density = np.sqrt(bend / (8.0 * error)) + 1e-3 / (high - low)
    grown = np.concatenate([[0.0], np.cumsum((density[1:] + density[:-1]) / 2.0 * np.diff(dense))])
    count = max(1, math.floor(grown[-1]))
    while count <= MOST_PIECES:
        points: Floats = np.interp(np.linspace(0.0, grown[-1], count + 1), grown, dense)
        points[0], points[-1] = low, high
        moment = capacity(points)
        middles = (points[1:] + points[:-1]) / 2.0
        seen = np.concatenate([dense, middles])
        chords = np.interp(seen, points, moment)
        if np.max(np.abs(chords / np.concatenate([exact, capacity(middles)]) - 1.0)) < error:
            return points, moment
        count = max(count + 1, math.ceil(1.05 * count))
    raise CrumpleError(
        f"the capacity is not smooth between {low:.6g} and {high:.6g} rad: its law hides a kink"
    )
