"""How stress rises with strain rate."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crumple.errors import InputError, Problem
from crumple.registry.quantity import NonNegativeNumber, PositiveRate, RateExponent


@dataclass(frozen=True)
class CowperSymonds:
    """Cowper-Symonds strain-rate law: stress times 1 + (strain rate / D)^(1/q).

    Attributes
    ----------
    D
        Strain rate at which the stress doubles [1/s].
    q
        Exponent [-].

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

    D: PositiveRate
    q: RateExponent

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


@dataclass(frozen=True)
class JohnsonCook:
    """Johnson-Cook strain-rate law: stress times 1 + C ln(strain rate / reference), 1 below the reference.

    Attributes
    ----------
    C
        Rise of the stress per e-fold of strain rate [-].
    reference
        Strain rate of the static test [1/s].

    Raises
    ------
    InputError
        If C is negative or the reference is not positive.

    Notes
    -----
    The rate term of Johnson and Cook's law alone: no temperature.  The solver's hinge knows the power law,
    so a hinge takes `as_cowper_symonds`.
    """

    C: NonNegativeNumber
    reference: PositiveRate = 1.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.C) and self.C >= 0.0):
            what, todo = "the rate constant must not be negative", "steels have about 0.01"
            raise InputError(Problem(what, f"{self.C:g}", ">= 0", todo, "C"))
        if not (math.isfinite(self.reference) and self.reference > 0.0):
            what, todo = "the reference strain rate must be positive", "1 1/s is usual"
            raise InputError(Problem(what, f"{self.reference:g} 1/s", "> 0 1/s", todo, "reference"))

    def factor(self, strain_rate: ArrayLike) -> NDArray[np.float64]:
        """Dynamic over static stress at a strain rate [1/s]; the sign of the rate does not matter."""
        relative = np.maximum(np.abs(np.asarray(strain_rate, np.float64)) / self.reference, 1.0)
        return np.asarray(1.0 + self.C * np.log(relative), np.float64)

    def as_cowper_symonds(self, low: float = 10.0, high: float = 1000.0) -> CowperSymonds | None:
        """Power law with the same factor at two strain rates; None without a rate effect.

        Parameters
        ----------
        low, high
            Strain rates [1/s] at which both agree; ``low`` above e times the reference rate.

        Returns
        -------
        CowperSymonds or None
            q = ln(high/low)/ln(f_high/f_low) and D = low f_low^-q with f the rise above 1.

        Raises
        ------
        InputError
            If the rates are out of order or too low.

        Notes
        -----
        With C = 0.014 and a reference of 1/s both factors differ by less than 1 % from 10 to 1000 /s.
        """
        if self.C == 0.0:
            return None
        if not math.e * self.reference <= low < high < math.inf:
            allowed = f"{math.e * self.reference:g} 1/s <= low < high"
            what = "no power law with an exponent of at least 1 fits at these strain rates"
            todo = "choose strain rates that occur in the crash"
            raise InputError(Problem(what, f"{low:g} and {high:g} 1/s", allowed, todo, "low"))
        rise_low, rise_high = (self.C * math.log(rate / self.reference) for rate in (low, high))
        q = math.log(high / low) / math.log(rise_high / rise_low)
        return CowperSymonds(low * rise_low**-q, q)


RateLaw = CowperSymonds | JohnsonCook
"""Any law of stress against strain rate."""
