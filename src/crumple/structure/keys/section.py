"""Cross-sections as the description gives them."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag

from crumple import section
from crumple.structure.keys.any_section import AnySection, MaterialReference, Metal
from crumple.structure.keys.walls import WallSectionSpec
from crumple.structure.schema.quantity import NonNegativeLength, PositiveLength
from crumple.structure.schema.spec import type_tag


class RectangularTubeSpec(AnySection):
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

    def shape(self, metal: Metal) -> section.RectangularTube:
        """Build the section."""
        return section.RectangularTube(self.width, self.depth, self.thickness, self.corner_radius)


class SquareTubeSpec(AnySection):
    """Square tube."""

    type: Literal["square_tube"] = "square_tube"
    """Kind of section."""
    side: PositiveLength
    """Outer dimension along local y and z."""
    thickness: PositiveLength
    """Wall thickness, less than half the side."""
    corner_radius: NonNegativeLength = 0.0
    """Outer corner radius."""

    def shape(self, metal: Metal) -> section.RectangularTube:
        """Build the section."""
        return section.square_tube(self.side, self.thickness, self.corner_radius)


class CircularTubeSpec(AnySection):
    """Circular tube."""

    type: Literal["circular_tube"] = "circular_tube"
    """Kind of section."""
    diameter: PositiveLength
    """Outer diameter."""
    thickness: PositiveLength
    """Wall thickness, less than half the diameter."""

    def shape(self, metal: Metal) -> section.CircularTube:
        """Build the section."""
        return section.CircularTube(self.diameter, self.thickness)


class ChannelSpec(AnySection):
    """Channel, or C with lips: web along local z, flanges towards +y."""

    type: Literal["channel"] = "channel"
    """Kind of section."""
    width: PositiveLength
    """Outer dimension of the flanges along local y."""
    depth: PositiveLength
    """Outer dimension of the web along local z."""
    thickness: PositiveLength
    """Wall thickness."""
    corner_radius: NonNegativeLength = 0.0
    """Outer radius of the bends."""
    lip: NonNegativeLength = 0.0
    """Outer dimension along z of the lips at the ends of the flanges; 0: none."""

    def shape(self, metal: Metal) -> section.Section:
        """Build the section."""
        return section.Channel(self.width, self.depth, self.thickness, self.corner_radius, self.lip)


class AngleSpec(AnySection):
    """Angle of two legs, one along local y and one along local z."""

    type: Literal["angle"] = "angle"
    """Kind of section."""
    width: PositiveLength
    """Outer dimension of the leg along local y."""
    depth: PositiveLength
    """Outer dimension of the leg along local z."""
    thickness: PositiveLength
    """Wall thickness."""
    corner_radius: NonNegativeLength = 0.0
    """Outer radius of the bend."""

    def shape(self, metal: Metal) -> section.Section:
        """Build the section."""
        return section.Angle(self.width, self.depth, self.thickness, self.corner_radius)


class HatSpec(AnySection):
    """Hat: crown along local y at the top, flanges at the bottom pointing outwards, open below."""

    type: Literal["hat"] = "hat"
    """Kind of section."""
    width: PositiveLength
    """Outer dimension of the crown along local y."""
    depth: PositiveLength
    """Outer dimension along local z."""
    thickness: PositiveLength
    """Wall thickness."""
    flange: PositiveLength
    """Width of each flange beyond the outer face of its web."""
    corner_radius: NonNegativeLength = 0.0
    """Outer radius of the bends."""

    def shape(self, metal: Metal) -> section.Section:
        """Build the section."""
        return section.Hat(self.width, self.depth, self.thickness, self.flange, self.corner_radius)


class ClosedHatSpec(AnySection):
    """Hat closed by a plate under its flanges, spot-welded along the middle of each flange."""

    type: Literal["closed_hat"] = "closed_hat"
    """Kind of section."""
    width: PositiveLength
    """Outer dimension of the crown along local y."""
    depth: PositiveLength
    """Outer dimension of the hat along local z, without the plate."""
    thickness: PositiveLength
    """Thickness of the hat."""
    flange: PositiveLength
    """Width of each flange beyond the outer face of its web."""
    corner_radius: NonNegativeLength = 0.0
    """Outer radius of the bends."""
    plate_thickness: NonNegativeLength = 0.0
    """Thickness of the plate; 0: that of the hat."""
    hat_material: MaterialReference | None = None
    """Metal of the hat; without it the member's."""
    plate_material: MaterialReference | None = None
    """Metal of the plate; without it the member's."""

    def references(self) -> dict[str, MaterialReference | None]:
        """Metals of the two sheets."""
        return {"hat_material": self.hat_material, "plate_material": self.plate_material}

    def shape(self, metal: Metal) -> section.Section:
        """Build the section."""
        return section.ClosedHat(
            self.width,
            self.depth,
            self.thickness,
            self.flange,
            corner_radius=self.corner_radius,
            plate_thickness=self.plate_thickness,
            hat_material=metal(self.hat_material),
            plate_material=metal(self.plate_material),
        )


Count = Annotated[int, Field(ge=1, le=20, strict=True)]


class MultiCellTubeSpec(AnySection):
    """Rectangular tube divided by inner walls into equal cells."""

    type: Literal["multi_cell_tube"] = "multi_cell_tube"
    """Kind of section."""
    width: PositiveLength
    """Outer dimension along local y."""
    depth: PositiveLength
    """Outer dimension along local z."""
    thickness: PositiveLength
    """Thickness of the outer walls."""
    columns: Count = 2
    """Cells beside each other along y, 1 to 20."""
    rows: Count = 1
    """Cells above each other along z, 1 to 20."""
    inner_thickness: NonNegativeLength = 0.0
    """Thickness of the inner walls; 0: that of the outer ones."""
    corner_radius: NonNegativeLength = 0.0
    """Outer radius of the four outer corners."""

    def shape(self, metal: Metal) -> section.Section:
        """Build the section."""
        return section.MultiCellTube(
            self.width,
            self.depth,
            self.thickness,
            columns=self.columns,
            rows=self.rows,
            inner_thickness=self.inner_thickness,
            corner_radius=self.corner_radius,
        )


def _from_section(given: Any) -> Any:
    """Take a section of the physics room too, where the structure is built in Python."""
    kind = getattr(given, "kind", None)
    if isinstance(given, type) or not is_dataclass(given) or not isinstance(kind, str):
        return given
    return {"type": kind, **_keys(given)}


def _keys(given: Any) -> dict[str, Any]:
    """Fields of a section, its walls and its welds as keys; metals stay what they are."""
    keys = {field.name: getattr(given, field.name) for field in fields(given)}
    for name in {"walls", "welds"} & set(keys):
        keys[name] = [_keys(part) for part in keys[name]]
    return keys


SectionSpec = Annotated[
    Annotated[RectangularTubeSpec, Tag("(type=rectangular_tube)")]
    | Annotated[SquareTubeSpec, Tag("(type=square_tube)")]
    | Annotated[CircularTubeSpec, Tag("(type=circular_tube)")]
    | Annotated[ChannelSpec, Tag("(type=channel)")]
    | Annotated[AngleSpec, Tag("(type=angle)")]
    | Annotated[HatSpec, Tag("(type=hat)")]
    | Annotated[ClosedHatSpec, Tag("(type=closed_hat)")]
    | Annotated[MultiCellTubeSpec, Tag("(type=multi_cell_tube)")]
    | Annotated[WallSectionSpec, Tag("(type=walls)")],
    Discriminator(type_tag),
    BeforeValidator(_from_section),
]
"""Any section; ``type`` says which."""
