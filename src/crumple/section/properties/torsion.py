"""Torsion and warping of a graph of thin walls: any number of cells, open walls, all in one system.

Unknown: the warping u of the nodes at unit twist per length.  In a wall of thickness t, length L, with s the
ray's sweep (twice the area that the ray from the pole sweeps along it):

    shear flow    q = G t/L (u_end - u_start + s)
    at each node  sum of the flows that leave = 0

so open walls carry no flow and warp freely, and cells carry Bredt's flow.  Then

    G J   = sum q s + sum G L t^3/3
    shear centre P:  the warping about it, u + y_P z - z_P y + const, does no work with bending:
                     int E u_P dA = int E u_P y dA = int E u_P z dA = 0
    E I_w = int E u_P^2 dA + sum E t^3/12 int r_t^2 ds       (r_t lever arm along the wall: warping across it)

Limits: a single cell gives 4 A_m^2/sum(L/t); an angle has no warping but that across its walls, A^3/144 for
equal legs.  Mid-line integrals: sharp corners add stiffness that is not here.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.section.geometry.skeleton import Skeleton

# A weld is this much stiffer in shear than the stiffest wall: enough for seven digits, far from rounding.
_WELD = 1e7


class Torsion(NamedTuple):
    """Answers to a twist, relative to the reference metal.

    ``constant`` [m^4]; ``shear_centre`` complex [m] in the coordinates of the walls; ``warping_constant``
    of the mid-line and ``wall_warping_constant`` across the walls [m^6]; ``flow`` q/(G twist) [m^2] of each
    edge and ``warping`` of each node about the shear centre [m^2].
    """

    constant: float
    shear_centre: complex
    warping_constant: float
    wall_warping_constant: float
    flow: Floats
    warping: Floats


def torsion_of(skeleton: Skeleton, stretch: Floats, shear: Floats) -> Torsion:
    """Torsion constant, shear centre and warping.

    Parameters
    ----------
    skeleton
        Graph of the section.
    stretch, shear
        Young's and shear modulus of each edge over those of the reference metal, shape (m,).
    """
    t, length, sweep = skeleton.thickness, skeleton.length, skeleton.sweep
    conductance = np.where(t > 0.0, shear * t / length, 0.0)
    conductance[t <= 0.0] = _WELD * conductance.max()
    start, end = skeleton.ends.T
    n = len(skeleton.nodes)
    matrix, load = np.zeros((n, n)), np.zeros(n)
    np.add.at(matrix, (start, start), conductance)
    np.add.at(matrix, (end, end), conductance)
    np.add.at(matrix, (start, end), -conductance)
    np.add.at(matrix, (end, start), -conductance)
    np.add.at(load, start, conductance * sweep)
    np.add.at(load, end, -conductance * sweep)
    warping = np.zeros(n)
    warping[1:] = np.linalg.solve(matrix[1:, 1:], load[1:])
    flow = conductance * (warping[end] - warping[start] + sweep)
    # rounding of the stiff welds would leave a trace of flow in open walls
    constant = float(flow @ sweep + (shear * length * t**3).sum() / 3.0)
    y, z = skeleton.nodes.real, skeleton.nodes.imag
    metal = _Midline(start, end, stretch * t * length)
    pole, warping = _about_shear_centre(metal, y, z, warping)
    lever = _lever_along(skeleton, pole)
    across = float((stretch * t**3 / 12.0 * length * lever).sum())
    return Torsion(constant, pole, metal.product(warping, warping), across, flow, warping)


class _Midline(NamedTuple):
    """Integrals over the mid-lines of functions that are linear along each edge."""

    start: np.ndarray[tuple[int], np.dtype[np.int64]]
    end: np.ndarray[tuple[int], np.dtype[np.int64]]
    area: Floats

    def product(self, f: Floats, g: Floats) -> float:
        fa, fb, ga, gb = f[self.start], f[self.end], g[self.start], g[self.end]
        return float(self.area @ (2.0 * (fa * ga + fb * gb) + fa * gb + fb * ga)) / 6.0

    def centred(self, f: Floats) -> Floats:
        mean = float(self.area @ (f[self.start] + f[self.end])) / 2.0 / float(self.area.sum())
        return np.asarray(f - mean)


def _about_shear_centre(metal: _Midline, y: Floats, z: Floats, warping: Floats) -> tuple[complex, Floats]:
    y0, z0, u = metal.centred(y), metal.centred(z), metal.centred(warping)
    iyy, izz, iyz = metal.product(z0, z0), metal.product(y0, y0), metal.product(y0, z0)
    matrix = np.array([[iyz, -izz], [iyy, -iyz]])
    right = -np.array([metal.product(u, y0), metal.product(u, z0)])
    # a straight strip has no stiffness across itself: its shear centre is on it
    yp, zp = np.linalg.lstsq(matrix, right, rcond=1e-12)[0].tolist()
    return complex(yp, zp), metal.centred(u + yp * z0 - zp * y0)


def _lever_along(skeleton: Skeleton, pole: complex) -> Floats:
    """Mean square over each edge of the distance to the pole along the edge [m^2]."""
    start, end = (skeleton.nodes[number] for number in skeleton.ends.T)
    direction = (end - start) / np.abs(end - start)
    a, b = (((point - pole) * direction.conj()).real for point in (start, end))
    return np.asarray((a * a + a * b + b * b) / 3.0)
