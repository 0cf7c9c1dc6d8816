"""Mid-line of a wall as flats and arcs: every corner of the polyline replaced by its bend.

A bend of outer radius R has its mid-line on R - t/2 about the same centre and takes
(R - t/2) tan(turn/2) of the flat on either side.  Points are complex numbers y + i z.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

from crumple.section.outline import CHORDS_PER_QUARTER
from crumple.section.wall import Wall

# Smaller turns [rad] are drawn points on a straight wall, not corners.
STRAIGHT = 1e-6


@dataclass(frozen=True)
class Piece:
    """Flat (radius 0) or arc of a mid-line from one complex point [m] to another.

    ``sense`` is +1 where the arc turns counter-clockwise, -1 clockwise; ``wall`` the number of its wall.
    """

    start: complex
    end: complex
    thickness: float
    wall: int
    centre: complex = 0j
    radius: float = 0.0
    sense: float = 0.0

    @property
    def half_angle(self) -> float:
        """Half the angle that an arc spans [rad]; 0 for a flat."""
        return math.asin(min(abs(self.end - self.start) / (2.0 * self.radius), 1.0)) if self.radius else 0.0

    @property
    def length(self) -> float:
        """Length along the mid-line [m], exact for arcs."""
        return 2.0 * self.half_angle * self.radius if self.radius else abs(self.end - self.start)

    def sweep(self, pole: complex) -> float:
        """Twice the area that the ray from a pole sweeps along the piece [m^2], exact for arcs."""
        chord = ((self.start - pole).conjugate() * (self.end - pole)).imag
        if not self.radius:
            return chord
        angle = 2.0 * self.half_angle
        return chord + self.sense * self.radius**2 * (angle - math.sin(angle))

    def tangent(self, end: int) -> complex:
        """Unit direction in which the piece leaves its start (0) or its end (1), into itself."""
        if not self.radius:
            direction = (self.end - self.start) / abs(self.end - self.start)
            return -direction if end else direction
        radial = ((self.end if end else self.start) - self.centre) / self.radius
        return (-1.0 if end else 1.0) * self.sense * 1j * radial


def corner_turns(points: list[complex], closed: bool) -> list[float]:
    """Angle by which a polyline turns at each point [rad], 0 at free ends."""
    n = len(points)
    turns = [0.0] * n
    for k in range(n) if closed else range(1, n - 1):
        before, after = points[k] - points[k - 1], points[(k + 1) % n] - points[k]
        turns[k] = cmath.phase(after / before)
    return turns


def pieces_of(wall: Wall, number: int) -> tuple[list[Piece], list[tuple[complex, float]], list[int]]:
    """Flats and arcs of a wall in order.

    Returns
    -------
    tuple
        The pieces; the corners (point, outer radius) that are round on the outside alone, as the radius is
        below the thickness; and the numbers of the flats that the bends at their ends do not leave room for.
    """
    points = [complex(*point) for point in wall.points]
    n, thickness = len(points), wall.thickness
    turns = corner_turns(points, wall.closed)
    bent = wall.corner_radius >= thickness
    middle = wall.corner_radius - thickness / 2.0 if bent else 0.0
    cut = [middle * math.tan(abs(turn) / 2.0) for turn in turns]
    rounded = []
    if 0.0 < wall.corner_radius < thickness:
        rounded = [
            (point, wall.corner_radius)
            for point, turn in zip(points, turns, strict=True)
            if abs(turn) > STRAIGHT
        ]
    pieces: list[Piece] = []
    short: list[int] = []
    for k in range(n if wall.closed else n - 1):
        after = (k + 1) % n
        side = points[after] - points[k]
        direction, left = side / abs(side), abs(side) - cut[k] - cut[after]
        if left < -1e-9 * abs(side):
            short.append(k)
            continue
        if left > 1e-9 * abs(side):
            start, end = points[k] + cut[k] * direction, points[after] - cut[after] * direction
            pieces.append(Piece(start, end, thickness, number))
        if cut[after] > 0.0:
            start = points[after] - cut[after] * direction
            pieces += _arc(start, direction, turns[after], middle, thickness, number)
    return pieces, rounded, short


def _arc(
    start: complex, direction: complex, turn: float, radius: float, thickness: float, wall: int
) -> list[Piece]:
    """Pieces of one bend that starts along a direction."""
    sense = math.copysign(1.0, turn)
    centre = start + sense * 1j * radius * direction
    count = max(2, math.ceil(abs(turn) / (math.pi / 2.0) * CHORDS_PER_QUARTER - 1e-9))
    points = [centre + (start - centre) * cmath.exp(1j * turn * k / count) for k in range(count + 1)]
    return [Piece(points[k], points[k + 1], thickness, wall, centre, radius, sense) for k in range(count)]
