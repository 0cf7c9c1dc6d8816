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

NO_FORCE = 1e-9
"""Part of all walls' strength below which that of a wall along a force is rounding of its direction."""
HALF = 0.5
"""Share of the largest shear force at which the loss of torque is read; the loss grows a little faster."""


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
    if not skeleton.cells:
        torque = float((skeleton.length * skeleton.thickness * strength).sum()) / 2.0
        return torque, np.where(skeleton.thickness > 0.0, 1.0, 0.0)
    torque, flow = _flow(skeleton, strength)
    used = np.abs(flow) / np.where(skeleton.thickness > 0.0, strength, np.inf)
    return torque, np.minimum(used, 1.0)


def torque_lost_to_shear(skeleton: Skeleton, yields: Floats, centre: complex, angle: float) -> float:
    """Share of the plastic torque that a shear force takes, over the force [1/N]; 0 without cells.

    Every wall of a cell is taken to yield in shear on its own, which needs corners that carry the differences
    of flow along the member: docs/theory/interaction.md.  Mean of both senses of the force.

    Parameters
    ----------
    skeleton, yields
        As for `plastic_torsion`.
    centre
        Point y + i z about which the torque is taken [m].
    angle
        Direction of the force from y towards z [rad].
    """
    if not skeleton.cells:
        return 0.0
    beside = np.array([half >> 1 for _, halves in skeleton.cells for half in halves])
    walls = np.unique(beside[skeleton.thickness[beside] > 0.0])
    start, end = (skeleton.nodes[skeleton.ends[walls, k]] for k in (0, 1))
    strength = (skeleton.thickness * yields)[walls] / math.sqrt(3.0)
    force = strength * ((end - start) * np.exp(-1j * angle)).real
    torque = strength * (np.conj(start - centre) * (end - start)).imag
    largest = float(np.abs(force).sum())
    across = np.abs(force) <= NO_FORCE * float((strength * np.abs(end - start)).sum())
    if across.all():
        return 0.0
    # T(V) of flows +-strength, from the largest force backwards: walls turn round by their torque over force
    fixed, along, turned = float(np.abs(torque[across]).sum()), force[~across], torque[~across]
    order = np.argsort(-turned / along)
    gained = 2.0 * np.cumsum(np.abs(along)[order])
    kept = 2.0 * np.cumsum((turned * np.sign(along))[order])
    forces = np.append(-largest, gained - largest)
    torques = fixed - float((turned * np.sign(along)).sum()) + np.append(0.0, kept)
    back, none, ahead = np.interp([-HALF * largest, 0.0, HALF * largest], forces, torques).tolist()
    return (1.0 - (back + ahead) / (2.0 * none)) / (HALF * largest)


def _flow(skeleton: Skeleton, strength: Floats) -> tuple[float, Floats]:
    """Plastic torque of cells [N m], and the shear flow along each edge [N/m]."""
    cells = skeleton.cells
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
    return torque, np.asarray(height[left] - height[right])
