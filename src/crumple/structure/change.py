"""A structure with some of its numbers changed, by their places in the input."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from typing import Any

from crumple.errors import InputError, Problem
from crumple.structure.bending import PLANAR
from crumple.structure.checks.checks import problems_in
from crumple.structure.schema.mapping import frozen
from crumple.structure.schema.spec import Spec, raise_all
from crumple.structure.structure import Structure

WALLS = ("sections", "materials")
"""Parts that say nothing of where a structure is and how it moves."""
SHARED = ("bending_normal", "part_normals", "supports_at", "masses_at", "joints_at", "members_at")
"""Derived data that does not depend on them."""


def changed(structure: Structure, values: Mapping[str, Any]) -> Structure:
    """Copy of a structure with other values, checked like any other.

    Parameters
    ----------
    values
        By path, as in the input: ``materials.steel.yield_stress``, ``nodes.tip.0``,
        ``initial_velocity.0.rotation``.  Numbers are SI.

    Raises
    ------
    InputError
        If a path does not exist, or the changed structure is refused.
    """
    paths = {tuple(path.split(".")): value for path, value in values.items()}
    if paths and all(head in WALLS and len(rest) > 1 for head, *rest in paths):
        return _with_walls(structure, paths)
    found: Structure = _changed(structure, paths, "")
    return found


def _with_walls(structure: Structure, values: Mapping[tuple[str, ...], Any]) -> Structure:
    """Copy with other sections or materials, each checked by itself and all of them together.

    The rest was checked before, and what was derived of places and directions alone is that of the original.
    """
    groups: dict[str, dict[tuple[str, ...], Any]] = defaultdict(dict)
    for (head, *rest), value in values.items():
        groups[head][tuple(rest)] = value
    fields = {name: getattr(structure, name) for name in type(structure).model_fields}
    for head, inner in groups.items():
        fields[head] = frozen(_changed(fields[head], inner, head))
    found = type(structure).model_construct(**fields)
    found.__dict__.update({name: structure.__dict__[name] for name in SHARED if name in structure.__dict__})
    found.kept.frames.update(structure.kept.frames)
    if PLANAR in structure.kept:
        found.kept[PLANAR] = structure.kept[PLANAR]
    raise_all(problems_in(found))
    return found


def value_at(structure: Structure, path: str) -> float:
    """Number at a path of the input.

    Raises
    ------
    InputError
        If the path does not exist or is not that of a number.
    """
    part: Any = structure
    for head in path.split("."):
        part = _inside(part, head, path)
    if isinstance(part, bool) or not isinstance(part, int | float):
        raise InputError(_not_a_number(path, part))
    return float(part)


def _changed(part: Any, values: Mapping[tuple[str, ...], Any], where: str) -> Any:
    groups: dict[str, dict[tuple[str, ...], Any]] = defaultdict(dict)
    for (head, *rest), value in values.items():
        groups[head][tuple(rest)] = value
    new: dict[str, Any] = {}
    for head, inner in groups.items():
        here = f"{where}.{head}" if where else head
        old = _inside(part, head, here)
        new[head] = inner[()] if () in inner else _changed(old, inner, here)
    if isinstance(part, Spec):
        return part.model_copy(update=new)
    if isinstance(part, Mapping):
        return {**part, **new}
    return tuple(new.get(str(i), item) for i, item in enumerate(part))


def _inside(part: Any, head: str, path: str) -> Any:
    """What is called ``head`` in a part of the input."""
    if isinstance(part, Spec):
        names = part.key_names
        if head in names:
            return getattr(part, head)
    elif isinstance(part, Mapping):
        names = list(part)
        if head in part:
            return part[head]
    elif isinstance(part, tuple):
        names = [str(i) for i in range(len(part))]
        if head in names:
            return part[int(head)]
    else:
        raise InputError(_not_a_number(path, part))
    raise InputError(
        Problem("this path does not exist", head, ", ".join(names), "write the path as in the input", path)
    )


def _not_a_number(path: str, part: Any) -> Problem:
    allowed = "the path of a number of the input, such as materials.steel.yield_stress"
    return Problem("this is not the path of a number", f"{part!r:.60}", allowed, "correct the path", path)
