"""Swift's power law, s = s_y (1 + e/e_0)^n: no limit; slope ~ e^(n-1).

From a tensile test: necking begins where the slope equals the stress (Considere), at the uniform
elongation A_g with true strain e_g = ln(1 + A_g) and true stress s_g = R_m (1 + A_g).  Both conditions give
n = e_g + e_0 (elastic strain left out), and the curve through s_y fixes e_0:

    s_y (1 + e_g/e_0)^(e_g + e_0) = s_g
"""

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
    HardeningExponent,
    PositiveNumber,
)


@dataclass(frozen=True)
class Swift:
    """Power law: yield stress times (1 + plastic strain / prestrain)^exponent.

    Attributes
    ----------
    yield_stress
        [Pa], > 0.
    prestrain
        Plastic strain e_0 that scales the law [-].
    exponent
        Exponent n [-], 0 to 1; 0 is perfectly plastic.
    """

    kinks: ClassVar[tuple[float, ...]] = ()

    yield_stress: float
    prestrain: PositiveNumber
    exponent: HardeningExponent

    def __post_init__(self) -> None:
        refuse_not_positive(yield_stress=(self.yield_stress, "Pa"), prestrain=(self.prestrain, ""))
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
    refuse_not_positive(
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
