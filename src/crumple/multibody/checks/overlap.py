"""Warnings for what overlaps at the start and has contact: the solver does not separate it."""

from __future__ import annotations

from collections import Counter

import numpy as np

from crumple.multibody.bodies.capsules import member_capsules, touching_pairs
from crumple.multibody.bodies.crossing import crossing_members, pair_distances
from crumple.multibody.bodies.linkage import link
from crumple.multibody.checks.names import named
from crumple.numeric.arrays import Floats
from crumple.structure import Structure
from crumple.structure.keys.obstacles import Obstacle, gap
from crumple.text.names import listed

MOST_PAIRS = 4
"""Pairs of members that a sentence names."""
LEAST = 1e-6
"""Overlap [m] that is rounding of the input."""
LEAST_INSIDE = 1e-4
"""Depth [m] of a wall in an obstacle that is rounding of the input."""
STATIONS, PER_WALL = 33, 8
"""Places along a member and along each wall at which the gap is taken, then around the closest."""


def overlap_warnings(structure: Structure) -> tuple[str, ...]:
    """A sentence for members that overlap, and one for those that cross and therefore never touch."""
    if structure.member_contact is None:
        return ()
    deepest: dict[tuple[str, str], float] = {}
    capsules, owner = member_capsules(structure, link(structure).pieces)
    pairs = list(touching_pairs(structure, capsules, owner))
    crossing = crossing_members(capsules, owner, pairs)
    for (i, j), apart in zip(pairs, pair_distances(capsules, pairs).tolist(), strict=True):
        deep, names = capsules[i].radius + capsules[j].radius - apart, (owner[i], owner[j])
        if deep > LEAST and names not in crossing:
            deepest[names] = max(deepest.get(names, 0.0), deep)
    found = []
    if crossing:
        found.append(
            f"{_pairs(sorted(crossing))} cross at the start although they share no node: "
            "they have no contact with each other."
        )
    if deepest:
        found.append(
            f"{_pairs(sorted(deepest))} overlap at the start by up to "
            f"{1e3 * max(deepest.values()):.3g} mm: "
            "contact treats this as zero gap; move them apart, or connect them at a node."
        )
    return tuple(found)


def obstacle_overlap_warnings(structure: Structure) -> tuple[str, ...]:
    """A sentence for each obstacle inside which walls of members start; not where joints cut members back."""
    meeting = Counter(node for member in structure.members.values() for node in set(member.nodes))
    found = []
    for name, obstacle in structure.obstacles.items():
        deep = {
            member: depth
            for member in obstacle.members or structure.members
            if (depth := _depth(structure, member, obstacle, meeting)) > LEAST_INSIDE
        }
        if deep:
            start, most = "starts" if len(deep) == 1 else "start", f"{1e3 * max(deep.values()):.2g} mm"
            found.append(
                f"{named('Member', list(deep))} {start} up to {most} inside obstacle {name}: contact treats "
                "this as zero gap; move the obstacle away (shells refuse it)."
            )
    return tuple(found)


def _depth(structure: Structure, member: str, obstacle: Obstacle, meeting: Counter[str]) -> float:
    """How deep the surface of a member lies in an obstacle at the start [m]."""
    frame, outline = structure.frame_of(member), structure.section_of(member).outer_outline()
    reach = float(np.hypot(*outline.T).max())
    shared = [reach if meeting[node] > 1 else 0.0 for node in structure.members[member].nodes]
    start, end = shared[0], frame.length - shared[1]
    between = np.linspace(0.0, 1.0, PER_WALL, endpoint=False)[:, None, None]
    walls = (outline + between * (np.roll(outline, -1, axis=0) - outline)).reshape(-1, 2)
    across = walls @ np.array([frame.axis("y"), frame.axis("z")])

    def gaps(stations: Floats) -> Floats:
        line = np.array([frame.position(station) for station in stations.tolist()])
        return np.asarray(gap(obstacle, line[:, None, :] + across[None, :, :]).min(axis=1))

    if start >= end:
        return 0.0
    stations = np.linspace(start, end, STATIONS)
    nearest = gaps(stations)
    # between two stations the gap changes at most by half their distance
    if nearest.min() > (end - start) / (2 * (STATIONS - 1)):
        return 0.0
    k, last = int(nearest.argmin()), STATIONS - 1
    return -float(gaps(np.linspace(stations[max(k - 1, 0)], stations[min(k + 1, last)], STATIONS)).min())


def _pairs(names: list[tuple[str, str]]) -> str:
    return f"Members {listed((f'{first} and {second}' for first, second in names), MOST_PAIRS, '; ')}"
