"""Torsion and warping of a graph of thin walls: any number of cells, open walls, all in one system.

At unit twist per length, in a wall of thickness t and length L, with u the warping of its ends and s twice
the area that the ray from the pole sweeps along it, the shear flow is

    q = G t/L (u_end - u_start + s).

The flows that leave a node add up to zero, so they are sums of flows q_i that circulate in the independent
loops of the graph.  Once around a loop the warping comes back to its value; with A_i the area of the loop:

    sum over its walls of q L/(G t) = 2 A_i      (Bredt; one equation per loop for the q_i)

Walls in no loop carry no flow and warp freely.  A weld is rigid in shear: L/(G t) = 0.  Then

    G J   = sum 2 A_i q_i + sum G L t^3/3
    shear centre P:  the warping about it, u + y_P z - z_P y + const, does no work with bending:
                     int E u_P dA = int E u_P y dA = int E u_P z dA = 0
    E I_w = int E u_P^2 dA + sum E t^3/12 int r_t^2 ds       (r_t lever arm along the wall: warping across it)

Limits: a single cell gives 4 A_m^2/sum(L/t); an angle has no warping but that across its walls, A^3/144 for
equal legs.  Mid-line integrals: sharp corners add stiffness that is not here.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.section.geometry.skeleton import Complexes, Skeleton


class Torsion(NamedTuple):
    """Answers to a twist, relative to the reference metal.

    ``constant`` [m^4]; ``shear_centre`` complex [m] in the coordinates of the walls; ``warping_constant``
    of the mid-line and ``wall_warping_constant`` across the walls [m^6].
    """

    constant: float
    shear_centre: complex
    warping_constant: float
    wall_warping_constant: float


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
    flexibility = np.divide(length, shear * t, out=np.zeros(len(t)), where=t > 0.0)
    paths, loops = _paths_and_loops(skeleton)
    twice_areas = loops @ sweep
    circulating = np.linalg.solve((loops * flexibility) @ loops.T, twice_areas)
    constant = float(circulating @ twice_areas + (shear * length * t**3).sum() / 3.0)
    warping = paths @ (flexibility * (circulating @ loops) - sweep)
    start, end = skeleton.ends.T
    metal = _Midline(start, end, stretch * t * length)
    local = skeleton.nodes - skeleton.middle
    pole, warping = _about_shear_centre(metal, local.real, local.imag, warping)
    lever = _lever_along(local[start], local[end], pole)
    across = float((stretch * t**3 / 12.0 * length * lever).sum())
    return Torsion(constant, skeleton.middle + pole, metal.product(warping, warping), across)


def warping_of(skeleton: Skeleton) -> Floats:
    """Warping of the nodes of walls without cells at unit twist per length about `middle`, (n,) [m^2]."""
    paths, _ = _paths_and_loops(skeleton)
    return np.asarray(-paths @ skeleton.sweep)


def _paths_and_loops(skeleton: Skeleton) -> tuple[Floats, Floats]:
    """Which edges lead from node 0 to each node, and which make up each independent loop.

    Returns
    -------
    tuple
        Paths along a spanning tree, shape (n, m), and the loops that the other edges close, shape (loops, m):
        +1 where an edge is followed from its start to its end, -1 against it, else 0.
    """
    edges, ends = len(skeleton.pieces), skeleton.ends.tolist()
    paths = np.zeros((len(skeleton.nodes), edges))
    loops: list[Floats] = []
    reached, used = {0}, set()
    walls, welds = deque(skeleton.stars[0]), deque[int]()
    while walls or welds:
        # welds first: one that then closes a loop closes a loop of welds alone, and is redundant
        half = (welds or walls).popleft()
        edge, side = half >> 1, half & 1
        if edge in used:
            continue
        used.add(edge)
        far = ends[edge][1 - side]
        path = paths[ends[edge][side]].copy()
        path[edge] = 1.0 - 2.0 * side
        if far not in reached:
            reached.add(far)
            paths[far] = path
            for leaving in skeleton.stars[far]:
                (walls if skeleton.thickness[leaving >> 1] > 0.0 else welds).append(leaving)
        elif skeleton.thickness[edge] > 0.0:
            loops.append(path - paths[far])
    return paths, np.array(loops).reshape(-1, edges)


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


def _lever_along(start: Complexes, end: Complexes, pole: complex) -> Floats:
    """Mean square over each edge of the distance to the pole along the edge [m^2]."""
    direction = (end - start) / np.abs(end - start)
    a, b = (((point - pole) * direction.conj()).real for point in (start, end))
    return np.asarray((a * a + a * b + b * b) / 3.0)
