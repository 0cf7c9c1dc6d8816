"""What is rigid in a mesh: rigid parts of members, as one body each with the sections that they reach."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Integers
from crumple.shell.mesh.mesh import Mesh
from crumple.structure import Structure


@dataclass(frozen=True, eq=False)
class Group:
    """Wall nodes that move as one.

    Attributes
    ----------
    walls
        Their numbers, increasing.
    joints
        Structure nodes whose sections are among them.
    stretch
        Whether a rigid part of a member belongs to it.
    """

    walls: Integers
    joints: tuple[str, ...]
    stretch: bool


def groups_of(structure: Structure, mesh: Mesh) -> tuple[Group, ...]:
    """Rigid groups: those of the mesh's reference nodes in their order, then those that no joint is part of.

    Raises
    ------
    InputError
        If a rigid part is shorter than an element.
    """
    groups = [_section(mesh, node) for node in mesh.reference]
    for name, tube in mesh.tubes.items():
        for first, last in rigid_rings(structure, mesh, name):
            ends = [
                structure.members[name].nodes[i]
                for i, at in ((0, 0), (1, tube.last_ring))
                if first <= at <= last
            ]
            groups = _joined(groups, Group(np.unique(tube.nodes[first : last + 1]), tuple(ends), True))
    return tuple(groups)


def rigid_rings(structure: Structure, mesh: Mesh, member: str) -> list[tuple[int, int]]:
    """First and last ring of every rigid part of a member."""
    tube, found = mesh.tubes[member], []
    for a, b in structure.members[member].rigid_parts(tube.frame.length):
        first, last = tube.ring_at(a), tube.ring_at(b)
        if first == last:
            what, todo = "a rigid part is shorter than an element", "make it longer, or use smaller elements"
            came = f"{1e3 * (b - a):.4g} mm"
            raise InputError(Problem(what, came, "at least one element", todo, f"members.{member}.rigid"))
        found.append((first, last))
    return found


def rigid_elements(structure: Structure, mesh: Mesh) -> NDArray[np.bool_]:
    """Whether an element is in a rigid part, (m,)."""
    rigid = np.zeros(len(mesh.quads), dtype=bool)
    for name, tube in mesh.tubes.items():
        for first, last in rigid_rings(structure, mesh, name):
            rigid[tube.elements_between(first, last)] = True
    return rigid


def _section(mesh: Mesh, node: str) -> Group:
    rings = [mesh.end_ring(end.member, end.second) for end in mesh.joints[node].ends]
    return Group(np.unique(np.concatenate(rings)), (node,), False)


def _joined(groups: list[Group], new: Group) -> list[Group]:
    """Groups with a new one that takes up all that it shares nodes with, at the place of the first."""
    touching = [group for group in groups if np.isin(group.walls, new.walls).any()]
    walls = np.unique(np.concatenate([new.walls, *(group.walls for group in touching)]))
    names = [name for group in (*touching, new) for name in group.joints]
    whole = Group(walls, tuple(dict.fromkeys(names)), True)
    at = next((i for i, group in enumerate(groups) if group in touching), len(groups))
    rest = [whole if i == at else group for i, group in enumerate(groups) if group not in touching or i == at]
    return rest if touching else [*groups, whole]
