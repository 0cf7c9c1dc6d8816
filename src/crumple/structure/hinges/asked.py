"""Which members have automatic hinges, and where the input asks for them."""

from __future__ import annotations

from crumple.structure.keys.member import AutomaticHinges
from crumple.structure.parts import StructureParts

FOLDS = AutomaticHinges()
"""Candidates of elastic members for which nothing is asked: what yields folds where it yields most."""


def automatic_of(structure: StructureParts, member: str) -> AutomaticHinges | None:
    """Automatic hinges of a member: its own setting, else the structure's if it has no hinges of its own.

    An elastic member without either has candidates too, unless its list of hinges is there and empty: its
    walls yield, so they also fold.
    """
    spec = structure.members[member]
    if isinstance(spec.hinges, AutomaticHinges):
        return spec.hinges
    if spec.hinges or spec.bars.number > 1:
        return None
    if structure.hinges is not None or not spec.elastic or spec.hinges is not None:
        return structure.hinges
    return FOLDS


def folds_at_ends(structure: StructureParts, member: str) -> bool:
    """Whether a member with a list of hinges also has candidates at its ends: if it is elastic."""
    spec = structure.members[member]
    return bool(spec.elastic and isinstance(spec.hinges, tuple) and spec.hinges and spec.bars.number == 1)


def where_automatic(structure: StructureParts, member: str) -> str | None:
    """Path of what `automatic_of` finds for a member; None where its hinges are given one by one."""
    if automatic_of(structure, member) is None:
        return None
    own = isinstance(structure.members[member].hinges, AutomaticHinges)
    return f"members.{member}.hinges" if own else "hinges"


def any_automatic(structure: StructureParts) -> bool:
    """Whether a member has automatic hinges, or the structure asks for them although all have lists."""
    return structure.hinges is not None or structure.kept.once(
        "any automatic",
        "",
        lambda: any(automatic_of(structure, one) is not None for one in structure.members),
    )
