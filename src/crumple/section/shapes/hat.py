"""Hat, bent from one sheet."""

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
class Hat(WalledSection):
    """Hat: crown along local y at the top, flanges at the bottom pointing outwards, open below.

    Attributes
    ----------
    width
        Outer dimension of the crown along local y [m].
    depth
        Outer dimension along local z, from the underside of the flanges to the top of the crown [m].
    thickness
        Wall thickness [m].
    flange
        Width of each flange beyond the outer face of its web [m].
    corner_radius
        Outer radius of the bends [m].

    Raises
    ------
    InputError
        With every dimension that cannot be accepted.

    References
    ----------
    docs/theory/thin_walled_sections.md.  Verified in tests/verification/section/test_section_properties.py.
    """

    kind: ClassVar[str] = "hat"

    width: PositiveLength
    depth: PositiveLength
    thickness: PositiveLength
    flange: Annotated[PositiveLength, Word(("flange", "flanges"))]
    corner_radius: NonNegativeLength = 0.0

    def __post_init__(self) -> None:
        lengths_of_texts(self)
        lengths = {
            "width": self.width,
            "depth": self.depth,
            "thickness": self.thickness,
            "flange": self.flange,
        }
        problems = not_positive(lengths, "give outer dimensions")
        problems += must_not_be_negative({"corner_radius": self.corner_radius})
        problems = problems or must_be_below(
            "thickness", self.thickness, min(self.width, self.depth) / 2.0, "half a side"
        )
        if problems:
            raise InputError(problems)
        super().__post_init__()

    @property
    def title(self) -> str:
        """One line for people."""
        extras = {"flanges": self.flange, "corner radius": self.corner_radius}
        return in_title("hat", (self.width, self.depth, self.thickness), extras)

    @cached_property
    def walls(self) -> tuple[Wall, ...]:
        """One sheet; origin in the middle between the mid-lines of the flanges."""
        return (hat_wall(self.width, self.depth, self.thickness, self.flange, self.corner_radius),)


def hat_wall(width: float, depth: float, thickness: float, flange: float, corner_radius: float) -> Wall:
    """Sheet of a hat by its outer dimensions [m]; the mid-lines of the flanges lie on z = 0."""
    web, tip, top = (width - thickness) / 2.0, width / 2.0 + flange, depth - thickness
    points = ((tip, 0.0), (web, 0.0), (web, top), (-web, top), (-web, 0.0), (-tip, 0.0))
    return Wall(points, thickness, corner_radius, name="hat")


SHAPE = Shape(Hat, (Example("50x40x1.5 mm, flange 18 mm, corner radius 3 mm", senses=(1, -1)),))
