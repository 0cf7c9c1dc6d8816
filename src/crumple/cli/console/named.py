"""Sections and materials as written on the command line.

rectangular_tube 50x25x2.65 mm, corner radius 5 mm   a shape: see crumple.section.shapes.written
yield 488 MPa, E 210 GPa, nu 0.3                     a material
S355, yield 400 MPa                                  a named grade with one value changed
model.yaml:tube                                      the section or material of this name in an input file
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from crumple.errors import InputError, Problem
from crumple.section.shapes.registry import SHAPES
from crumple.units import format_quantity, parse_quantity

if TYPE_CHECKING:
    from crumple.analysis import Analysis
    from crumple.material import Material
    from crumple.section import Section

SECTION_HELP = (
    "A shape, its outer width x depth x thickness and its details, as 'rectangular_tube 50x25x2.65 mm, "
    "corner radius 5 mm', 'hat 60x50x1.5 mm, flange 20 mm' or 'multi_cell_tube 90x60x3 mm, cells 3x2, inner "
    f"walls 2 mm'; the shapes are {', '.join(SHAPES)}. Or 'model.yaml:tube' for a section of an input file, "
    "where walls of any shape can be described."
)
MATERIAL_HELP = (
    "'yield 488 MPa, E 210 GPa' (also nu, density, ultimate, flow), a grade such as 'S355', or "
    "'model.yaml:steel' for a material of an input file."
)


_NAMED = re.compile(r"(?P<path>.+\.(?:ya?ml|json)):(?P<name>.+)", re.IGNORECASE)


class _Key(NamedTuple):
    """A property of a material: its field, its SI unit, and the value of steel as the default."""

    field: str
    unit: str
    default: float | None
    needed: bool = False


_MATERIAL_KEYS = {
    "yield": _Key("yield_stress", "Pa", None, needed=True),
    "E": _Key("youngs_modulus", "Pa", None, needed=True),
    "nu": _Key("poissons_ratio", "1", 0.3),
    "density": _Key("density", "kg/m^3", 7850.0),
    "ultimate": _Key("ultimate_stress", "Pa", None),
    "flow": _Key("given_flow_stress", "Pa", None),
}


@contextmanager
def option(name: str) -> Iterator[None]:
    """Name the option of the command line in refusals that have no file."""
    try:
        yield
    except InputError as error:
        problems = [one if one.file else replace(one, where=name) for one in error.problems]
        raise InputError(problems) from None


def quantity_of(name: str, text: str, unit: str) -> float:
    """SI value of an option of the command line, such as ``--to`` and "45 deg".

    Raises
    ------
    InputError
        With the name of the option, if it is no quantity of the unit.
    """
    with option(name):
        return parse_quantity(text, unit)


def section_of(text: str) -> Section:
    """Section from the command line's text.

    Raises
    ------
    InputError
        If the text is not a section, or a dimension cannot be accepted.
    """
    named = _NAMED.fullmatch(text.strip())
    if named:
        structure = _loaded(named["path"]).structure
        return structure.sections[_known(named["name"], structure.sections, text, "section")].section(
            structure.materials
        )
    from crumple.section.shapes.written import written_section

    return written_section(text, SECTION_HELP)


def material_of(text: str) -> tuple[Material, list[str]]:
    """Material from the command line's text, and sentences about what was assumed.

    Raises
    ------
    InputError
        With the name of the option, if the text is not a material, or a value cannot be accepted.
    """
    with option("--material"):
        return _material_of(text)


def _material_of(text: str) -> tuple[Material, list[str]]:
    named = _NAMED.fullmatch(text.strip())
    if named:
        structure = _loaded(named["path"]).structure
        name = _known(named["name"], structure.materials, text, "material")
        spec = structure.materials[name]
        return spec.material(name), [spec.statement] if spec.statement else []
    from crumple.material import Material

    first, *rest = (part.strip() for part in text.split(","))
    grade = _grade_of(first)
    values = _material_values(rest if grade else [first, *rest], text)
    if grade:
        return _graded(grade, values)
    missing = [word for word, key in _MATERIAL_KEYS.items() if key.needed and key.field not in values]
    if missing:
        raise _refused(f"missing: {', '.join(missing)}", text, MATERIAL_HELP)
    defaults = {
        key.field: key.default
        for key in _MATERIAL_KEYS.values()
        if key.default is not None and key.field not in values
    }
    assumed = [
        f"{word} {format_quantity(key.default, key.unit)} as for steel, since none was given"
        for word, key in _MATERIAL_KEYS.items()
        if key.default is not None and key.field in defaults
    ]
    return Material(name="command line", **(defaults | values)), assumed  # type: ignore[arg-type]


def _material_values(parts: list[str], text: str) -> dict[str, float]:
    """Given properties by the field of the material."""
    values: dict[str, float] = {}
    for part in parts:
        word, _, quantity = part.partition(" ")
        key = _MATERIAL_KEYS.get(word)
        if key is None or not quantity.strip():
            raise _refused(f"{part!r} is not a property of a material", text, MATERIAL_HELP)
        if key.field in values:
            raise _refused(f"{word} is given twice", text, MATERIAL_HELP)
        values[key.field] = parse_quantity(quantity.strip(), key.unit)
    return values


def _grade_of(text: str) -> str:
    """Name of the grade that a text such as "S355" or "grade S355" names; empty if it names none."""
    from crumple.material import grade

    try:
        return grade(text.removeprefix("grade ").strip()).name
    except InputError:
        return ""


def _graded(name: str, values: dict[str, float]) -> tuple[Material, list[str]]:
    """Material of a grade with some values of its own, and what the grade's numbers are."""
    from crumple.structure import MaterialSpec

    given = {{"given_flow_stress": "flow_stress"}.get(key, key): value for key, value in values.items()}
    spec = MaterialSpec.model_validate({"grade": name, **given})
    return spec.material(name), [spec.statement]


def _loaded(path: str) -> Analysis:
    from crumple.analysis import load

    return load(Path(path))


def _known(name: str, names: object, text: str, noun: str) -> str:
    known = sorted(str(entry) for entry in names)  # type: ignore[attr-defined]
    if name not in known:
        raise InputError(Problem(f"the file has no {noun} {name!r}", text, ", ".join(known) or "none", ""))
    return name


def _refused(what: str, text: str, allowed: str) -> InputError:
    return InputError(Problem(what, came=repr(text[:80]), allowed=allowed))
