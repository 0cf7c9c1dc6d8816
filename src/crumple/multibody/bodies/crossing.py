"""Members that cross at the start although they share no node, and distances between segments."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from crumple._core.spatial.model import SpatialCapsule
from crumple.numeric.arrays import Floats
from crumple.numeric.rotation import cross

JOINED = 0.1
"""Share of the radii within which centre lines count as meeting; see native/spatial/contact/contacts.cpp."""


def pair_distances(capsules: Sequence[SpatialCapsule], pairs: Sequence[tuple[int, int]]) -> Floats:
    """Distances between the centre lines of pairs of capsules [m], (pairs,)."""
    if not pairs:
        return np.zeros(0)
    ends = np.array([(capsule.first, capsule.second) for capsule in capsules], float)
    first, second = ends[np.array(pairs)].swapaxes(0, 1)
    return segment_distance((first[:, 0], first[:, 1]), (second[:, 0], second[:, 1]))


def crossing_members(
    capsules: Sequence[SpatialCapsule], member: Sequence[str], pairs: Sequence[tuple[int, int]]
) -> set[tuple[str, str]]:
    """Members of pairs of capsules whose centre lines meet: contact has no direction there.

    Their other capsules have none either: around the crossing they would clamp the members to each other.
    """
    radius = np.array([capsule.radius for capsule in capsules])
    near = pair_distances(capsules, pairs) < JOINED * radius[np.array(pairs, int).reshape(-1, 2)].sum(axis=1)
    return {(member[pairs[k][0]], member[pairs[k][1]]) for k in np.flatnonzero(near).tolist()}


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
