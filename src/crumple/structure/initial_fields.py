"""What an initial velocity moves: members, and masses at their nodes; one rule for both solvers.

A field without `nodes` and `members` moves everything.  `members` moves these members, and the masses at
nodes all of whose members have the same motion by such fields; not those at a node that any field names in
`nodes`: who names it has decided about its mass.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crumple.numeric.arrays import Floats
from crumple.structure.keys.motion import FREEDOMS, InitialVelocity
from crumple.structure.parts import StructureParts

Fields = Sequence[InitialVelocity]

ROUNDING = 1e-9
"""Share of the size of a velocity field below which a velocity is rounding."""


@dataclass(frozen=True)
class Standing:
    """A node with mass that does not move with members that are thrown.

    Attributes
    ----------
    node
        Where it is.
    thrown
        Members at it that are thrown.
    others
        Members at it that are thrown otherwise or not at all.
    """

    node: str
    thrown: tuple[str, ...]
    others: tuple[str, ...]


def fields_of_member(fields: Fields, member: str) -> list[InitialVelocity]:
    """Fields that move a member.

    Parameters
    ----------
    fields
        All, of the start or of a stage.
    member
        Its name.
    """
    return [field for field in fields if field.everywhere or member in (field.members or ())]


def fields_of_mass(structure: StructureParts, fields: Fields, node: str) -> list[InitialVelocity]:
    """Fields that move the masses at a node.

    Parameters
    ----------
    structure
        With members and supports.
    fields
        All, of the start or of a stage.
    node
        Its name.
    """
    found = [field for field in fields if field.everywhere or node in (field.nodes or ())]
    if any(not field.everywhere for field in found) or _is_held(structure, node):
        return found
    if len(_ways(structure, fields, node)) == 1:
        return fields_of_member(fields, structure.members_at[node][0])
    return found


def standing_masses(structure: StructureParts, fields: Fields) -> Iterator[Standing]:
    """Nodes with masses that stand still, or keep the motion of the whole, while members at them are thrown.

    Parameters
    ----------
    structure
        With members, masses and supports.
    fields
        All, of the start or of a stage.
    """
    for node in structure.masses_at:
        if any(node in (field.nodes or ()) for field in fields) or _is_held(structure, node):
            continue
        ways = _ways(structure, fields, node)
        thrown = next((names for way, names in ways if way and _moves(structure, way, node)), None)
        # where all members move alike the masses move with them
        if len(ways) > 1 and thrown is not None:
            others = tuple(name for name in structure.members_at[node] if name not in thrown)
            yield Standing(node, tuple(thrown), others)


def _ways(structure: StructureParts, fields: Fields, node: str) -> list[tuple[Fields, list[str]]]:
    """Kinds of motion of the members at a node: the fields of each that name members, and who has them."""
    found: list[tuple[Fields, list[str]]] = []
    for member in structure.members_at.get(node, ()):
        own = [field for field in fields if member in (field.members or ())]
        names = next((names for way, names in found if _alike(way, own)), None)
        if names is None:
            found.append((own, [member]))
        else:
            names.append(member)
    return found


def _alike(one: Fields, other: Fields) -> bool:
    """Whether the sums of two lists of fields are one rigid motion."""
    if not (one and other):
        return not (one or other)
    size = sum(_size(field) for field in (*one, *other))
    return all(
        float(np.linalg.norm(first - second)) <= ROUNDING * size
        for first, second in zip(_sum(one, np.zeros(3)), _sum(other, np.zeros(3)), strict=True)
    )


def _sum(fields: Fields, point: Floats) -> tuple[Floats, Floats]:
    """Velocity at a point [m/s] and angular velocity [rad/s] of all fields, (3,) each."""
    velocity = sum((field.at(point) for field in fields), np.zeros(3))
    return velocity, sum((field.rate for field in fields), np.zeros(3))


def _size(field: InitialVelocity) -> float:
    """Sum of the magnitudes of its terms, which rounding is compared with."""
    rate = float(np.linalg.norm(field.rate))
    return float(np.linalg.norm(field.translation)) + rate * (1.0 + float(np.linalg.norm(field.about)))


def _moves(structure: StructureParts, fields: Fields, node: str) -> bool:
    """Whether fields would move the masses at a node along what supports leave free."""
    point, blocked = np.asarray(structure.nodes[node], float), _blocked(structure, node)
    velocity, rate = _sum(fields, point)
    size = sum(_size(field) + float(np.linalg.norm(field.rate) * np.linalg.norm(point)) for field in fields)
    pushed = np.where(blocked[:3], 0.0, velocity)
    turned = np.where(blocked[3:], 0.0, rate) if _has_extent(structure, node) else np.zeros(3)
    return bool(np.linalg.norm(pushed) > ROUNDING * size or np.linalg.norm(turned) > ROUNDING * size)


def _is_held(structure: StructureParts, node: str) -> bool:
    """Whether supports hold or drive all that masses at a node could do."""
    blocked = _blocked(structure, node)
    return bool(blocked[:3].all() and (blocked[3:].all() or not _has_extent(structure, node)))


def _blocked(structure: StructureParts, node: str) -> NDArray[np.bool_]:
    """Which freedoms supports hold or drive, (6,)."""
    supports = [support for _, support in structure.supports_at.get(node, ())]
    held = {freedom for support in supports for freedom in (*support.held, *support.driven)}
    return np.array([freedom in held for freedom in FREEDOMS])


def _has_extent(structure: StructureParts, node: str) -> bool:
    """Whether a mass at a node resists its rotation."""
    return any(any(mass.offset) or any(mass.rotary_inertia) for mass in structure.masses_at.get(node, ()))
