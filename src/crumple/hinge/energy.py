"""Energy absorbed by a law up to a rotation."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from crumple.hinge.law import HingeLaw
from crumple.numeric.arrays import Floats

GAUSS_POINTS = 8
"""Per interval of a smooth piece."""
HALVINGS = 16
"""Intervals of a piece halve towards its start, where folding curves fall like a power of the rotation."""
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(GAUSS_POINTS)
_SHARES = np.concatenate([[0.0], 0.5 ** np.arange(HALVINGS, -1.0, -1.0)])


def absorbed_energy(law: HingeLaw, rotation: float, sense: int = 1) -> float:
    """Integral of the quasi-static capacity from 0 to a rotation [rad], in [J]."""
    ends = [0.0, *(kink for kink in law.kinks(sense) if 0.0 < kink < rotation), rotation]
    graded = [low + (high - low) * _SHARES for low, high in pairwise(ends) if high > low]
    if not graded:
        return 0.0
    lows = np.concatenate([interval[:-1] for interval in graded])
    lengths = np.concatenate([np.diff(interval) for interval in graded])
    at: Floats = lows[:, None] + lengths[:, None] * (_POINTS + 1.0) / 2.0
    return float(lengths @ law.moment_capacity(at, sense) @ _WEIGHTS) / 2.0


def rotation_absorbing(law: HingeLaw, energy: float, sense: int = 1) -> float:
    """Rotation [rad] at which a law has absorbed an energy [J], from rest and without elasticity.

    Notes
    -----
    Rotation of a single hinge on a rigid bar that absorbs all its kinetic energy.
    """
    low, high = 0.0, 1e-3
    while absorbed_energy(law, high, sense) < energy:
        low, high = high, 2.0 * high
    # bisection: 60 halvings reach the rounding of the rotation
    for _ in range(60):
        middle = (low + high) / 2.0
        low, high = (middle, high) if absorbed_energy(law, middle, sense) < energy else (low, middle)
    return high
