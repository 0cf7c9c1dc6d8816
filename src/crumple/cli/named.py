"""Sections and materials as they are written on the command line.

rectangular_tube 50x25x2.65 mm                     width x depth x thickness, outer dimensions
rectangular_tube 50x25x2.65 mm, corner radius 5 mm
circular_tube 60x2 mm                              outer diameter x thickness
yield 488 MPa, E 210 GPa, nu 0.3                   a material
model.yaml:tube                                    the section or material of this name in an input file
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from crumple.errors import InputError, Problem
from crumple.units import format_quantity, parse_quantity

if TYPE_CHECKING:
    from crumple.analysis import Analysis
    from crumple.material import Material
    from crumple.section import Section

SECTION_HELP = (
    "'rectangular_tube 50x25x2.65 mm' (outer width x depth x thickness; add ', corner radius 5 mm' for the "
    "outer radius), 'circular_tube 60x2 mm' (outer diameter x thickness), or 'model.yaml:tube' for a section "
    "of an input file."
)
MATERIAL_HELP = (
    "'yield 488 MPa, E 210 GPa' (also nu, density, ultimate, flow), or 'model.yaml:steel' for a material of "
    "an input file."
)

_DIMENSIONS = re.compile(
    r"(?P<kind>[A-Za-z]+[ _-]?[A-Za-z]*)\s+(?P<numbers>[0-9.eE+x×-]+)\s*(?P<unit>[A-Za-z]+)"
)
_NAMED = re.compile(r"(?P<path>.+\.(?:ya?ml|json)):(?P<name>.+)", re.IGNORECASE)


class _Key(NamedTuple):
    """A property of a material: its field, SI unit, and the steel's value that stands where none is given."""

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
    from crumple.section import CircularTube, RectangularTube

    head, *extras = (part.strip() for part in text.split(","))
    match = _DIMENSIONS.fullmatch(head)
    kind = re.sub(r"[ -]", "_", match["kind"]).lower() if match else ""
    wanted = {"rectangular_tube": 3, "circular_tube": 2}.get(kind)
    if match is None or wanted is None:
        raise _refused("this is not a section", text, SECTION_HELP)
    numbers = re.split("[x×]", match["numbers"])
    if len(numbers) != wanted:
        raise _refused(f"a {kind} has {wanted} dimensions, not {len(numbers)}", text, SECTION_HELP)
    lengths = [parse_quantity(f"{number} {match['unit']}", "m") for number in numbers]
    radius = _corner_radius(extras, text, kind)
    if kind == "circular_tube":
        return CircularTube(*lengths)
    width, depth, thickness = lengths
    return RectangularTube(width, depth, thickness, radius)


def material_of(text: str) -> tuple[Material, list[str]]:
    """Material from the command line's text, and sentences about what was assumed.

    Raises
    ------
    InputError
        If the text is not a material, or a value cannot be accepted.
    """
    named = _NAMED.fullmatch(text.strip())
    if named:
        structure = _loaded(named["path"]).structure
        name = _known(named["name"], structure.materials, text, "material")
        return structure.materials[name].material(name), []
    from crumple.material import Material

    values: dict[str, float] = {}
    for part in text.split(","):
        word, _, quantity = part.strip().partition(" ")
        key = _MATERIAL_KEYS.get(word)
        if key is None or not quantity.strip():
            raise _refused(f"{part.strip()!r} is not a property of a material", text, MATERIAL_HELP)
        if key.field in values:
            raise _refused(f"{word} is given twice", text, MATERIAL_HELP)
        values[key.field] = parse_quantity(quantity.strip(), key.unit)
    missing = [word for word, key in _MATERIAL_KEYS.items() if key.needed and key.field not in values]
    if missing:
        raise _refused(f"missing: {', '.join(missing)}", text, MATERIAL_HELP)
    defaults = {
        key.field: key.default
        for key in _MATERIAL_KEYS.values()
        if key.default is not None and key.field not in values
    }
    assumed = [
        f"{word} {format_quantity(key.default, key.unit)}, steel's, as none was given"
        for word, key in _MATERIAL_KEYS.items()
        if key.default is not None and key.field in defaults
    ]
    return Material(name="command line", **(defaults | values)), assumed  # type: ignore[arg-type]


def _corner_radius(extras: list[str], text: str, kind: str) -> float:
    if not extras:
        return 0.0
    match = re.fullmatch(r"corner[ _-]radius\s+(.+)", extras[0])
    if match is None or len(extras) > 1 or kind != "rectangular_tube":
        raise _refused(f"{', '.join(extras)!r} does not belong to a {kind}", text, SECTION_HELP)
    return parse_quantity(match[1], "m")


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
