"""Walls as a graph: nodes joined by flats, arcs and welds, and the solid metal around them.

Where walls meet, the offset lines of neighbours in angle are cut with each other (mitre).  The metal of one
edge is then the polygon between its four corner points, and all polygons together tile the metal exactly:
two walls that meet at a corner, a T or a star overlap nowhere.  Free ends are cut square.

An arc is drawn by chords.  Its polygons take the corner points at s r instead of r with
s^2 = x/(sin x cos x), x half the angle of a chord: then area and first moment are those of the arc
(the latter to order x^4).  The contours keep the corner points on the true arcs.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from crumple.numeric.arrays import Floats, Integers
from crumple.section.geometry.bends import STRAIGHT, Piece

Complexes = NDArray[np.complex128]

# Sine of the angle between walls below which they count as one straight wall: a step in thickness there is
# cut square, as the mitre of two almost parallel faces would run far away.
_ALMOST_STRAIGHT = 0.2


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Graph of a section; lengths [m], points complex y + i z in the coordinates of the walls.

    Attributes
    ----------
    nodes
        Where pieces meet, shape (n,).
    pieces
        Edges in order of the walls, then welds (wall -1, no thickness).
    ends
        Node numbers at start and end of each edge, shape (m, 2).
    rounded
        Outer corner radius at nodes whose corner is round on the outside alone.
    """

    nodes: Complexes
    pieces: tuple[Piece, ...]
    ends: Integers
    rounded: dict[int, float]

    @cached_property
    def thickness(self) -> Floats:
        """Thickness of each edge [m], 0 for welds, shape (m,)."""
        return np.array([piece.thickness for piece in self.pieces])

    @cached_property
    def wall(self) -> Integers:
        """Number of the wall that each edge belongs to, -1 for welds, shape (m,)."""
        return np.array([piece.wall for piece in self.pieces])

    @cached_property
    def length(self) -> Floats:
        """Length of each edge along the mid-line [m], shape (m,)."""
        return np.array([piece.length for piece in self.pieces])

    @cached_property
    def middle(self) -> complex:
        """Mean of the nodes: integrals are taken about it, as about a distant origin they lose digits."""
        return complex(self.nodes.mean())

    @cached_property
    def sweep(self) -> Floats:
        """Twice the area that the ray from `middle` sweeps along each edge [m^2], shape (m,)."""
        return np.array([piece.sweep(self.middle) for piece in self.pieces])

    @cached_property
    def stars(self) -> list[list[int]]:
        """Half-edges that leave each node, counter-clockwise: 2 e at the start of edge e, 2 e + 1 the end."""
        stars: list[list[int]] = [[] for _ in self.nodes]
        for half, node in enumerate(self.ends.ravel().tolist()):
            stars[node].append(half)
        for star in stars:
            star.sort(key=lambda half: cmath.phase(self.directions[half]))
        return stars

    @cached_property
    def directions(self) -> list[complex]:
        """Unit direction of each half-edge away from its node."""
        return [piece.tangent(end) for piece in self.pieces for end in (0, 1)]

    @cached_property
    def corners(self) -> tuple[list[list[complex]], list[list[complex]]]:
        """Points of the surface at each half-edge's node, on its left and on its right, from near to far.

        One point each, more where the corner is round on the outside.
        """
        left: list[list[complex]] = [[] for _ in self.directions]
        right: list[list[complex]] = [[] for _ in self.directions]
        for node, star in enumerate(self.stars):
            for position, first in enumerate(star):
                second = star[(position + 1) % len(star)]
                left[first], right[second] = self._corner(node, first, second, len(star))
        return left, right

    def _corner(self, node: int, first: int, second: int, degree: int) -> tuple[list[complex], list[complex]]:
        """Surface left of one half-edge and right of the next one counter-clockwise."""
        point, d1, d2 = complex(self.nodes[node]), self.directions[first], self.directions[second]
        h1, h2 = (self.pieces[half // 2].thickness / 2.0 for half in (first, second))
        sine = (d1.conjugate() * d2).imag
        straight = abs(sine) < (STRAIGHT if h1 == h2 else _ALMOST_STRAIGHT)
        if degree == 1 or straight:
            return [point + 1j * h1 * d1], [point - 1j * h2 * d2]
        corner = point + (h2 * d1 + h1 * d2) / sine
        radius = self.rounded.get(node, 0.0)
        # the outside of a corner of two walls is where the angle between them passes 180 degrees
        if radius and degree == 2 and sine < 0.0:
            return _rounded(corner, d1, d2, radius)
        return [corner], [corner]

    @cached_property
    def polygons(self) -> Complexes:
        """Metal of each edge, counter-clockwise, shape (m, k); short rows repeat their last point."""
        left, right = self.corners
        rows = []
        for edge, piece in enumerate(self.pieces):
            a, b = 2 * edge, 2 * edge + 1
            if piece.radius:
                rows.append(_sector(piece))
                continue
            start, end = (complex(self.nodes[node]) for node in self.ends[edge])
            across_b = [end] if len(self.stars[self.ends[edge, 1]]) > 2 else []
            across_a = [start] if len(self.stars[self.ends[edge, 0]]) > 2 else []
            rows.append([*right[a], *reversed(left[b]), *across_b, *right[b], *reversed(left[a]), *across_a])
        width = max(len(row) for row in rows)
        return np.array([row + row[-1:] * (width - len(row)) for row in rows])

    @cached_property
    def faces(self) -> list[list[int]]:
        """Regions between the walls: the half-edges around each with the region on their left."""
        before = {}
        for star in self.stars:
            for position, half in enumerate(star):
                before[half] = star[position - 1]
        faces, seen = [], set()
        for first in before:
            if first in seen:
                continue
            face, half = [], first
            while half not in seen:
                seen.add(half)
                face.append(half)
                half = before[half ^ 1]
            faces.append(face)
        return faces

    @cached_property
    def cells(self) -> list[tuple[float, list[int]]]:
        """Closed cells: area inside the mid-line [m^2] and the half-edges around, counter-clockwise."""
        smallest = 1e-9 * float(np.ptp(self.nodes.real) + np.ptp(self.nodes.imag)) ** 2
        cells = [(self._area(face), face) for face in self.faces]
        return [cell for cell in cells if cell[0] > smallest]

    def _area(self, face: list[int]) -> float:
        return sum((0.5 - (half & 1)) * float(self.sweep[half >> 1]) for half in face)

    @cached_property
    def contours(self) -> list[Complexes]:
        """Surfaces of the metal: the outer one counter-clockwise first, then that of each cell."""
        left, right = self.corners
        contours = []
        for face in sorted(self.faces, key=self._area):
            points = [point for half in face for point in (*left[half], *reversed(right[half ^ 1]))]
            loop = np.array(points)
            keep = np.abs(loop - np.roll(loop, 1)) > 1e-9 * np.ptp(np.abs(self.nodes - self.nodes[0]))
            contours.append(loop[keep])
        # the region around the section lies left of its walls when they are followed clockwise
        return [contours[0][::-1], *contours[1:]]


def _rounded(corner: complex, d1: complex, d2: complex, radius: float) -> tuple[list[complex], list[complex]]:
    """Halves of a round outer corner, for the wall along d1 and for that along d2."""
    turn = cmath.phase(-d2 / d1)
    centre = corner + radius / math.cos(turn / 2.0) * (d1 + d2) / abs(d1 + d2)
    start = corner + radius * math.tan(abs(turn) / 2.0) * d1
    arc = [centre + (start - centre) * cmath.exp(1j * turn * k / 8) for k in range(9)]
    # equal-area radius, as for the chords of an arc
    half = abs(turn) / 16.0
    scale = math.sqrt(half / (math.sin(half) * math.cos(half)))
    larger = [centre + scale * (point - centre) for point in arc]
    return [*larger[4::-1], arc[0]], [*larger[4:], arc[-1]]


def _sector(piece: Piece) -> list[complex]:
    """Four corners of a chord of an arc, with the area and first moment of the arc."""
    x = piece.half_angle
    scale = math.sqrt(x / (math.sin(x) * math.cos(x)))
    radial = [(point - piece.centre) / piece.radius for point in (piece.start, piece.end)]
    outer, inner = (scale * (piece.radius + side * piece.thickness / 2.0) for side in (1.0, -1.0))
    corners = [
        piece.centre + r * ray for ray, r in zip(radial * 2, (outer, outer, inner, inner), strict=True)
    ]
    corners = [corners[0], corners[1], corners[3], corners[2]]
    return corners if piece.sense > 0.0 else corners[::-1]
