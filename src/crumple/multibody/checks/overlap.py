"""Warnings for members that overlap at the start and have contact: the solver does not separate them."""

from __future__ import annotations

from crumple.multibody.bodies.capsules import member_capsules, touching_pairs
from crumple.multibody.bodies.crossing import crossing_members, pair_distances
from crumple.multibody.bodies.linkage import link
from crumple.structure import Structure
from crumple.text.names import listed

MOST_PAIRS = 4
"""Pairs of members that a sentence names."""
LEAST = 1e-6
"""Overlap [m] that is rounding of the input."""


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


def _pairs(names: list[tuple[str, str]]) -> str:
    return f"Members {listed((f'{first} and {second}' for first, second in names), MOST_PAIRS, '; ')}"
