"""Sections given wall by wall."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Literal

from pydantic import Field

from crumple import section
from crumple.errors import InputError, Problem
from crumple.registry.quantity import Length, NonNegativeLength, PositiveLength
from crumple.structure.keys.any_section import AnySection, MaterialReference, Metal
from crumple.structure.schema.spec import Spec

MOST_WALLS = 100
"""Walls of one section; a multi-chamber extrusion has some thirty."""
MOST_POINTS = 400
"""Points of all walls of one section: the check of walls against each other grows with their square."""

Point = tuple[Length, Length]
Label = Annotated[str, Field(max_length=80)]


class WallSpec(Spec):
    """One sheet, bent where its mid-line turns."""

    points: Annotated[tuple[Point, ...], Field(min_length=2, max_length=MOST_POINTS)]
    """Corners of the mid-line, y and z each."""
    thickness: PositiveLength
    """Thickness."""
    corner_radius: NonNegativeLength = 0.0
    """Outer radius of every bend."""
    closed: bool = False
    """Whether the last point is joined to the first."""
    material: MaterialReference | None = None
    """Metal of this wall; without it the member's."""
    name: Label = ""
    """Name of the wall in messages."""


class WeldSpec(Spec):
    """Line of spot welds between two walls that lie on each other."""

    first: Point
    """Point on the mid-line of one wall."""
    second: Point
    """Point on the mid-line of the other."""


class WallSectionSpec(AnySection):
    """Any section by its walls: open, closed, with many cells, or mixed."""

    type: Literal["walls"] = "walls"
    """Kind of section."""
    name: Label = ""
    """Title for people."""
    walls: Annotated[tuple[WallSpec, ...], Field(min_length=1, max_length=MOST_WALLS)]
    """Walls; they may share points or end on the flats of others."""
    welds: Annotated[tuple[WeldSpec, ...], Field(max_length=MOST_WALLS)] = ()
    """Lines of spot welds."""

    def references(self) -> dict[str, MaterialReference | None]:
        """Metals of the walls."""
        return {f"walls[{i}].material": wall.material for i, wall in enumerate(self.walls)}

    def shape(self, metal: Metal) -> section.Section:
        """Build the section."""
        number = sum(len(wall.points) for wall in self.walls)
        if number > MOST_POINTS:
            what, allowed = "the walls have too many points", f"at most {MOST_POINTS} in all"
            raise InputError(Problem(what, f"{number}", allowed, "describe bends by corner_radius", "walls"))
        walls = tuple(
            section.Wall(
                wall.points, wall.thickness, wall.corner_radius, wall.closed, metal(wall.material), wall.name
            )
            for wall in self.walls
        )
        welds = tuple(section.Weld(weld.first, weld.second) for weld in self.welds)
        return section.WallSection(walls, welds, self.name)

    def placed(self, problems: list[Problem]) -> list[Problem]:
        """Problems whose paths start with the place of the wall instead of its name."""
        return [self._placed(problem) for problem in problems]

    def _placed(self, problem: Problem) -> Problem:
        for i, wall in enumerate(self.walls):
            if wall.name and problem.where.startswith(f"{wall.name}."):
                return replace(problem, where=f"walls[{i}]{problem.where[len(wall.name) :]}")
        return problem
