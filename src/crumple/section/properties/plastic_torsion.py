"""Largest torque of thin walls at yield, and how much shear it puts into each wall.

Cells: the shear flow of a wall is the difference of the stress function (Prandtl's roof) on its two sides,
zero outside, one height per cell.  No wall passes t sigma_y/sqrt(3).  The torque is twice the volume under
the roof, so every cell is as high as it can be: its height is the shortest path from outside through the
walls, each of length t sigma_y/sqrt(3) (a weld does not yield: a path through it is infinitely long).

Without cells: every wall is a strip with a roof of its own, L t^2/2 sigma_y/sqrt(3).

Limits: one cell of equal walls gives T = 2 A_m t sigma_y/sqrt(3).  Beside cells the open walls are left
out, on the safe side: their torque needs far more twist.
"""

from __future__ import annotations

import math

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.section.geometry.skeleton import Skeleton


def plastic_torsion(skeleton: Skeleton, yields: Floats) -> tuple[float, Floats]:
    """Fully plastic torque and its shear in each wall.

    Parameters
    ----------
    skeleton
        Graph of the section.
    yields
        Yield stress of each edge [Pa], shape (m,).

    Returns
    -------
    tuple
        Torque [N m]; part of the shear yield stress that each edge uses, 0 to 1, shape (m,).
    """
    strength = skeleton.thickness * yields / math.sqrt(3.0)
    cells = skeleton.cells
    if not cells:
        torque = float((skeleton.length * skeleton.thickness * strength).sum()) / 2.0
        return torque, np.where(skeleton.thickness > 0.0, 1.0, 0.0)
    # region on the left of each half-edge: 0 outside, then the cells
    region = np.zeros(2 * len(strength), int)
    for number, (_, halves) in enumerate(cells, start=1):
        region[halves] = number
    left, right = region[0::2], region[1::2]
    cost = np.where(skeleton.thickness > 0.0, strength, np.inf)
    height = np.full(len(cells) + 1, np.inf)
    height[0] = 0.0
    for _ in cells:
        np.minimum.at(height, left, height[right] + cost)
        np.minimum.at(height, right, height[left] + cost)
    torque = 2.0 * sum(area * float(height[number]) for number, (area, _) in enumerate(cells, start=1))
    used = np.abs(height[left] - height[right]) / np.where(skeleton.thickness > 0.0, strength, np.inf)
    return torque, np.minimum(used, 1.0)
