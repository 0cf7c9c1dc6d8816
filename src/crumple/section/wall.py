"""Walls of a thin-walled section: mid-line points and a thickness, as people give them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from crumple.material import Material
from crumple.registry.quantity import texts_to_si
from crumple.units import parse_quantity

Point = tuple[float, float]


def _points(points: Iterable[Iterable[float]]) -> tuple[Point, ...]:
    """Points as a tuple of pairs of floats, so that a wall can be hashed."""
    return tuple((_length(y), _length(z)) for y, z in points)


def _length(given: float | str) -> float:
    return parse_quantity(given, "m") if isinstance(given, str) else float(given)


@dataclass(frozen=True)
class Wall:
    """One sheet, bent where its mid-line turns.

    Attributes
    ----------
    points
        Corners of the mid-line (y, z) [m], at least two, sharp; `corner_radius` rounds them.
    thickness
        [m], > 0.
    corner_radius
        Outer radius of every bend [m]; 0 is sharp.  Below the thickness the inside of the bend is sharp.
    closed
        Whether the last point is joined to the first.
    material
        Metal of this wall, or None for the member's.
    name
        What messages call it; empty: its number.
    """

    points: tuple[Point, ...]
    thickness: float
    corner_radius: float = 0.0
    closed: bool = False
    material: Material | None = None
    name: str = ""

    def __post_init__(self) -> None:
        texts_to_si(self, {"thickness": "m", "corner_radius": "m"})
        object.__setattr__(self, "points", _points(self.points))


@dataclass(frozen=True)
class Weld:
    """Line of spot welds between two walls that touch: it ties them and has no area of its own.

    Attributes
    ----------
    first, second
        Points (y, z) [m] on the mid-lines of the two walls, half the sum of their thicknesses apart.
    """

    first: Point
    second: Point

    def __post_init__(self) -> None:
        first, second = _points((self.first, self.second))
        object.__setattr__(self, "first", first)
        object.__setattr__(self, "second", second)
