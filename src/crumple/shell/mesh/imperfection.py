"""Small waviness of walls: a perfect mesh under axial load folds as no real tube does.

Every wall node is moved across its wall by u a, with u evenly spread over -1 to 1: a hash of the member's and
the node's number, so a mesh is the same on every machine.  End sections stay, since other members meet them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crumple.numeric.arrays import Floats
from crumple.shell.mesh.contour import Contour

Words = NDArray[np.uint64]


def offsets(contour: Contour, rings: int, amplitude: float, member: int) -> Floats:
    """Shift of every node in the plane of its section [m], (rings, points, 2).

    Parameters
    ----------
    contour
        The divided section.
    rings
        Number of sections.
    amplitude
        Largest shift [m].
    member
        Number of the member: each has waves of its own.
    """
    shift = amplitude * spread(member, rings * len(contour.points)).reshape(rings, -1)
    shift[[0, -1]] = 0.0
    return np.asarray(shift[..., None] * normals(contour))


def normals(contour: Contour) -> Floats:
    """Unit vectors across the walls at the points of a contour, mean of the sides that meet, (points, 2)."""
    along = contour.points[contour.sides[:, 1]] - contour.points[contour.sides[:, 0]]
    across = np.column_stack([along[:, 1], -along[:, 0]]) / np.linalg.norm(along, axis=1)[:, None]
    mean = np.zeros_like(contour.points)
    for end in (0, 1):
        np.add.at(mean, contour.sides[:, end], across)
    size = np.linalg.norm(mean, axis=1)[:, None]
    return np.asarray(mean / np.maximum(size, 1e-6))


def spread(seed: int, number: int) -> Floats:
    """Numbers evenly spread over -1 to 1 that look random: splitmix64 of a counter, its upper 53 bits."""
    counter: Words = np.arange(1, number + 1, dtype=np.uint64) + np.uint64(seed << 40)
    z: Words = counter * np.uint64(0x9E3779B97F4A7C15)
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    z = z ^ (z >> np.uint64(31))
    return np.asarray((z >> np.uint64(11)).astype(float) * 2.0**-52 - 1.0, float)
