"""What the forms of sections and laws show beside their fields: drawing, capacities and law curves."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from crumple.hinge import HingeLaw
    from crumple.material import Material
    from crumple.section import Section
    from crumple.structure import Structure

MOST_SECTIONS = 12
MOST_LAWS = 6
"""Law curves of one section, and of one named law."""
KEPT = 64
"""Drawings that a process remembers: most stay the same while one number is dragged."""


def forms_of(structure: Structure) -> list[dict[str, Any]]:
    """Sections, then laws by name: path, what is drawn, and rows of values with units."""
    laws = list(_laws(structure))
    found = []
    for name in list(structure.sections)[:MOST_SECTIONS]:
        member = next((key for key, one in structure.members.items() if one.section == name), None)
        section = structure.sections[name].section(structure.materials)
        material = None if member is None else structure.material_of(member)
        own = [(law, about) for used, _, law, about in laws if used == name]
        found.append(
            {
                "path": f"sections.{name}",
                "title": section.title,
                "drawing": _drawing(section, material),
                "rows": [list(row) for row in _capacities(section, material)],
                "curves": _curves(own),
            }
        )
    for name in structure.hinge_laws:
        own = [(law, about) for _, named, law, about in laws if named == name]
        title = own[0][0].title if own else ""
        path = f"hinge_laws.{name}"
        found.append({"path": path, "title": title, "drawing": "", "rows": [], "curves": _curves(own)})
    return found


def _laws(structure: Structure) -> Iterator[tuple[str, str, HingeLaw, str]]:
    """Section, name of the law if it has one, law, and what it belongs to, once for each different law."""
    from crumple.structure import hinge_places, plastic_hinges  # noqa: PLC0415

    placed = {hinge.name: hinge for hinge in plastic_hinges(structure)}
    seen = set()
    for place in hinge_places(structure):
        hinge = placed.get(place.name)
        section = structure.members[place.member].section
        if hinge is None:
            continue
        named = place.law if isinstance(place.law, str) and place.law in structure.hinge_laws else ""
        if (section, named, hinge.law, hinge.axis) not in seen:
            seen.add((section, named, hinge.law, hinge.axis))
            yield section, named, hinge.law, f"{section} about {hinge.axis}"


def _curves(laws: list[tuple[HingeLaw, str]]) -> list[dict[str, str]]:
    found = []
    for law, about in laws[:MOST_LAWS]:
        width = law.validity.uncertainty
        band = "band not known" if not width else f"band ±{100.0 * width:.2g} %"
        found.append({"caption": f"{law.title}; {band}; {law.source.citation}", "svg": _curve(law, about)})
    return found


@lru_cache(KEPT)
def _curve(law: HingeLaw, about: str) -> str:
    from crumple.report.figures.law_figure import law_figure  # noqa: PLC0415

    return law_figure(law, "law", about)


@lru_cache(KEPT)
def _drawing(section: Section, material: Material | None) -> str:
    from crumple.report.figures.section_figure import section_figure  # noqa: PLC0415

    return section_figure(section, material)


@lru_cache(KEPT)
def _capacities(section: Section, material: Material | None) -> tuple[tuple[str, str], ...]:
    from crumple.section import moment_capacity, plastic_interaction, walls_of  # noqa: PLC0415
    from crumple.units import format_quantity  # noqa: PLC0415

    rows = [("Area", format_quantity(section.area, "m^2", 4).replace("^2", "²"))]
    if material is None:
        return tuple(rows)
    interaction = plastic_interaction(walls_of(section), material)
    rows.append(("Mass per length", format_quantity(section.mass_per_length(material.density), "kg/m", 4)))
    rows.append(("Squash force", format_quantity(interaction.squash_force, "N", 4)))
    rows.append(("Plastic torque", format_quantity(interaction.plastic_torque, "N*m", 4)))
    for axis in ("y", "z"):
        for sense in (1, -1):
            capacity = moment_capacity(section, material, axis, sense=sense)
            rows.append(
                (
                    f"Moment about {'+' if sense > 0 else '-'}{axis}",
                    format_quantity(capacity.moment, "N*m", 4),
                )
            )
    return tuple(rows)
