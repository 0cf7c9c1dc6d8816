"""Rigid motion of rings of wall points: the rotation that fits their points best (Kabsch 1976)."""

from __future__ import annotations

import numpy as np

from crumple.numeric.arrays import Floats


def rotations(start: Floats, now: Floats) -> Floats:
    """Rotations that carry points nearest to others, about their means.

    Parameters
    ----------
    start, now
        At the start, (n, 3), and in every state, (n_states, n, 3) [m].

    Returns
    -------
    Floats
        Matrices, (n_states, 3, 3).
    """
    scatter = np.einsum("pi,tpj->tij", start - start.mean(axis=0), now - now.mean(axis=1)[:, None])
    u, _, vt = np.linalg.svd(scatter)
    v = np.swapaxes(vt, 1, 2)
    flip = np.linalg.det(v @ np.swapaxes(u, 1, 2))
    v[:, :, 2] *= flip[:, None]
    return np.asarray(v @ np.swapaxes(u, 1, 2))


def carried(start: Floats, now: Floats, points: Floats) -> Floats:
    """Positions of points that move with a ring as one rigid body [m], (n_states, n_points, 3).

    Parameters
    ----------
    start, now
        Of the ring, as for `rotations`.
    points
        At the start, (n_points, 3) [m].
    """
    turned = np.einsum("tij,pj->tpi", rotations(start, now), points - start.mean(axis=0))
    return np.asarray(now.mean(axis=1)[:, None] + turned)
