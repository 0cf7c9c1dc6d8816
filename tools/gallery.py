"""Write the gallery: one picture per section type with its properties, laws and sources.

`python tools/gallery.py docs` writes docs/gallery.md and docs/gallery/*.svg.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from crumple.errors import InputError
from crumple.hinge import axial_law_types, build_axial_law, fitting_laws
from crumple.material import Material, grade, grade_material
from crumple.report.drawing.scales import display_unit, largest, spread
from crumple.report.drawing.style import (
    WIDTH,
    Line,
    add_axes,
    draw_lines,
    drawing,
    name_axes,
    new_figure,
    to_svg,
)
from crumple.report.figures.section_figure import draw_walls
from crumple.section import AXES, Axis, Section, moment_capacity, walls_of
from crumple.section.shapes.registry import SHAPES
from crumple.section.shapes.written import written_section

GRADE = "S355"
LARGEST_SVG = 60_000
"""Bytes of one picture; a page of nine stays quick to load."""
ROTATION = np.linspace(0.0, np.radians(45.0), 300)
HEAD = """# Gallery of sections

One picture per section type: the walls to scale (dot: centroid, cross: shear centre, thin lines: principal
axes) and every collapse law that applies to it, drawn faintly beyond its range of validity. Written
by `python tools/gallery.py docs`; a change by hand is lost. Material: {metal}.

The evidence for each law is described in its page under [theory](theory). Positive bending about y stretches
the upper side, and positive bending about z the left side."""


@dataclass(frozen=True)
class Exhibit:
    """One section: its file name, the section, and the axis and senses that its laws are drawn for."""

    key: str
    section: Section
    axis: Axis
    senses: tuple[int, ...]


EXHIBITS = tuple(
    Exhibit(one.name or kind, written_section(f"{kind} {one.text}"), one.axis, one.senses)
    for kind, shape in SHAPES.items()
    for one in shape.examples
)


def picture(exhibit: Exhibit, metal: Material) -> str:
    """Walls and laws side by side as SVG."""
    laws, _ = fitting_laws(exhibit.section, metal, exhibit.axis)
    curves = {
        (
            f"{name} {'+' if sense > 0 else '-'}" if len(exhibit.senses) > 1 else name,
            law,
        ): law.moment_capacity(ROTATION, sense)
        for name, law in laws.items()
        for sense in (exhibit.senses if name != "constant" else (1,))
    }
    unit, factor = display_unit("N*m", largest(list(curves.values())))
    with drawing():
        figure = new_figure(WIDTH, 2.7)
        draw_walls(add_axes(figure, 0.35, 0.42, 1.9, 1.9), walls_of(exhibit.section))
        axes = add_axes(figure, 2.95, 0.42, WIDTH - 2.95 - 1.15, 1.9)
        axes.set_xlim(0.0, 45.0)
        axes.set_ylim(*spread([curve / factor for curve in curves.values()]))
        name_axes(axes, "rotation, deg", f"moment about {exhibit.axis}, {unit}")
        lines = []
        for index, ((name, law), curve) in enumerate(curves.items()):
            angles, moment = np.rad2deg(ROTATION), curve / factor
            backed = np.where(law.validity.rotation_max >= ROTATION, moment, np.nan)
            lines += [Line(name, angles, moment, faint=True), Line(name, angles, backed, index)]
        draw_lines(axes, lines)
        return to_svg(figure, exhibit.key, f"{exhibit.section.title} and its collapse laws.") + "\n"


def _properties(exhibit: Exhibit, metal: Material) -> list[str]:
    section = exhibit.section
    rows = [
        f"| area | {1e6 * section.area:.1f} mm^2 |",
        f"| mass | {section.mass_per_length(metal.density):.3f} kg/m |",
        f"| torsion constant | {1e12 * section.torsion_constant:.4g} mm^4 |",
    ]
    for axis in AXES:
        rows.append(f"| second moment about {axis} | {1e12 * section.second_moment(axis):.4g} mm^4 |")
        for sense in (1, -1):
            most = moment_capacity(section, metal, axis, sense=sense)
            values = (most.elastic_moment, most.plastic_moment, most.effective_moment, most.moment)
            texts = " / ".join(f"{value:.0f}" for value in values)
            rows.append(
                f"| about {axis}, sense {sense:+d}: elastic / plastic / effective / capacity | {texts} N m |"
            )
    return ["| property | value |", "|---|---|", *rows]


def _laws(exhibit: Exhibit, metal: Material) -> list[str]:
    rows = []
    for name, law in fitting_laws(exhibit.section, metal, exhibit.axis)[0].items():
        reach = law.validity.rotation_max
        backed = "any rotation" if np.isinf(reach) else f"{np.degrees(reach):.1f} deg"
        band = law.validity.uncertainty
        rows.append(
            f"| `{name}` | {law.source.citation} ({law.source.trust.name.lower()}) | {backed} | "
            f"{'-' if band is None else f'{100 * band:.0f} %'} |"
        )
    table = ["| law | source (trust) | valid up to | band |", "|---|---|---|---|", *rows]
    crushing = []
    for name in axial_law_types():
        try:
            law = build_axial_law(name, exhibit.section, metal)
        except InputError:
            continue
        crushing.append(
            f"| `{name}` | {law.peak_force / 1e3:.1f} kN | {law.mean_crushing_force / 1e3:.1f} kN | "
            f"{law.effective_stroke:.2f} | {law.source.citation} ({law.source.trust.name.lower()}) |"
        )
    if crushing:
        head = ["| axial law | peak | mean | stroke | source (trust) |", "|---|---|---|---|---|"]
        table += ["", *head, *crushing]
    return table


def write_gallery(folder: Path) -> list[Path]:
    """Write the page and its pictures into a folder; every file that was written."""
    metal = grade_material(GRADE)
    pictures = folder / "gallery"
    pictures.mkdir(parents=True, exist_ok=True)
    page, written = [HEAD.format(metal=grade(GRADE).statement)], []
    for exhibit in EXHIBITS:
        file = pictures / f"{exhibit.key}.svg"
        svg = picture(exhibit, metal)
        if len(svg.encode()) > LARGEST_SVG:
            raise SystemExit(f"{file.name} has {len(svg)} bytes, more than {LARGEST_SVG}")
        file.write_text(svg, encoding="utf-8")
        title = exhibit.section.title
        page += [
            f"## {exhibit.key.replace('_', ' ').capitalize()}",
            f"{title[0].upper()}{title[1:]}.",
            f"![{title} and its collapse laws](gallery/{file.name})",
            "\n".join(_properties(exhibit, metal)),
            "\n".join(_laws(exhibit, metal)),
        ]
        written.append(file)
    target = folder / "gallery.md"
    target.write_text("\n\n".join(page) + "\n", encoding="utf-8")
    return [*written, target]


if __name__ == "__main__":
    for path in write_gallery(Path(sys.argv[1])):
        print(path)
