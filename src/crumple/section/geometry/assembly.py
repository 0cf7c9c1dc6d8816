"""From walls and welds to a graph: bends, walls that end on other walls, common nodes.

Points closer than a thousandth of the thinnest wall are the same point.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crumple.errors import InputError
from crumple.numeric.arrays import Integers
from crumple.section.geometry.bends import Piece, pieces_of
from crumple.section.geometry.skeleton import Complexes, Skeleton
from crumple.section.geometry.wall_checks import (
    bends_without_room,
    graph_problems,
    wall_problems,
    weld_problems,
)
from crumple.section.wall import Wall, Weld

SAME_POINT = 1e-3


def skeleton_of(walls: Sequence[Wall], welds: Sequence[Weld] = ()) -> Skeleton:
    """Graph of a section.

    Raises
    ------
    InputError
        With everything that is wrong with the walls, each wall by name.
    """
    problems = wall_problems(walls)
    if problems:
        raise InputError(problems)
    tolerance = SAME_POINT * min(wall.thickness for wall in walls)
    pieces: list[Piece] = []
    rounded: list[tuple[complex, float]] = []
    for number, wall in enumerate(walls):
        new, corners, short = pieces_of(wall, number)
        problems += bends_without_room(wall, number, short)
        pieces += new
        rounded += corners
    problems += weld_problems(pieces, walls, welds, tolerance)
    if problems:
        raise InputError(problems)
    welded = [Piece(complex(*weld.first), complex(*weld.second), 0.0, -1) for weld in welds]
    pieces = _split(pieces, [p.start for p in welded] + [p.end for p in welded], tolerance) + welded
    nodes, ends = _joined(pieces, tolerance)
    outside = {_nearest(nodes, point): radius for point, radius in rounded}
    skeleton = Skeleton(nodes, tuple(pieces), ends, outside)
    problems = graph_problems(skeleton, walls)
    if problems:
        raise InputError(problems)
    return skeleton


def _split(pieces: list[Piece], further: list[complex], tolerance: float) -> list[Piece]:
    """Cut flats where an end of another piece, or a weld, lies on them."""
    points = np.array([point for piece in pieces for point in (piece.start, piece.end)] + further)
    result = []
    for piece in pieces:
        if piece.radius:
            result.append(piece)
            continue
        side = piece.end - piece.start
        length = abs(side)
        local = (points - piece.start) * (side.conjugate() / length)
        on_it = (abs(local.imag) < tolerance) & (local.real > tolerance) & (local.real < length - tolerance)
        if not on_it.any():
            result.append(piece)
            continue
        cuts = np.sort(local.real[on_it])
        cuts = cuts[np.concatenate([[True], np.diff(cuts) > tolerance])]
        stops = [piece.start, *(piece.start + cut / length * side for cut in cuts.tolist()), piece.end]
        result += [Piece(stops[k], stops[k + 1], piece.thickness, piece.wall) for k in range(len(stops) - 1)]
    return result


def _joined(pieces: list[Piece], tolerance: float) -> tuple[Complexes, Integers]:
    """Nodes, and their numbers at the ends of each piece."""
    points = np.array([point for piece in pieces for point in (piece.start, piece.end)])
    close = np.abs(points[:, None] - points[None, :]) < tolerance
    first = close.argmax(axis=1)
    chosen, number = np.unique(first, return_inverse=True)
    return points[chosen], number.reshape(-1, 2)


def _nearest(nodes: Complexes, point: complex) -> int:
    return int(np.abs(nodes - point).argmin())
