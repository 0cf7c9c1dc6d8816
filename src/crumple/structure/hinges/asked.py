"""Which members have automatic hinges, and where the input asks for them."""

from __future__ import annotations

from crumple.structure.keys.member import AutomaticHinges
from crumple.structure.parts import StructureParts


def automatic_of(structure: StructureParts, member: str) -> AutomaticHinges | None:
    """Automatic hinges of a member: its own setting, else the structure's if it has no hinges of its own."""
    spec = structure.members[member]
    if isinstance(spec.hinges, AutomaticHinges):
        return spec.hinges
    own = spec.hinges or spec.bars.number > 1
    return None if own else structure.hinges


def where_automatic(structure: StructureParts, member: str) -> str | None:
    """Path of what `automatic_of` finds for a member; None where its hinges are given one by one."""
    if automatic_of(structure, member) is None:
        return None
    own = isinstance(structure.members[member].hinges, AutomaticHinges)
    return f"members.{member}.hinges" if own else "hinges"


def any_automatic(structure: StructureParts) -> bool:
    """Whether any member has automatic hinges."""
    return any(automatic_of(structure, member) is not None for member in structure.members)
