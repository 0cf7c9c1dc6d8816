"""Spot welds: pairs of nodes of two sheets that lie on each other, each pair one small rigid body."""

from __future__ import annotations

import numpy as np

from crumple.shell.contour import Floats, Integers
from crumple.shell.mesh import Mesh


def spot_welds(mesh: Mesh, pitch: float | None) -> Integers:
    """Pairs of nodes that spot welds tie, (k, 2).

    Parameters
    ----------
    mesh
        Of all members.
    pitch
        Distance of the spots along a member [m]; None: one at every ring.
    """
    pairs = [np.zeros((0, 2), dtype=np.int64)]
    for tube in mesh.tubes.values():
        if len(tube.contour.welds):
            rings = _rings(tube.stations, pitch)
            pairs.append(tube.nodes[rings][:, tube.contour.welds].reshape(-1, 2))
    # members that share a mitre share its spots
    return np.unique(np.sort(np.concatenate(pairs), axis=1), axis=0)


def _rings(stations: Floats, pitch: float | None) -> Integers:
    """Rings nearest to the spots, of which as many as fit lie evenly between both ends."""
    if pitch is None:
        return np.arange(len(stations))
    number = max(1, round(float(stations[-1] - stations[0]) / pitch))
    spots = stations[0] + (np.arange(number) + 0.5) * float(stations[-1] - stations[0]) / number
    return np.unique(np.abs(stations[:, None] - spots).argmin(axis=0))
