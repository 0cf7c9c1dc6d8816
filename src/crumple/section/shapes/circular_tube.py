"""Circular hollow section: every property is the difference of two discs, exact for any wall."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.registry.quantity import PositiveLength
from crumple.section.outline import circle
from crumple.section.section import Axis, ByAxis, checked_axis, in_mm, not_positive
from crumple.section.shapes.shape import Example, Shape
from crumple.section.shapes.shape_checks import lengths_of_texts


@dataclass(frozen=True)
class CircularTube(ByAxis):
    """Circular tube.

    Attributes
    ----------
    diameter
        Outer diameter [m].
    thickness
        Wall thickness, less than half the diameter [m].

    Raises
    ------
    InputError
        With every dimension that cannot be accepted.

    References
    ----------
    docs/theory/sections.md.  Verified in tests/verification/section/test_tube_sections.py.
    """

    kind: ClassVar[str] = "circular_tube"

    diameter: PositiveLength
    thickness: PositiveLength

    def __post_init__(self) -> None:
        lengths_of_texts(self)
        problems = not_positive(
            {"diameter": self.diameter, "thickness": self.thickness}, "give the outer diameter"
        )
        if not problems and self.thickness >= self.diameter / 2.0:
            problems.append(
                Problem(
                    "the wall is not thinner than half the diameter",
                    in_mm(self.thickness),
                    f"< {in_mm(self.diameter / 2.0)}",
                    "give a thinner wall, or a larger section",
                    "thickness",
                )
            )
        if problems:
            raise InputError(problems)

    @property
    def title(self) -> str:
        """One line for people."""
        return f"circular tube {1e3 * self.diameter:g} x {1e3 * self.thickness:g} mm"

    @property
    def inner_diameter(self) -> float:
        """Diameter less two walls [m]."""
        return self.diameter - 2.0 * self.thickness

    @property
    def area(self) -> float:
        """Area of the metal [m^2]."""
        return math.pi / 4.0 * (self.diameter**2 - self.inner_diameter**2)

    @property
    def torsion_constant(self) -> float:
        """Polar second moment, exact for a circular tube [m^4]."""
        return math.pi / 32.0 * (self.diameter**4 - self.inner_diameter**4)

    def second_moment(self, axis: Axis) -> float:
        """Second moment of area, the same about any axis [m^4]."""
        checked_axis(axis)
        return math.pi / 64.0 * (self.diameter**4 - self.inner_diameter**4)

    def elastic_section_modulus(self, axis: Axis) -> float:
        """Second moment over the outer radius [m^3]."""
        return 2.0 * self.second_moment(axis) / self.diameter

    def plastic_section_modulus(self, axis: Axis) -> float:
        """(D^3 - d^3)/6 [m^3]."""
        checked_axis(axis)
        return (self.diameter**3 - self.inner_diameter**3) / 6.0

    def flange_width(self, axis: Axis) -> float:
        """Outer diameter: the width that a fold crosses [m]."""
        checked_axis(axis)
        return self.diameter

    def bending_depth(self, axis: Axis) -> float:
        """Outer diameter [m]."""
        checked_axis(axis)
        return self.diameter

    def turned(self, axis: Axis) -> CircularTube:
        """Return the tube itself: it looks the same about every axis."""
        checked_axis(axis)
        return self

    def mass_per_length(self, density: float) -> float:
        """Mass per length [kg/m] at a density [kg/m^3]."""
        return self.area * density

    def outline(self) -> Floats:
        """Mid-line polygon (y, z) [m], shape (n, 2), counter-clockwise."""
        return circle(self.diameter - self.thickness)

    def outer_outline(self) -> Floats:
        """Polygon of the outer surface (y, z) [m], shape (n, 2)."""
        return circle(self.diameter)

    def inner_outline(self) -> Floats:
        """Polygon of the inner surface (y, z) [m], shape (n, 2)."""
        return circle(self.inner_diameter)


SHAPE = Shape(CircularTube, (Example("50x2 mm"),))
