"""Interface of all cross-sections.

Coordinates (y, z) are the member's local axes with the origin in the centroid.  "Bending about y" has
its moment vector along y: the compression flange runs along y, the depth of bending along z.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Literal, Protocol, get_args, runtime_checkable

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats

Axis = Literal["y", "z"]
AXES: tuple[Axis, ...] = get_args(Axis)


@runtime_checkable
class Section(Protocol):
    """A thin-walled cross-section; lengths in metres, frozen.

    Methods that take an axis mean bending with the moment vector along that axis.
    """

    def __hash__(self) -> int:
        """By its dimensions."""
        ...

    @property
    def kind(self) -> str:
        """Name of the shape as the input writes it."""
        ...

    @property
    def title(self) -> str:
        """One line for people, with dimensions in mm."""
        ...

    @property
    def thickness(self) -> float:
        """Wall thickness [m]."""
        ...

    @property
    def area(self) -> float:
        """Area of the metal [m^2]."""
        ...

    @property
    def torsion_constant(self) -> float:
        """Saint-Venant torsion constant J [m^4]: twist per length is torque / (G J)."""
        ...

    def second_moment(self, axis: Axis) -> float:
        """Second moment of area about an axis [m^4]."""
        ...

    def elastic_section_modulus(self, axis: Axis) -> float:
        """Second moment over the distance of the extreme fibre [m^3]."""
        ...

    def plastic_section_modulus(self, axis: Axis) -> float:
        """Sum of the absolute first moments on both sides of the equal-area axis [m^3]."""
        ...

    def flange_width(self, axis: Axis) -> float:
        """Outer width of the compression flange in bending about an axis [m]."""
        ...

    def bending_depth(self, axis: Axis) -> float:
        """Outer depth of the section in bending about an axis [m]."""
        ...

    def mass_per_length(self, density: float) -> float:
        """Mass per length [kg/m] at a density [kg/m^3]."""
        ...

    def outline(self) -> Floats:
        """Mid-line polygon (y, z) [m], shape (n, 2), counter-clockwise, not repeating the first point."""
        ...

    def outer_outline(self) -> Floats:
        """Polygon of the outer surface, like `outline`."""
        ...

    def inner_outline(self) -> Floats:
        """Polygon of the inner surface, like `outline`."""
        ...


class ByAxis(ABC):
    """Adds the properties about y and z by name to a section that has them about any axis."""

    @abstractmethod
    def second_moment(self, axis: Axis) -> float:
        """Second moment of area about an axis [m^4]."""

    @abstractmethod
    def elastic_section_modulus(self, axis: Axis) -> float:
        """Second moment over the distance of the extreme fibre [m^3]."""

    @abstractmethod
    def plastic_section_modulus(self, axis: Axis) -> float:
        """Sum of the absolute first moments on both sides of the equal-area axis [m^3]."""

    @property
    def second_moment_y(self) -> float:
        """Second moment of area about y [m^4]."""
        return self.second_moment("y")

    @property
    def second_moment_z(self) -> float:
        """Second moment of area about z [m^4]."""
        return self.second_moment("z")

    @property
    def elastic_section_modulus_y(self) -> float:
        """Elastic section modulus about y [m^3]."""
        return self.elastic_section_modulus("y")

    @property
    def elastic_section_modulus_z(self) -> float:
        """Elastic section modulus about z [m^3]."""
        return self.elastic_section_modulus("z")

    @property
    def plastic_section_modulus_y(self) -> float:
        """Plastic section modulus about y [m^3]."""
        return self.plastic_section_modulus("y")

    @property
    def plastic_section_modulus_z(self) -> float:
        """Plastic section modulus about z [m^3]."""
        return self.plastic_section_modulus("z")


def checked_axis(axis: str) -> Axis:
    """Return the axis itself, or refuse it.

    Raises
    ------
    InputError
        If it is neither "y" nor "z".
    """
    for known in AXES:
        if axis == known:
            return known
    raise InputError(
        Problem(
            "unknown bending axis", repr(axis), "y or z", "name the axis along which the moment vector points"
        )
    )


def not_positive(lengths: Mapping[str, float], todo: str) -> list[Problem]:
    """Problems of lengths [m] that are not positive and finite."""
    return [
        Problem(f"{name.replace('_', ' ')} must be positive", in_mm(length), "> 0 mm", todo, name)
        for name, length in lengths.items()
        if not (math.isfinite(length) and length > 0.0)
    ]


def in_mm(length: float) -> str:
    """A length [m] as text in mm."""
    return f"{1e3 * length:.6g} mm"
