"""Warnings for members that overlap at the start and have contact: the solver does not separate them."""

from __future__ import annotations

import numpy as np

from crumple.multibody.bodies.linkage import link
from crumple.multibody.bodies.obstacle_bodies import member_capsules, touching_pairs
from crumple.numeric.arrays import Floats
from crumple.structure import Structure
from crumple.text.names import listed

MOST_PAIRS = 4
"""Pairs of members that a sentence names."""
JOINED = 0.1
"""Share of the radii within which centre lines count as meeting; see native/spatial/contact/contacts.cpp."""
LEAST = 1e-6
"""Overlap [m] that is rounding of the input."""


def overlap_warnings(structure: Structure) -> tuple[str, ...]:
    """A sentence for members that overlap, and one for those that cross and therefore never touch."""
    if structure.member_contact is None:
        return ()
    deepest: dict[tuple[str, str], float] = {}
    crossing: set[tuple[str, str]] = set()
    capsules, owner = member_capsules(structure, link(structure).pieces)
    for i, j in touching_pairs(structure, capsules, owner):
        first, second = capsules[i], capsules[j]
        radii = first.radius + second.radius
        apart = segment_distance((first.first, first.second), (second.first, second.second))
        names = (owner[i], owner[j])
        if apart < JOINED * radii:
            crossing.add(names)
        elif radii - apart > LEAST:
            deepest[names] = max(deepest.get(names, 0.0), radii - apart)
    found = []
    if crossing:
        found.append(
            f"{_pairs(sorted(crossing))} cross at the start although they share no node: "
            "they have no contact with each other."
        )
    overlapping = {names: depth for names, depth in deepest.items() if names not in crossing}
    if overlapping:
        found.append(
            f"{_pairs(sorted(overlapping))} overlap at the start by up to "
            f"{1e3 * max(overlapping.values()):.3g} mm: "
            "contact treats this as zero gap; move them apart, or connect them at a node."
        )
    return tuple(found)


def segment_distance(first: tuple[Floats, Floats], second: tuple[Floats, Floats]) -> float:
    """Smallest distance of two segments [m]: inside both, or from an end of one to the other."""
    a, b = (np.asarray(end[1], float) - end[0] for end in (first, second))
    between = np.asarray(second[0], float) - first[0]
    normal = np.cross(a, b)
    square = float(normal @ normal)
    if square > 0.0:
        s = float(np.cross(between, b) @ normal) / square
        t = float(np.cross(between, a) @ normal) / square
        if 0.0 <= s <= 1.0 and 0.0 <= t <= 1.0:
            return abs(float(between @ normal)) / float(np.sqrt(square))
    ends = [(point, second) for point in first] + [(point, first) for point in second]
    return min(_from_point(point, segment) for point, segment in ends)


def _from_point(point: Floats, segment: tuple[Floats, Floats]) -> float:
    start, along = np.asarray(segment[0], float), np.asarray(segment[1], float) - segment[0]
    square = float(along @ along)
    share = min(max(float((point - start) @ along) / square, 0.0), 1.0) if square > 0.0 else 0.0
    return float(np.linalg.norm(point - start - share * along))


def _pairs(names: list[tuple[str, str]]) -> str:
    return f"Members {listed((f'{first} and {second}' for first, second in names), MOST_PAIRS, '; ')}"
