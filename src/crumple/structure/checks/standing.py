"""Masses that do not move with members that are thrown: mostly an initial velocity that lacks a node.

A mass moves with members where all that end at its node do.  Not reported: masses whose node is named, and
motion that supports take.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from crumple.structure.checks.unusual import Unusual
from crumple.structure.initial_fields import Fields, Standing, standing_masses
from crumple.structure.keys.stages import Stage
from crumple.structure.parts import StructureParts
from crumple.text.names import listed

MOST_NAMED = 4
"""Nodes, and members of one, that the sentence names."""


def standing_doubts(structure: StructureParts, stages: Sequence[Stage] = ()) -> Iterator[Unusual]:
    """Masses that stay behind while members at their nodes are thrown; one sentence for all.

    Parameters
    ----------
    structure
        Checked.
    stages
        Of the run.
    """
    found: dict[str, Standing] = {}
    for fields in _thrown(structure, stages):
        for one in standing_masses(structure, fields):
            found.setdefault(one.node, one)
    if not found:
        return
    masses = {node: _masses_at(structure, node) for node in found}
    cases = (f"{listed(masses[node])} at node {node} ({_members(one)})" for node, one in found.items())
    several = sum(map(len, masses.values())) > 1
    text = (
        f"Mass{'es' if several else ''} not thrown with 'members' of initial_velocity: "
        f"{listed(cases, MOST_NAMED, '; ')}. A mass moves with members if all that end at its node have the "
        f"same velocity. Where it should move, add its node to this entry: 'nodes: [{listed(found)}]'."
    )
    for names in masses.values():
        for name in names:
            yield Unusual(f"mass {name}", structure.masses[name].mass, 0.0, "kg", text, "standing_mass")


def _thrown(structure: StructureParts, stages: Sequence[Stage]) -> Iterator[Fields]:
    """Fields that act together: those of the start with those of the first stage, then stage by stage."""
    first, *later = [stage.initial_velocity for stage in stages] or [()]
    yield (*structure.initial_velocity, *first)
    yield from later


def _masses_at(structure: StructureParts, node: str) -> list[str]:
    return [name for name, mass in structure.masses.items() if mass.node == node]


def _members(one: Standing) -> str:
    """Which members at its node are thrown, and which are not."""
    alone = len(one.others) == 1
    return (
        f"{listed(one.thrown, MOST_NAMED)} {'is' if len(one.thrown) == 1 else 'are'} thrown, "
        f"{listed(one.others, MOST_NAMED)} {'is' if alone else 'are'} not thrown alike"
    )
