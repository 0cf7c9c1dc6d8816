"""Voce's law, s = s_y + Q (1 - exp(-e/e_c)): it tends to s_y + Q."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.material.hardening.curve import refuse_not_positive
from crumple.numeric.arrays import Floats
from crumple.registry.quantity import (
    PositiveNumber,
    PositiveStress,
)


@dataclass(frozen=True)
class Voce:
    """Saturating law: yield stress + saturation (1 - exp(-plastic strain / strain)).

    Attributes
    ----------
    yield_stress
        [Pa], > 0.
    saturation
        How much the stress rises in the end, Q [Pa].
    strain
        Plastic strain in which 63 % of the rise happens, e_c [-].
    """

    kinks: ClassVar[tuple[float, ...]] = ()

    yield_stress: float
    saturation: PositiveStress
    strain: PositiveNumber

    def __post_init__(self) -> None:
        refuse_not_positive(yield_stress=(self.yield_stress, "Pa"), strain=(self.strain, ""))
        if not (math.isfinite(self.saturation) and self.saturation >= 0.0):
            what, came = "the rise of a Voce curve must not be negative", f"{self.saturation:g} Pa"
            raise InputError(Problem(what, came, ">= 0 Pa", "give the rise above yield", "saturation"))

    def stress(self, plastic_strain: ArrayLike) -> Floats:
        """True stress [Pa]."""
        strain = np.asarray(plastic_strain, np.float64)
        return np.asarray(self.yield_stress - self.saturation * np.expm1(-strain / self.strain), np.float64)

    def slope(self, plastic_strain: ArrayLike) -> Floats:
        """Hardening modulus [Pa]."""
        strain = np.asarray(plastic_strain, np.float64)
        return np.asarray(self.saturation / self.strain * np.exp(-strain / self.strain), np.float64)
