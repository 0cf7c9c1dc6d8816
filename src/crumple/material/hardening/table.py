"""Hardening as measured: straight lines between points, last stress held."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.registry.keys import As
from crumple.registry.quantity import (
    Longest,
    NonNegativeNumber,
    PositiveStress,
)

POINTS = Longest(1000, least=1)
"""Points of one hardening table."""


@dataclass(frozen=True)
class HardeningTable:
    """Straight lines of true stress against plastic strain; the last stress is held.

    Attributes
    ----------
    plastic_strain
        Plastic strains, from 0, strictly increasing [-].
    true_stress
        True stresses, the first one the yield stress, never falling [Pa].
    """

    plastic_strain: Annotated[Sequence[float], As(Annotated[tuple[NonNegativeNumber, ...], POINTS])]
    true_stress: Annotated[Sequence[float], As(Annotated[tuple[PositiveStress, ...], POINTS])]

    def __post_init__(self) -> None:
        # tuples: a curve must not change when the caller's list does, and must hash
        for key in ("plastic_strain", "true_stress"):
            object.__setattr__(self, key, tuple(float(value) for value in getattr(self, key)))
        strain, stress = np.array(self.plastic_strain), np.array(self.true_stress)
        problems = []
        if strain.size != stress.size or strain.size == 0:
            came = f"{strain.size} strains, {stress.size} stresses"
            what, todo = "the table needs as many stresses as strains", "add or remove points"
            raise InputError(Problem(what, came, "as many, at least one", todo, "true_stress"))
        if not np.all(np.isfinite(strain)) or strain[0] != 0.0 or np.any(np.diff(strain) <= 0.0):
            todo = "begin at plastic strain 0 (first yield) and remove repeated points"
            what = "plastic strains must increase strictly from 0"
            came = _first_wrong(strain, np.concatenate([[strain[0] != 0.0], ~(np.diff(strain) > 0.0)]))
            problems.append(Problem(what, came, "0 < 1st < 2nd < ...", todo, "plastic_strain"))
        if not np.all(np.isfinite(stress)) or stress[0] <= 0.0 or np.any(np.diff(stress) < 0.0):
            todo = "give true stress: an engineering curve falls after necking, a true one does not"
            what = "true stresses must be positive and must not fall"
            came = _first_wrong(stress, np.concatenate([[not stress[0] > 0.0], ~(np.diff(stress) >= 0.0)]))
            problems.append(Problem(what, came, "0 < 1st <= 2nd <= ...", todo, "true_stress"))
        if problems:
            raise InputError(problems)

    @property
    def yield_stress(self) -> float:
        """First stress [Pa]."""
        return self.true_stress[0]

    @property
    def kinks(self) -> tuple[float, ...]:
        """Strain of every point [-]."""
        return tuple(self.plastic_strain)

    def stress(self, plastic_strain: ArrayLike) -> Floats:
        """True stress [Pa]."""
        strain = np.asarray(plastic_strain, np.float64)
        return np.asarray(np.interp(strain, self.plastic_strain, self.true_stress), np.float64)

    def slope(self, plastic_strain: ArrayLike) -> Floats:
        """Hardening modulus [Pa], zero beyond the table."""
        steps = np.diff(self.true_stress) / np.diff(self.plastic_strain)
        piece = np.searchsorted(np.asarray(self.plastic_strain), np.asarray(plastic_strain), side="right")
        return np.asarray(np.concatenate([steps, [0.0]])[piece - 1], np.float64)


def _first_wrong(values: Floats, wrong: NDArray[np.bool_]) -> str:
    """First point of a table that is marked, in words."""
    at = int(np.argmax(wrong))
    return f"point {at + 1}: {values[at]:g}" + (f" after {values[at - 1]:g}" if at else "")
