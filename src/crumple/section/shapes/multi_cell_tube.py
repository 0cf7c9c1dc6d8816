"""Tube with inner walls, as extrusions are."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar

from crumple.errors import InputError, Problem
from crumple.registry.keys import Word
from crumple.registry.quantity import COUNT, Count, NonNegativeLength, PositiveLength
from crumple.section.section import in_mm, not_positive
from crumple.section.shapes.shape import Example, Shape
from crumple.section.shapes.shape_checks import (
    in_title,
    lengths_of_texts,
    must_be_below,
    must_not_be_negative,
)
from crumple.section.wall import Wall
from crumple.section.walled import WalledSection


@dataclass(frozen=True)
class MultiCellTube(WalledSection):
    """Rectangular tube divided by inner walls into equal cells.

    Attributes
    ----------
    width
        Outer dimension along local y [m].
    depth
        Outer dimension along local z [m].
    thickness
        Thickness of the outer walls [m].
    columns
        Cells beside each other along y, 1 to 20.
    rows
        Cells above each other along z, 1 to 20.
    inner_thickness
        Thickness of the inner walls [m]; 0: that of the outer ones.
    corner_radius
        Outer radius of the four outer corners [m].

    Raises
    ------
    InputError
        With every dimension that cannot be accepted.

    References
    ----------
    docs/theory/thin_walled_sections.md.  Verified in tests/verification/section/test_section_properties.py.
    """

    kind: ClassVar[str] = "multi_cell_tube"

    width: PositiveLength
    depth: PositiveLength
    thickness: PositiveLength
    columns: Annotated[Count, Word(("cells",))] = 2
    rows: Annotated[Count, Word(("cells",))] = 1
    inner_thickness: Annotated[NonNegativeLength, Word(("inner walls",))] = 0.0
    corner_radius: NonNegativeLength = 0.0

    def __post_init__(self) -> None:
        lengths_of_texts(self)
        problems = not_positive(
            {"width": self.width, "depth": self.depth, "thickness": self.thickness}, "give outer dimensions"
        )
        extras = {"corner_radius": self.corner_radius, "inner_thickness": self.inner_thickness}
        problems += must_not_be_negative(extras)
        for name, count in (("columns", self.columns), ("rows", self.rows)):
            if not (isinstance(count, int) and COUNT.at_least <= count <= COUNT.at_most):
                todo = "give the number of cells in that direction"
                problems.append(
                    Problem(
                        f"{name} is out of range",
                        f"{count}",
                        f"{COUNT.at_least} to {COUNT.at_most}",
                        todo,
                        name,
                    )
                )
        problems = problems or must_be_below(
            "thickness", self.thickness, min(self.width, self.depth) / 2.0, "half the smaller side"
        )
        half = min(self.width, self.depth) / 2.0
        if not problems and self.corner_radius > half:
            todo = "give the outer radius of the corner"
            problems.append(
                Problem(
                    "the corner radius does not fit the section",
                    in_mm(self.corner_radius),
                    f"0 mm to {in_mm(half)} (outer radius)",
                    todo,
                    "corner_radius",
                )
            )
        if problems:
            raise InputError(problems)
        super().__post_init__()

    @property
    def title(self) -> str:
        """One line for people."""
        extras = {"inner walls": self.inner_thickness, "corner radius": self.corner_radius}
        cells = f"tube of {self.columns} x {self.rows} cells"
        return in_title(cells, (self.width, self.depth, self.thickness), extras)

    @cached_property
    def walls(self) -> tuple[Wall, ...]:
        """Outer wall, inner walls along z, then pieces of inner walls along y; origin in the middle."""
        y, z = (self.width - self.thickness) / 2.0, (self.depth - self.thickness) / 2.0
        inner = self.inner_thickness or self.thickness
        across = [-y + 2.0 * y * k / self.columns for k in range(self.columns + 1)]
        up = [-z + 2.0 * z * k / self.rows for k in range(self.rows + 1)]
        outer = Wall(
            ((-y, -z), (y, -z), (y, z), (-y, z)), self.thickness, self.corner_radius, True, name="outer wall"
        )
        upright = [
            Wall(((at, -z), (at, z)), inner, name=f"inner wall {k}")
            for k, at in enumerate(across[1:-1], start=1)
        ]
        # the pieces between the uprights meet on them
        level = [
            Wall(((across[i], at), (across[i + 1], at)), inner, name=f"inner wall {i},{k}")
            for k, at in enumerate(up[1:-1])
            for i in range(self.columns)
        ]
        return (outer, *upright, *level)


SHAPE = Shape(MultiCellTube, (Example("80x40x2 mm, cells 2x1"),))
