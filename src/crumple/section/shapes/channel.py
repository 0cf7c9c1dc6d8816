"""Channel, with or without lips, bent from one sheet."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar

from crumple.errors import InputError
from crumple.registry.keys import Word
from crumple.registry.quantity import NonNegativeLength, PositiveLength
from crumple.section.section import not_positive
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
class Channel(WalledSection):
    """Channel, or C with lips: web along local z, flanges towards +y.

    Attributes
    ----------
    width
        Outer dimension of the flanges along local y [m].
    depth
        Outer dimension of the web along local z [m].
    thickness
        Wall thickness [m].
    corner_radius
        Outer radius of the bends [m].
    lip
        Outer dimension along z of the lips at the ends of the flanges [m]; 0: none.

    Raises
    ------
    InputError
        With every dimension that cannot be accepted.

    References
    ----------
    docs/theory/thin_walled_sections.md.  Verified in tests/verification/section/test_section_properties.py.
    """

    kind: ClassVar[str] = "channel"

    width: PositiveLength
    depth: PositiveLength
    thickness: PositiveLength
    corner_radius: NonNegativeLength = 0.0
    lip: Annotated[NonNegativeLength, Word(("lip", "lips"))] = 0.0

    def __post_init__(self) -> None:
        lengths_of_texts(self)
        problems = not_positive(
            {"width": self.width, "depth": self.depth, "thickness": self.thickness}, "give outer dimensions"
        )
        problems += must_not_be_negative({"corner_radius": self.corner_radius, "lip": self.lip})
        problems = problems or [
            *must_be_below("thickness", self.thickness, min(self.width, self.depth) / 2.0, "half a side"),
            *must_be_below("lip", self.lip, self.depth / 2.0, "half the depth, where the lips meet"),
        ]
        if problems:
            raise InputError(problems)
        super().__post_init__()

    @property
    def title(self) -> str:
        """One line for people."""
        shape = "lipped channel" if self.lip else "channel"
        return in_title(
            shape,
            (self.width, self.depth, self.thickness),
            {"corner radius": self.corner_radius, "lip": self.lip},
        )

    @cached_property
    def walls(self) -> tuple[Wall, ...]:
        """One sheet from flange to flange; origin in the middle of the web's mid-line."""
        half, tip = (self.depth - self.thickness) / 2.0, self.width - self.thickness / 2.0
        points = [(tip, -half), (0.0, -half), (0.0, half), (tip, half)]
        if self.lip:
            y, end = self.width - self.thickness, half + self.thickness / 2.0 - self.lip
            points = [(y, -end), (y, -half), *points[1:3], (y, half), (y, end)]
        return (Wall(tuple(points), self.thickness, self.corner_radius, name="channel"),)


SHAPE = Shape(
    Channel,
    (
        Example("40x80x2 mm, corner radius 4 mm", "z", (1, -1)),
        Example("40x80x2 mm, corner radius 4 mm, lip 12 mm", "z", (1, -1), "lipped_channel"),
    ),
)
