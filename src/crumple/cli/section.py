"""`crumple section SECTION`: the properties of a cross-section, and its capacity in a material."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crumple.cli.console.named import MATERIAL_HELP, SECTION_HELP

if TYPE_CHECKING:
    from rich.console import Console

    from crumple.material import Material
    from crumple.section import MomentCapacity, Section, WalledSection

Row = tuple[str, str]


def section(
    section: Annotated[str, typer.Argument(help=SECTION_HELP, show_default=False)],
    *,
    material: Annotated[str | None, typer.Option(help=MATERIAL_HELP)] = None,
    angle: Annotated[
        str | None, typer.Option(help="A further bending axis: its angle from y towards z, as '30 deg'.")
    ] = None,
    axial: Annotated[
        str, typer.Option(help="Axial force at the centroid, tension positive, as '-20 kN'.")
    ] = "0 N",
    figure: Annotated[Path | None, typer.Option(help="Write a drawing to this SVG file.")] = None,
) -> None:
    """Print the properties of a cross-section. With a material also its mass and its capacity."""
    from rich.console import Console
    from rich.text import Text

    from crumple.cli.console.named import material_of, quantity_of, section_of
    from crumple.errors import InputError, Problem
    from crumple.section import walls_of

    shape = section_of(section)
    metal, assumed = material_of(material) if material else (None, [])
    turned = None if angle is None else quantity_of("--angle", angle, "rad")
    force = quantity_of("--axial", axial, "N")
    if force and metal is None:
        raise InputError(Problem("an axial force needs a material", axial, "", "add --material", "--axial"))
    walled = walls_of(shape)
    capacities = _capacities(shape, metal, turned, force) if metal else {}
    console = Console(highlight=False)
    console.print(Text(shape.title, style="bold"))
    _show(console, _geometry(shape, walled, turned))
    if any(wall.material is not None for wall in walled.walls):
        console.print(
            "Properties are those of the geometry, independent of the materials of its walls.", style="dim"
        )
    if metal is not None:
        _show(console, _strength(shape, metal))
        _show_capacities(console, capacities, force)
    warnings = [text for capacity in capacities.values() for text in capacity.warnings]
    for text in dict.fromkeys([*walled.warnings, *warnings]):
        console.print(Text(f"Warning: {text}", style="yellow"))
    for text in assumed:
        console.print(Text(f"Assumed: {text}"))
    if figure is not None:
        from crumple.report.figures.section_figure import section_figure

        figure.write_text(section_figure(shape, metal), encoding="utf-8")
        console.print(f"Figure: {figure}", soft_wrap=True, markup=False)


def _geometry(shape: Section, walled: WalledSection, angle: float | None) -> list[Row]:
    """Properties of the shape alone."""
    from crumple.units import format_quantity

    found = walled.properties
    rows = [("Area", format_quantity(shape.area, "m^2", 5))]
    if shape is walled:
        rows.append(("Centroid y, z in the section's own coordinates", _point(found.centroid, walled)))
    for axis in ("y", "z"):
        rows += [
            (f"Second moment of area about {axis}", format_quantity(shape.second_moment(axis), "m^4", 5)),
            (
                f"Elastic section modulus about {axis}",
                format_quantity(shape.elastic_section_modulus(axis), "m^3", 5),
            ),
            (
                f"Plastic section modulus about {axis}",
                format_quantity(shape.plastic_section_modulus(axis), "m^3", 5),
            ),
        ]
    if angle is not None:
        name = format_quantity(angle, "rad", 4)
        rows += [
            (f"Second moment of area about {name}", format_quantity(walled.second_moment(angle), "m^4", 5)),
            (
                f"Elastic section modulus about {name}",
                format_quantity(walled.elastic_section_modulus(angle), "m^3", 5),
            ),
            (
                f"Plastic section modulus about {name}",
                format_quantity(walled.plastic_section_modulus(angle), "m^3", 5),
            ),
        ]
    high, low = found.principal_moments
    warping = walled.warping_constant
    # rounding error of a section that does not warp
    if warping < 1e-9 * found.area**3:
        warping = 0.0
    return [
        *rows,
        ("Product moment of area", _rounded(found.product_moment, high, "m^4")),
        ("Principal axis, from y towards z", _rounded(found.principal_angle, 1.0, "rad")),
        ("Principal second moments", f"{format_quantity(high, 'm^4', 5)}, {format_quantity(low, 'm^4', 5)}"),
        ("Shear centre y, z from the centroid", _point(walled.shear_centre, walled)),
        ("Torsion constant", format_quantity(shape.torsion_constant, "m^4", 5)),
        ("Warping constant", format_quantity(warping, "m^6", 5)),
    ]


def _strength(shape: Section, metal: Material) -> list[Row]:
    """Mass and capacity of the whole section, and the error of the fitted interaction."""
    from crumple.section import fitted_interaction, plastic_interaction
    from crumple.units import format_quantity

    interaction = plastic_interaction(shape, metal)
    fit = fitted_interaction(interaction)
    return [
        ("Mass per length", format_quantity(shape.mass_per_length(metal.density), "kg/m", 5)),
        ("Squash force", format_quantity(interaction.squash_force, "N", 5)),
        ("Plastic torque", format_quantity(interaction.plastic_torque, "N*m", 5)),
        ("Fit of the N-My-Mz-T interaction", f"error {fit.error:.1%} at most, {fit.mean_error:.1%} mean"),
    ]


def _capacities(
    shape: Section, metal: Material, angle: float | None, force: float
) -> dict[str, MomentCapacity]:
    """Moment capacities by what the table calls their axis and sense."""
    from crumple.section import moment_capacity
    from crumple.units import format_quantity

    axes: dict[str, float] = {"y": 0.0, "z": math.pi / 2.0}
    if angle is not None:
        axes[f"({format_quantity(angle, 'rad', 4)})"] = angle
    return {
        f"{'+' if sense > 0 else '-'}{name}": moment_capacity(
            shape, metal, axis, sense=sense, axial_force=force
        )
        for name, axis in axes.items()
        for sense in (1, -1)
    }


def _show_capacities(console: Console, capacities: dict[str, MomentCapacity], force: float) -> None:
    from rich.table import Table
    from rich.text import Text

    from crumple.cli.console.columns import in_one_unit
    from crumple.units import format_quantity

    every = list(capacities.values())
    columns = ("moment", "elastic_moment", "plastic_moment", "effective_moment")
    unit, texts = in_one_unit([getattr(entry, name) for entry in every for name in columns], "N*m", 5)
    beside = f" with an axial force of {format_quantity(force, 'N', 5)}" if force else ""
    console.print(Text(f"Moment capacity{beside}, {unit}; +y stretches +z, +z stretches -y", style="bold"))
    table = Table()
    for head in ("About", "Capacity", "Elastic", "Plastic", "Effective"):
        table.add_column(head, justify="left" if head == "About" else "right")
    table.add_column("How")
    for index, (name, entry) in enumerate(capacities.items()):
        table.add_row(name, *texts[4 * index : 4 * index + 4], Text(entry.regime))
    console.print(table)
    console.print(Text(f"Rules: {every[0].basis}", style="dim"))


def _show(console: Console, rows: list[Row]) -> None:
    from rich.table import Table

    table = Table(show_header=False)
    table.add_column()
    table.add_column(justify="right")
    for row in rows:
        table.add_row(*row)
    console.print(table)


def _point(point: tuple[float, float], walled: WalledSection) -> str:
    size = max(walled.bending_depth("y"), walled.bending_depth("z"))
    return ", ".join(_rounded(part, size, "m") for part in point)


def _rounded(value: float, size: float, unit: str) -> str:
    """Readable value; zero if it is only rounding error compared with a reference size."""
    from crumple.units import format_quantity

    return format_quantity(0.0 if abs(value) < 1e-9 * size else value, unit, 5)
