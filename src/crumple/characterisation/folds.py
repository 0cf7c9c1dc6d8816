"""Folds of a crushed member: how many, and the shortening at which they are closed."""

from __future__ import annotations

import numpy as np
from scipy.signal import find_peaks

from crumple.numeric.arrays import Floats
from crumple.result import Result

CREST, PROMINENCE = 2.0, 4.0
"""Displacement of a crest out of its wall, and its height above the next troughs, over the wall thickness."""
NEAR = 0.9
"""Efficiency over its largest value down to which the folds count as open."""
POINTS = 600
"""Points of the shortening at which the efficiency is compared."""


def stroke(shortening: Floats, force: Floats, wave: float) -> float:
    """Shortening at which the folds are closed: where the efficiency of absorption begins to fall [m].

    Parameters
    ----------
    shortening, force
        Histories [m], [N], (n,).
    wave
        Length of a fold [m]: the force is averaged over as much shortening, so its swing does not matter.

    Notes
    -----
    Efficiency: the work so far over the force, W(u)/P(u).  It grows with u while the force swings about a
    constant mean, and falls when the closed folds let the force rise.  The stroke ends where it is within
    10 % of its largest value for the last time, since it swings with the force.

    References
    ----------
    Li, Magkiriadis & Harrigan, J. Cell. Plast. 42 (2006) 371-392, as used for foams.
    """
    reached = np.maximum.accumulate(np.maximum(shortening, 0.0))
    new = np.concatenate([[True], np.diff(reached) > 0.0])
    work = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(shortening))])
    at = np.linspace(min(2.0 * wave, 0.5 * float(reached[-1])), float(reached[-1]), POINTS)
    done, before = (np.interp(u, reached[new], work[new]) for u in (at, at - wave))
    efficiency = done / np.maximum(done - before, 1e-12 * done[-1])
    return float(at[np.flatnonzero(efficiency >= NEAR * efficiency.max())[-1]])


def fold_count(result: Result, thickness: float) -> int:
    """Number of folds in the last stored shape of a straight member along x.

    Along each line of the mesh the crests of the wall's displacement are counted, outwards and inwards, that
    stand out by more than a few wall thicknesses; the median of the lines that have any.
    """
    states = result.states
    assert states is not None
    counts = []
    for line in np.unique(states.contour):
        own = np.flatnonzero(states.contour == line)
        own = own[np.argsort(states.points[own, 0])]
        across = states.points[own, 1:]
        outward = across / np.maximum(np.linalg.norm(across, axis=1), 1e-300)[:, None]
        moved = (states.displacement[-1][own, 1:] * outward).sum(axis=1)
        ended = np.concatenate([[0.0], moved, [0.0]])
        high, apart = CREST * thickness, PROMINENCE * thickness
        counts.append(sum(len(find_peaks(one, high, prominence=apart)[0]) for one in (ended, -ended)))
    folded = [count for count in counts if count > 0]
    return int(np.median(folded)) if folded else 0
