"""Shear area of a graph of thin walls, of its shear flow in bending about an axis.

With the curvature changing by kappa' along the member, in a wall of thickness t at the distance eta from the
neutral axis the shear flow q changes along the mid-line by

    dq/ds = -E kappa' t eta,        V = kappa' int E eta^2 dA,

flows that meet in a node add up to zero, and they deform the walls without a gap: with a warping u of nodes

    u_end - u_start = int q/(G t) ds        for every wall; 0 for a weld.

The work of q is that of V in the shear stiffness G A_s (Castigliano):

    A_s = V^2 / int q^2/(r t) ds            r: shear modulus of the wall over that of the reference.

Limits: 5/6 of the area of a strip, 5/12 of that of a thin square tube, half of that of a thin ring.  An
unsymmetrical section is held in the plane of bending.
"""

from __future__ import annotations

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.section.geometry.skeleton import Skeleton

GAUSS = np.polynomial.legendre.leggauss(3)
"""Exact to the fifth power: the square of a flow has the fourth."""


def shear_area_of(skeleton: Skeleton, stretch: Floats, shear: Floats, angle: float) -> float:
    """Shear area for bending about an axis [m^2].

    Parameters
    ----------
    skeleton
        Graph of the section.
    stretch, shear
        Young's and shear modulus of each edge over those of the reference metal, shape (m,).
    angle
        Direction of the axis from y towards z [rad].
    """
    t, length, (start, end) = skeleton.thickness, skeleton.length, skeleton.ends.T
    weight = stretch * t * length
    across = (skeleton.nodes * np.exp(-1j * angle)).imag
    eta = across - float(weight @ (across[start] + across[end])) / 2.0 / float(weight.sum())
    first, last = eta[start], eta[end]
    force = float(weight @ (first**2 + first * last + last**2)) / 3.0
    # what the flow loses along a wall, and the mean of what it has lost on the way
    lost = weight * (first + last) / 2.0
    lost_on_the_way = weight * (2.0 * first + last) / 6.0
    flow = _flows_at_the_start(skeleton, shear, lost, lost_on_the_way)
    squared = np.zeros(len(t))
    for place, share in zip((GAUSS[0] + 1.0) / 2.0, GAUSS[1] / 2.0, strict=True):
        there = flow - weight * place * (first + (last - first) * place / 2.0)
        squared += share * there**2
    work = np.divide(length * squared, shear * t, out=np.zeros(len(t)), where=t > 0.0)
    return force**2 / float(work.sum())


def _flows_at_the_start(skeleton: Skeleton, shear: Floats, lost: Floats, lost_on_the_way: Floats) -> Floats:
    """Shear flow at the start of each edge, (m,), from balance in the nodes and warping without gaps."""
    t, length, (start, end) = skeleton.thickness, skeleton.length, skeleton.ends.T
    edges, nodes = len(t), len(skeleton.nodes)
    number = np.arange(edges)
    into = np.zeros((nodes, edges))
    np.add.at(into, (end, number), 1.0)
    np.add.at(into, (start, number), -1.0)
    gain = np.zeros(nodes)
    np.add.at(gain, end, lost)
    # warpings count as flows of a wall of the mean length and thickness, so that both have one size
    flexibility = np.divide(length, shear * t, out=np.zeros(edges), where=t > 0.0)
    scale = float(flexibility.mean())
    matrix = np.block([[np.diag(flexibility / scale), -into.T], [into, np.zeros((nodes, nodes))]])
    right = np.concatenate([flexibility / scale * lost_on_the_way, gain])
    return np.asarray(np.linalg.lstsq(matrix, right, rcond=1e-12)[0][:edges])
