"""Straight runs of members that supports hold at both ends: what bends them must stretch them.

With hinges that only turn, a straight bar between two clamps cannot move at all: a bend of it needs a longer
bar.  Its walls yield in tension instead, together with bending (the interaction of the section).

A run of length L that is kinked by a is longer than the distance of its ends by L a^2/8.  It is straight if
this reserve is below the stretch at which its walls yield: it then cannot move far without yielding.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from crumple.hinge.corner.in_plane import SMALLEST
from crumple.numeric.arrays import Floats
from crumple.structure.hinges.corners import leaving
from crumple.structure.hinges.lengthening.framework import passes_on
from crumple.structure.parts import StructureParts

RESERVE = 1e-3
"""Length of a run beyond the distance of its ends, over that distance, up to which it is straight.

Yield stress over Young's modulus is 1.1e-3 for mild steel, and more for most metals of structures.
"""
ALONG = math.sqrt(2.0 * RESERVE)
"""Sine of the angle between a run and what is held up to which it is held along itself: the same reserve."""


def held_runs(structure: StructureParts) -> frozenset[str]:
    """Members of straight runs whose ends are both held along the run."""
    return frozenset(_held_runs(structure))


def pushed_runs(structure: StructureParts) -> frozenset[str]:
    """Those of which a support drives an end: it may press them, and then they fold or buckle."""
    return frozenset(name for name, driven in _held_runs(structure).items() if driven)


def _held_runs(structure: StructureParts) -> Mapping[str, bool]:
    """Members of held runs, and whether an end of theirs is driven."""
    return structure.kept.once("held runs", "", lambda: _found_runs(structure))


def _found_runs(structure: StructureParts) -> dict[str, bool]:
    found: dict[str, bool] = {}
    seen: set[str] = set()
    for member, spec in structure.members.items():
        if member in seen or not structure.has_line(member):
            continue
        (first, one), (second, other) = (_to_support(structure, member, node) for node in spec.nodes)
        run = {member, *first, *second}
        seen |= run
        if one is not None and other is not None and _is_straight(structure, run, (one, other)):
            supports = (*structure.supports_at[one], *structure.supports_at[other])
            found |= dict.fromkeys(run, any(support.driven for _, support in supports))
    return found


def _to_support(structure: StructureParts, member: str, node: str) -> tuple[list[str], str | None]:
    """Further members in line from a member's end, up to a node held along them, and that node."""
    last, passed = member, dict.fromkeys([member])
    while passes_on(structure, last, node):
        if _held(structure, node, structure.frame_of(last).x):
            return list(passed)[1:], node
        arriving = -leaving(structure, last, node)
        in_line = {
            name: float(leaving(structure, name, node) @ arriving)
            for name in structure.members_at.get(node, ())
            if name not in passed and structure.has_line(name) and passes_on(structure, name, node)
        }
        following = max(in_line, key=lambda name: in_line[name], default=None)
        if following is None or in_line[following] <= math.cos(SMALLEST):
            break
        passed[following], last = None, following
        first, second = structure.members[following].nodes
        node = second if node == first else first
    return list(passed)[1:], None


def _is_straight(structure: StructureParts, run: set[str], ends: tuple[str, str]) -> bool:
    """Whether a run is not longer than the distance of its ends by more than the reserve."""
    length = sum(structure.frame_of(member).length for member in run)
    return length <= (1.0 + RESERVE) * math.dist(*(structure.nodes[node] for node in ends))


def _held(structure: StructureParts, node: str, line: Floats) -> bool:
    """Whether supports hold or drive all displacements of a node that have a part along a line."""
    held = {
        freedom
        for _, support in structure.supports_at.get(node, ())
        for freedom in (*support.held, *support.driven)
    }
    free = [part for part, axis in zip(line, "xyz", strict=True) if axis not in held]
    return float(np.linalg.norm(free)) <= ALONG
