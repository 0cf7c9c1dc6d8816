"""Sections by their walls: any outline, and the tubes written as walls."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import ClassVar

from crumple.errors import InputError, Problem
from crumple.section.section import Section, in_mm
from crumple.section.shapes.circular_tube import CircularTube
from crumple.section.shapes.rectangular_tube import RectangularTube
from crumple.section.wall import Point, Wall, Weld
from crumple.section.walled import WalledSection


@dataclass(frozen=True)
class WallSection(WalledSection):
    """Section given wall by wall: open, closed, with many cells, or mixed.

    Attributes
    ----------
    walls
        Walls may share points or end on the flats of others.
    welds
        Lines of spot welds between sheets that lie on each other.
    name
        Title for people; empty: a count of the walls.

    References
    ----------
    docs/theory/thin_walled_sections.md.  Verified in tests/verification/section/test_section_properties.py.
    """

    kind: ClassVar[str] = "walls"

    walls: tuple[Wall, ...]
    welds: tuple[Weld, ...] = ()
    name: str = ""

    @property
    def title(self) -> str:
        """One line for people."""
        return self.name or super().title

    @cached_property
    def thickness(self) -> float:
        """Wall thickness [m]; with several the mean over the length of the mid-line."""
        used = {wall.thickness for wall in self.walls}
        if len(used) == 1:
            return used.pop()
        skeleton = self.skeleton
        length = skeleton.length * (skeleton.thickness > 0.0)
        return float(skeleton.thickness @ length / length.sum())


def outline_section(
    points: Iterable[Iterable[float]],
    thickness: float,
    *,
    corner_radius: float = 0.0,
    closed: bool = True,
    name: str = "",
) -> WallSection:
    """Section of one wall along a mid-line.

    Parameters
    ----------
    points
        Corners of the mid-line (y, z) [m]; a closed one does not repeat its first.
    thickness
        [m]
    corner_radius
        Outer radius of every bend [m].
    closed
        Whether the last point is joined to the first.
    name
        Title for people.
    """
    corners = tuple((float(y), float(z)) for y, z in points)
    return WallSection((Wall(corners, thickness, corner_radius, closed),), name=name)


def walls_of(section: Section) -> WalledSection:
    """Return the same section as walls; tubes keep their exact area and moments.

    Raises
    ------
    InputError
        If the section has no description in walls.
    """
    if isinstance(section, WalledSection):
        return section
    if isinstance(section, RectangularTube | CircularTube):
        return _tube_walls(section)
    raise InputError(Problem(f"a {section.kind} has no walls", in_mm(section.thickness), "", ""))


@lru_cache(maxsize=64)
def _tube_walls(section: RectangularTube | CircularTube) -> WallSection:
    if isinstance(section, RectangularTube):
        y, z = (section.width - section.thickness) / 2.0, (section.depth - section.thickness) / 2.0
        return outline_section(
            _rectangle(y, z), section.thickness, corner_radius=section.corner_radius, name=section.title
        )
    half = (section.diameter - section.thickness) / 2.0
    return outline_section(
        _rectangle(half, half),
        section.thickness,
        corner_radius=section.diameter / 2.0,
        name=section.title,
    )


def _rectangle(y: float, z: float) -> tuple[Point, ...]:
    return ((-y, -z), (y, -z), (y, z), (-y, z))
