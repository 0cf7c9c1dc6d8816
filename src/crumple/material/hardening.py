"""Hardening curves: true stress against plastic strain.

One rule for all: stress(0) is the yield stress, the curve never falls, and beyond the last strain that the
evidence covers a table is held.  With s the stress and e the plastic strain:

    perfectly plastic   s = s_y
    Swift               s = s_y (1 + e/e_0)^n                 no limit; slope ~ e^(n-1)
    Voce                s = s_y + Q (1 - exp(-e/e_c))         tends to s_y + Q
    table               straight lines, last stress held

Swift from a tensile test: necking begins where the slope equals the stress (Considere), at the uniform
elongation A_g with true strain e_g = ln(1 + A_g) and true stress s_g = R_m (1 + A_g).  Both conditions give
n = e_g + e_0 (elastic strain left out), and the curve through s_y fixes e_0:

    s_y (1 + e_g/e_0)^(e_g + e_0) = s_g
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats


@runtime_checkable
class HardeningCurve(Protocol):
    """True stress against plastic strain; frozen, vectorised."""

    @property
    def yield_stress(self) -> float:
        """Stress at zero plastic strain [Pa]."""
        ...

    def stress(self, plastic_strain: ArrayLike) -> Floats:
        """True stress [Pa] at a plastic strain >= 0 [-], same shape."""
        ...

    def slope(self, plastic_strain: ArrayLike) -> Floats:
        """Hardening modulus ds/de [Pa], same shape; of a table the slope to the right."""
        ...


@dataclass(frozen=True)
class PerfectlyPlastic:
    """Constant stress.

    Attributes
    ----------
    yield_stress
        [Pa], > 0.
    """

    yield_stress: float

    def __post_init__(self) -> None:
        _refuse_not_positive(yield_stress=(self.yield_stress, "Pa"))

    def stress(self, plastic_strain: ArrayLike) -> Floats:
        """Yield stress [Pa] at every strain."""
        return np.full_like(np.asarray(plastic_strain, np.float64), self.yield_stress)

    def slope(self, plastic_strain: ArrayLike) -> Floats:
        """Zero [Pa]."""
        return np.zeros_like(np.asarray(plastic_strain, np.float64))


@dataclass(frozen=True)
class Swift:
    """Power law s_y (1 + e/e_0)^n.

    Attributes
    ----------
    yield_stress
        [Pa], > 0.
    prestrain
        e_0 [-], > 0.
    exponent
        n [-], 0 to 1; 0 is perfectly plastic.
    """

    yield_stress: float
    prestrain: float
    exponent: float

    def __post_init__(self) -> None:
        _refuse_not_positive(yield_stress=(self.yield_stress, "Pa"), prestrain=(self.prestrain, ""))
        if not 0.0 <= self.exponent <= 1.0:
            what, todo = "the hardening exponent is out of range", "sheet steels have 0.05 to 0.25"
            raise InputError(Problem(what, f"{self.exponent:g}", "0 to 1", todo, "exponent"))

    def stress(self, plastic_strain: ArrayLike) -> Floats:
        """True stress [Pa]."""
        strain = np.asarray(plastic_strain, np.float64)
        return np.asarray(self.yield_stress * (1.0 + strain / self.prestrain) ** self.exponent, np.float64)

    def slope(self, plastic_strain: ArrayLike) -> Floats:
        """Hardening modulus [Pa]."""
        strain = np.asarray(plastic_strain, np.float64)
        return np.asarray(self.exponent * self.stress(strain) / (self.prestrain + strain), np.float64)


@dataclass(frozen=True)
class Voce:
    """Saturating law s_y + Q (1 - exp(-e/e_c)).

    Attributes
    ----------
    yield_stress
        [Pa], > 0.
    saturation
        Q [Pa], >= 0: how much the stress rises in the end.
    strain
        e_c [-], > 0: strain in which 63 % of the rise happens.
    """

    yield_stress: float
    saturation: float
    strain: float

    def __post_init__(self) -> None:
        _refuse_not_positive(yield_stress=(self.yield_stress, "Pa"), strain=(self.strain, ""))
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


@dataclass(frozen=True)
class HardeningTable:
    """Straight lines between points; the last stress is held.

    Attributes
    ----------
    plastic_strain
        [-], strictly increasing from 0.
    true_stress
        [Pa], > 0, never falling, as many.
    """

    plastic_strain: Sequence[float]
    true_stress: Sequence[float]

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

    def stress(self, plastic_strain: ArrayLike) -> Floats:
        """True stress [Pa]."""
        strain = np.asarray(plastic_strain, np.float64)
        return np.asarray(np.interp(strain, self.plastic_strain, self.true_stress), np.float64)

    def slope(self, plastic_strain: ArrayLike) -> Floats:
        """Hardening modulus [Pa], zero beyond the table."""
        steps = np.diff(self.true_stress) / np.diff(self.plastic_strain)
        piece = np.searchsorted(np.asarray(self.plastic_strain), np.asarray(plastic_strain), side="right")
        return np.asarray(np.concatenate([steps, [0.0]])[piece - 1], np.float64)


def swift_from_tensile_test(yield_stress: float, ultimate_stress: float, uniform_elongation: float) -> Swift:
    """Swift curve through yield that necks at the ultimate strength and the uniform elongation.

    Parameters
    ----------
    yield_stress, ultimate_stress
        Engineering values of the test, R_p0.2 or R_eL and R_m [Pa].
    uniform_elongation
        A_g [-]: plastic extension at the largest force.  The elongation after fracture A is larger, since it
        includes the neck: do not use it here.

    Returns
    -------
    Swift
        With stress(ln(1 + A_g)) = R_m (1 + A_g) and slope equal to stress there.

    Raises
    ------
    InputError
        If the ultimate stress is too close to yield for a curve that necks at this elongation, or a value is
        out of range.

    References
    ----------
    Derived at the head of this file.  Verified in tests/unit/material/test_hardening.py.
    """
    _refuse_not_positive(
        yield_stress=(yield_stress, "Pa"),
        ultimate_stress=(ultimate_stress, "Pa"),
        uniform_elongation=(uniform_elongation, ""),
    )
    strain = math.log1p(uniform_elongation)
    wanted = math.log(ultimate_stress * (1.0 + uniform_elongation) / yield_stress)
    # n ln(1 + e_g/e_0) falls with e_0 from infinity; at its least the exponent would be 1
    if strain >= 1.0 or wanted < -math.log1p(-strain):
        allowed = f"above the yield stress, {yield_stress / 1e6:g} MPa"
        what = "no power law has so little hardening at so large a uniform elongation"
        todo = "take a smaller uniform elongation, a Voce curve, or perfect plasticity"
        came = f"{ultimate_stress / 1e6:g} MPa at {100 * uniform_elongation:g} % uniform elongation"
        raise InputError(Problem(what, came, allowed, todo, "ultimate_stress"))
    # bisection on the logarithm: 200 halvings reach rounding from any start
    low, high = math.log(1e-300), math.log(1.0 - strain)
    for _ in range(200):
        middle = (low + high) / 2.0
        prestrain = math.exp(middle)
        rise = (strain + prestrain) * math.log1p(strain / prestrain)
        low, high = (middle, high) if rise > wanted else (low, middle)
    prestrain = math.exp(high)
    return Swift(yield_stress, prestrain, min(strain + prestrain, 1.0))


def _first_wrong(values: Floats, wrong: NDArray[np.bool_]) -> str:
    """First point of a table that is marked, in words."""
    at = int(np.argmax(wrong))
    return f"point {at + 1}: {values[at]:g}" + (f" after {values[at - 1]:g}" if at else "")


def _refuse_not_positive(**values: tuple[float, str]) -> None:
    problems = [
        Problem(f"{name.replace('_', ' ')} must be positive", f"{value:g} {unit}".strip(), "> 0", "", name)
        for name, (value, unit) in values.items()
        if not (math.isfinite(value) and value > 0.0)
    ]
    if problems:
        raise InputError(problems)
