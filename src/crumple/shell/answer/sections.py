"""Rotation of a deformed section: the plane that fits its points best, and the turn within that plane.

The plane's normal is the direction of least spread of the points.  The turn about the normal is taken from
the rotation R that carries the points best in the sense of least squares: with the points' arms a at the
start and b now, the sum of b a^T = U S V^T gives R = U diag(1, 1, det(U V^T)) V^T (the solution of the
orthogonal Procrustes problem among rotations).
"""

from __future__ import annotations

import numpy as np

from crumple.numeric.arrays import Floats


def section_frame(start: Floats, now: Floats) -> Floats:
    """Axes of a section now: columns are the fitted normal, and the carried first direction within the plane.

    Parameters
    ----------
    start, now
        Points at the start and now [m], (n, 3) each.

    Returns
    -------
    NDArray
        Right-handed orthonormal columns, (3, 3).
    """
    before, after = start - start.mean(axis=0), now - now.mean(axis=0)
    carried = best_rotation(before, after)
    reference = plane_normal(before)
    normal = plane_normal(after)
    if normal @ carried @ reference < 0.0:
        normal = -normal
    across = carried @ _within(reference)
    across = across - (across @ normal) * normal
    across /= np.linalg.norm(across)
    return np.column_stack([normal, across, np.cross(normal, across)])


def section_rotation(start: Floats, now: Floats, frame: Floats | None = None) -> Floats:
    """Rotation of a section from the start, (3, 3), by its best-fit planes.

    Parameters
    ----------
    start, now
        As `section_frame` takes them.
    frame
        `section_frame(start, start)`, if it is known.
    """
    before = section_frame(start, start) if frame is None else frame
    rotation: Floats = section_frame(start, now) @ before.T
    return rotation


def plane_normal(arms: Floats) -> Floats:
    """Unit normal of the plane through the origin that fits points best, (3,); its sign is arbitrary."""
    return np.asarray(np.linalg.svd(arms, full_matrices=False)[2][-1])


def best_rotation(before: Floats, after: Floats) -> Floats:
    """Rotation that carries arms (n, 3) into arms (n, 3) with the least squared distance."""
    u, _, vt = np.linalg.svd(after.T @ before)
    sign = np.sign(np.linalg.det(u @ vt))
    return np.asarray((u * np.array([1.0, 1.0, sign])) @ vt)


def mean_spin(position: Floats, velocity: Floats) -> Floats:
    """Angular velocity of the rigid motion nearest to points' velocities [rad/s], (3,)."""
    arm = position - position.mean(axis=0)
    tensor = (arm**2).sum() * np.eye(3) - arm.T @ arm
    moment = np.cross(arm, velocity - velocity.mean(axis=0)).sum(axis=0)
    return np.asarray(np.linalg.solve(tensor, moment))


def _within(normal: Floats) -> Floats:
    """Some unit vector across a normal, always the same for the same normal."""
    least = np.eye(3)[int(np.argmin(np.abs(normal)))]
    across = np.cross(normal, least)
    return np.asarray(across / np.linalg.norm(across))
