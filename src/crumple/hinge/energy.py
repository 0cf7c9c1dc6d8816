"""Energy that a law absorbs on the way to a rotation."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from crumple.hinge.law import Floats, HingeLaw

GAUSS_POINTS = 24
"""Per smooth piece between kinks; folding curves behave like a power of the rotation there."""


def absorbed_energy(law: HingeLaw, rotation: float, sense: int = 1) -> float:
    """Integral of the quasi-static capacity from 0 to a rotation [rad], in [J]."""
    ends = [0.0, *(kink for kink in law.kinks(sense) if 0.0 < kink < rotation), rotation]
    place, weight = np.polynomial.legendre.leggauss(GAUSS_POINTS)
    total = 0.0
    for low, high in pairwise(ends):
        at: Floats = low + (high - low) * (place + 1.0) / 2.0
        total += float(weight @ law.moment_capacity(at, sense)) * (high - low) / 2.0
    return total


def rotation_absorbing(law: HingeLaw, energy: float, sense: int = 1) -> float:
    """Rotation [rad] at which a law has absorbed an energy [J], from rest and without elasticity.

    Notes
    -----
    What a single hinge on a rigid bar turns by, if all its kinetic energy goes into it.
    """
    low, high = 0.0, 1e-3
    while absorbed_energy(law, high, sense) < energy:
        low, high = high, 2.0 * high
    # bisection: 60 halvings reach the rounding of the rotation
    for _ in range(60):
        middle = (low + high) / 2.0
        low, high = (middle, high) if absorbed_energy(law, middle, sense) < energy else (low, middle)
    return high
