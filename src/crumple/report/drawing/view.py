"""View of a structure: normal to the plane of a planar motion, else axonometric from above."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crumple.numeric.arrays import Floats
from crumple.result import States

_PLANAR = 0.05
"""Spread across a plane over the spread along it, below which structure and motion count as planar."""
_STRAIGHT = 0.02
"""The same across a line."""
_SNAP = np.cos(np.radians(3.0))  # nearer than this to a world axis the view takes the axis itself
_AZIMUTH, _ELEVATION = np.radians(-55.0), np.radians(22.0)  # of the eye for a structure in space


@dataclass(frozen=True)
class View:
    """An orthographic view.

    Attributes
    ----------
    right, up, towards
        Unit vectors of the picture in world axes and towards the eye, each (3,).
    """

    right: Floats
    up: Floats
    towards: Floats

    def flat(self, points: Floats) -> Floats:
        """Picture coordinates of points, (..., 3) to (..., 2)."""
        return points @ np.stack([self.right, self.up], axis=1)

    def depth(self, points: Floats) -> Floats:
        """Distance towards the eye, (..., 3) to (...)."""
        return points @ self.towards

    def axis_arrows(self) -> list[tuple[str, Floats]]:
        """World axes that are seen at some length: name and picture vector (2,)."""
        arrows = [(name, self.flat(np.eye(3)[i])) for i, name in enumerate("xyz")]
        return [(name, arrow) for name, arrow in arrows if np.hypot(*arrow) > 0.2]


def ring_centres(states: States) -> tuple[Floats, NDArray[np.int64]]:
    """Section centres in every state, undeformed first, (n_states + 1, n_rings, 3), and each point's ring."""
    order = np.lexsort((states.station, states.member))
    member, station = states.member[order], states.station[order]
    ring = np.empty(len(order), dtype=np.int64)
    ring[order[:1]] = 0
    ring[order[1:]] = np.cumsum((np.diff(member) != 0) | (np.diff(station) != 0.0))
    positions = np.concatenate([states.points[None], states.points + states.displacement])
    sums = np.zeros((len(positions), ring.max(initial=-1) + 1, 3))
    for state, moved in zip(sums, positions, strict=True):
        np.add.at(state, ring, moved)
    return sums / np.maximum(np.bincount(ring), 1)[:, None], ring


def choose_view(states: States) -> View:
    """The view that shows the most of the structure and its motion.

    Parameters
    ----------
    states
        Their section centres over all times decide, so that the size of the sections does not.

    Returns
    -------
    View
        Square on to the plane of a planar structure and motion, z up where it can be; else axonometric.
    """
    centres = ring_centres(states)[0].reshape(-1, 3)
    if not len(centres):
        return _facing(np.array([0.0, -1.0, 0.0]))
    centred = centres - centres.mean(axis=0)
    sizes, axes = np.linalg.eigh(centred.T @ centred / len(centred))
    sizes = np.sqrt(np.maximum(sizes, 0.0))
    if sizes[2] == 0.0 or sizes[1] <= _STRAIGHT * sizes[2]:
        # a straight line that only moves along itself: the side view is expected
        along = np.abs(axes[:, 2])
        return _facing(np.eye(3)[1] if along[1] < 0.9 else np.eye(3)[0])
    if sizes[0] <= _PLANAR * sizes[2]:
        return _facing(axes[:, 0])
    azimuth = np.array([np.cos(_AZIMUTH), np.sin(_AZIMUTH)]) * np.cos(_ELEVATION)
    return _facing(np.array([*azimuth, np.sin(_ELEVATION)]), keep_side=True)


def _facing(normal: Floats, *, keep_side: bool = False) -> View:
    """View along a normal: z up unless it is the normal, x (or else y) to the right."""
    world = np.eye(3)
    nearest = int(np.argmax(np.abs(normal)))
    if abs(normal[nearest]) > _SNAP:
        normal = world[nearest]
    up = world[2] if abs(normal[2]) < _SNAP else world[1]
    up = up - (up @ normal) * normal
    up /= np.linalg.norm(up)
    right = np.cross(up, normal)
    if not keep_side and right[int(np.argmax(np.abs(right)))] < 0:
        right, normal = -right, -normal
    return View(right, up, normal)
