"""Polygons of closed contours, for drawing, bodies and meshes."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

# Chords per quarter turn: 8 keep a polygon within 0.5 % of the radius; fewer show as facets in pictures.
CHORDS_PER_QUARTER = 8


@lru_cache(maxsize=256)
def rounded_rectangle(width: float, depth: float, radius: float) -> NDArray[np.float64]:
    """Corner points of a rectangle centred on the origin, or arcs where the radius is positive.

    Parameters
    ----------
    width, depth
        Dimensions along y and z [m].
    radius
        Corner radius [m].

    Returns
    -------
    NDArray
        Points (y, z) [m], shape (4, 2) or (4 * (CHORDS_PER_QUARTER + 1), 2), counter-clockwise from the
        lower right; arc points lie on the arc.
    """
    y, z = width / 2.0 - radius, depth / 2.0 - radius
    centres = np.array([[y, -z], [y, z], [-y, z], [-y, -z]])
    if radius <= 0.0:
        return _read_only(centres)
    quarter = np.linspace(0.0, np.pi / 2.0, CHORDS_PER_QUARTER + 1)
    corners = [
        centre + radius * np.column_stack([np.cos(start + quarter), np.sin(start + quarter)])
        for centre, start in zip(centres, np.pi / 2.0 * np.arange(-1, 3), strict=True)
    ]
    points = np.concatenate(corners)
    # corners that touch (radius of half a side) share a point: keep it once
    apart = np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1) > 1e-9 * (width + depth)
    return _read_only(points[apart])


@lru_cache(maxsize=256)
def circle(diameter: float) -> NDArray[np.float64]:
    """Points of a circle about the origin, shape (8 * CHORDS_PER_QUARTER, 2), counter-clockwise from +y."""
    angle = np.linspace(0.0, 2.0 * np.pi, 8 * CHORDS_PER_QUARTER, endpoint=False)
    return _read_only(diameter / 2.0 * np.column_stack([np.cos(angle), np.sin(angle)]))


def _read_only(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points that all callers share."""
    points.flags.writeable = False
    return points
