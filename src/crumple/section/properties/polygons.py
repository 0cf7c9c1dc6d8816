"""Integrals over polygons, many at once, and over what a straight line leaves of them.

With Green's theorem every integral is a sum over the sides of a polygon, exact for straight sides.
Points are complex y + i z [m]; rows run counter-clockwise and may repeat their last point.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.numeric.monotone_root import rising_root
from crumple.section.geometry.skeleton import Complexes

BLOCK = 1 << 15
"""Lines times corners that are worked on at once: what a processor's cache holds."""


class Moments(NamedTuple):
    """Integrals over polygons: area, y, z, y^2, z^2, y z [m^2 to m^4]; each of shape (m,)."""

    area: Floats
    y: Floats
    z: Floats
    yy: Floats
    zz: Floats
    yz: Floats


def moments(polygons: Complexes) -> Moments:
    """Integrals over each polygon, shape (m, k)."""
    y1, z1 = polygons.real, polygons.imag
    following = np.roll(polygons, -1, axis=1)
    y2, z2 = following.real, following.imag
    cross = y1 * z2 - y2 * z1
    return Moments(
        cross.sum(1) / 2.0,
        (cross * (y1 + y2)).sum(1) / 6.0,
        (cross * (z1 + z2)).sum(1) / 6.0,
        (cross * (y1 * y1 + y1 * y2 + y2 * y2)).sum(1) / 12.0,
        (cross * (z1 * z1 + z1 * z2 + z2 * z2)).sum(1) / 12.0,
        (cross * (y1 * (2.0 * z1 + z2) + y2 * (z1 + 2.0 * z2))).sum(1) / 24.0,
    )


class Above(NamedTuple):
    """Of the part of each polygon above a line: area, integral of height, integral of the place along."""

    area: Floats
    height: Floats
    along: Floats


def above(polygons: Complexes, angle: Floats, level: Floats) -> Above:
    """What lies above lines.

    Parameters
    ----------
    polygons
        Shape (m, k).
    angle
        Direction of each line from y towards z [rad], shape (d,).
    level
        Height of each line over the origin [m], shape (d,); height = z cos(angle) - y sin(angle).

    Returns
    -------
    Above
        Each of shape (d, m); along = y cos(angle) + z sin(angle).
    """
    together = max(BLOCK // polygons.size, 1)
    if len(angle) > together:
        borders = list(range(together, len(angle), together))
        blocks = zip(np.split(angle, borders), np.split(level, borders), strict=True)
        parts = zip(*(above(polygons, *block) for block in blocks), strict=True)
        return Above(*(np.concatenate(part) for part in parts))
    # corners come first: numpy adds up and shifts whole tables faster than rows of four
    turned = np.ascontiguousarray(polygons.T)[:, None, :] * np.exp(-1j * angle)[:, None]
    u1, h1 = turned.real, turned.imag
    u2, h2 = np.roll(u1, -1, axis=0), np.roll(h1, -1, axis=0)
    line = level[:, None]
    # ends of each side moved along it onto the line where they lie below
    rise = h2 - h1
    level_side = np.abs(rise) < 1e-14 * np.abs(polygons).max()
    slope = (u2 - u1) / np.where(level_side, np.inf, rise)
    g1, g2 = np.maximum(h1, line), np.maximum(h2, line)
    v1, v2 = u1 + slope * (g1 - h1), u2 + slope * (g2 - h2)
    step = g2 - g1
    return Above(
        (step * (v1 + v2)).sum(0) / 2.0,
        (step * (v1 * (2.0 * g1 + g2) + v2 * (g1 + 2.0 * g2))).sum(0) / 6.0,
        (step * (v1 * v1 + v1 * v2 + v2 * v2)).sum(0) / 6.0,
    )


def equal_level(polygons: Complexes, weight: Floats, angle: float, wanted: float) -> float:
    """Height of the line above which the weighted area of the polygons is ``wanted``, to rounding."""
    turned = np.asarray(polygons * np.exp(-1j * angle))
    flat = np.zeros(1)

    def missing(level: float) -> float:
        return wanted - float(weight @ above(turned, flat, np.array([level])).area[0])

    low, high = float(turned.imag.min()), float(turned.imag.max())
    return rising_root(missing, low, high, 1e-14 * abs(missing(high)) + 1e-300)
