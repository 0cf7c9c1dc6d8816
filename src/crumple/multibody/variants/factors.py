"""Parameters of a structure: paths of its input, and factors on its quantities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.structure import Structure, value_at

FACTORS = ("initial_velocity", "impulses", "loads", "gravity")
"""In addition: ``hinges.NAME.capacity``."""


def quick(name: str) -> bool:
    """Whether a parameter only scales arrays of the kernel."""
    return is_factor(name) or _is_mass(name)


def is_factor(name: str) -> bool:
    """Whether a parameter is a factor on a quantity of the structure."""
    head, *rest = name.split(".")
    return (not rest and head in FACTORS) or head == "hinges"


def masses_of(values: Mapping[str, Floats]) -> dict[str, Floats]:
    """The parameters that are lumped masses."""
    return {name: column for name, column in values.items() if _is_mass(name)}


def _is_mass(name: str) -> bool:
    head, *rest = name.split(".")
    return head == "masses" and rest[1:] == ["mass"]


def checked_names(structure: Structure, hinges: Sequence[str], names: Sequence[str]) -> None:
    """Refuse parameters that do not exist; `hinges` by their names.

    Raises
    ------
    InputError
        If a path leads nowhere or to no number, or a hinge has another name.
    """
    for name in names:
        head, *rest = name.split(".")
        if head == "hinges":
            if len(rest) != 2 or rest[0] not in hinges or rest[1] != "capacity":
                allowed = ", ".join(f"hinges.{hinge}.capacity" for hinge in hinges)
                raise InputError(
                    Problem("no hinge has this factor", name, allowed, "choose one of them", name)
                )
        elif name not in FACTORS:
            value_at(structure, name)
