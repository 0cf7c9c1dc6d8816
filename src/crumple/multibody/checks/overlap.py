"""Warnings for members that overlap at the start and have contact: the solver does not separate them."""

from __future__ import annotations

import numpy as np

from crumple.multibody.bodies.capsules import member_capsules, touching_pairs
from crumple.multibody.bodies.linkage import link
from crumple.numeric.arrays import Floats
from crumple.numeric.rotation import cross
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
    pairs = np.array(list(touching_pairs(structure, capsules, owner)), int).reshape(-1, 2)
    ends = np.array([(capsule.first, capsule.second) for capsule in capsules], float).reshape(-1, 2, 3)
    first, second = ends[pairs[:, 0]], ends[pairs[:, 1]]
    distances = segment_distance((first[:, 0], first[:, 1]), (second[:, 0], second[:, 1]))
    for (i, j), apart in zip(pairs.tolist(), distances.tolist(), strict=True):
        radii = capsules[i].radius + capsules[j].radius
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


def segment_distance(first: tuple[Floats, Floats], second: tuple[Floats, Floats]) -> Floats:
    """Smallest distances of pairs of segments [m], (...), with ends (..., 3).

    Inside both, or from an end of one to the other.
    """
    (start, end), (other, far) = first, second
    a, b, between = end - start, far - other, other - start
    normal = cross(a, b)
    square = _dot(normal, normal)
    safe = np.where(square > 0.0, square, 1.0)
    s, t = _dot(cross(between, b), normal) / safe, _dot(cross(between, a), normal) / safe
    inside = (square > 0.0) & (s >= 0.0) & (s <= 1.0) & (t >= 0.0) & (t <= 1.0)
    across = np.where(inside, np.abs(_dot(between, normal)) / np.sqrt(safe), np.inf)
    ends = [_from_point(point, second) for point in first] + [_from_point(point, first) for point in second]
    return np.asarray(np.minimum.reduce([across, *ends]))


def _from_point(point: Floats, segment: tuple[Floats, Floats]) -> Floats:
    start, along = segment[0], segment[1] - segment[0]
    square = _dot(along, along)
    share = np.clip(_dot(point - start, along) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    return np.asarray(np.linalg.norm(point - start - share[..., None] * along, axis=-1))


def _dot(first: Floats, second: Floats) -> Floats:
    return np.asarray((first * second).sum(axis=-1))


def _pairs(names: list[tuple[str, str]]) -> str:
    return f"Members {listed((f'{first} and {second}' for first, second in names), MOST_PAIRS, '; ')}"
