"""The motions that a linkage allows at the start, and the constraints that are redundant.

Every connection leaves some relative motion: a twist of the second body against the first for each free
freedom, written about one point for all.  A spanning tree from the ground carries every body; each
connection beyond the tree closes a loop, around which all relative motions must cancel:

    sum over the loop of +-(twists) rates = 0            six equations for each loop

The null space of these equations is what can move (its size is the mobility); equations that depend on the
others are constraints held twice, in consistent structures harmless, but then the forces in them are not
unique.  This is the count at the start: straight structures may gain or lose motion as they deform.
"""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from crumple.cancelling import go_on
from crumple.multibody.bodies.linkage import GROUND, Connection, Linkage
from crumple.numeric.arrays import Floats
from crumple.text.names import listed

NOTHING = 1e-9
"""Singular value relative to the largest, and share of a motion, below which it is rounding."""
LARGEST_SYSTEM = 2000
"""Largest number of equations, or freedoms, of loops for a dense decomposition: seconds, and 32 MB."""


@dataclass(frozen=True)
class Mobility:
    """Mobility of a linkage.

    Attributes
    ----------
    motions
        Number of independent motions.
    moving
        Bodies that take part in one, increasing.
    stuck
        Connections with free freedoms of which none can move.
    redundant
        Constraints that others imply.
    across
        Those of them across the plane in which all loops move, three a loop; 0 if there is no such plane.
    loops
        Connections of the loops that hold redundant constraints.
    """

    motions: int
    moving: tuple[int, ...]
    stuck: tuple[int, ...]
    redundant: int
    loops: tuple[int, ...]
    across: int = 0


class Columns:
    """Twists of free freedoms, each computed when it is needed; off the loops of a chain none is.

    Parameters
    ----------
    linkage
        Whose connections have the freedoms.
    """

    def __init__(self, linkage: Linkage) -> None:
        self._linkage = linkage
        self._freedoms: list[tuple[int, int]] = []
        self._found: dict[int, Floats] = {}

    @cached_property
    def _scale(self) -> tuple[Floats, float]:
        return scale_of(self._linkage)

    def add(self, owner: int, freedoms: Sequence[int]) -> list[int]:
        """Numbers of further freedoms of a connection, or of the ground for those of a floating body."""
        first = len(self._freedoms)
        self._freedoms += [(owner, freedom) for freedom in freedoms]
        return list(range(first, len(self._freedoms)))

    def __getitem__(self, k: int) -> Floats:
        if k not in self._found:
            owner, freedom = self._freedoms[k]
            connections = self._linkage.connections
            self._found[k] = (
                np.eye(6)[freedom] if owner == GROUND else _twist(connections[owner], freedom, *self._scale)
            )
        return self._found[k]


@dataclass
class Tree:
    """Spanning tree: twists of the free freedoms, and the connection through which every body is reached."""

    columns: Columns
    owner: list[int] = field(default_factory=list)
    inboard: dict[int, tuple[int, int, list[int], float]] = field(default_factory=dict)
    """By body: the body before it, the connection (-1: floating), its freedoms, and their sign."""
    loops: list[tuple[int, list[int]]] = field(default_factory=list)
    """Connections beyond the tree, and their freedoms."""

    def freedoms(self, owner: int, free: Sequence[int]) -> list[int]:
        """Numbers of further free freedoms."""
        self.owner += [owner] * len(free)
        return self.columns.add(owner, free)

    def path(self, body: int) -> Iterator[tuple[int, list[int], float]]:
        """Connections from a body to the ground."""
        while body != GROUND:
            body, connection, own, sign = self.inboard[body]
            yield connection, own, sign


def mobility(linkage: Linkage, *, locked: bool = False) -> Mobility:
    """Motions that the connections allow.

    Parameters
    ----------
    linkage
        Bodies and connections.
    locked
        Whether hinges carry every moment, as they do until they yield.
    """
    if not linkage.bodies:
        return Mobility(0, (), (), 0, ())
    tree = tree_of(linkage, locked)
    width = len(tree.owner)
    blocks = [_loop_rows(linkage, tree, width, closing, own) for closing, own in tree.loops]
    system = np.concatenate([rows for rows, _ in blocks]) if blocks else np.zeros((0, width))
    # a connection on no loop moves independently
    coupled = np.flatnonzero(np.any(system != 0.0, axis=0))
    null, redundant = null_space(system[:, coupled])
    moves = np.ones(width, bool)
    moves[coupled] = np.any(np.abs(null) > NOTHING, axis=0)
    bodies: set[int] = set()
    # every body comes after the one from which it is reached
    for body, (before, _, own, _) in tree.inboard.items():
        if before in bodies or moves[own].any():
            bodies.add(body)
    free: dict[int, list[int]] = defaultdict(list)
    for k, owner in enumerate(tree.owner):
        if owner != GROUND:
            free[owner].append(k)
    stuck = tuple(i for i, own in sorted(free.items()) if not moves[own].any())
    doubled = {i for rows, loop in blocks if redundant and null_space(rows)[1] for i in loop}
    number = width - len(coupled) + len(null)
    across = (
        3 * len(blocks) if redundant and _planar(np.array([tree.columns[k] for k in coupled.tolist()])) else 0
    )
    return Mobility(number, tuple(sorted(bodies)), stuck, redundant, tuple(sorted(doubled)), across)


def _planar(twists: Floats) -> bool:
    """Whether twists, (n, 6), are rotations about one direction, and motions across it."""
    if not len(twists):
        return False
    turns, moves = twists[:, :3], twists[:, 3:]
    normal = np.linalg.svd(turns)[2][0]
    in_plane = np.abs(turns - np.outer(turns @ normal, normal)).max() <= NOTHING
    return bool(turns.any() and in_plane and np.abs(moves @ normal).max() <= NOTHING)


def too_large(linkage: Linkage) -> bool:
    """Whether the equations of the loops are too many for a dense decomposition."""
    tree = tree_of(linkage)
    return bool(tree.loops) and max(6 * len(tree.loops), len(tree.owner)) > LARGEST_SYSTEM


def free_twists(linkage: Linkage, points: Floats, *, locked: bool = False) -> Floats:
    """Velocities of places on every body in each independent motion.

    Parameters
    ----------
    linkage
        Bodies and connections.
    points
        One place for every body [m], (b, 3).
    locked
        Whether hinges carry every moment.

    Returns
    -------
    Floats
        Angular velocity and velocity of the place, (motions, b, 6), to scales of their own.
    """
    if not linkage.bodies:
        return np.zeros((0, 0, 6))
    tree = tree_of(linkage, locked)
    system = loop_system(linkage, tree)
    rates = null_space(system)[0] if len(system) else np.eye(len(tree.owner))
    centre, length = scale_of(linkage)
    found = np.zeros((len(rates), len(linkage.bodies), 6))
    for body in range(len(linkage.bodies)):
        for _, own, sign in tree.path(body):
            for k in own:
                found[:, body] += sign * np.outer(rates[:, k], tree.columns[k])
        spin = found[:, body, :3]
        found[:, body, 3:] = length * found[:, body, 3:] + np.cross(spin, points[body] - centre)
    return found


def notes(linkage: Linkage, released: Linkage | None = None) -> tuple[str, ...]:
    """Sentences about parts that are not held, hinges that cannot rotate, and redundant constraints.

    Parameters
    ----------
    linkage
        Its driven freedoms count as held.
    released
        The same with all driven freedoms free, if there are any: what a drive moves is not stuck.
    """
    if too_large(linkage):
        return ("The structure is too large to count what is free, locked or held twice.",)
    found = list(free_parts(linkage))
    free = mobility(linkage)
    names = [connection.name for connection in linkage.connections]
    stuck = free.stuck
    if stuck and released is not None:
        held = mobility(released).stuck
        stuck = tuple(i for i in stuck if i in held)
    if stuck:
        text = _named("Hinge or joint", "Hinges and joints", [names[i] for i in stuck])
        found.append(f"{text} cannot move at the start: the closed loops around prevent it.")
    # every loop that moves in a plane is held thrice across it, which says nothing of forces in the plane
    redundant = free.redundant - free.across
    if redundant:
        elastic = {i for i in free.loops if (hinge := linkage.connections[i].hinge) and not hinge.plastic}
        shown = [names[i] for i in free.loops if i not in elastic] or [names[i] for i in free.loops]
        # loops of supports alone have no connection with a name
        what = f"Closed loops through {listed(shown)} are" if shown else "Parts between supports are"
        found.append(
            f"{what} held more often than it takes "
            f"({redundant} redundant constraint{'s' * (redundant > 1)}): motion and energies are unique, but "
            "forces along which nothing gives way are not, and of these "
            "one possible set is given."
        )
    return tuple(found)


def free_parts(linkage: Linkage) -> tuple[str, ...]:
    """A sentence about parts that can move without rotation of any hinge; empty if all is held."""
    rigid = mobility(linkage, locked=True)
    if not rigid.motions:
        return ()
    grounded = any(GROUND in (connection.first, connection.second) for connection in linkage.connections)
    if not grounded and rigid.motions == 6:
        return ("The structure has no supports: it moves freely in space.",)
    ways = f"{rigid.motions} independent ways" if rigid.motions > 1 else "one way"
    moving = set(rigid.moving)
    names = [name for name, pieces in linkage.pieces.items() if any(p.body in moving for p in pieces)]
    return (
        f"The supports and joints leave {ways} to move without rotation of any hinge "
        f"({named_members(tuple(names))}).",
    )


def floating_bodies(linkage: Linkage) -> set[int]:
    """Bodies that are not connected with the ground."""
    beside: dict[int, list[int]] = defaultdict(list)
    for connection in linkage.connections:
        beside[connection.first].append(connection.second)
        beside[connection.second].append(connection.first)
    held, queue = {GROUND}, deque([GROUND])
    while queue:
        go_on()
        reached = set(beside[queue.popleft()]) - held
        held |= reached
        queue.extend(reached)
    return set(range(len(linkage.bodies))) - held


def floating_members(linkage: Linkage) -> tuple[str, ...]:
    """Members that are not connected with the ground, in the structure's order."""
    floating = floating_bodies(linkage)
    return tuple(name for name, pieces in linkage.pieces.items() if {p.body for p in pieces} <= floating)


def tree_of(linkage: Linkage, locked: bool = False) -> Tree:
    """Breadth-first tree from the ground; bodies that it does not reach are floating."""
    if locked not in linkage.trees:
        linkage.trees[locked] = _tree_of(linkage, locked)
    tree: Tree = linkage.trees[locked]
    return tree


def _tree_of(linkage: Linkage, locked: bool) -> Tree:
    tree = Tree(Columns(linkage))
    own: list[list[int]] = []
    edges: dict[int, list[int]] = defaultdict(list)
    for i, connection in enumerate(linkage.connections):
        free = () if locked and connection.hinge is not None else connection.free
        own.append(tree.freedoms(i, free) if free else [])
        edges[connection.first].append(i)
        edges[connection.second].append(i)
    used: set[int] = set()
    for start in (GROUND, *range(len(linkage.bodies))):
        if start in tree.inboard:
            continue
        if start != GROUND:
            tree.inboard[start] = (GROUND, GROUND, tree.freedoms(GROUND, range(6)), 1.0)
        queue = deque([start])
        while queue:
            go_on()
            here = queue.popleft()
            for i in edges[here]:
                connection = linkage.connections[i]
                ahead = here == connection.first
                there = connection.second if ahead else connection.first
                if there == GROUND or there in tree.inboard:
                    continue
                used.add(i)
                tree.inboard[there] = (here, i, own[i], 1.0 if ahead else -1.0)
                queue.append(there)
    tree.loops = [(i, own[i]) for i in range(len(linkage.connections)) if i not in used]
    return tree


def loop_system(linkage: Linkage, tree: Tree) -> Floats:
    """Equations of all loops, (6 loops, freedoms)."""
    width = len(tree.owner)
    blocks = [_loop_rows(linkage, tree, width, closing, own)[0] for closing, own in tree.loops]
    return np.concatenate(blocks) if blocks else np.zeros((0, width))


def _loop_rows(
    linkage: Linkage, tree: Tree, width: int, closing: int, own: list[int]
) -> tuple[Floats, set[int]]:
    """Six equations of a loop, and the connections along it."""
    rows = np.zeros((6, width))
    along = {closing}
    for k in own:
        rows[:, k] = tree.columns[k]
    connection = linkage.connections[closing]
    for body, sense in ((connection.first, 1.0), (connection.second, -1.0)):
        for passed, free, sign in tree.path(body):
            along ^= {passed}
            for k in free:
                rows[:, k] += sense * sign * tree.columns[k]
    return rows, along - {GROUND}


def _twist(connection: Connection, freedom: int, centre: Floats, length: float) -> Floats:
    """Rotation and translation of the common point, over the length, of one relative freedom."""
    axis = connection.axes[freedom % 3]
    if freedom < 3:
        return np.concatenate([np.zeros(3), axis])
    # written out: np.cross takes twenty times as long for one pair of vectors
    (a, b, c), (x, y, z) = axis.tolist(), (centre - connection.position).tolist()
    return np.array([a, b, c, (b * z - c * y) / length, (c * x - a * z) / length, (a * y - b * x) / length])


def scale_of(linkage: Linkage) -> tuple[Floats, float]:
    """Common reference point and length of a linkage."""
    places = np.array([c.position for c in linkage.connections] + [b.centre for b in linkage.bodies])
    centre = places.mean(axis=0)
    return centre, float(np.linalg.norm(places - centre, axis=1).max()) or 1.0


def null_space(system: Floats) -> tuple[Floats, int]:
    """Orthonormal basis of a system's null space, and the number of its redundant rows."""
    if not len(system):
        return np.zeros((0, system.shape[1])), 0
    null, left = null_spaces(system)
    return null, len(left)


def null_spaces(system: Floats) -> tuple[Floats, Floats]:
    """Orthonormal bases of the null spaces of a system and of its transpose, as rows."""
    left, sizes, right = np.linalg.svd(system)
    rank = int(np.sum(sizes > NOTHING * max(float(sizes.max(initial=0.0)), 1.0)))
    return right[rank:], left[:, rank:].T


def named_members(names: tuple[str, ...]) -> str:
    """Members as part of a sentence."""
    return _named("member", "members", list(names))


def _named(one: str, several: str, names: list[str]) -> str:
    return f"{one if len(names) == 1 else several} {listed(names)}"
