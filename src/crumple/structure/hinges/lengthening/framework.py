"""Structures as pinned frameworks: what hinges alone can do to the nodes, at the start and to first order.

Take every node as a pin and every member as a bar of fixed length.  With the unit vector e_k of bar k from
node i to node j, and the displacements q of the nodes, of which supports hold some, the bars keep their
lengths if

    R q = 0,    (R q)_k = e_k . (q_j - q_i)

(compatibility matrix R).  Its null space holds the sway of a portal, the kink between members in line, and
the motion of the whole where it is free.  Instead of a basis random displacements z are projected on it: what
vanishes for them vanishes for all.  The framework on a soft bed follows z where it is free to,
(R'R + b I) q = b z, and by the share b/(b + s) alone where an eigenvalue s of R'R resists; three times in a
row leave nothing of that.

Limits: bars without hinges turn at the nodes like all others, spot welds hold nothing, and what supports
drive is free: each of these can only add motions.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.bending import planar
from crumple.structure.hinges.asked import automatic_of
from crumple.structure.parts import StructureParts

BED = 1e-10
"""Stiffness of the bed over that of a bar: far below the softest braced framework, above rounding."""
STILL = 1e-5
"""Displacement of a node, and of the ends of a member of mean length against each other, that is none, over
that of a node that nothing holds."""
MOTIONS = 3
"""Random displacements: one suffices unless it happens to be across the motion that matters."""
DENSE = 600
"""Displacements up to which the equations are solved as full ones, without loading a sparse solver."""
KEEPS_LENGTH = ("spherical", "revolute", "universal")
"""Joints that pass displacements on."""


def framework_motions(structure: StructureParts) -> Mapping[str, Floats]:
    """Random motions of the members' nodes that keep all lengths, by node, (3, MOTIONS) each.

    In a plane they lie in it.
    """
    return structure.kept.once("framework", "", lambda: _motions(structure))


def supported(structure: StructureParts, node: str, kind: str = "") -> set[int]:
    """Axes along which, or with kind "r" about which, supports hold a node; what they drive can move."""
    return {
        "xyz".index(freedom[-1])
        for _, support in structure.supports_at.get(node, ())
        for freedom in support.held
        if freedom[:-1] == kind
    }


def passes_on(structure: StructureParts, member: str, node: str) -> bool:
    """Whether a member's end moves as its node does."""
    joints = (joint for joint in structure.joints_at.get(node, ()) if joint.member == member)
    return all(joint.type in KEEPS_LENGTH for joint in joints)


Row = tuple[Floats, list[int]]
"""Coefficients of displacements, and which ones."""


@dataclass(frozen=True)
class Framework:
    """Equations R q = 0 of the displacements q that keep all lengths.

    Attributes
    ----------
    free
        Orthonormal directions in which a node can move, by node, (directions, 3).
    starts
        First displacement of a node.
    count
        Number of displacements.
    rows
        R, bar by bar.
    """

    free: Mapping[str, Floats]
    starts: Mapping[str, int]
    count: int
    rows: list[Row]

    def places(self, node: str) -> list[int]:
        """Displacements of a node."""
        return [self.starts[node] + i for i in range(len(self.free[node]))]


def framework(structure: StructureParts) -> Framework:
    """The framework of the members' nodes."""
    members = [name for name in structure.members if structure.has_line(name)]
    nodes = list(dict.fromkeys(node for name in members for node in structure.members[name].nodes))
    free = {node: free_directions(structure, node) for node in nodes}
    starts = dict(zip(nodes, np.cumsum([0, *(len(one) for one in free.values())]).tolist(), strict=False))
    found = Framework(free, starts, sum(len(one) for one in free.values()), [])
    for name in members:
        if _keeps_length(structure, name):
            first, second = structure.members[name].nodes
            along = structure.frame_of(name).x
            row = np.concatenate([-free[first] @ along, free[second] @ along])
            found.rows.append((row, [*found.places(first), *found.places(second)]))
    return found


def _motions(structure: StructureParts) -> dict[str, Floats]:
    pinned = framework(structure)
    found = np.random.default_rng(0).standard_normal((pinned.count, MOTIONS))
    for _ in range(3 if pinned.count else 0):
        found = BED * on_a_bed(pinned.rows, found)
    return {node: one.T @ found[pinned.places(node)] for node, one in pinned.free.items()}


def on_a_bed(rows: list[Row], right: Floats) -> Floats:
    """Displacements of bars on a bed of stiffness `BED` under forces, (displacements, ...)."""
    count = len(right)
    if count <= DENSE:
        stiffness = BED * np.eye(count)
        for row, places in rows:
            stiffness[np.ix_(places, places)] += np.outer(row, row)
        return np.asarray(np.linalg.solve(stiffness, right), np.float64)
    from scipy import sparse  # noqa: PLC0415  (takes a tenth of a second)
    from scipy.sparse.linalg import splu  # noqa: PLC0415  (the same)

    lengths = [len(places) for _, places in rows]
    index = (np.repeat(np.arange(len(rows)), lengths), np.concatenate([places for _, places in rows]))
    bars = sparse.csr_array((np.concatenate([row for row, _ in rows]), index), shape=(len(rows), count))
    return splu((bars.T @ bars + BED * sparse.eye_array(count)).tocsc()).solve(right)


def free_directions(structure: StructureParts, node: str) -> Floats:
    """Orthonormal directions in which a node can move, (directions, 3); in a plane those of the plane."""
    blocked = [np.eye(3)[axis] for axis in supported(structure, node)]
    if planar(structure):
        blocked.append(np.array(structure.bending_normal))
    if not blocked:
        return np.eye(3)
    _, sizes, directions = np.linalg.svd(np.array(blocked))
    return directions[int(np.sum(sizes > 1e-6)) :]


def _keeps_length(structure: StructureParts, member: str) -> bool:
    """Whether a member's nodes keep their distance, as far as the input says."""
    asked, spec = automatic_of(structure, member), structure.members[member]
    given = [] if asked is None else [asked.axial]
    given += [hinge.axial for hinge in spec.given_hinges]
    return all(one is None for one in given) and all(
        passes_on(structure, member, node) for node in spec.nodes
    )
