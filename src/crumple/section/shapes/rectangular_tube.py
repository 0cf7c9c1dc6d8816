"""Rectangular hollow section of one wall thickness, corners sharp or rounded.

Every property is the difference of two rounded rectangles.  With outer corner radius R the inner
corners are concentric, radius R - t, and sharp where R <= t.  For one rounded rectangle w x d, radius r:

    A = w d - (4 - pi) r^2
    S = w d^2/8 - 2 [r^2 (d/2 - r/2) - (pi r^2/4) z_c - r^3/3],        z_c = d/2 - r   (half above the axis)
    I = w d^3/12 - 4 [r^4/12 + r^2 (d/2 - r/2)^2 - pi r^4/16 - 2 z_c r^3/3 - (pi r^2/4) z_c^2]

where the brackets are what one corner lacks: a square of side r less a quarter disc.  Z_pl = 2 S.
The torsion constant is Bredt's on the mid-line plus the wall's own:  J = 4 A_m^2 t/s_m + s_m t^3/3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.registry.quantity import NonNegativeLength, PositiveLength
from crumple.section.outline import rounded_rectangle
from crumple.section.section import Axis, ByAxis, checked_axis, in_mm, not_positive
from crumple.section.shapes.shape import Example, Shape
from crumple.section.shapes.shape_checks import lengths_of_texts


@dataclass(frozen=True)
class RectangularTube(ByAxis):
    """Rectangular tube: width along local y, depth along local z, both outer dimensions.

    Attributes
    ----------
    width
        Outer dimension along local y [m].
    depth
        Outer dimension along local z [m].
    thickness
        Wall thickness, less than half the smaller side [m].
    corner_radius
        Outer corner radius, 0 for a sharp corner, at most half the smaller side [m].

    Raises
    ------
    InputError
        With every dimension that cannot be accepted.

    References
    ----------
    docs/theory/sections.md.  Verified in tests/verification/section/test_tube_sections.py.
    """

    kind: ClassVar[str] = "rectangular_tube"

    width: PositiveLength
    depth: PositiveLength
    thickness: PositiveLength
    corner_radius: NonNegativeLength = 0.0

    def __post_init__(self) -> None:
        lengths_of_texts(self)
        lengths = {"width": self.width, "depth": self.depth, "thickness": self.thickness}
        problems = not_positive(lengths, "give the outer dimensions, for example 50 mm")
        problems = problems or self._out_of_proportion()
        if problems:
            raise InputError(problems)

    def _out_of_proportion(self) -> list[Problem]:
        half = min(self.width, self.depth) / 2.0
        problems = []
        if self.thickness >= half:
            problems.append(
                Problem(
                    "the wall is not thinner than half the smaller side",
                    in_mm(self.thickness),
                    f"< {in_mm(half)}",
                    "give a thinner wall, or a larger section",
                    "thickness",
                )
            )
        if not 0.0 <= self.corner_radius <= half:
            problems.append(
                Problem(
                    "the corner radius does not fit the section",
                    in_mm(self.corner_radius),
                    f"0 mm to {in_mm(half)} (outer radius)",
                    "give the outer radius of the corner, 0 mm for a sharp one",
                    "corner_radius",
                )
            )
        return problems

    @property
    def title(self) -> str:
        """One line for people."""
        sides = " x ".join(f"{1e3 * side:g}" for side in (self.width, self.depth, self.thickness))
        corners = f", corner radius {in_mm(self.corner_radius)}" if self.corner_radius else ""
        return f"rectangular tube {sides} mm{corners}"

    @cached_property
    def area(self) -> float:
        """Area of the metal [m^2]."""
        return _area(*self._outer("y")) - _area(*self._inner("y"))

    @cached_property
    def torsion_constant(self) -> float:
        """Bredt's constant on the mid-line plus that of the wall, 4 A_m^2 t/s + s t^3/3 [m^4]."""
        width, depth, radius = self.midline
        enclosed = _area(width, depth, radius)
        perimeter = 2.0 * (width + depth) - (8.0 - 2.0 * math.pi) * radius
        return 4.0 * enclosed**2 * self.thickness / perimeter + perimeter * self.thickness**3 / 3.0

    @property
    def midline(self) -> tuple[float, float, float]:
        """Width, depth and corner radius of the mid-line [m]; a corner sharper than t/2 is sharp there."""
        t = self.thickness
        return self.width - t, self.depth - t, max(self.corner_radius - t / 2.0, 0.0)

    def second_moment(self, axis: Axis) -> float:
        """Second moment of area about an axis [m^4]."""
        return _second_moment(*self._outer(axis)) - _second_moment(*self._inner(axis))

    def elastic_section_modulus(self, axis: Axis) -> float:
        """Second moment over half the depth [m^3]."""
        return 2.0 * self.second_moment(axis) / self.bending_depth(axis)

    def plastic_section_modulus(self, axis: Axis) -> float:
        """Twice the first moment of the half above the axis [m^3]."""
        return 2.0 * (_half_first_moment(*self._outer(axis)) - _half_first_moment(*self._inner(axis)))

    def flange_width(self, axis: Axis) -> float:
        """Outer width of the compression flange in bending about an axis [m]."""
        return self.width if checked_axis(axis) == "y" else self.depth

    def bending_depth(self, axis: Axis) -> float:
        """Outer depth in bending about an axis [m]."""
        return self.depth if checked_axis(axis) == "y" else self.width

    def turned(self, axis: Axis) -> RectangularTube:
        """Return the tube whose bending about y is this tube's bending about ``axis``."""
        return RectangularTube(
            self.flange_width(axis), self.bending_depth(axis), self.thickness, self.corner_radius
        )

    def mass_per_length(self, density: float) -> float:
        """Mass per length [kg/m] at a density [kg/m^3]."""
        return self.area * density

    def outline(self) -> Floats:
        """Mid-line polygon (y, z) [m], shape (n, 2), counter-clockwise."""
        return rounded_rectangle(*self.midline)

    def outer_outline(self) -> Floats:
        """Polygon of the outer surface (y, z) [m], shape (n, 2)."""
        return rounded_rectangle(*self._outer("y"))

    def inner_outline(self) -> Floats:
        """Polygon of the inner surface (y, z) [m], shape (n, 2)."""
        return rounded_rectangle(*self._inner("y"))

    def _outer(self, axis: Axis) -> tuple[float, float, float]:
        return self.flange_width(axis), self.bending_depth(axis), self.corner_radius

    def _inner(self, axis: Axis) -> tuple[float, float, float]:
        width, depth, radius = self._outer(axis)
        return width - 2.0 * self.thickness, depth - 2.0 * self.thickness, max(radius - self.thickness, 0.0)


def _area(width: float, depth: float, radius: float) -> float:
    """Area of a rounded rectangle."""
    return width * depth - (4.0 - math.pi) * radius**2


def _half_first_moment(width: float, depth: float, radius: float) -> float:
    """First moment of the upper half of a rounded rectangle about the middle axis."""
    centre = depth / 2.0 - radius
    corner = radius**2 * (depth - radius) / 2.0 - math.pi * radius**2 / 4.0 * centre - radius**3 / 3.0
    return width * depth**2 / 8.0 - 2.0 * corner


def _second_moment(width: float, depth: float, radius: float) -> float:
    """Second moment of a rounded rectangle about the middle axis along its width."""
    centre = depth / 2.0 - radius
    square = radius**4 / 12.0 + radius**2 * ((depth - radius) / 2.0) ** 2
    quarter_disc = (
        math.pi * radius**4 / 16.0 + 2.0 * centre * radius**3 / 3.0 + math.pi * radius**2 / 4.0 * centre**2
    )
    return width * depth**3 / 12.0 - 4.0 * (square - quarter_disc)


SHAPE = Shape(RectangularTube, (Example("50x25x2 mm, corner radius 4 mm"),))
