"""From the bodies and connections of a structure to a tree in a plane, for the planar kernel.

The linkage is the one that both kernels are lowered from.  In the plane a body that holds a clamped node is
the ground.  The graph of bodies and hinges is walked breadth first from the ground (a structure that floats
from its heaviest body) so that parents come before children.  A hinge that leads back to a body already met
closes a loop: that body is cut in equal parts, one for each of its hinges to hang on, and welds hold the
parts together.
"""

from __future__ import annotations

from collections import Counter, defaultdict, deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from crumple.cancelling import go_on
from crumple.errors import InputError, Problem
from crumple.multibody.bodies.assembly import Piece, idle
from crumple.multibody.bodies.linkage import GROUND, Linkage, link
from crumple.multibody.bodies.rigid import RigidMass
from crumple.multibody.planar.plane import Plane, plane_of
from crumple.numeric.arrays import Floats
from crumple.structure import PlacedHinge, Structure, placed_hinges

Edge = tuple[PlacedHinge, int, int]
"""A hinge and the bodies on its sides."""


@dataclass(frozen=True, eq=False)
class Link:
    """Inboard joint of a body.

    Attributes
    ----------
    parent
        Body that it hangs on; -1 ground.
    position
        Of the joint at the start [m], (3,).
    hinge
        The plastic hinge, or None: a pin of a support, or the free joint of a floating root.
    free
        Whether the body floats.
    sign
        +1 if the hinge's rotation (second side against first, about its axis) is the joint's (this body
        against its parent, about the plane's normal), -1 if it is the opposite.
    """

    parent: int
    position: Floats
    hinge: PlacedHinge | None = None
    free: bool = False
    sign: float = 1.0


def hinge_links(links: Iterable[Link]) -> Iterator[tuple[int, PlacedHinge, float]]:
    """Joint coordinate, hinge and sign of every hinge, in the kernel's order."""
    dof = 0
    for joint in links:
        if joint.hinge is not None:
            yield dof, joint.hinge, joint.sign
        dof += 3 if joint.free else 1


@dataclass(frozen=True, eq=False)
class Mechanism:
    """Rigid bodies in a tree, in space.

    Attributes
    ----------
    plane
        Plane in which it moves.
    bodies
        Mass properties per body.
    links
        Inboard joint per body; parents first.
    pieces
        Where every part of every member went, by member, along the member.
    node_body
        Body of every node.
    welds
        Further parts of cut bodies: (part, body that it belongs to, -1 for the ground).
    pin_joints
        Pinned nodes whose pin is a joint of the tree; the other pins are constraints.
    corner_sides
        Bodies on both sides of the hinge of every mitred corner, by node.
    """

    plane: Plane
    bodies: tuple[RigidMass, ...]
    links: tuple[Link, ...]
    pieces: dict[str, tuple[Piece, ...]]
    node_body: dict[str, int]
    corner_sides: Mapping[str, tuple[int, int]] = field(default_factory=dict)
    welds: tuple[tuple[int, int], ...] = ()
    pin_joints: frozenset[str] = frozenset()

    def parts_of(self, body: int) -> int:
        """Into how many equal parts a body is cut; its mass here is that of one."""
        return 1 + sum(whole == body for _, whole in self.welds)


def lower(structure: Structure, hinges: tuple[PlacedHinge, ...] | None = None) -> Mechanism:
    """Cut a structure into rigid bodies and hinges.

    Parameters
    ----------
    structure
        A structure that passed its checks.
    hinges
        Its hinges; None: as `placed_hinges` gives them.

    Raises
    ------
    InputError
        If there are joints, hinges' axes are not parallel, a hinge cannot turn, or a body has no inertia.
    """
    hinges = placed_hinges(structure) if hinges is None else hinges
    if structure.joints:
        raise _needs_space()
    plane = plane_of(structure, hinges)
    return _walk(structure, link(structure, hinges), plane)


@dataclass
class _Graph:
    """Bodies of a linkage as they move in the plane: those that supports clamp there belong to the ground."""

    clamped: set[int]
    pinned: list[tuple[int, str]]
    """Bodies and their nodes that supports pin, in the order of the nodes."""
    edges: dict[int, list[Edge]]
    heaviest: list[int]
    """Bodies with mass, the heaviest first; of equal ones the one of the first member."""

    def body(self, number: int) -> int:
        """The body that moves in the plane."""
        return GROUND if number in self.clamped else number


def _graph(structure: Structure, linkage: Linkage, plane: Plane) -> _Graph:
    held = {node: plane.held(structure, node) for node in structure.nodes if node in structure.supports_at}
    clamped = {linkage.node_body[node] for node, by in held.items() if by.clamped}
    pinned = [(linkage.node_body[node], node) for node, by in held.items() if by.pinned and not by.clamped]
    pieces = [piece.body for pieces in linkage.pieces.values() for piece in pieces]
    lumps = [linkage.node_body[mass.node] for mass in structure.masses.values()]
    massive = [i for i in dict.fromkeys([*pieces, *lumps]) if i != GROUND and linkage.bodies[i].mass > 0.0]
    heaviest = sorted(massive, key=lambda i: -linkage.bodies[i].mass)
    graph = _Graph(clamped, pinned, defaultdict(list), heaviest)
    for connection in linkage.connections:
        go_on()
        if connection.hinge is None:
            continue
        first, second = graph.body(connection.first), graph.body(connection.second)
        if first == second:
            raise idle(structure, connection.hinge, None)
        graph.edges[first].append((connection.hinge, first, second))
        graph.edges[second].append((connection.hinge, first, second))
    return graph


def _walk(structure: Structure, linkage: Linkage, plane: Plane) -> Mechanism:
    """Number the bodies from the ground outwards."""
    graph = _graph(structure, linkage, plane)
    number: dict[int, int] = {GROUND: GROUND}
    links: list[Link] = []
    order: list[int] = []
    welds: list[tuple[int, int]] = []
    used: set[str] = set()
    jointed: set[str] = set()

    def enter(body: int, joint: Link) -> None:
        if body in number:
            welds.append((len(links), number[body]))
        else:
            number[body] = len(links)
        links.append(joint)
        order.append(body)

    def spread(start: int) -> None:
        queue = deque([start])
        while queue:
            go_on()
            here = queue.popleft()
            for hinge, first, second in graph.edges[here]:
                if hinge.name in used:
                    continue
                used.add(hinge.name)
                there = second if here == first else first
                sign = float(np.sign(hinge.direction @ plane.normal)) * (1.0 if there == second else -1.0)
                if there not in number:
                    queue.append(there)
                enter(there, Link(number[here], hinge.position, hinge, sign=sign))

    spread(GROUND)
    for body, node in graph.pinned:
        if graph.body(body) in number:
            continue
        jointed.add(node)
        enter(body, Link(GROUND, np.asarray(structure.nodes[node], float)))
        spread(body)
    for body in graph.heaviest:
        if graph.body(body) not in number:
            enter(body, Link(GROUND, linkage.bodies[body].centre, free=True))
            spread(body)
    parts = Counter(order)
    bodies = tuple(
        linkage.bodies[order[joint.parent]] if body == GROUND else _part(linkage.bodies[body], parts[body])
        for body, joint in zip(order, links, strict=True)
    )
    _check_inertia(bodies, links, plane)

    places = _places(linkage, lambda body: number.get(graph.body(body), GROUND))
    return Mechanism(plane, bodies, tuple(links), *places, tuple(welds), frozenset(jointed))


def _places(
    linkage: Linkage, numbered: Callable[[int], int]
) -> tuple[dict[str, tuple[Piece, ...]], dict[str, int], dict[str, tuple[int, int]]]:
    """Pieces of members, bodies of nodes, and bodies on both sides of corners, in the mechanism's numbers."""
    pieces = {
        name: tuple(Piece(name, piece.start, piece.end, numbered(piece.body)) for piece in of)
        for name, of in linkage.pieces.items()
    }
    node_body = {node: numbered(body) for node, body in linkage.node_body.items()}
    sides = {node: (numbered(a), numbered(b)) for node, (a, b) in linkage.corner_sides.items()}
    return pieces, node_body, sides


def _part(whole: RigidMass, parts: int) -> RigidMass:
    """Share of a body that is cut; parts of the ground never move, so their mass has no effect."""
    if parts == 1:
        return whole
    return RigidMass(whole.mass / parts, whole.centre, whole.inertia / parts)


def _check_inertia(bodies: tuple[RigidMass, ...], links: list[Link], plane: Plane) -> None:
    problems = []
    for body, joint in zip(bodies, links, strict=True):
        if body.mass > 0.0 and plane.normal @ body.inertia @ plane.normal > 0.0:
            continue
        place = ", ".join(f"{value:.4g}" for value in joint.position)
        body_at = f"beyond hinge {joint.hinge.name}" if joint.hinge else f"held by the pin at ({place}) m"
        problems.append(
            Problem(
                f"the body {body_at} has no inertia",
                "mass 0 kg",
                "a body with mass and rotary inertia",
                "move the hinge into the member, or give the node a mass",
                f"hinges.{joint.hinge.name}" if joint.hinge else "supports",
            )
        )
    if problems:
        raise InputError(problems)


def _needs_space() -> InputError:
    what, todo = "the tree kernel does not support joints", "write kernel: auto"
    return InputError(Problem(what, "", "hinges and supports alone", todo, "analysis.multibody.kernel"))
