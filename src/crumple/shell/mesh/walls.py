"""Sections made of walls, open or with many cells: each piece of the mid-line divided by itself."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace
from itertools import pairwise

import numpy as np

from crumple.material import Material
from crumple.section.geometry.bends import Piece
from crumple.section.geometry.skeleton import Skeleton
from crumple.section.walled import WalledSection
from crumple.shell.mesh.profile import SHORTEST_BEND, Contour, number_of_sides

LARGEST_BEND = math.radians(150.0)
"""Angle up to which arcs are drawn together [rad]: below 180 degrees the chord determines the angle."""


def walled_contour(section: WalledSection, size: float) -> Contour:
    """Divide the walls of a section; pieces that meet share a point.

    Parameters
    ----------
    section
        Walls and lines of spot welds.
    size
        Target length of a side [m].
    """
    skeleton = section.skeleton
    node = list(skeleton.nodes)
    same = list(range(len(node)))
    edges = _edges(skeleton)
    for piece, first, second in edges:
        # a small bend becomes a corner in its middle
        if piece.radius and piece.length < SHORTEST_BEND * size:
            a, b = _root(same, first), _root(same, second)
            node[a] = _point(piece, 0.5)
            same[b] = a
    used = sorted({_root(same, number) for _, *ends in edges for number in ends})
    points = [node[number] for number in used]
    index = {number: i for i, number in enumerate(used)}
    sides: list[tuple[int, int]] = []
    thickness: list[float] = []
    metals: list[Material | None] = []
    for piece, first, second in edges:
        a, b = _root(same, first), _root(same, second)
        if a == b and piece.radius:
            continue
        number = number_of_sides(piece.length, size, bend=bool(piece.radius))
        inner = [_between(piece, node[a], node[b], k / number) for k in range(1, number)]
        chain = [index[a], *range(len(points), len(points) + len(inner)), index[b]]
        points += inner
        sides += list(pairwise(chain))
        thickness += [piece.thickness] * number
        metals += [section.walls[piece.wall].material] * number
    welds = [
        [index[_root(same, int(end))] for end in ends]
        for piece, ends in zip(skeleton.pieces, skeleton.ends, strict=True)
        if piece.wall < 0
    ]
    about = np.array(points) - complex(*section.properties.centroid)
    middle = np.column_stack([about.real, about.imag])
    tied = np.array(welds, dtype=np.int64).reshape(-1, 2)
    return Contour(middle, np.array(sides), np.array(thickness), tuple(metals), tied)


def _edges(skeleton: Skeleton) -> list[tuple[Piece, int, int]]:
    """Pieces with the numbers of their ends, the short arcs of one bend as one; welds are none."""
    degree = np.bincount(skeleton.ends.reshape(-1))
    edges: list[tuple[Piece, int, int]] = []
    for piece, (first, second) in zip(skeleton.pieces, skeleton.ends.tolist(), strict=True):
        if piece.wall < 0:
            continue
        if edges and edges[-1][2] == first and degree[first] == 2 and _goes_on(edges[-1][0], piece):
            before, start, _ = edges[-1]
            edges[-1] = (replace(before, end=piece.end), start, second)
        else:
            edges.append((piece, first, second))
    return edges


def _goes_on(before: Piece, piece: Piece) -> bool:
    """Whether an arc continues another within one bend."""
    same = before.radius and before.radius == piece.radius and before.wall == piece.wall
    return bool(
        same
        and abs(before.centre - piece.centre) < 1e-9 * piece.radius
        and before.half_angle + piece.half_angle < LARGEST_BEND / 2
    )


def _root(same: list[int], number: int) -> int:
    while same[number] != number:
        number = same[number]
    return number


def _point(piece: Piece, share: float) -> complex:
    """Point of a piece at a share of its length."""
    if not piece.radius:
        return piece.start + share * (piece.end - piece.start)
    turn = cmath.exp(2j * piece.sense * piece.half_angle * share)
    return piece.centre + (piece.start - piece.centre) * turn


def _between(piece: Piece, start: complex, end: complex, share: float) -> complex:
    """Point of a piece whose ends may have moved into a corner."""
    moved = (1.0 - share) * (start - piece.start) + share * (end - piece.end)
    return _point(piece, share) + moved
