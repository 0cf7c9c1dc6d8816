"""Angle, bent from one sheet."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from crumple.errors import InputError
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
class Angle(WalledSection):
    """Angle of two legs, one along local y and one along local z.

    Attributes
    ----------
    width
        Outer dimension of the leg along local y [m].
    depth
        Outer dimension of the leg along local z [m].
    thickness
        Wall thickness [m].
    corner_radius
        Outer radius of the bend [m].

    Raises
    ------
    InputError
        With every dimension that cannot be accepted.

    References
    ----------
    docs/theory/thin_walled_sections.md.  Verified in tests/verification/section/test_section_properties.py.
    """

    kind: ClassVar[str] = "angle"

    width: PositiveLength
    depth: PositiveLength
    thickness: PositiveLength
    corner_radius: NonNegativeLength = 0.0

    def __post_init__(self) -> None:
        lengths_of_texts(self)
        problems = not_positive(
            {"width": self.width, "depth": self.depth, "thickness": self.thickness}, "give outer dimensions"
        )
        problems += must_not_be_negative({"corner_radius": self.corner_radius})
        problems = problems or must_be_below(
            "thickness", self.thickness, min(self.width, self.depth) / 2.0, "half a leg"
        )
        if problems:
            raise InputError(problems)
        super().__post_init__()

    @property
    def title(self) -> str:
        """One line for people."""
        return in_title(
            "angle", (self.width, self.depth, self.thickness), {"corner radius": self.corner_radius}
        )

    @cached_property
    def walls(self) -> tuple[Wall, ...]:
        """One sheet; origin in the corner of the mid-line."""
        half = self.thickness / 2.0
        points = ((self.width - half, 0.0), (0.0, 0.0), (0.0, self.depth - half))
        return (Wall(points, self.thickness, self.corner_radius, name="angle"),)


SHAPE = Shape(Angle, (Example("50x50x3 mm"),))
