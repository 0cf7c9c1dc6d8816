"""Braced members: none of their hinges can open unless some member changes its length.

Take every node as a pin and every member as a bar of fixed length.  With the unit vector e_k of bar k from node
i to node j, and the displacements q of the nodes that no support holds, the bars keep their lengths if

    R q = 0,    (R q)_k = e_k . (q_j - q_i)

(compatibility matrix R, first order).  The null space of R is all that hinges alone can do to the nodes: the sway
of a portal, the kink between two members in line, the motion of the whole where it is free.  In such a motion
bar k turns so that its direction changes by d_k = (q_j - q_i)/L_k across it.  A member is braced if in every such
motion one rotation w explains what it does and what it meets at both ends does, w x e_k = d_k, with no part of w
that a support there holds.  Then nothing turns against it, and what its hinges need comes from lengths alone.

Instead of a basis of the null space random displacements z are projected on it: what vanishes for them vanishes
for all.  The framework on a soft bed follows z where it is free to, (R'R + b I) q = b z, and where it is not, by the
share b/(b + s) alone, with the eigenvalue s of R'R; three times in a row leave nothing of it.

Limits: of first order, so a straight run through a node between two of its members can kink there even if both its
ends are held (held_runs).  Bars without hinges turn at the nodes like all others, spot welds hold nothing, and
joints other than spherical ones do not let anything turn: each of these can only make fewer members braced.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.bending import planar
from crumple.structure.hinges.asked import automatic_of
from crumple.structure.hinges.held_runs import passes_on
from crumple.structure.parts import StructureParts

BED = 1e-10
"""Stiffness of the bed over that of a bar: far below the softest braced framework, above rounding."""
TURN = 1e-5
"""Change of direction of a member of mean length, over the mean displacement of its nodes, that is none."""
MOTIONS = 3
"""Random displacements: one suffices unless it happens to be across the motion that matters."""
DENSE = 900
"""Displacements up to which the equations are solved as full ones, without loading a sparse solver."""


def braced(structure: StructureParts) -> frozenset[str]:
    """Members whose hinges cannot open unless some member changes its length."""
    return structure.kept.once("braced", "", lambda: _braced(structure))


def _braced(structure: StructureParts) -> frozenset[str]:
    lines = {name: structure.frame_of(name) for name in structure.members if structure.has_line(name)}
    if not lines:
        return frozenset()
    mean = float(np.mean([line.length for line in lines.values()]))
    moved = _motions(structure, list(lines))
    turned = {}
    for name, line in lines.items():
        first, second = structure.members[name].nodes
        apart = moved[second] - moved[first]
        turned[name] = (apart - np.outer(line.x, line.x @ apart)) * (mean / line.length)
    return frozenset(name for name in lines if _is_braced(structure, name, turned))


def _is_braced(structure: StructureParts, member: str, turned: dict[str, Floats]) -> bool:
    """Whether one rotation explains what a member does and what it meets."""
    if not all(passes_on(structure, member, node) for node in structure.members[member].nodes):
        return False
    met = {name for node in structure.members[member].nodes for name in _met(structure, member, node)}
    met &= turned.keys()
    held = {axis for node in structure.members[member].nodes for axis in _held(structure, node, "r")}
    if not met and not held:
        return False
    turning = [member, *sorted(met)]
    # w x e = -e x w
    rows = [-_cross(structure.frame_of(name).x) for name in turning] + [np.eye(3)[sorted(held)]]
    wanted = [turned[name] for name in turning] + [np.zeros((len(held), MOTIONS))]
    matrix, right = np.concatenate(rows), np.concatenate(wanted)
    rotation = np.linalg.lstsq(matrix, right, rcond=None)[0]
    return bool(np.abs(matrix @ rotation - right).max() <= TURN)


def _met(structure: StructureParts, member: str, node: str) -> Iterator[str]:
    """Other members that a member cannot turn against at a node but by hinges."""
    pinned = {joint.member for joint in structure.joints_at.get(node, ()) if joint.type == "spherical"}
    if member not in pinned:
        yield from (name for name in structure.members_at[node] if name != member and name not in pinned)


def _motions(structure: StructureParts, members: list[str]) -> dict[str, Floats]:
    """Random motions of the nodes that keep the lengths of all members, (3, MOTIONS) each."""
    nodes = list(dict.fromkeys(node for name in members for node in structure.members[name].nodes))
    free = {node: _free_directions(structure, node) for node in nodes}
    starts = dict(zip(nodes, np.cumsum([0, *(len(one) for one in free.values())]).tolist(), strict=False))
    count = sum(len(one) for one in free.values())
    rows: list[tuple[Floats, list[int]]] = []
    for name in members:
        if not _keeps_length(structure, name):
            continue
        first, second = structure.members[name].nodes
        along = structure.frame_of(name).x
        places = [starts[node] + i for node in (first, second) for i in range(len(free[node]))]
        rows.append((np.concatenate([-free[first] @ along, free[second] @ along]), places))
    found = np.random.default_rng(0).standard_normal((count, MOTIONS))
    for _ in range(3 if count else 0):
        found = BED * _solved(rows, found)
    return {node: one.T @ found[starts[node] : starts[node] + len(one)] for node, one in free.items()}


def _solved(rows: list[tuple[Floats, list[int]]], right: Floats) -> Floats:
    """Displacements of bars on a bed under forces."""
    count = len(right)
    if count <= DENSE:
        stiffness = BED * np.eye(count)
        for row, places in rows:
            stiffness[np.ix_(places, places)] += np.outer(row, row)
        return np.linalg.solve(stiffness, right)
    from scipy import sparse  # noqa: PLC0415  (takes a tenth of a second)
    from scipy.sparse.linalg import splu  # noqa: PLC0415

    lengths = [len(places) for _, places in rows]
    index = (np.repeat(np.arange(len(rows)), lengths), np.concatenate([places for _, places in rows]))
    bars = sparse.csr_array((np.concatenate([row for row, _ in rows]), index), shape=(len(rows), count))
    return splu((bars.T @ bars + BED * sparse.eye_array(count)).tocsc()).solve(right)


def _free_directions(structure: StructureParts, node: str) -> Floats:
    """Orthonormal directions in which a node can move, (directions, 3); in a plane those of the plane."""
    blocked = [np.eye(3)[axis] for axis in _held(structure, node)]
    if planar(structure):
        blocked.append(np.array(structure.bending_normal))
    if not blocked:
        return np.eye(3)
    _, sizes, directions = np.linalg.svd(np.array(blocked))
    return directions[int(np.sum(sizes > 1e-6)) :]


def _held(structure: StructureParts, node: str, kind: str = "") -> set[int]:
    """Axes along which, or with kind "r" about which, supports hold or drive a node."""
    return {
        "xyz".index(freedom[-1])
        for _, support in structure.supports_at.get(node, ())
        for freedom in (*support.held, *support.driven)
        if freedom[:-1] == kind
    }


def _keeps_length(structure: StructureParts, member: str) -> bool:
    """Whether a member's nodes keep their distance, as far as the input says."""
    asked, spec = automatic_of(structure, member), structure.members[member]
    given = [] if asked is None else [asked.axial]
    given += [hinge.axial for hinge in spec.given_hinges]
    return all(one is None for one in given) and all(passes_on(structure, member, node) for node in spec.nodes)


def _cross(vector: Floats) -> Floats:
    """Matrix of the cross product vector x."""
    x, y, z = vector.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
