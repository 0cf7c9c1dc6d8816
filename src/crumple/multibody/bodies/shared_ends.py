"""Ends of capsules that share their place: an obstacle meets one of them.

Pieces of a member on both sides of a hinge, and members that meet rigidly at a node, end in balls about the
same point, which move as one.  A contact at each would be the same contact again: how the force divides
between them is not determined, and which of them slides is decided by rounding.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from crumple._core.spatial.model import SpatialCapsule
from crumple.multibody.bodies.linkage import GROUND, Connection, Linkage
from crumple.numeric.arrays import Floats

SAME = 1e-7
"""Distance [m] below which places are the same."""
FIRST, SECOND, BOTH = 1, 2, 3
ROTATIONS = 3
"""First of the freedoms that are rotations."""
Place = tuple[int, int, int]


def ends_met(
    linkage: Linkage, capsules: Sequence[SpatialCapsule], touching: tuple[int, ...]
) -> tuple[int, ...]:
    """Ends of capsules that an obstacle meets: `FIRST`, `SECOND`, `BOTH` or 0, for each of `touching`.

    Of ends that stay together the largest counts, of equal ones the first.
    """
    together = _together(linkage)
    at: dict[Place, list[tuple[float, int, int]]] = defaultdict(list)
    for k, index in enumerate(touching):
        capsule = capsules[index]
        for side, end in ((FIRST, capsule.first), (SECOND, capsule.second)):
            at[_place(end)].append((-capsule.radius, k, side))
    met = [0] * len(touching)
    for place, ends in at.items():
        joined = together.get(place, {})
        seen: set[int] = set()
        for _, k, side in sorted(ends):
            body = capsules[touching[k]].body
            group = joined.get(body, body)
            if group not in seen:
                seen.add(group)
                met[k] |= side
    return tuple(met)


def _together(linkage: Linkage) -> dict[Place, dict[int, int]]:
    """Bodies whose points at a place stay together, by place: one of them stands for all."""
    found: dict[Place, dict[int, int]] = defaultdict(dict)
    for connection in linkage.connections:
        if GROUND in (connection.first, connection.second) or not _keeps(connection):
            continue
        of = found[_place(connection.position)]
        first, second = (of.get(body, body) for body in (connection.first, connection.second))
        of[connection.first], of[connection.second] = first, first
        for body, stands in of.items():
            if stands == second:
                of[body] = first
    return found


def _keeps(connection: Connection) -> bool:
    """Whether both sides keep a common point.

    A hinge within a member that folds along it counts: what one piece leaves the other covers.
    """
    slips = {freedom for freedom in connection.free if freedom < ROTATIONS}
    return not slips or (slips == {0} and connection.hinge is not None)


def _place(position: Floats) -> Place:
    x, y, z = np.rint(np.asarray(position) / SAME).astype(int).tolist()
    return x, y, z
