"""Ends of capsules that share their place: an obstacle meets one of them.

Pieces of a member on both sides of a hinge, and members that meet rigidly at a node, end in balls about the
same point, which move as one.  A contact at each would be the same contact again: how the force divides
between them is not determined, and which of them slides is decided by rounding.  The one that is met must not
depend on which end of a member the input names first: a ball that turns with one piece rubs otherwise than
one that turns with the other.  Balls beside the axis of a member, of a flat section, part when a hinge turns,
but not at an elastic joint, which hardly does.

A plane does not meet the cuts within a member that folds along its axis towards it: there the walls fold in
front of it until they are solid, and then what is behind them carries on.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence, Set

import numpy as np

from crumple._core.spatial.model import SpatialCapsule
from crumple.multibody.bodies.linkage import GROUND, Connection, Linkage
from crumple.numeric.arrays import Floats
from crumple.structure import Structure

SAME = 1e-7
"""Distance [m] below which places are the same."""
FIRST, SECOND, BOTH = 1, 2, 3
FACING = math.cos(math.radians(30.0))
"""Cosine of the angle between a member's axis and the normal of a plane up to which it folds towards it."""
ROTATIONS = 3
"""First of the freedoms that are rotations."""
Place = tuple[int, int, int]


def ends_met(
    together: Mapping[Place, Mapping[int, int]],
    capsules: Sequence[SpatialCapsule],
    touching: tuple[int, ...],
    covered: Set[tuple[int, int]] = frozenset(),
) -> tuple[int, ...]:
    """Ends of capsules that an obstacle meets: `FIRST`, `SECOND`, `BOTH` or 0, for each of `touching`.

    None of those `covered`, by capsule and end.  Of ends that stay together, by `bodies_together`, the
    largest counts, of equal ones that of the longest capsule, of equally long ones the first.
    """
    at: dict[Place, list[tuple[float, float, int, int]]] = defaultdict(list)
    for k, index in enumerate(touching):
        capsule = capsules[index]
        length = SAME * round(math.dist(capsule.first, capsule.second) / SAME)
        for side, end in ((FIRST, capsule.first), (SECOND, capsule.second)):
            if (index, side) not in covered:
                at[_place(end)].append((-capsule.radius, -length, k, side))
    met = [0] * len(touching)
    for place, ends in at.items():
        joined = together.get(place, {})
        seen: set[int] = set()
        for _, _, k, side in sorted(ends):
            body = capsules[touching[k]].body
            group = joined.get(body, body)
            if group not in seen:
                seen.add(group)
                met[k] |= side
    return tuple(met)


def covered_by_folds(
    structure: Structure,
    linkage: Linkage,
    capsules: Sequence[SpatialCapsule],
    owners: Sequence[str],
    normal: Floats,
) -> Set[tuple[int, int]]:
    """Ends of capsules at the cuts of members that fold towards a plane, by capsule and end.

    Parameters
    ----------
    structure, linkage
        The structure, its bodies and connections.
    capsules, owners
        Capsules, and the member of each of the first of them.
    normal
        Of the plane, (3,).
    """
    folding = {c.hinge.member for c in linkage.connections if c.hinge is not None and _folds(linkage, c)}
    at: dict[str, list[tuple[float, int, int]]] = defaultdict(list)
    for k, member in enumerate(owners):
        frame = structure.frame_of(member)
        if member in folding and abs(frame.x @ normal) > FACING:
            for side, end in ((FIRST, capsules[k].first), (SECOND, capsules[k].second)):
                at[member].append((float(frame.x @ (end - frame.origin)), k, side))
    found = set()
    for places in at.values():
        low, high = min(places)[0] + SAME, max(places)[0] - SAME
        found |= {(k, side) for station, k, side in places if low < station < high}
    return found


def bodies_together(
    linkage: Linkage, rows: Mapping[str, Floats], *, folding: bool
) -> dict[Place, dict[int, int]]:
    """Bodies whose points at a place stay together, by place: one of them stands for all.

    Parameters
    ----------
    linkage
        Bodies and connections.
    rows
        Of every member, places of its capsules from its axis [m], (rows, 3).
    folding
        Whether pieces on both sides of a hinge that folds along their member count.  They slide into each
        other, and what one leaves the other covers: a plane, which rests on the ends of capsules alone, meets
        no other point then.
    """
    found: dict[Place, dict[int, int]] = defaultdict(dict)
    for connection in linkage.connections:
        ground = GROUND in (connection.first, connection.second)
        if ground or not (not _slips(connection) or (folding and _folds(linkage, connection))):
            continue
        hinge = connection.hinge
        for shift in np.zeros((1, 3)) if hinge is None or hinge.plastic else rows[hinge.member]:
            of = found[_place(connection.position + shift)]
            first, second = (of.get(body, body) for body in (connection.first, connection.second))
            of[connection.first], of[connection.second] = first, first
            for body, stands in of.items():
                if stands == second:
                    of[body] = first
    return found


def _slips(connection: Connection) -> set[int]:
    """Directions in which points on both sides part."""
    return {freedom for freedom in connection.free if freedom < ROTATIONS}


def _folds(linkage: Linkage, connection: Connection) -> bool:
    """Whether it is a hinge between the ends of a member that folds along it."""
    if connection.hinge is None or _slips(connection) != {0}:
        return False
    pieces = linkage.pieces[connection.hinge.member]
    return pieces[0].start < connection.hinge.station < pieces[-1].end


def _place(position: Floats) -> Place:
    x, y, z = np.rint(np.asarray(position) / SAME).astype(int).tolist()
    return x, y, z
