"""Open sections bent from one sheet: channel, angle, hat."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from crumple.errors import InputError
from crumple.section.section import not_positive
from crumple.section.shapes.shape_checks import in_title, must_be_below, must_not_be_negative
from crumple.section.wall import Wall
from crumple.section.walled import WalledSection


@dataclass(frozen=True)
class Channel(WalledSection):
    """Channel, or C with lips: web along z on the left, flanges to +y.

    Attributes
    ----------
    width
        Outer dimension of the flanges along y [m].
    depth
        Outer dimension of the web along z [m].
    thickness
        [m]
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

    width: float
    depth: float
    thickness: float
    corner_radius: float = 0.0
    lip: float = 0.0

    def __post_init__(self) -> None:
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


@dataclass(frozen=True)
class Angle(WalledSection):
    """Angle: one leg along y, one along z, the corner at the lower left.

    Attributes
    ----------
    width, depth
        Outer dimensions of the legs along y and along z [m].
    thickness
        [m]
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

    width: float
    depth: float
    thickness: float
    corner_radius: float = 0.0

    def __post_init__(self) -> None:
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


@dataclass(frozen=True)
class Hat(WalledSection):
    """Hat: crown on top, webs along z, flanges outwards at the bottom.

    Attributes
    ----------
    width
        Outer width of the crown along y [m].
    depth
        Outer depth along z, from the underside of the flanges to the top of the crown [m].
    thickness
        [m]
    flange
        Width of each flange beyond the outer face of its web [m].
    corner_radius
        Outer radius of the four bends [m].

    Raises
    ------
    InputError
        With every dimension that cannot be accepted.

    References
    ----------
    docs/theory/thin_walled_sections.md.  Verified in tests/verification/section/test_section_properties.py.
    """

    kind: ClassVar[str] = "hat"

    width: float
    depth: float
    thickness: float
    flange: float
    corner_radius: float = 0.0

    def __post_init__(self) -> None:
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
