"""Hat closed by a spot-welded plate."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar

from crumple.errors import InputError
from crumple.material import Material
from crumple.registry.keys import Word
from crumple.registry.quantity import NonNegativeLength, PositiveLength
from crumple.section.section import not_positive
from crumple.section.shapes.hat import hat_wall
from crumple.section.shapes.shape import Example, Shape
from crumple.section.shapes.shape_checks import (
    in_title,
    lengths_of_texts,
    must_be_below,
    must_not_be_negative,
)
from crumple.section.wall import Wall, Weld
from crumple.section.walled import WalledSection


@dataclass(frozen=True)
class ClosedHat(WalledSection):
    """Hat closed by a plate under its flanges, spot-welded along the middle of each flange.

    Attributes
    ----------
    width
        Outer dimension of the crown along local y [m].
    depth
        Outer dimension of the hat along local z, without the plate [m].
    thickness
        Thickness of the hat [m].
    flange
        Width of each flange beyond the outer face of its web [m].
    corner_radius
        Outer radius of the bends [m].
    plate_thickness
        Thickness of the plate, which is as wide as the hat with its flanges [m]; 0: that of the hat.
    hat_material
        Metal of the hat; without it the member's.
    plate_material
        Metal of the plate; without it the member's.

    Raises
    ------
    InputError
        With every dimension that cannot be accepted.

    Notes
    -----
    The welds are taken as continuous lines; the pitch of the spots is not looked at.  The cell is closed
    along the weld lines.

    References
    ----------
    docs/theory/thin_walled_sections.md.  Verified in tests/verification/section/test_section_properties.py.
    """

    kind: ClassVar[str] = "closed_hat"

    width: PositiveLength
    depth: PositiveLength
    thickness: PositiveLength
    flange: Annotated[PositiveLength, Word(("flange", "flanges"))]
    corner_radius: NonNegativeLength = 0.0
    plate_thickness: Annotated[NonNegativeLength, Word(("plate",))] = 0.0
    hat_material: Material | None = None
    plate_material: Material | None = None

    def __post_init__(self) -> None:
        lengths_of_texts(self)
        lengths = {
            "width": self.width,
            "depth": self.depth,
            "thickness": self.thickness,
            "flange": self.flange,
        }
        problems = not_positive(lengths, "give outer dimensions")
        extras = {"corner_radius": self.corner_radius, "plate_thickness": self.plate_thickness}
        problems += must_not_be_negative(extras)
        problems = problems or must_be_below(
            "thickness", self.thickness, min(self.width, self.depth) / 2.0, "half a side"
        )
        if problems:
            raise InputError(problems)
        super().__post_init__()

    @property
    def title(self) -> str:
        """One line for people."""
        extras = {
            "flanges": self.flange,
            "corner radius": self.corner_radius,
            "plate": self.plate_thickness,
        }
        return in_title("closed hat", (self.width, self.depth, self.thickness), extras)

    @cached_property
    def walls(self) -> tuple[Wall, ...]:
        """Hat and plate; origin in the middle between the mid-lines of the hat's flanges."""
        hat = hat_wall(self.width, self.depth, self.thickness, self.flange, self.corner_radius)
        plate, tip = self.plate_thickness or self.thickness, self.width / 2.0 + self.flange
        under = -(self.thickness + plate) / 2.0
        return (
            Wall(hat.points, self.thickness, self.corner_radius, material=self.hat_material, name="hat"),
            Wall(((-tip, under), (tip, under)), plate, material=self.plate_material, name="plate"),
        )

    @cached_property
    def welds(self) -> tuple[Weld, ...]:
        """Weld lines in the middle of the flanges, or of their flats where a bend takes part of them."""
        (_, plate), web = self.walls, (self.width - self.thickness) / 2.0
        tip = self.width / 2.0 + self.flange
        bend = max(self.corner_radius - self.thickness / 2.0, 0.0)
        flat = max(self.width / 2.0, web + bend)
        y, under = (flat + tip) / 2.0, plate.points[0][1]
        return tuple(Weld((side * y, 0.0), (side * y, under)) for side in (-1.0, 1.0))


SHAPE = Shape(ClosedHat, (Example("50x40x1.5 mm, flange 18 mm, corner radius 3 mm", senses=(1, -1)),))
