"""Walls too narrow for an image: round tubes are polygons of many sides, of which an image shows few."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from crumple.numeric.arrays import Floats, Integers
from crumple.result import States

FLAT = math.cos(math.radians(15.0))
"""Cosine of the angle between two walls up to which one stands for both.  Joined walls then meet at
twice this angle, where pictures begin to show an edge."""


def without_narrow_walls(states: States, narrow: float) -> States:
    """The states with neighbouring walls of a member joined two by two, while they are narrow.

    Parameters
    ----------
    states
        Those whose walls have data of their own are returned as they are.
    narrow
        Largest width of a joined wall [m].
    """
    if states.cell_data:
        return states
    owner = states.member[states.quads[:, 0]]
    parts = []
    for member in np.unique(owner):
        quads = states.quads[owner == member]
        while (joined := _joined(states.points, quads, narrow)) is not None:
            quads = joined
        parts.append(quads)
    return replace(states, quads=np.concatenate(parts))


def _joined(points: Floats, quads: Integers, narrow: float) -> Integers | None:
    """One wall for every two, (n / 2, 4); None if they do not come in pairs, or would not be narrow."""
    first, second = quads[0::2], quads[1::2]
    # the last two corners of the first are the first two of the second, which runs round in the same sense
    if len(first) != len(second) or (first[:, 2:] != second[:, 1::-1]).any():
        return None
    found = np.concatenate([first[:, :2], second[:, 2:]], axis=1)
    corners = points[found]
    width = np.linalg.norm(corners[:, [3, 2]] - corners[:, [0, 1]], axis=2)
    one, other = (_normals(points[half]) for half in (first, second))
    level = np.einsum("ij,ij->i", one, other) >= FLAT
    return found if width.max(initial=0.0) <= narrow and level.all() else None


def _normals(corners: Floats) -> Floats:
    found: Floats = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    found /= np.maximum(np.linalg.norm(found, axis=1), 1e-300)[:, None]
    return found
