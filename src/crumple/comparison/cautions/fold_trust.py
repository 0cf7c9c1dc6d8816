"""Sentences on folds and hinges: missing hinges, shared folds, corners, positions, shortening."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crumple.comparison.comparison import Comparison
from crumple.comparison.measure.metrics import deg, mm
from crumple.comparison.measure.motion import REACH, HingeMotion, largest_side
from crumple.structure import PlacedHinge, Structure
from crumple.text.names import listed

CRUSHED = 0.1
"""Shortening of a fold beyond that of its bend, over its length, from which it is reported."""
BENT = math.radians(1.0)
"""Rotation of a corner [rad] from which it is reported."""


def largest_turn(motion: HingeMotion) -> float:
    """Largest rotation in the hinge's sense [rad]."""
    return float(np.max(motion.sense * motion.rotation)) if motion.rotation.size else 0.0


def fold_sentences(
    comparison: Comparison, structure: Structure, hinges: dict[str, PlacedHinge]
) -> Iterator[tuple[str, bool]]:
    """Folds without hinges, hinges without folds, folds away from their hinges."""
    first, second = comparison.candidate.name, comparison.reference.name
    for motion in comparison.reference.extra:
        where = f"member {motion.member} at {mm(motion.station)}"
        place = f"The {second} result folds in {where} (by {deg(largest_turn(motion))}{_shortened(motion)})"
        near = across_joint(structure, motion, hinges)
        if near:
            turns = [s.hinge(near) for s in (comparison.candidate, comparison.reference)]
            alone, beside = (0.0 if turn is None else largest_turn(turn) for turn in turns)
            both = beside + largest_turn(motion)
            yield (
                f"{place}, at the joint next to hinge {near} of another member. Both members share the "
                f"rotation of this corner ({deg(both)} in total; {deg(alone)} {first}), so the values of "
                "that hinge alone cannot be compared.",
                True,
            )
            continue
        yield (
            f"{place}, where the {first} model has no hinge. It cannot fold there, and the energy absorbed "
            "in this fold is missing from its result. Put a hinge there.",
            True,
        )
    yield from _shared(comparison)
    yield from _corners(comparison, structure, hinges)
    yield from _opened_in_one(comparison, hinges)
    for hinge in comparison.hinges:
        if hinge.name not in hinges:
            continue
        if hinge.fold_station is not None:
            away = hinge.fold_station - hinge.station
            text = (
                f"The fold of hinge {hinge.name} is at {mm(hinge.fold_station)} along member "
                f"{hinge.member}, the hinge at {mm(hinge.station)}."
            )
            yield text, abs(away) > largest_side(structure, hinge.member)


def _opened_in_one(comparison: Comparison, hinges: dict[str, PlacedHinge]) -> Iterator[tuple[str, bool]]:
    """Hinges that open in one result alone, together."""
    first, second = comparison.candidate.name, comparison.reference.name
    opened = {source: {o.name for o in found} for source, found in comparison.opened.items()}
    for here, there, note in (
        (first, second, f"; the {second} result has no fold there"),
        (second, first, ""),
    ):
        names = [
            hinge.name
            for hinge in comparison.hinges
            if hinge.name in hinges and hinge.name in opened[here] - opened[there]
        ]
        if names:
            do = "Hinge {} opens" if len(names) == 1 else "Hinges {} open"
            yield f"{do.format(listed(names))} in the {here} result only{note}.", True


def _shortened(motion: HingeMotion) -> str:
    """Shortening of a fold that is also crushed along its member, in words."""
    if motion.planes is None or motion.crushed < CRUSHED:
        return ""
    a, b = motion.planes
    return f", shortened by {mm(motion.crushed * (b - a))} of {mm(b - a)}"


def _shared(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Hinges within one fold: how its rotation divides between them depends on where the planes are."""
    first, second = comparison.candidate.name, comparison.reference.name
    for hinge in comparison.hinges:
        low, high = hinge.fold_extent or (math.inf, -math.inf)
        for other in comparison.hinges:
            half = (other.station + hinge.station) / 2
            if other is hinge or other.member != hinge.member or not low < half < high:
                continue
            names = [h.name for h in sorted((hinge, other), key=lambda h: h.station)]
            together = [
                sum(largest_turn(turn) for name in names if (turn := s.hinge(name)) is not None)
                for s in (comparison.candidate, comparison.reference)
            ]
            yield (
                f"Hinges {names[0]} and {names[1]} are in one fold of the {second} result, from "
                f"{mm(low)} to {mm(high)} along member {hinge.member}. Their total rotation is "
                f"{deg(together[0])} {first} and {deg(together[1])} {second}; the values of one hinge alone "
                "cannot be compared. One hinge is enough there.",
                True,
            )


def _corners(
    comparison: Comparison, structure: Structure, hinges: dict[str, PlacedHinge]
) -> Iterator[tuple[str, bool]]:
    """Hinges on both sides of a corner of two members: one fold of the reference may belong to either."""
    for node in structure.nodes:
        members = [name for name, member in structure.members.items() if node in member.nodes]
        beside = [
            hinge.name
            for hinge in comparison.hinges
            if hinge.name in hinges
            and hinge.member in members
            and np.linalg.norm(hinges[hinge.name].position - np.asarray(structure.nodes[node]))
            <= REACH * largest_side(structure, hinge.member)
        ]
        if len(members) != 2 or len(beside) != 2 or len({hinges[name].member for name in beside}) != 2:
            continue
        turned, checked = (
            [largest_turn(motion) for name in beside if (motion := s.hinge(name)) is not None]
            for s in (comparison.candidate, comparison.reference)
        )
        if sum(checked) < BENT:
            continue
        yield (
            f"Hinges {beside[0]} and {beside[1]} are on both sides of corner {node}. The total rotation of "
            f"the corner is {deg(sum(turned))} {comparison.candidate.name} and {deg(sum(checked))} "
            f"{comparison.reference.name}. It is more reliable than the rotations of the two hinges, "
            "because their shares depend on where the fold begins.",
            False,
        )


def across_joint(structure: Structure, motion: HingeMotion, hinges: dict[str, PlacedHinge]) -> str:
    """Name of the hinge of another member next to a fold, as at a joint; empty if there is none."""
    place = structure.frame_of(motion.member).position(motion.station)
    reach = REACH * largest_side(structure, motion.member)
    near = [
        (float(np.linalg.norm(hinge.position - place)), name)
        for name, hinge in hinges.items()
        if hinge.member != motion.member
    ]
    distance, name = min(near, default=(np.inf, ""))
    return name if distance <= reach else ""
