"""Sections written in one line, as on the command line: a shape, its sizes with one unit, its details.

rectangular_tube 50x25x2.65 mm, corner radius 5 mm
multi_cell_tube 90x60x3 mm, cells 3x2, inner walls 2 mm
square_tube 70x70x2

The sizes are the keys of the shape that must be given, in their order; details are the others, by their words
(`crumple.registry.keys.Word`).  Keys that share a word are written together, as the cells are.  Sizes without
a unit are in mm, as catalogues write them; the side of a square tube can be written twice, as of others.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from crumple.errors import InputError, Problem
from crumple.registry.keys import MISSING, Key
from crumple.registry.quantity import Whole
from crumple.section.section import Section
from crumple.section.shapes.registry import SHAPES
from crumple.units import parse_quantity

_SIZES = re.compile(
    r"(?P<kind>[A-Za-z]+(?:[ _-][A-Za-z]+){0,2})\s+(?P<numbers>[0-9.eE+x×-]+)\s*(?P<unit>[A-Za-z]*)"
)
_DETAIL = re.compile(r"(?P<words>[A-Za-z]+(?:[ _-][A-Za-z]+)?)\s+(?P<value>[0-9.].{0,40})")
_COUNT = re.compile("[0-9]{1,3}")


def written_section(text: str, allowed: str = "") -> Section:
    """Section that a line describes.

    Parameters
    ----------
    text
        The line.
    allowed
        Permitted text in a message if the shape is not known.

    Raises
    ------
    InputError
        If the line is not a section, or a dimension cannot be accepted.
    """
    head, *extras = (part.strip() for part in text.split(","))
    match = _SIZES.fullmatch(head)
    kind = re.sub(r"[ -]", "_", match["kind"]).lower() if match else ""
    if match is None or kind not in SHAPES:
        raise _refused("this is not a section", text, allowed or f"{', '.join(SHAPES)}, with their sizes")
    shape = SHAPES[kind]
    keys = [key for key in shape.keys if key.measure is not None]
    sizes = [key for key in keys if not key.words]
    numbers = re.split("[x×]", match["numbers"])
    if kind == "square_tube" and len(numbers) == len(sizes) + 1 and numbers[0] == numbers[1]:
        numbers = numbers[1:]
    if len(numbers) != len(sizes):
        what = f"{_one(kind)} has {len(sizes)} dimensions, not {len(numbers)}"
        raise _refused(what, text, _grammar(kind, keys))
    values: dict[str, float] = {
        key.name: parse_quantity(f"{number} {match['unit'] or 'mm'}", "m")
        for key, number in zip(sizes, numbers, strict=True)
    }
    for extra in extras:
        found = _detail(extra, keys)
        if not found:
            raise _refused(f"{extra!r} does not belong to {_one(kind)}", text, _grammar(kind, keys))
        if found.keys() & values.keys():
            raise _refused(f"{extra!r} is given twice", text, _grammar(kind, keys))
        values |= found
    missing = [key.words[0] for key in keys if key.default is MISSING and key.name not in values]
    if missing:
        raise _refused(f"{_one(kind)} needs its {', '.join(missing)}", text, _grammar(kind, keys))
    return shape.make(**values)


def _detail(text: str, keys: Sequence[Key]) -> dict[str, float]:
    """Values that a detail gives by the names of their keys; nothing where no key has its words."""
    match = _DETAIL.fullmatch(text)
    words = re.sub("[_-]", " ", match["words"]).lower() if match else ""
    named = [key for key in keys if words in key.words]
    if match is None or not named:
        return {}
    if not isinstance(named[0].measure, Whole):
        return {named[0].name: parse_quantity(match["value"], "m")}
    counts = [count.strip() for count in re.split("[x×]", match["value"])]
    if len(counts) != len(named) or not all(_COUNT.fullmatch(count) for count in counts):
        return {}
    return {key.name: int(count) for key, count in zip(named, counts, strict=True)}


def _grammar(kind: str, keys: Sequence[Key]) -> str:
    """How a shape is written: ``hat WIDTHxDEPTHxTHICKNESS mm, flange 20 mm, [corner radius 2 mm]``."""
    sizes = "x".join(key.name.upper() for key in keys if not key.words)
    details: dict[str, list[Key]] = {}
    for key in keys:
        if key.words:
            details.setdefault(key.words[0], []).append(key)
    texts = [
        f"{word} {'x'.join('2' for _ in named)}" if isinstance(named[0].measure, Whole) else f"{word} 2 mm"
        for word, named in details.items()
    ]
    needed = [named[0].default is MISSING for named in details.values()]
    return ", ".join(
        [f"{kind} {sizes} mm", *(t if must else f"[{t}]" for t, must in zip(texts, needed, strict=True))]
    )


def _one(kind: str) -> str:
    return f"{'an' if kind.startswith('a') else 'a'} {kind}"


def _refused(what: str, text: str, allowed: str) -> InputError:
    return InputError(Problem(what, came=repr(text[:80]), allowed=allowed))
