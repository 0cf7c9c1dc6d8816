"""Elements between the rings of a member; where they are long, every second point around is left out.

A point within a wall can be left out with every other one of that wall, where it has an even number of sides.
From a ring to the next coarser one each pair of sides becomes three triangles: two that stand on the finer
sides and one on the coarser.  What is left is halved again where elements are twice as long once more.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from crumple.numeric.arrays import Floats, Integers
from crumple.shell.mesh.profile import Contour

FLAT = 1e-6
"""Sine of the turn at a point up to which it lies in a wall and not at a corner or in a bend."""
LONG = 2.0
"""Factor on the length of an element at which it may be twice as wide: then it is square again."""
FEWEST_LEFT = 2
"""Sides of a wall that a further halving leaves, at least: one alone, with one point, has no stiffness
against bending in its plane."""
FEWEST_COARSE = 4
"""Coarse rings in a row that save more elements than the triangles at their ends cost."""

Flags = NDArray[np.bool_]
Levels = NDArray[np.int64]
"""How often the section is halved at every ring, (rings,)."""


@dataclass(frozen=True, eq=False)
class Halving:
    """Pairs of sides that become one where a section is coarser.

    Attributes
    ----------
    pairs
        First and second side, (p, 2); the point between is left out.
    others
        Sides that stay, (q,).
    """

    pairs: Integers
    others: Integers


@dataclass(frozen=True, eq=False)
class Level:
    """A section after some halvings.

    Attributes
    ----------
    contour
        All points of the whole section, and the sides that are left.
    of
        Side of the whole section that each lies on, the first of those merged into it, (k,).
    halving
        To the next level.
    """

    contour: Contour
    of: Integers
    halving: Halving


def levels_of(contour: Contour) -> tuple[Level, ...]:
    """Every level of a section, the whole one first; nothing can be left out of the last."""
    level = Level(contour, np.arange(len(contour.sides)), halving_of(contour))
    levels = [level]
    while len(level.halving.pairs):
        first, second = level.halving.pairs.T
        kept = np.concatenate([level.halving.others, first])
        old = level.contour
        sides = np.vstack(
            [old.sides[level.halving.others], np.column_stack([old.sides[first, 0], old.sides[second, 1]])]
        )
        metals = tuple(old.metals[side] for side in kept) if old.metals else ()
        coarser = replace(old, sides=sides, thickness=old.thickness[kept], metals=metals)
        level = Level(coarser, level.of[kept], halving_of(coarser, fewest=FEWEST_LEFT))
        levels.append(level)
    return tuple(levels)


def halving_of(contour: Contour, fewest: int = 1) -> Halving:
    """What can be left out of a section: every second point of walls with an even number of sides.

    Parameters
    ----------
    contour
        Section, or what earlier halvings left of it.
    fewest
        Sides that must be left of a wall.
    """
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
    walls = [_pairs(int(side), second, out, inner) for side in np.flatnonzero(~inner[first])]
    # a wall of so many pairs has as many sides afterwards
    pairs = [pair for wall in walls if len(wall) >= fewest for pair in wall]
    paired = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    return Halving(paired, np.setdiff1d(np.arange(len(first)), paired))


def _pairs(side: int, second: Integers, out: Integers, inner: Flags) -> list[tuple[int, int]]:
    """Sides of a wall from its first one on, two by two; none where their number is odd."""
    wall = [side]
    while inner[second[wall[-1]]]:
        wall.append(int(out[second[wall[-1]]]))
    return [(wall[i], wall[i + 1]) for i in range(0, len(wall), 2)] if len(wall) % 2 == 0 else []


def coarse_rings(stations: Floats, size: float, most: int = 1) -> Levels:
    """How often the section may be halved at every ring: between long elements, several in a row.

    Neighbours differ by one at most.  Ends at which members meet or something holds lie in fine zones, so
    their elements are not long.

    Parameters
    ----------
    stations
        Of the rings [m].
    size
        Fine size [m].
    most
        Largest number of halvings of the section.
    """
    length = np.diff(stations) / size * (1.0 + 1e-9)
    between = np.minimum(np.concatenate([length[:1], length]), np.concatenate([length, length[-1:]]))
    levels: Levels = np.clip(np.floor(np.log(between) / np.log(LONG)), 0, most).astype(np.int64)
    for level in range(most, 0, -1):
        coarse = levels >= level
        for run in np.split(np.arange(len(coarse)), np.flatnonzero(np.diff(coarse)) + 1):
            if coarse[run[0]] and len(run) < FEWEST_COARSE:
                levels[run] = level - 1
    # one level at a time, from either side
    for order in (range(1, len(levels)), range(len(levels) - 2, -1, -1)):
        for i in order:
            levels[i] = min(levels[i], levels[i - order.step] + 1)
    return levels


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


def bays_of(contour: Contour, halved: Levels) -> Bays:
    """Elements between rings, with triangles where a ring meets one that is halved once more."""
    levels, around = levels_of(contour), len(contour.points)
    corners, side, start = [], [], [0]
    for i in range(len(halved) - 1):
        here, there = int(halved[i]), int(halved[i + 1])
        level = levels[min(here, there)]
        sides, halving = level.contour.sides, level.halving
        if here == there:
            of, found = level.of, _quads(sides)
        else:
            first = halving.pairs[:, 0]
            wide = np.column_stack([sides[first, 0], sides[halving.pairs[:, 1], 1]])
            of = level.of[np.concatenate([halving.others, first, first, first])]
            triangles = _triangles(wide, sides[first, 1], coarse_first=here > there)
            found = np.vstack([_quads(sides[halving.others]), *triangles])
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


def left_out(contour: Contour, halved: Levels) -> Flags:
    """Points that have no node of their own, (rings, points)."""
    out = np.zeros((len(halved), len(contour.points)), dtype=bool)
    for number, level in enumerate(levels_of(contour)):
        out[np.ix_(halved > number, level.contour.sides[level.halving.pairs[:, 0], 1])] = True
    return out


def without_points(numbers: Integers, contour: Contour, halved: Levels) -> Integers:
    """Nodes of the rings with the points that are left out replaced by their neighbours, (rings, points)."""
    changed = numbers.copy()
    # the last halving first: the neighbour of a point may be left out later itself
    for number, level in reversed(list(enumerate(levels_of(contour)))):
        pairs, rings = level.halving.pairs[:, 0], halved > number
        left, before = level.contour.sides[pairs, 1], level.contour.sides[pairs, 0]
        changed[np.ix_(rings, left)] = changed[np.ix_(rings, before)]
    return changed
