"""Elements between the rings of a member; where they are long, every second point around is left out.

A point within a wall can be left out with every other one of that wall, where it has an even number of sides.
From a fine ring to a coarse one each pair of sides becomes three triangles: two that stand on the fine sides
and one on the coarse.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crumple.shell.profile import Contour, Floats, Integers

FLAT = 1e-6
"""Sine of the turn at a point up to which it lies in a wall and not at a corner or in a bend."""
LONG = 2.0
"""Length of an element over the fine size from which it may be twice as wide: then it is square again."""
FEWEST_COARSE = 4
"""Coarse rings in a row that save more elements than the triangles at their ends cost."""

Flags = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Halving:
    """Pairs of sides that become one where a section is coarse.

    Attributes
    ----------
    pairs
        First and second side, (p, 2); the point between is left out.
    others
        Sides that stay, (q,).
    """

    pairs: Integers
    others: Integers


def halving_of(contour: Contour) -> Halving:
    """What can be left out of a section: every second point of walls with an even number of sides."""
    first, second = contour.sides[:, 0], contour.sides[:, 1]
    number = len(contour.points)
    out, into = np.full(number, -1), np.full(number, -1)
    out[first], into[second] = np.arange(len(first)), np.arange(len(second))
    degree = np.bincount(contour.sides.reshape(-1), minlength=number)
    along = contour.points[second] - contour.points[first]
    along = along / np.linalg.norm(along, axis=1)[:, None]
    inner = np.zeros(number, dtype=bool)
    for p in np.flatnonzero((degree == 2) & (out >= 0) & (into >= 0)):
        a, b = into[p], out[p]
        turn = along[a, 0] * along[b, 1] - along[a, 1] * along[b, 0]
        same = contour.thickness[a] == contour.thickness[b] and (
            not contour.metals or contour.metals[a] == contour.metals[b]
        )
        inner[p] = p not in contour.welds and abs(turn) < FLAT and along[a] @ along[b] > 0.0 and same
    pairs = [pair for side in np.flatnonzero(~inner[first]) for pair in _pairs(int(side), second, out, inner)]
    paired = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    return Halving(paired, np.setdiff1d(np.arange(len(first)), paired))


def _pairs(side: int, second: Integers, out: Integers, inner: Flags) -> list[tuple[int, int]]:
    """Sides of a wall from its first one on, two by two; none where their number is odd."""
    wall = [side]
    while inner[second[wall[-1]]]:
        wall.append(int(out[second[wall[-1]]]))
    return [(wall[i], wall[i + 1]) for i in range(0, len(wall), 2)] if len(wall) % 2 == 0 else []


def coarse_rings(stations: Floats, size: float) -> Flags:
    """Rings at which the section may be coarse: between long elements, several in a row.

    Ends at which members meet or something holds lie in fine zones, so their elements are not long.

    Parameters
    ----------
    stations
        Of the rings [m].
    size
        Fine size [m].
    """
    long = np.diff(stations) >= LONG * size * (1.0 - 1e-9)
    coarse = np.concatenate([[True], long]) & np.concatenate([long, [True]])
    for run in np.split(np.arange(len(coarse)), np.flatnonzero(np.diff(coarse)) + 1):
        if len(run) < FEWEST_COARSE:
            coarse[run] = False
    return np.asarray(coarse, dtype=bool)


@dataclass(frozen=True, eq=False)
class Bays:
    """Elements of one member, bay after bay.

    Attributes
    ----------
    corners
        Numbers of points, ring times points around plus point, (m, 4); a triangle repeats its third.
    side
        Side of the section that each lies on, the first of two, (m,).
    start
        Number of the first element of each bay, and behind the last, (bays + 1,).
    """

    corners: Integers
    side: Integers
    start: Integers


def bays_of(contour: Contour, coarse: Flags) -> Bays:
    """Elements between rings, with triangles where a fine ring meets a coarse one."""
    halving, around = halving_of(contour), len(contour.points)
    every = np.arange(len(contour.sides))
    corners, side, start = [], [], [0]
    for i in range(len(coarse) - 1):
        here, there = bool(coarse[i]), bool(coarse[i + 1])
        if not here and not there:
            of, found = every, _quads(contour.sides)
        else:
            a, b = contour.sides[halving.pairs[:, 0], 0], contour.sides[halving.pairs[:, 1], 1]
            wide = np.column_stack([a, b])
            middle = contour.sides[halving.pairs[:, 0], 1]
            rest = _quads(contour.sides[halving.others])
            if here and there:
                of, found = (
                    np.concatenate([halving.others, halving.pairs[:, 0]]),
                    np.vstack([rest, _quads(wide)]),
                )
            else:
                of = np.concatenate([halving.others, *[halving.pairs[:, 0]] * 3])
                found = np.vstack([rest, *_triangles(wide, middle, coarse_first=here)])
        # corners: point around, and 0 for this ring or 1 for the next
        corners.append(found[..., 0] + (found[..., 1] + i) * around)
        side.append(of)
        start.append(start[-1] + len(of))
    return Bays(np.concatenate(corners), np.concatenate(side), np.array(start))


def _quads(sides: Integers) -> Integers:
    """Corners of quadrilaterals on sides, normals to the right of these, (k, 4, 2): point and ring."""
    a, b = sides[:, 0], sides[:, 1]
    return _corners((a, 0), (b, 0), (b, 1), (a, 1))


def _triangles(wide: Integers, middle: Integers, *, coarse_first: bool) -> list[Integers]:
    """Three triangles on each wide side, (k, 4, 2) each."""
    a, b, m = wide[:, 0], wide[:, 1], middle
    if coarse_first:
        return [
            _corners((a, 0), (m, 1), (a, 1), (a, 1)),
            _corners((a, 0), (b, 0), (m, 1), (m, 1)),
            _corners((b, 0), (b, 1), (m, 1), (m, 1)),
        ]
    return [
        _corners((a, 0), (m, 0), (a, 1), (a, 1)),
        _corners((m, 0), (b, 1), (a, 1), (a, 1)),
        _corners((m, 0), (b, 0), (b, 1), (b, 1)),
    ]


def _corners(*corners: tuple[Integers, int]) -> Integers:
    return np.stack(
        [np.column_stack([point, np.full(len(point), ring)]) for point, ring in corners], axis=1
    ).astype(np.int64)


def left_out(contour: Contour, coarse: Flags) -> Flags:
    """Points that have no node of their own, (rings, points)."""
    out = np.zeros((len(coarse), len(contour.points)), dtype=bool)
    out[np.ix_(coarse, contour.sides[halving_of(contour).pairs[:, 0], 1])] = True
    return out


def without_points(numbers: Integers, contour: Contour, coarse: Flags) -> Integers:
    """Nodes of the rings with the points that are left out replaced by their neighbours, (rings, points)."""
    pairs = halving_of(contour).pairs[:, 0]
    left, before = contour.sides[pairs, 1], contour.sides[pairs, 0]
    changed = numbers.copy()
    changed[np.ix_(coarse, left)] = numbers[np.ix_(coarse, before)]
    return changed
