"""`crumple section SECTION`: the properties of a cross-section."""

from __future__ import annotations

from typing import Annotated

import typer

from crumple.cli.named import MATERIAL_HELP, SECTION_HELP


def section(
    section: Annotated[str, typer.Argument(help=SECTION_HELP, show_default=False)],
    material: Annotated[str | None, typer.Option(help=MATERIAL_HELP)] = None,
) -> None:
    """Print the properties of a cross-section. With a material also its mass and plastic moments."""
    from rich.console import Console
    from rich.table import Table

    from crumple.cli.named import material_of, section_of
    from crumple.units import format_quantity

    shape = section_of(section)
    metal, assumed = material_of(material) if material else (None, [])
    rows = [("Area", shape.area, "m^2")]
    for axis in ("y", "z"):
        rows += [
            (f"Second moment of area about {axis}", shape.second_moment(axis), "m^4"),
            (f"Elastic section modulus about {axis}", shape.elastic_section_modulus(axis), "m^3"),
            (f"Plastic section modulus about {axis}", shape.plastic_section_modulus(axis), "m^3"),
        ]
    rows.append(("Torsion constant", shape.torsion_constant, "m^4"))
    if metal is not None:
        rows.append(("Mass per length", shape.mass_per_length(metal.density), "kg/m"))
        moments = [(axis, metal.yield_stress * shape.plastic_section_modulus(axis)) for axis in ("y", "z")]
        rows += [(f"Plastic moment about {axis}", moment, "N*m") for axis, moment in moments]
    console = Console(highlight=False)
    console.print(shape.title, style="bold")
    table = Table(show_header=False)
    table.add_column()
    table.add_column(justify="right")
    for name, value, unit in rows:
        table.add_row(name, format_quantity(value, unit, digits=5))
    console.print(table)
    for text in assumed:
        console.print(f"Assumed: {text}")
