"""Cross-sections as the description gives them."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Tag, model_validator

from crumple import section
from crumple.errors import InputError
from crumple.structure.quantity import NonNegativeLength, PositiveLength
from crumple.structure.spec import Spec, refuse, type_tag


class _SectionSpec(Spec):
    @model_validator(mode="after")
    def _consistent(self) -> _SectionSpec:
        try:
            self.section()
        except InputError as error:
            refuse("the section is not consistent", problems=error.problems)
        return self

    def section(self) -> section.Section:
        """Section of the physics room."""
        raise NotImplementedError


class RectangularTubeSpec(_SectionSpec):
    """Rectangular tube: width along local y, depth along local z, both outer dimensions."""

    type: Literal["rectangular_tube"] = "rectangular_tube"
    """Kind of section."""
    width: PositiveLength
    """Outer dimension along local y."""
    depth: PositiveLength
    """Outer dimension along local z."""
    thickness: PositiveLength
    """Wall thickness, less than half the smaller side."""
    corner_radius: NonNegativeLength = 0.0
    """Outer corner radius."""

    def section(self) -> section.RectangularTube:
        """Section of the physics room."""
        return section.RectangularTube(self.width, self.depth, self.thickness, self.corner_radius)


class CircularTubeSpec(_SectionSpec):
    """Circular tube."""

    type: Literal["circular_tube"] = "circular_tube"
    """Kind of section."""
    diameter: PositiveLength
    """Outer diameter."""
    thickness: PositiveLength
    """Wall thickness, less than half the diameter."""

    def section(self) -> section.CircularTube:
        """Section of the physics room."""
        return section.CircularTube(self.diameter, self.thickness)


def _from_section(given: Any) -> Any:
    """Take a section of the physics room too, where the structure is built in Python."""
    if isinstance(given, section.RectangularTube | section.CircularTube):
        return {"type": given.kind, **asdict(given)}
    return given


SectionSpec = Annotated[
    Annotated[RectangularTubeSpec, Tag("(type=rectangular_tube)")]
    | Annotated[CircularTubeSpec, Tag("(type=circular_tube)")],
    Discriminator(type_tag),
    BeforeValidator(_from_section),
]
"""Any section; ``type`` says which."""
