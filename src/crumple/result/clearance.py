"""Distance between a space that must stay free and the members around it."""

from __future__ import annotations

import numpy as np

from crumple.numeric.arrays import Floats

SAMPLES = 33
"""Points of a segment that are looked at, ends included; between two of them the distance errs by at most
an eighth of their spacing squared over the distance, and not at all beside a straight side."""


def clearance(space: Floats, segments: Floats, radii: Floats) -> Floats:
    """Least distance between a closed polygon and round bars, both moving.

    Parameters
    ----------
    space
        Corners of a plane polygon [m], (times, corners, 3), in order; at least three.  What lies across its
        plane counts by where it is along it, as if the space were a prism.
    segments
        Ends of the bars' axes [m], (times, bars, 2, 3).
    radii
        Of the bars [m], (bars,).

    Returns
    -------
    NDArray
        [m], (times,); negative by the depth where a bar is inside.
    """
    corners, ends = _in_plane(space, segments)
    share = np.linspace(0.0, 1.0, SAMPLES)[:, None]
    points = ends[:, :, :1] * (1.0 - share) + ends[:, :, 1:] * share
    distance = signed_distance(points.reshape(len(points), -1, 2), corners)
    least: Floats = (distance.reshape(points.shape[:3]).min(axis=2) - radii).min(axis=1)
    return least


def signed_distance(points: Floats, corners: Floats) -> Floats:
    """Distance of points from a polygon in a plane, negative inside.

    Parameters
    ----------
    points, corners
        (times, points, 2) and (times, corners, 2).

    Returns
    -------
    NDArray
        (times, points).
    """
    nearest = np.full(points.shape[:2], np.inf)
    inside = np.zeros(points.shape[:2], bool)
    for i in range(corners.shape[1]):
        a, b = corners[:, i - 1][:, None], corners[:, i][:, None]
        side, apart = b - a, points - a
        size = np.maximum((side * side).sum(axis=-1), 1e-300)
        along = np.clip((apart * side).sum(axis=-1) / size, 0.0, 1.0)
        nearest = np.minimum(nearest, np.linalg.norm(apart - along[..., None] * side, axis=-1))
        # a ray towards +x crosses the side
        crosses = (a[..., 1] > points[..., 1]) != (b[..., 1] > points[..., 1])
        rise = np.where(side[..., 1] == 0.0, 1.0, side[..., 1])
        at = a[..., 0] + (points[..., 1] - a[..., 1]) * side[..., 0] / rise
        inside ^= crosses & (points[..., 0] < at)
    return np.where(inside, -nearest, nearest)


def _in_plane(space: Floats, segments: Floats) -> tuple[Floats, Floats]:
    """Corners and ends in the coordinates of the polygon's plane."""
    origin = space[:, :1]
    arms = space[:, 1:] - origin
    # the sum over the fan of triangles has the plane's normal also where some are degenerate
    normal = np.cross(arms[:, :-1], arms[:, 1:]).sum(axis=1)
    first = arms[:, 0] / np.linalg.norm(arms[:, 0], axis=-1, keepdims=True)
    second = np.cross(normal, first)
    second /= np.linalg.norm(second, axis=-1, keepdims=True)
    basis = np.stack([first, second], axis=-1)
    corners = (space - origin) @ basis
    ends = (segments - origin[:, :, None]) @ basis[:, None]
    return corners, ends
