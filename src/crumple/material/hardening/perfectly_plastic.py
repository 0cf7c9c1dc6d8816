"""Perfect plasticity: s = s_y."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.material.hardening.curve import refuse_not_positive
from crumple.material.hardening.table import HardeningTable
from crumple.numeric.arrays import Floats


@dataclass(frozen=True)
class PerfectlyPlastic:
    """Constant stress.

    Attributes
    ----------
    yield_stress
        [Pa], > 0.
    """

    kinks: ClassVar[tuple[float, ...]] = ()

    yield_stress: float

    def __post_init__(self) -> None:
        refuse_not_positive(yield_stress=(self.yield_stress, "Pa"))

    def stress(self, plastic_strain: ArrayLike) -> Floats:
        """Yield stress [Pa] at every strain."""
        return np.full_like(np.asarray(plastic_strain, np.float64), self.yield_stress)

    def slope(self, plastic_strain: ArrayLike) -> Floats:
        """Zero [Pa]."""
        return np.zeros_like(np.asarray(plastic_strain, np.float64))

    def as_table(self) -> HardeningTable:
        """Return the same curve as a table of one point."""
        return HardeningTable((0.0,), (self.yield_stress,))
