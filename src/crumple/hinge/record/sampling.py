"""A capacity curve as a minimal number of linear pieces with bounded error.

A chord of length l over a curve of curvature M'' errs by l^2 |M''|/8, so pieces of equal relative error have
lengths ~ sqrt(8 error M/|M''|): points are spread by the integral of its inverse, between kinks.  All
stretches between kinks are sampled together, so that a law is called a few times for many rotations.  A law
that says so is straight between its kinks, and these are all points.
"""

from __future__ import annotations

import math

import numpy as np

from crumple.errors import InputError, Problem
from crumple.hinge.law import HingeLaw
from crumple.hinge.record.record import Envelope
from crumple.numeric.arrays import Floats

DENSE = np.linspace(0.0, 1.0, 65) ** 3
"""Points per smooth piece on which the error is measured, beside the middle of every chord: closest at its
start, where folds begin and moments fall fastest."""
SPARE = 1.1
"""Factor on the estimated number of chords, so that the first try is mostly sufficient."""
MOST_PIECES = 4096
"""More than this for one smooth piece means that the curve is not smooth; kinks are missing."""

TOO_STEEP = "changes too steeply for a table"
"""End of the message on such a curve: where the walls are to blame, the input has a better place for it."""


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
    InputError
        If the capacity is not positive somewhere: the error is relative, and such a hinge is a joint.  If it
        is not smooth between the kinks that the law reports: extremely thin walls, an unreported kink.
    """
    ends = np.array([0.0, *sorted({k for k in law.kinks(sense) if 0.0 < k < rotation_max}), rotation_max])
    # not inherited: what derives from a straight law may curve
    if vars(type(law)).get("straight", False):
        capacity = law.moment_capacity(ends, sense)
        _refuse_without_capacity(law, ends, capacity)
        return _shared(ends, capacity)
    dense = ends[:-1, None] + (ends[1:] - ends[:-1])[:, None] * DENSE
    exact = law.moment_capacity(dense.ravel(), sense).reshape(dense.shape)
    _refuse_without_capacity(law, dense, exact)
    grown = _spread(exact, error)
    counts = np.maximum(1, np.floor(SPARE * grown[:, -1])).astype(np.int64)
    share = grown / grown[:, -1:]
    while counts.max() <= MOST_PIECES:
        # chords are numbered consecutively; every piece begins at the end of the one before
        first = np.concatenate([[0], np.cumsum(counts)])
        number = first[:-1, None] + counts[:, None] * share
        points: Floats = np.interp(np.arange(first[-1] + 1), number.ravel(), dense.ravel())
        points[first] = ends
        middles = (points[1:] + points[:-1]) / 2.0
        places = np.concatenate([points, middles])
        both = law.moment_capacity(places, sense)
        _refuse_without_capacity(law, places, both)
        moment, between = both[: points.size], both[points.size :]
        off_chord = np.abs((moment[1:] + moment[:-1]) / 2.0 / between - 1.0)
        off_dense = np.abs(np.interp(dense, points, moment) / exact - 1.0)
        too_far = np.maximum(np.maximum.reduceat(off_chord, first[:-1]), off_dense.max(axis=1)) >= error
        if not too_far.any():
            return _shared(points, moment)
        counts = np.where(too_far, np.maximum(counts + 1, np.ceil(1.05 * counts)), counts).astype(np.int64)
    low, high = np.degrees(ends[np.argmax(counts) :][:2])
    what = f"the capacity of the law '{law.title}' {TOO_STEEP}"
    came, allowed = (
        f"between {low:.4g} and {high:.4g} deg",
        f"{MOST_PIECES} chords with an error below {error:g}",
    )
    todo = "give thicker walls, or a measured law; a law of your own must report its kinks"
    raise InputError(Problem(what, came, allowed, todo))


def _shared(points: Floats, moment: Floats) -> Envelope:
    """Envelope that hinges share, and so cannot change."""
    points.flags.writeable = moment.flags.writeable = False
    return Envelope(points, moment)


def _refuse_without_capacity(law: HingeLaw, rotation: Floats, capacity: Floats) -> None:
    wrong = ~(np.isfinite(capacity) & (capacity > 0.0))
    if wrong.any():
        first = np.argmin(np.where(wrong, rotation, np.inf))
        came = f"{capacity.ravel()[first]:g} N m at {math.degrees(rotation.ravel()[first]):.4g} deg"
        what, allowed = (
            f"the law '{law.title}' has no capacity",
            "more than 0 N m at every rotation up to 180 deg",
        )
        todo = "keep a small residual capacity, or let the hinge break: fracture"
        raise InputError(Problem(what, came, allowed, todo))


def _spread(exact: Floats, error: float) -> Floats:
    """Number of chords from the start of each piece, (pieces, points); determines sampling points only."""
    step = np.diff(DENSE)
    slope = np.diff(exact, axis=1) / step
    bend = 2.0 * np.abs(np.diff(slope, axis=1)) / (step[1:] + step[:-1]) / exact[:, 1:-1]
    # chords per length; at the ends of a piece as beside them
    chords = np.sqrt(np.concatenate([bend[:, :1], bend, bend[:, -1:]], axis=1) / (8.0 * error)) + 1e-3
    within = (chords[:, 1:] + chords[:, :-1]) / 2.0 * step
    return np.concatenate([np.zeros((len(exact), 1)), np.cumsum(within, axis=1)], axis=1)
