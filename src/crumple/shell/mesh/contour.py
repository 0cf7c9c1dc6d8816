"""Where the nodes of a section lie: its mid-line outline divided into element sides.

The outline is split into walls (straight) and bends (runs of short chords).  A wall gets an even number
of sides, so that a row of nodes runs along its middle, where a folding flange has its crease.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from crumple.numeric.arrays import Floats, Integers
from crumple.section import Section
from crumple.section.walled import WalledSection
from crumple.shell.mesh.profile import SHORTEST_BEND, Contour, number_of_sides
from crumple.shell.mesh.walls import walled_contour

__all__ = ["Contour", "Floats", "Integers", "contour_of", "outline_points"]

SHARP_TURN = np.radians(25.0)
"""Angle between two chords from which their common point is a corner; arcs of outlines turn by 11.25 degrees
a chord."""
UNEQUAL_CHORDS = 1.5
"""Ratio of neighbouring chords from which one is a wall and the other part of a bend."""
LEAST_AROUND_CIRCLE = 8
"""Sides around a closed curve, at least: fewer are no longer round."""


def contour_of(section: Section, size: float) -> Contour:
    """Divide a section.

    Parameters
    ----------
    section
        A tube, or walls.
    size
        Target length of a side [m].
    """
    if isinstance(section, WalledSection):
        return walled_contour(section, size)
    points = outline_points(section, size)
    numbers = np.arange(len(points))
    sides = np.column_stack([numbers, np.roll(numbers, -1)])
    return Contour(points, sides, np.full(len(points), section.thickness))


def outline_points(section: Section, size: float) -> Floats:
    """Points of a closed section for a mesh.

    Parameters
    ----------
    section
        Closed.
    size
        Target length of a side [m].

    Returns
    -------
    NDArray
        Points (y, z) [m] on the mid-line, shape (n, 2), counter-clockwise, first point not repeated.
    """
    outline = section.outline()
    breaks = np.flatnonzero(_is_break(outline))
    if not breaks.size:
        length = float(_lengths(outline).sum())
        quarter = number_of_sides(length / 4.0, size, bend=True)
        number = max(LEAST_AROUND_CIRCLE, 4 * round(length / (4.0 * size)), 4 * quarter if quarter > 1 else 0)
        return _divided(np.vstack([outline, outline[:1]]), number)[:-1]
    start = np.roll(outline, -breaks[0], axis=0)
    ends = [*(breaks - breaks[0]), len(outline)]
    closed = np.vstack([start, start[:1]])
    paths = [closed[a : b + 1] for a, b in pairwise(ends)]
    points = [_divided(path, _number(path, size))[:-1] for path in _without_small_bends(paths, size)]
    return np.asarray(np.concatenate(points), float)


def triple(vector: Floats) -> tuple[float, float, float]:
    """Vector as the stepper's model holds it."""
    x, y, z = (float(value) for value in vector)
    return x, y, z


def _is_break(outline: Floats) -> NDArray[np.bool_]:
    """Points where a wall ends."""
    after = np.roll(outline, -1, axis=0) - outline
    before = np.roll(after, 1, axis=0)
    a, b = np.linalg.norm(before, axis=1), np.linalg.norm(after, axis=1)
    cosine = np.einsum("ij,ij->i", before, after) / (a * b)
    unequal = np.maximum(a, b) > UNEQUAL_CHORDS * np.minimum(a, b)
    turns: NDArray[np.bool_] = (np.arccos(np.clip(cosine, -1.0, 1.0)) > SHARP_TURN) | unequal
    return turns


def _lengths(closed: Floats) -> Floats:
    return np.asarray(np.linalg.norm(np.roll(closed, -1, axis=0) - closed, axis=1))


def _without_small_bends(paths: list[Floats], size: float) -> list[Floats]:
    """Paths with bends shorter than a share of the size drawn together into their middle."""
    paths = [path.copy() for path in paths]
    small = [len(path) > 2 and _along(path)[-1] < SHORTEST_BEND * size for path in paths]
    if all(small):
        return paths
    for i, is_small in enumerate(small):
        if is_small:
            middle = _divided(paths[i], 2)[1]
            paths[i - 1][-1] = middle
            paths[(i + 1) % len(paths)][0] = middle
    return [path for path, is_small in zip(paths, small, strict=True) if not is_small]


def _number(path: Floats, size: float) -> int:
    """Sides of one wall or bend."""
    return number_of_sides(float(_along(path)[-1]), size, bend=len(path) > 2)


def _along(path: Floats) -> Floats:
    """Distance along a path of every point, (n,)."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1))])


def _divided(path: Floats, number: int) -> Floats:
    """Path with equal sides, (number + 1, 2)."""
    along = _along(path)
    at = np.linspace(0.0, along[-1], number + 1)
    return np.column_stack([np.interp(at, along, path[:, 0]), np.interp(at, along, path[:, 1])])
