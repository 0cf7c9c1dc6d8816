"""Hardening curves: true stress against plastic strain.

One rule for all: stress(0) is the yield stress, the curve never falls, and a table keeps its last stress
beyond its last strain.
"""

from __future__ import annotations

import math
from typing import Protocol, runtime_checkable

from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats


@runtime_checkable
class HardeningCurve(Protocol):
    """True stress against plastic strain; frozen, vectorised."""

    @property
    def yield_stress(self) -> float:
        """Stress at zero plastic strain [Pa]."""
        ...

    @property
    def kinks(self) -> tuple[float, ...]:
        """Plastic strains where the slope jumps [-]; between them straight lines; none: smooth."""
        ...

    def stress(self, plastic_strain: ArrayLike) -> Floats:
        """True stress [Pa] at a plastic strain >= 0 [-], same shape."""
        ...

    def slope(self, plastic_strain: ArrayLike) -> Floats:
        """Hardening modulus ds/de [Pa], same shape; of a table the slope to the right."""
        ...


def refuse_not_positive(**values: tuple[float, str]) -> None:
    """Refuse values, each with its unit, that are not positive and finite."""
    problems = [
        Problem(f"{name.replace('_', ' ')} must be positive", f"{value:g} {unit}".strip(), "> 0", "", name)
        for name, (value, unit) in values.items()
        if not (math.isfinite(value) and value > 0.0)
    ]
    if problems:
        raise InputError(problems)
