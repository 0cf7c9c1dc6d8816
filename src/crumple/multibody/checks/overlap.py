"""Warnings for what overlaps at the start and has contact: the solver does not separate it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crumple.multibody.bodies.capsules import member_capsules, pieces_by_length, touching_pairs
from crumple.multibody.bodies.crossing import crossing_members, pair_distances
from crumple.multibody.bodies.linkage import link
from crumple.multibody.checks.names import named
from crumple.numeric.arrays import Floats
from crumple.structure import Stage, Structure
from crumple.structure.keys.obstacles import Obstacle, gap
from crumple.text.names import listed

MOST_PAIRS = 4
"""Pairs of members that a sentence names."""
LEAST = 1e-6
"""Overlap [m] that is rounding of the input."""
LEAST_INSIDE = 1e-4
"""Depth [m] of a wall in an obstacle that is rounding of the input."""
INSIDE = 1e-6
"""The same of the middle of a wall, from which on shells refuse it [m]."""
STATIONS = 33
"""Places along a member at which its gap to an obstacle is taken, then around the closest."""
WALL_STEP, MOST_PARTS = 2e-3, 64
"""Distance [m] of places along a wall, and the largest number of them."""
IN_LINE = -0.9
"""Cosine of the angle between two members away from a node, below which they go on in line."""


def overlap_warnings(structure: Structure) -> tuple[str, ...]:
    """A sentence for members that overlap, and one for those that cross and therefore never touch."""
    if structure.member_contact is None:
        return ()
    deepest: dict[tuple[str, str], float] = {}
    linkage = link(structure)
    moving, held = (
        member_capsules(structure, of, held=still)
        for of, still in ((linkage.pieces, False), (pieces_by_length(linkage, fixed=True), True))
    )
    capsules, owner = moving[0] + held[0], moving[1] + held[1]
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


def obstacle_overlap_warnings(structure: Structure, stages: Sequence[Stage] = ()) -> tuple[str, ...]:
    """A sentence for each obstacle inside which walls of members start.

    Parameters
    ----------
    structure
        Members and obstacles.
    stages
        Of the run; obstacles that are not there in the first one are left out.
    """
    there = stages[0].obstacles if stages and stages[0].obstacles is not None else tuple(structure.obstacles)
    names = list(structure.members)
    frames = [structure.frame_of(name) for name in names]
    middles = np.array([frame.position(frame.length / 2.0) for frame in frames]).reshape(-1, 3)
    reach = np.array([_reach(structure, name) for name in names])
    longest = np.array([frame.length for frame in frames]) / 2.0 + reach
    found = []
    for name in there:
        obstacle = structure.obstacles[name]
        near = np.flatnonzero(gap(obstacle, middles) < longest).tolist()
        deep = {
            names[k]: depth
            for k in near
            if (obstacle.members is None or names[k] in obstacle.members)
            and (depth := _depth(structure, names[k], obstacle)) > LEAST_INSIDE
        }
        if deep:
            # shells have the middle of the wall
            beyond = any(
                depth > structure.section_of(member).thickness / 2.0 + INSIDE
                for member, depth in deep.items()
            )
            refused = ", and shells refuse it" if beyond else ", as shells do"
            start, most = "starts" if len(deep) == 1 else "start", f"{1e3 * max(deep.values()):.2g} mm"
            found.append(
                f"{named('Member', list(deep))} {start} up to {most} inside obstacle {name}: contact treats "
                f"this as zero gap{refused}; move the obstacle away."
            )
    return tuple(found)


def _reach(structure: Structure, member: str) -> float:
    """Largest distance of a member's surface from its line [m]."""
    return float(np.hypot(*structure.section_of(member).outer_outline().T).max())


def _depth(structure: Structure, member: str, obstacle: Obstacle) -> float:
    """How deep the surface of a member lies in an obstacle at the start [m]."""
    frame, outline = structure.frame_of(member), structure.section_of(member).outer_outline()
    following = np.roll(outline, -1, axis=0)
    parts = int(np.clip(np.ceil(np.hypot(*(following - outline).T).max() / WALL_STEP), 1, MOST_PARTS))
    share = np.linspace(0.0, 1.0, parts, endpoint=False)[:, None, None]
    walls = (outline + share * (following - outline)).reshape(-1, 2)
    across = walls @ np.array([frame.axis("y"), frame.axis("z")])

    def gaps(stations: Floats) -> Floats:
        line = np.array([frame.position(station) for station in stations.tolist()])
        return np.asarray(gap(obstacle, line[:, None, :] + across[None, :, :]).min(axis=1))

    start, end = (_cut_back(structure, member, k) for k in (0, 1))
    if start + end >= frame.length:
        return -float(gaps(np.array([(frame.length + start - end) / 2.0]))[0])
    stations = np.linspace(start, frame.length - end, STATIONS)
    nearest = gaps(stations)
    # between two stations the gap changes at most by half their distance
    if nearest.min() > (stations[1] - stations[0]) / 2.0:
        return 0.0
    k = int(nearest.argmin())
    return -float(
        gaps(np.linspace(stations[max(k - 1, 0)], stations[min(k + 1, STATIONS - 1)], STATIONS)).min()
    )


def _cut_back(structure: Structure, member: str, end: int) -> float:
    """Length [m] at an end of a member where its surface does not count: others meet it, none in line."""
    node, out = structure.members[member].nodes[end], structure.frame_of(member).x * (1 - 2 * end)
    meeting = [name for name, spec in structure.members.items() if name != member and node in spec.nodes]
    for other in meeting:
        away = structure.frame_of(other).x * (1 - 2 * structure.members[other].nodes.index(node))
        if out @ away < IN_LINE:
            return 0.0
    return max(_reach(structure, name) for name in (member, *meeting)) if meeting else 0.0


def _pairs(names: list[tuple[str, str]]) -> str:
    return f"Members {listed((f'{first} and {second}' for first, second in names), MOST_PAIRS, '; ')}"
