"""Supports that drive their node in some directions and leave it free in the others.

`motion` prescribes what it names and holds nothing else.  A node that is pushed is meant so; a foot that is
to move along a rail has to be held in the other directions by `fix`.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import NamedTuple

from crumple.structure.keys.motion import FREEDOMS, Freedom
from crumple.structure.parts import StructureParts
from crumple.text.names import listed


class PartlyDriven(NamedTuple):
    """A support with a motion.

    Attributes
    ----------
    support, node
        Its name, and its node.
    driven, left
        Freedoms that it drives, and those that no support of the node holds or drives.
    held
        Whether a support of the node holds something.
    """

    support: str
    node: str
    driven: tuple[Freedom, ...]
    left: tuple[Freedom, ...]
    held: bool


def partly_driven(structure: StructureParts) -> Iterator[PartlyDriven]:
    """Every support that drives a node which is free in some directions."""
    for name, support in structure.supports.items():
        there = [one for one in structure.supports.values() if one.node == support.node]
        taken = {freedom for one in there for freedom in (*one.held, *one.driven)}
        left = tuple(freedom for freedom in FREEDOMS if freedom not in taken)
        if support.driven and left:
            yield PartlyDriven(
                name, support.node, tuple(support.driven), left, any(one.held for one in there)
            )


def driven_assumptions(structure: StructureParts) -> Iterator[str]:
    """A sentence for all supports that drive and leave alike."""
    alike: dict[tuple[tuple[Freedom, ...], tuple[Freedom, ...]], list[PartlyDriven]] = defaultdict(list)
    for one in partly_driven(structure):
        alike[one.driven, one.left].append(one)
    for (driven, left), several in alike.items():
        whose = f"Supports {listed(one.support for one in several)} drive their nodes"
        if len(several) == 1:
            whose = f"Support {several[0].support} drives node {several[0].node}"
        yield (
            f"{whose} {in_words(driven)} only and hold{'s' if len(several) == 1 else ''} nothing "
            f"{in_words(left)}; 'fix: [{', '.join(left)}]' beside 'motion' would."
        )


def in_words(freedoms: tuple[Freedom, ...]) -> str:
    """``along x and y and about z``."""
    along = [freedom for freedom in freedoms if freedom[0] != "r"]
    about = [freedom[1] for freedom in freedoms if freedom[0] == "r"]
    parts = [f"{word} {' and '.join(axes)}" for word, axes in (("along", along), ("about", about)) if axes]
    return " and ".join(part.replace("x and y and z", "x, y and z") for part in parts)
