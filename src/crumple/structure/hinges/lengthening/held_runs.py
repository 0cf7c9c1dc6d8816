"""Straight runs of members that supports hold at both ends: what bends them must stretch them.

With hinges that only turn, a straight bar between two clamps cannot move at all: a bend of it needs a longer
bar.  Its walls yield in tension instead, together with bending (the interaction of the section).
"""

from __future__ import annotations

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.hinges.lengthening.framework import passes_on
from crumple.structure.parts import StructureParts

STRAIGHT = 1e-6
"""Sine of the angle between members, or between a run and what is held, up to which they are in line."""


def held_runs(structure: StructureParts) -> frozenset[str]:
    """Members of straight runs whose ends are both held along the run."""
    return structure.kept.once("held runs", "", lambda: _held_runs(structure))


def _held_runs(structure: StructureParts) -> frozenset[str]:
    found: set[str] = set()
    seen: set[str] = set()
    for member, spec in structure.members.items():
        if member in seen or not structure.has_line(member):
            continue
        (first, one), (second, other) = (_to_support(structure, member, node) for node in spec.nodes)
        seen |= {member, *first, *second}
        found |= {member, *first, *second} if one and other else set()
    return frozenset(found)


def _to_support(structure: StructureParts, member: str, node: str) -> tuple[list[str], bool]:
    """Further members in line from a member's end, up to a node held along them, and whether there is one."""
    line, last, passed = structure.frame_of(member).x, member, dict.fromkeys([member])
    while passes_on(structure, last, node):
        if _held(structure, node, line):
            return list(passed)[1:], True
        further = (
            name
            for name in structure.members_at.get(node, ())
            if name not in passed and _in_line(structure, name, line) and passes_on(structure, name, node)
        )
        following = next(further, None)
        if following is None:
            break
        passed[following], last = None, following
        first, second = structure.members[following].nodes
        node = second if node == first else first
    return list(passed)[1:], False


def _held(structure: StructureParts, node: str, line: Floats) -> bool:
    """Whether supports hold or drive all displacements of a node that have a part along a line."""
    held = {
        freedom
        for _, support in structure.supports_at.get(node, ())
        for freedom in (*support.held, *support.driven)
    }
    free = [part for part, axis in zip(line, "xyz", strict=True) if axis not in held]
    return float(np.linalg.norm(free)) <= STRAIGHT


def _in_line(structure: StructureParts, member: str, line: Floats) -> bool:
    along = structure.frame_of(member).x if structure.has_line(member) else np.zeros(3)
    return float(abs(along @ line)) > 0.0 and float(np.linalg.norm(np.cross(along, line))) <= STRAIGHT
