"""Sections of several sheets: closed hat with spot-welded flanges, tube with inner walls."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from crumple.errors import InputError, Problem
from crumple.material import Material
from crumple.section.section import in_mm, not_positive
from crumple.section.shapes.open_sections import hat_wall
from crumple.section.shapes.shape_checks import in_title, must_be_below, must_not_be_negative
from crumple.section.wall import Wall, Weld
from crumple.section.walled import WalledSection


@dataclass(frozen=True)
class ClosedHat(WalledSection):
    """Hat with a plate under its flanges, spot-welded along the middle of each flange.

    Attributes
    ----------
    width
        Outer width of the crown along y [m].
    depth
        Outer depth of the hat along z, without the plate [m].
    thickness
        Of the hat [m].
    flange
        Width of each flange beyond the outer face of its web [m].
    corner_radius
        Outer radius of the bends [m].
    plate_thickness
        Of the plate [m]; 0: that of the hat.  The plate is as wide as the hat with its flanges.
    hat_material, plate_material
        Metals of the sheets, or None for the member's.

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

    width: float
    depth: float
    thickness: float
    flange: float
    corner_radius: float = 0.0
    plate_thickness: float = 0.0
    hat_material: Material | None = None
    plate_material: Material | None = None

    def __post_init__(self) -> None:
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


@dataclass(frozen=True)
class MultiCellTube(WalledSection):
    """Rectangular tube divided by inner walls into equal cells, as extrusions are.

    Attributes
    ----------
    width, depth
        Outer dimensions along y and z [m].
    thickness
        Of the outer walls [m].
    columns, rows
        Cells beside each other along y, above each other along z; at least 1.
    inner_thickness
        Of the inner walls [m]; 0: that of the outer ones.
    corner_radius
        Outer radius of the four outer corners [m].

    Raises
    ------
    InputError
        With every dimension that cannot be accepted.

    References
    ----------
    docs/theory/thin_walled_sections.md.  Verified in tests/verification/section/test_section_properties.py.
    """

    kind: ClassVar[str] = "multi_cell_tube"

    width: float
    depth: float
    thickness: float
    columns: int = 2
    rows: int = 1
    inner_thickness: float = 0.0
    corner_radius: float = 0.0

    def __post_init__(self) -> None:
        problems = not_positive(
            {"width": self.width, "depth": self.depth, "thickness": self.thickness}, "give outer dimensions"
        )
        extras = {"corner_radius": self.corner_radius, "inner_thickness": self.inner_thickness}
        problems += must_not_be_negative(extras)
        for name, count in (("columns", self.columns), ("rows", self.rows)):
            if not (isinstance(count, int) and 1 <= count <= 20):
                todo = "give the number of cells in that direction"
                problems.append(Problem(f"{name} is out of range", f"{count}", "1 to 20", todo, name))
        problems = problems or must_be_below(
            "thickness", self.thickness, min(self.width, self.depth) / 2.0, "half the smaller side"
        )
        half = min(self.width, self.depth) / 2.0
        if not problems and self.corner_radius > half:
            todo = "give the outer radius of the corner"
            problems.append(
                Problem(
                    "the corner radius does not fit the section",
                    in_mm(self.corner_radius),
                    f"0 mm to {in_mm(half)} (outer radius)",
                    todo,
                    "corner_radius",
                )
            )
        if problems:
            raise InputError(problems)
        super().__post_init__()

    @property
    def title(self) -> str:
        """One line for people."""
        extras = {"inner walls": self.inner_thickness, "corner radius": self.corner_radius}
        cells = f"tube of {self.columns} x {self.rows} cells"
        return in_title(cells, (self.width, self.depth, self.thickness), extras)

    @cached_property
    def walls(self) -> tuple[Wall, ...]:
        """Outer wall, inner walls along z, then pieces of inner walls along y; origin in the middle."""
        y, z = (self.width - self.thickness) / 2.0, (self.depth - self.thickness) / 2.0
        inner = self.inner_thickness or self.thickness
        across = [-y + 2.0 * y * k / self.columns for k in range(self.columns + 1)]
        up = [-z + 2.0 * z * k / self.rows for k in range(self.rows + 1)]
        outer = Wall(
            ((-y, -z), (y, -z), (y, z), (-y, z)), self.thickness, self.corner_radius, True, name="outer wall"
        )
        upright = [
            Wall(((at, -z), (at, z)), inner, name=f"inner wall {k}")
            for k, at in enumerate(across[1:-1], start=1)
        ]
        # the pieces between the uprights meet on them
        level = [
            Wall(((across[i], at), (across[i + 1], at)), inner, name=f"inner wall {i},{k}")
            for k, at in enumerate(up[1:-1])
            for i in range(self.columns)
        ]
        return (outer, *upright, *level)
