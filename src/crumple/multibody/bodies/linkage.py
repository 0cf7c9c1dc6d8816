"""Rigid bodies in space and what connects them, from a structure: a graph with any number of loops.

Members are cut at their hinges; what stays together is one body.  A connection lies at every hinge, at every
joint between a member's end and its node, and at every node that a support holds in part or drives.  A node
that is held in all six freedoms belongs to the ground.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from crumple.cancelling import go_on
from crumple.errors import InputError, Problem
from crumple.multibody.bodies.assembly import Assembly, Cut, Piece, assemble, idle
from crumple.multibody.bodies.rigid import RigidMass
from crumple.numeric.arrays import Floats
from crumple.structure import FREEDOMS, Joint, PlacedHinge, Structure, placed_hinges
from crumple.structure.geometry import cross
from crumple.structure.hinges.corner_laws import corner_laws, corner_name
from crumple.structure.hinges.hinges import OWN_HINGES

GROUND = -1
FREEDOM = {"x": 3, "y": 4, "z": 5}
"""Relative freedom of a hinge's bending axis: the rotation about it."""
THIN = 1e-12
"""Smallest ratio of principal moments of inertia for which a body resists rotation about every axis."""


@dataclass(frozen=True, eq=False)
class Connection:
    """A connection of two bodies at a place.

    Attributes
    ----------
    name, kind
        Of the hinge, joint or support: ``hinge``, ``joint`` or ``support``.
    first, second
        Bodies; -1 the ground.  A hinge's first side is that of the member's first node, a joint's the node, a
        support's the ground.
    parts
        Rigid parts on both sides; several of them may belong to the ground.
    position
        At the start [m], (3,).
    axes
        Its own x, y, z at the start as rows, (3, 3).
    free
        Relative freedoms that it leaves, 0 to 2 along and 3 to 5 about its axes; a hinge resists in them.
    hinge
        The plastic hinge, or None.
    universal
        Whether its y stays with the first body and its z with the second, like a cross.
    end
        Member that a joint joins, and 0 or 1 for its first or second node.
    """

    name: str
    kind: str
    first: int
    second: int
    parts: tuple[int, int]
    position: Floats
    axes: Floats
    free: tuple[int, ...]
    hinge: PlacedHinge | None = None
    universal: bool = False
    end: tuple[str, int] | None = None

    @property
    def held(self) -> tuple[bool, bool, bool, bool, bool, bool]:
        """Which of the six relative freedoms are held."""
        x, y, z, rx, ry, rz = (i not in self.free for i in range(6))
        return x, y, z, rx, ry, rz


@dataclass(frozen=True, eq=False)
class Linkage:
    """Rigid bodies and their connections.

    Attributes
    ----------
    bodies
        Mass properties at the start.
    connections
        Hinges first, in the order of `placed_hinges`, then joints, then supports.
    pieces
        Where every part of every member went, by member, along the member.
    node_body, node_part
        Body and rigid part of every node.
    part_mass
        Mass of every rigid part of the ground that has any.
    ground_parts
        Rigid parts of the ground.
    corner_sides
        Bodies on both sides of the hinge of every mitred corner, by node.  The hinge turns and slips between
        the ends of both members.  As in shells, where the node is the mean of the mitre that they share, it
        is neither's.
    """

    bodies: tuple[RigidMass, ...]
    connections: tuple[Connection, ...]
    pieces: dict[str, tuple[Piece, ...]]
    node_body: dict[str, int]
    node_part: dict[str, int]
    part_mass: dict[int, RigidMass]
    ground_parts: frozenset[int]
    corner_sides: Mapping[str, tuple[int, int]] = field(default_factory=dict)

    @cached_property
    def trees(self) -> dict[bool, Any]:
        """Spanning trees found by `mobility`, by whether hinges are locked."""
        return {}

    @property
    def hinges(self) -> tuple[PlacedHinge, ...]:
        """Hinges in the order of their connections."""
        return tuple(c.hinge for c in self.connections if c.hinge is not None)


def link(structure: Structure, hinges: tuple[PlacedHinge, ...] | None = None) -> Linkage:
    """Bodies and connections of a structure.

    Parameters
    ----------
    structure
        A structure that passed its checks.
    hinges
        Its hinges; None: as `placed_hinges` gives them.

    Raises
    ------
    InputError
        If a hinge or joint joins a part with itself, or two held parts.
    """
    placed = placed_hinges(structure) if hinges is None else hinges
    # studies place other hinges at the same places; these are linked anew
    if placed is not structure.kept.get(OWN_HINGES):
        return _link(structure, placed)
    return structure.kept.once("linkage", "", lambda: _link(structure, placed))


def _link(structure: Structure, hinges: tuple[PlacedHinge, ...]) -> Linkage:
    assembly = assemble(structure, hinges)
    cuts, masses = assembly.moving_cuts(), assembly.masses()
    held = _held(structure)
    clamped = {assembly.root(assembly.node[node]) for node, freedoms in held.items() if len(freedoms) == 6}
    for cut in cuts:
        if cut.first in clamped and cut.second in clamped:
            raise idle(structure, cut.hinge, cut.joint)
    parts = list(dict.fromkeys(assembly.root(i) for i in range(len(assembly.parent))))
    used = {side for cut in cuts for side in (cut.first, cut.second)} | set(masses)
    moving = [part for part in parts if part in used and part not in clamped]
    body = {part: i for i, part in enumerate(moving)}
    bodies = tuple(masses.get(part, RigidMass(0.0, np.zeros(3), np.zeros((3, 3)))) for part in moving)
    connections = [_cut_connection(structure, cut, body) for cut in cuts]
    connections.sort(key=lambda c: c.hinge is None)
    connections += _supports(assembly, body, held)
    pieces = {
        name: tuple(Piece(name, a, b, body.get(assembly.root(i), GROUND)) for a, b, i in of)
        for name, of in assembly.pieces.items()
    }
    node_part = {node: assembly.root(i) for node, i in assembly.node.items()}
    return Linkage(
        bodies=bodies,
        connections=tuple(connections),
        pieces=pieces,
        node_body={node: body.get(part, GROUND) for node, part in node_part.items()},
        node_part=node_part,
        part_mass={part: masses[part] for part in clamped if part in masses},
        ground_parts=frozenset(clamped),
        corner_sides=_corner_sides(structure, connections),
    )


def _corner_sides(structure: Structure, connections: list[Connection]) -> dict[str, tuple[int, int]]:
    sides = {c.hinge.name: (c.first, c.second) for c in connections if c.hinge is not None}
    names = {node: corner_name(node) for node in corner_laws(structure)}
    return {node: sides[name] for node, name in names.items() if name in sides}


def with_laws(linkage: Linkage, hinges: tuple[PlacedHinge, ...]) -> Linkage:
    """A linkage with other laws in its hinges, found by their names; places and axes are kept."""
    laws = {hinge.name: hinge for hinge in hinges}
    connections = tuple(
        c if c.hinge is None else replace(c, hinge=laws[c.hinge.name]) for c in linkage.connections
    )
    return replace(linkage, connections=connections)


def hinge_axes(structure: Structure, hinge: PlacedHinge) -> Floats:
    """Axes of a hinge as rows, (3, 3): along the member, and its two bending axes; or those of a corner."""
    if hinge.axes is not None:
        return hinge.axes
    x = structure.frame_of(hinge.member).x
    if hinge.axis == "y":
        return np.array([x, hinge.direction, cross(x, hinge.direction)])
    return np.array([x, cross(hinge.direction, x), hinge.direction])


def _held(structure: Structure) -> dict[str, set[str]]:
    """Freedoms that supports hold, for every supported node, without the driven ones."""
    held: dict[str, set[str]] = {}
    for support in structure.supports.values():
        held.setdefault(support.node, set()).update(support.held)
    return held


def _cut_connection(structure: Structure, cut: Cut, body: dict[int, int]) -> Connection:
    go_on()
    first, second = body.get(cut.first, GROUND), body.get(cut.second, GROUND)
    parts = (cut.first, cut.second)
    if cut.hinge is not None:
        hinge = cut.hinge
        axes = hinge_axes(structure, hinge)
        free: tuple[int, ...] = (FREEDOM[hinge.axis],)
        if hinge.spatial is not None:
            free = tuple(int(freedom) for freedom in hinge.spatial.freedoms)
        return Connection(hinge.name, "hinge", first, second, parts, hinge.position, axes, free, hinge)
    name = str(cut.joint)
    joint = structure.joints[name]
    position = np.asarray(structure.nodes[joint.node], float)
    axes = joint_axes(joint)
    end = (joint.member, structure.members[joint.member].nodes.index(joint.node))
    universal = joint.type == "universal"
    return Connection(
        name, "joint", first, second, parts, position, axes, joint.free, universal=universal, end=end
    )


def joint_axes(joint: Joint) -> Floats:
    """Right-handed axes of a joint as rows, (3, 3), in the order in which its `free` counts them."""
    if joint.axis is None:
        return np.eye(3)
    x = np.asarray(joint.axis, float) / np.linalg.norm(joint.axis)
    if joint.second is not None:
        second = np.asarray(joint.second, float)
        second -= (second @ x) * x
        second /= np.linalg.norm(second)
        return np.array([cross(x, second), x, second])
    y = cross(np.eye(3)[int(np.argmin(np.abs(x)))], x)
    y /= np.linalg.norm(y)
    return np.array([x, y, cross(x, y)])


def _supports(assembly: Assembly, body: dict[int, int], held: dict[str, set[str]]) -> list[Connection]:
    """One connection for every support that does not clamp its node; driven freedoms count as held."""
    found = []
    for name, support in assembly.structure.supports.items():
        part = assembly.root(assembly.node[support.node])
        if part not in body:
            continue
        taken = {*support.held, *support.driven}
        free = tuple(i for i, freedom in enumerate(FREEDOMS) if freedom not in taken)
        position = np.asarray(assembly.structure.nodes[support.node], float)
        found.append(
            Connection(name, "support", GROUND, body[part], (GROUND, part), position, np.eye(3), free)
        )
    return found


def check_inertia(linkage: Linkage) -> None:
    """Refuse bodies without mass, or without inertia about some axis.

    Raises
    ------
    InputError
        With every such body.
    """
    problems = []
    for i, mass in enumerate(linkage.bodies):
        moments = np.linalg.eigvalsh(mass.inertia)
        if mass.mass > 0.0 and moments[0] > THIN * moments[-1]:
            continue
        what, where = described(linkage, i)
        came = "mass 0 kg" if mass.mass == 0.0 else "a mass without rotary inertia"
        allowed, todo = "a body with mass and rotary inertia", "move the hinge, or give the node a mass"
        problems.append(Problem(f"{what} has no inertia", came, allowed, todo, where))
    if problems:
        raise InputError(problems)


def described(linkage: Linkage, body: int) -> tuple[str, str]:
    """What a body consists of, and a path of the input where it is defined."""
    for name, pieces in linkage.pieces.items():
        for piece in pieces:
            if piece.body == body:
                span = f"between {1e3 * piece.start:.6g} mm and {1e3 * piece.end:.6g} mm"
                return f"the body {span} of member {name}", f"members.{name}.hinges"
    nodes = [node for node, i in linkage.node_body.items() if i == body]
    return f"the body at node {', '.join(nodes)}", "joints"
