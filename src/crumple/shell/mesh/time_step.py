"""Which element sets the time step of a mesh at its start.

The stable step of an element is 2/w with a bound of its largest frequency w, by its shape, metal and loose
corners: the kernel's own formula (native/shell/run/lowering.cpp), here for all elements at once.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from crumple._core.shell.model import ShellModel
from crumple.numeric.arrays import Floats, Integers

SHARED = 2
"""Corners of an element that no other one has, from which it can dilate."""


def stable_steps(model: ShellModel) -> Floats:
    """Stable steps of all elements at the start, without safety and mass scaling [s], (m,); inf: rigid."""
    quads = np.asarray(model.elements)
    x = np.asarray(model.position)[quads]
    three = quads[:, 2] == quads[:, 3]
    d31, d42 = x[:, 2] - x[:, 0], x[:, 3] - x[:, 1]
    normal = np.cross(d31, d42)
    inverse = 1.0 / np.linalg.norm(normal, axis=1)
    e3 = inverse[:, None] * normal
    e1 = _unit(_unit(d31 - d42) + np.cross(_unit(d31 + d42), e3))
    e2 = np.cross(e3, e1)
    # the corners have b_1, b_2, -b_1 and -b_2, a triangle's third has -b_1 - b_2
    bx = np.stack([-_dot(d42, e2), _dot(d31, e2)]) * inverse
    by = np.stack([_dot(d42, e1), -_dot(d31, e1)]) * inverse
    twice, third = np.where(three, 1.0, 2.0), np.where(three, 1.0, 0.0)
    xx = twice * (bx**2).sum(axis=0) + third * bx.sum(axis=0) ** 2
    yy = twice * (by**2).sum(axis=0) + third * by.sum(axis=0) ** 2
    xy = twice * (bx * by).sum(axis=0) + third * bx.sum(axis=0) * by.sum(axis=0)
    number = np.broadcast_to(np.asarray(model.sheet), len(quads))
    metals = [model.materials[sheet.material] for sheet in model.sheets]
    nu = np.array([metal.poissons_ratio for metal in metals])[number]
    wave = np.array([metal.youngs_modulus / metal.density for metal in metals])[number] / (1.0 - nu**2)
    steps = 2.0 / np.sqrt(np.where(three, 3.0, 4.0) * wave * (np.maximum(xx, yy) + np.abs(xy)))
    loose = np.where(_own_corners(quads, three) >= SHARED, 1.0 + nu, 1.0)
    rigid = np.array([metal.rigid for metal in metals])[number]
    return np.where(rigid, np.inf, steps / np.sqrt(loose))


def _own_corners(quads: Integers, three: NDArray[np.bool_]) -> Integers:
    """Corners of every element that belong to no other, (m,)."""
    real = np.ones(quads.shape, bool)
    real[three, 3] = False
    sharing = np.bincount(quads[real])
    return np.asarray(((sharing[quads] == 1) & real).sum(axis=1))


def _unit(vectors: Floats) -> Floats:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1)[:, None])


def _dot(first: Floats, second: Floats) -> Floats:
    return np.asarray(np.einsum("mi,mi->m", first, second))
