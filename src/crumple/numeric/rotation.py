"""Finite rotations over time: matrices, unit quaternions (w, x, y, z) and vectors (axis times angle)."""

from __future__ import annotations

import numpy as np

from crumple.numeric.arrays import Floats

SMALL = 1e-9
"""Sine of a rotation below which its direction is noise."""


def rotation_vector(rotation: Floats) -> Floats:
    """Axis times angle [rad] of rotation matrices, (..., 3, 3) to (..., 3); angles up to half a turn."""
    skew = _together(
        rotation[..., 2, 1] - rotation[..., 1, 2],
        rotation[..., 0, 2] - rotation[..., 2, 0],
        rotation[..., 1, 0] - rotation[..., 0, 1],
    )
    sine = np.linalg.norm(skew, axis=-1) / 2
    cosine = (np.trace(rotation, axis1=-2, axis2=-1) - 1) / 2
    angle = np.arctan2(sine, cosine)
    # for small angles axis times angle is half the skew part itself
    factor = np.where(sine > SMALL, angle / np.maximum(2 * sine, SMALL), 0.5)
    vectors: Floats = factor[..., None] * skew
    return vectors


def continuous(vectors: Floats) -> Floats:
    """Rotation vectors over time without the jump at half a turn, (n, 3), or of m rotations, (n, m, 3)."""
    out = vectors.copy()
    lengths = np.linalg.norm(out, axis=-1)
    if out.ndim > 2:
        for k in np.flatnonzero((lengths[1:] + lengths[:-1] >= np.pi).any(axis=0)):
            out[:, k] = continuous(out[:, k])
        return out
    # no vector before the first pair that may jump is changed
    far = np.flatnonzero(lengths[1:] + lengths[:-1] >= np.pi)
    for i in range(1 + int(far[0]) if far.size else len(out), len(out)):
        before, angle = out[i - 1], float(np.linalg.norm(out[i]))
        # "not above", so that what is not a number stays as it is
        if not np.linalg.norm(before) + angle >= np.pi:
            continue
        axis = (out[i] if angle > SMALL else before) / max(angle, SMALL)
        axis = axis / np.linalg.norm(axis)
        turns = round((float(before @ axis) - float(out[i] @ axis)) / (2 * np.pi))
        out[i] += 2 * np.pi * turns * axis
    return out


def cross(first: Floats, second: Floats) -> Floats:
    """Cross products, (..., 3) each: for a few thousand vectors in a third of the time of `numpy.cross`."""
    a, b, c = first[..., 0], first[..., 1], first[..., 2]
    x, y, z = second[..., 0], second[..., 1], second[..., 2]
    return _together(b * z - c * y, c * x - a * z, a * y - b * x)


def _together(x: Floats, y: Floats, z: Floats) -> Floats:
    """Vectors of their components, (...,) each to (..., 3): `numpy.stack` takes several times as long."""
    vectors = np.empty((*x.shape, 3))
    vectors[..., 0], vectors[..., 1], vectors[..., 2] = x, y, z
    return vectors


def relative_vector(first: Floats, second: Floats) -> Floats:
    """Rotation vector of one section against another over time, in axes that move with the first.

    Parameters
    ----------
    first, second
        Rotations from the start, (n, 3, 3) each.

    Returns
    -------
    NDArray
        Without the jump at half a turn [rad], (n, 3).
    """
    return continuous(rotation_vector(np.swapaxes(first, -1, -2) @ second))


def relative_rotation(first: Floats, second: Floats, direction: Floats) -> Floats:
    """Rotation of one section against another about an axis that moves with the first.

    Parameters
    ----------
    first, second
        Rotations from the start, (n, 3, 3) each.
    direction
        Unit vector of the axis at the start, (3,).

    Returns
    -------
    NDArray
        Part of the relative rotation vector along the axis [rad], (n,).
    """
    about: Floats = relative_vector(first, second) @ direction
    return about


def quaternion_vector(quaternion: Floats) -> Floats:
    """Axis times angle [rad] of unit quaternions, (..., 4) to (..., 3); angles up to half a turn."""
    upper = np.where(quaternion[..., :1] < 0.0, -quaternion, quaternion)
    sine = np.linalg.norm(upper[..., 1:], axis=-1)
    angle = 2.0 * np.arctan2(sine, upper[..., 0])
    factor = np.where(sine > SMALL, angle / np.maximum(sine, SMALL), 2.0)
    vectors: Floats = factor[..., None] * upper[..., 1:]
    return vectors


def vector_quaternion(vector: Floats) -> Floats:
    """Unit quaternions of rotation vectors, (..., 3) to (..., 4)."""
    half = np.linalg.norm(vector, axis=-1, keepdims=True) / 2.0
    return np.asarray(np.concatenate([np.cos(half), np.sinc(half / np.pi) / 2.0 * vector], axis=-1))


def product(first: Floats, second: Floats) -> Floats:
    """Quaternions of the second rotation followed by the first, (..., 4)."""
    a, b = first[..., :1], second[..., :1]
    u, v = first[..., 1:], second[..., 1:]
    scalar = a * b - np.sum(u * v, axis=-1, keepdims=True)
    both: Floats = np.concatenate([scalar, a * v + b * u + cross(u, v)], axis=-1)
    return both


def inverse(quaternion: Floats) -> Floats:
    """Quaternions of the rotations back, (..., 4)."""
    back: Floats = quaternion * np.array([1.0, -1.0, -1.0, -1.0])
    return back


def turned(quaternion: Floats, vector: Floats) -> Floats:
    """Vectors turned by unit quaternions, (..., 4) and (..., 3) to (..., 3)."""
    u = quaternion[..., 1:]
    across = 2.0 * cross(u, vector)
    out: Floats = vector + quaternion[..., :1] * across + cross(u, across)
    return out
