"""How stress rises with strain rate."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crumple.errors import InputError, Problem


@dataclass(frozen=True)
class CowperSymonds:
    """Dynamic over static stress: 1 + (strain_rate / D)**(1 / q).

    Attributes
    ----------
    D
        Strain rate [1/s] at which the stress doubles, > 0.
    q
        Exponent [-], >= 1.

    Raises
    ------
    InputError
        If D is not positive or q is below 1.

    Notes
    -----
    One pair fits one strain: a pair fitted at yield overstates the effect at the large strains of a
    fold, so a material holds one pair for yield and another for flow.

    References
    ----------
    docs/theory/rate.md.  Verified in tests/unit/material/test_material.py.
    """

    D: float
    q: float

    def __post_init__(self) -> None:
        problems = []
        if not (math.isfinite(self.D) and self.D > 0.0):
            what, todo = (
                "the reference strain rate must be positive",
                "40.4 1/s is often used for mild steel at yield",
            )
            problems.append(Problem(what, f"{self.D:g} 1/s", "> 0 1/s", todo, "D"))
        if not (math.isfinite(self.q) and self.q >= 1.0):
            what, todo = "the rate exponent must be at least 1", "5 is often used for mild steel at yield"
            problems.append(Problem(what, f"{self.q:g}", ">= 1", todo, "q"))
        if problems:
            raise InputError(problems)

    def factor(self, strain_rate: ArrayLike) -> NDArray[np.float64]:
        """Dynamic over static stress at a strain rate [1/s]; the sign of the rate does not matter."""
        relative = np.abs(np.asarray(strain_rate, np.float64)) / self.D
        return np.asarray(1.0 + relative ** (1.0 / self.q), np.float64)
