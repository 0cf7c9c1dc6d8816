"""From a structure to rigid bodies joined by hinges: a tree in space, as the engine sees it.

Members are cut at their hinges.  Pieces that meet at a node are one rigid body; a body that holds a clamped
node is the ground.  What is left is a graph of bodies and hinges, walked breadth first from the ground (a
structure that floats from its heaviest body) so that parents come before children.  A hinge that leads back
to a body already met closes a loop: that body is cut in equal parts, one for each of its hinges to hang on,
and welds hold the parts together.
"""

from __future__ import annotations

from collections import Counter, defaultdict, deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from crumple.cancelling import go_on
from crumple.errors import InputError, Problem
from crumple.multibody.bodies.assembly import Assembly, Piece, assemble
from crumple.multibody.bodies.rigid import RigidMass
from crumple.multibody.planar.plane import Plane, plane_of
from crumple.numeric.arrays import Floats
from crumple.structure import PlacedHinge, Structure, placed_hinges

GROUND = -1


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
    for link in links:
        if link.hinge is not None:
            yield dof, link.hinge, link.sign
        dof += 3 if link.free else 1


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
    """

    plane: Plane
    bodies: tuple[RigidMass, ...]
    links: tuple[Link, ...]
    pieces: dict[str, tuple[Piece, ...]]
    node_body: dict[str, int]
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
        Sound.
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
    assembly = assemble(structure, hinges)
    ground = assembly.new()
    pins: dict[int, str] = {}
    for node, cluster in assembly.node.items():
        held = plane.held(structure, node)
        if held.clamped:
            assembly.join(ground, cluster)
        elif held.pinned:
            pins[cluster] = node
    return _walk(assembly, plane, ground, pins)


def _walk(assembly: Assembly, plane: Plane, ground: int, pins: dict[int, str]) -> Mechanism:
    """Number the bodies from the ground outwards."""
    structure, root = assembly.structure, assembly.root
    masses = assembly.masses()
    edges = _edges(assembly)
    number: dict[int, int] = {root(ground): GROUND}
    links: list[Link] = []
    order: list[int] = []
    welds: list[tuple[int, int]] = []
    used: set[str] = set()
    jointed: set[str] = set()

    def enter(cluster: int, link: Link) -> None:
        if cluster in number:
            welds.append((len(links), number[cluster]))
        else:
            number[cluster] = len(links)
        links.append(link)
        order.append(cluster)

    def spread(start: list[int]) -> None:
        queue = deque(start)
        while queue:
            go_on()
            here = queue.popleft()
            for hinge, first, second in edges[here]:
                if hinge.name in used:
                    continue
                used.add(hinge.name)
                there = second if here == first else first
                sign = float(np.sign(hinge.direction @ plane.normal)) * (1.0 if there == second else -1.0)
                if there not in number:
                    queue.append(there)
                enter(there, Link(number[here], hinge.position, hinge, sign=sign))

    spread([root(ground)])
    for cluster, node in pins.items():
        if root(cluster) in number:
            continue
        jointed.add(node)
        enter(root(cluster), Link(GROUND, np.asarray(structure.nodes[node], float)))
        spread([root(cluster)])
    for cluster in sorted(masses, key=lambda c: -masses[c].mass):
        if cluster not in number and masses[cluster].mass > 0.0:
            enter(cluster, Link(GROUND, masses[cluster].centre, free=True))
            spread([cluster])
    parts = Counter(order)
    bodies = tuple(
        masses[order[link.parent]] if cluster == root(ground) else _part(masses[cluster], parts[cluster])
        for cluster, link in zip(order, links, strict=True)
    )
    _check_inertia(bodies, links, plane)
    pieces = {
        name: tuple(Piece(name, a, b, number.get(root(i), GROUND)) for a, b, i in cuts)
        for name, cuts in assembly.pieces.items()
    }
    node_body = {node: number.get(root(i), GROUND) for node, i in assembly.node.items()}
    return Mechanism(
        plane, bodies, tuple(links), pieces, node_body, welds=tuple(welds), pin_joints=frozenset(jointed)
    )


def _part(whole: RigidMass, parts: int) -> RigidMass:
    """Share of a body that is cut; a part of the ground never moves, so that any mass serves there."""
    return RigidMass(whole.mass / parts, whole.centre, whole.inertia / parts)


def _edges(assembly: Assembly) -> dict[int, list[tuple[PlacedHinge, int, int]]]:
    edges: dict[int, list[tuple[PlacedHinge, int, int]]] = defaultdict(list)
    for cut in assembly.moving_cuts():
        if cut.hinge is not None:
            edges[cut.first].append((cut.hinge, cut.first, cut.second))
            edges[cut.second].append((cut.hinge, cut.first, cut.second))
    return edges


def _check_inertia(bodies: tuple[RigidMass, ...], links: list[Link], plane: Plane) -> None:
    problems = []
    for body, link in zip(bodies, links, strict=True):
        if body.mass > 0.0 and plane.normal @ body.inertia @ plane.normal > 0.0:
            continue
        place = ", ".join(f"{value:.4g}" for value in link.position)
        body_at = f"beyond hinge {link.hinge.name}" if link.hinge else f"held by the pin at ({place}) m"
        problems.append(
            Problem(
                f"the body {body_at} has no inertia",
                "mass 0 kg",
                "a body with mass and rotary inertia",
                "move the hinge into the member, or give the node a mass",
                f"hinges.{link.hinge.name}" if link.hinge else "supports",
            )
        )
    if problems:
        raise InputError(problems)


def _needs_space() -> InputError:
    what, todo = "the tree kernel does not take joints", "write kernel: auto"
    return InputError(Problem(what, "", "hinges and supports alone", todo, "analysis.multibody.kernel"))
