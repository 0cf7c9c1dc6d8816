"""`crumple hinge SECTION --material ...`: collapse laws of a section, printed and drawn side by side."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from crumple.cli.console.named import MATERIAL_HELP, SECTION_HELP

if TYPE_CHECKING:
    from rich.console import Console

    from crumple.hinge import HingeLaw
    from crumple.material import Material
    from crumple.numeric.arrays import Floats
    from crumple.section import Axis, Section

ROTATIONS = (0, 1, 2, 5, 10, 15, 20, 25, 30, 40, 50, 60, 75, 90)
"""Rotations of the table [deg], up to the largest that is requested."""
LARGEST_CURVE = 2_000_000
"""Largest size of a measured curve [bytes]."""
LARGEST = 3.1416
"""Largest rotation shown [rad]: half a turn, with room for rounding."""


def hinge(
    section: Annotated[str, typer.Argument(help=SECTION_HELP, show_default=False)],
    *,
    material: Annotated[str, typer.Option(help=MATERIAL_HELP, show_default=False)],
    axis: Annotated[
        str, typer.Option(help="Bending axis y or z, along the moment vector; y compresses the width.")
    ] = "y",
    law: Annotated[
        list[str] | None,
        typer.Option(help="Law to show; repeat for several. Without it every law that applies."),
    ] = None,
    curve: Annotated[
        list[Path] | None, typer.Option(help="CSV of a measured curve: rotation [deg], moment [N*m]; repeat.")
    ] = None,
    to: Annotated[str, typer.Option(help="Largest rotation.")] = "45 deg",
    figure: Annotated[Path | None, typer.Option(help="Write the drawing to this SVG file too.")] = None,
    save: Annotated[
        Path | None, typer.Option(help="Write the law to this law file (YAML): one law, by --law or --curve.")
    ] = None,
) -> None:
    """Print and draw collapse laws side by side. Moment against rotation, source and range of each law."""
    import numpy as np
    from rich.console import Console

    from crumple.cli.console.named import material_of, section_of
    from crumple.section.section import checked_axis

    shape = section_of(section)
    metal, assumed = material_of(material)
    rotation = np.linspace(0.0, _largest(to), 500)
    laws, left_out = _laws(shape, metal, checked_axis(axis), law)
    laws |= _measured(shape, metal, checked_axis(axis), curve or [])
    title = f"{shape.title}, bending about {axis}"
    console = Console(highlight=False)
    console.print(title, style="bold")
    _show_table(console, laws, float(rotation[-1]))
    _show_chart(console, laws, rotation)
    _show_sources(console, laws)
    for note in [*left_out, *(f"Assumed: {text}" for text in assumed)]:
        console.print(note, style="dim", markup=False)
    if figure is not None:
        from crumple.cli.console.law_figure import law_figure

        figure.write_text(law_figure(laws, rotation, title), encoding="utf-8")
        console.print(f"Figure: {figure}", soft_wrap=True, markup=False)
    if save is not None:
        save.write_text(_law_file(laws, shape, metal, axis), encoding="utf-8")
        console.print(f"Law file: {save}", soft_wrap=True, markup=False)


def _largest(text: str) -> float:
    from crumple.cli.console.named import quantity_of
    from crumple.errors import InputError, Problem

    rotation = quantity_of("--to", text, "rad")
    if not 0.0 < rotation <= LARGEST:
        what, allowed = "the largest rotation is out of range", "above 0 deg, at most 180 deg"
        raise InputError(Problem(what, text, allowed, "", "--to"))
    return rotation


def _laws(
    shape: Section, metal: Material, axis: Axis, wanted: list[str] | None
) -> tuple[dict[str, HingeLaw], list[str]]:
    """Laws to show, and a sentence for each that does not apply; a law requested by name must apply."""
    from crumple.cli.console.named import option
    from crumple.errors import InputError, Problem
    from crumple.hinge import build_law, fitting_laws, law_types, needs_curve

    for name in wanted or []:
        if name in law_types() and needs_curve(name):
            allowed = ", ".join(other for other in law_types() if not needs_curve(other))
            todo = "show a measured curve by --curve FILE"
            raise InputError(
                Problem("this law comes from a file, not from the section", name, allowed, todo, "--law")
            )
    if wanted:
        with option("--law"):
            return {name: build_law(name, shape, metal, axis) for name in wanted}, []
    laws, refused = fitting_laws(shape, metal, axis)
    return laws, [f"Not shown: {name}, {error.problems[0].what}" for name, error in refused.items()]


def _measured(shape: Section, metal: Material, axis: Axis, files: list[Path]) -> dict[str, HingeLaw]:
    """Measured curves as laws, by the names of their files."""
    from crumple.errors import InputError, Problem
    from crumple.hinge import build_law, read_table

    laws = {}
    for file in files:
        if file.stat().st_size > LARGEST_CURVE:
            raise InputError(Problem("the curve file is too large", str(file), f"{LARGEST_CURVE / 1e6:g} MB"))
        text = file.read_text(encoding="utf-8", errors="replace")
        rotation, moment = read_table(text, str(file))
        _refuse_rows(rotation, moment, text, str(file))
        laws[file.name] = build_law("table", shape, metal, axis, rotation=rotation, moment=moment)
    return laws


def _refuse_rows(rotation: Floats, moment: Floats, text: str, file: str) -> None:
    """Refuse the first row of a measured curve that no law can have, with its line."""
    from crumple.errors import InputError, Problem
    from crumple.units import format_quantity

    lines = [n for n, line in enumerate(text.splitlines(), 1) if line.strip() and line.lstrip()[0] != "#"]
    for i, (angle, value) in enumerate(zip(rotation.tolist(), moment.tolist(), strict=True)):
        turned, carried = format_quantity(angle, "rad"), format_quantity(value, "N*m")
        problem = None
        if i == 0 and value == 0.0:
            what, allowed = (
                "the curve begins with its elastic rise",
                "plastic rotation, from 0, with a moment",
            )
            todo = "take off the elastic rise, or give the file to a law 'type: measured' of an input file"
            problem = Problem(what, carried, allowed, todo)
        elif value <= 0.0:
            todo = (
                "keep a small residual moment; give the other sense as positive numbers in a file of its own"
            )
            problem = Problem("the moment is not positive", carried, "more than 0 N m", todo)
        elif i > 0 and angle <= rotation[i - 1]:
            came = f"{turned} after {format_quantity(float(rotation[i - 1]), 'rad')}"
            allowed, todo = (
                "each rotation larger than the one before",
                "sort the rows, leave out repeated ones",
            )
            problem = Problem("the rotations do not increase", came, allowed, todo)
        elif angle > LARGEST:
            todo = "check the unit in the head of the file"
            problem = Problem("the rotation is more than half a turn", turned, "at most 180 deg", todo)
        if problem is not None:
            raise InputError(replace(problem, where="--curve", file=file, line=lines[i + 1]))


def _law_file(laws: dict[str, HingeLaw], shape: Section, metal: Material, axis: str) -> str:
    """Text of the law file of the only law that is shown."""
    from crumple.errors import InputError, Problem
    from crumple.hinge import Trust, stored_law, write_law
    from crumple.version import __version__

    if len(laws) != 1:
        todo = "name one with --law"
        raise InputError(Problem("a law file holds one law", ", ".join(laws), "one law", todo, "--save"))
    ((name, law),) = laws.items()
    methods = {Trust.MEASURED: "measured", Trust.COMPUTED: "library", Trust.ESTIMATED: "estimate"}
    origin = {
        "method": methods.get(law.source.trust, "formula"),
        "section": shape.title,
        "axis": axis,
        "material": f"yield {metal.yield_stress / 1e6:g} MPa, flow stress {metal.flow_stress / 1e6:g} MPa",
        "made_by": f"crumple {__version__}, law {name}",
    }
    return write_law(stored_law(law, origin))


def _show_table(console: Console, laws: dict[str, HingeLaw], largest: float) -> None:
    import numpy as np
    from rich.markup import escape
    from rich.table import Table

    from crumple.cli.console.columns import in_one_unit

    rows = [angle for angle in ROTATIONS if np.deg2rad(angle) < largest * (1.0 - 1e-9)]
    angles = np.array([*rows, np.rad2deg(largest)])
    moments = np.array([entry.moment_capacity(np.deg2rad(angles)) for entry in laws.values()])
    unit, texts = in_one_unit(moments.ravel().tolist(), "N*m")
    table = Table()
    table.add_column("Rotation, deg", justify="right")
    for name in laws:
        table.add_column(escape(f"{name}, {unit}"), justify="right")
    for index, angle in enumerate(angles):
        table.add_row(f"{angle:g}", *texts[index :: angles.size])
    console.print(table)


def _show_chart(console: Console, laws: dict[str, HingeLaw], rotation: Floats) -> None:
    from rich.text import Text

    from crumple.cli.console.chart import COLOURS, MARKS, chart
    from crumple.units import format_quantity

    curves = [entry.moment_capacity(rotation) for entry in laws.values()]
    top = max(float(curve.max()) for curve in curves)
    ends = ("0", format_quantity(float(rotation[-1]), "rad"))
    console.print(chart(rotation, curves, ends, format_quantity(top, "N*m")))
    legend = Text()
    for mark, colour, name in zip(MARKS, COLOURS, laws, strict=False):
        legend.append(f"  {mark} {name}", style=colour)
    console.print(legend)


def _show_sources(console: Console, laws: dict[str, HingeLaw]) -> None:
    from rich.text import Text

    for name, entry in laws.items():
        validity = entry.validity
        console.print(Text(f"\n{name}: {entry.title}", style="bold"))
        console.print(Text(f"Source: {entry.source.citation} ({entry.source.trust.value})"))
        if entry.source.note:
            console.print(Text(f"Note: {entry.source.note}"))
        reach = "" if validity.rotation_max > LARGEST else f"up to {_angle(validity.rotation_max)}; "
        console.print(Text(f"Range: {reach}{validity.basis}"))
        if entry.jamming_angle is not None:
            console.print(Text(f"Walls touch at {_angle(entry.jamming_angle)}"))
        for warning in validity.warnings:
            console.print(Text(f"Warning: {warning}", style="yellow"))


def _angle(rotation: float) -> str:
    from crumple.units import format_quantity

    return format_quantity(rotation, "rad", 3)
