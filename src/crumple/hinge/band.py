"""The scatter band of a law as three laws: nominal, lower, upper.

A law whose validity gives a relative half-width u has the bounds 1 - u and 1 + u times the law.  The solver
does not use the band itself: it runs three times.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.hinge.inside import LawInside
from crumple.hinge.law import HingeLaw, Validity
from crumple.hinge.options import choice
from crumple.numeric.arrays import Floats


class Bound(Enum):
    """Which law of a band."""

    LOWER = "lower"
    NOMINAL = "nominal"
    UPPER = "upper"


@dataclass(frozen=True)
class Band:
    """Three laws of one hinge.

    Attributes
    ----------
    nominal, lower, upper
        Ordered at every rotation.
    """

    nominal: HingeLaw
    lower: HingeLaw
    upper: HingeLaw

    def law(self, bound: Bound | str) -> HingeLaw:
        """Law of a bound, by enum or by its text."""
        laws = {Bound.LOWER: self.lower, Bound.NOMINAL: self.nominal, Bound.UPPER: self.upper}
        return laws[choice("bound", bound, Bound)]


@dataclass(frozen=True)
class ScaledLaw(LawInside):
    """A law whose capacity is multiplied by a constant; all other properties are those of the law.

    The scatter of strength does not affect its stiffness.

    Attributes
    ----------
    law
        Any law.
    factor
        > 0 [-].
    reason
        Reason of the factor, for the title.
    """

    factor: float
    reason: str = "scaled"

    def __post_init__(self) -> None:
        if not (np.isfinite(self.factor) and self.factor > 0.0):
            what, todo = "the factor on a law must be positive", "a band of 100 % or more has no lower law"
            raise InputError(Problem(what, f"{self.factor:g}", "> 0", todo, "factor"))

    @property
    def title(self) -> str:
        """One line for people."""
        return f"{self.law.title}, {self.reason} (times {self.factor:.3g})"

    @property
    def validity(self) -> Validity:
        """Range of the law inside, without the band: this is one edge of it."""
        return replace(self.law.validity, uncertainty=None)

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]."""
        return self.factor * self.law.moment_capacity(rotation, sense)


def band_of(law: HingeLaw, uncertainty: float | None = None) -> Band:
    """Band of a law.

    Parameters
    ----------
    law
        Any law.
    uncertainty
        Relative half-width [-], below 1; None: the one given by the law.

    Returns
    -------
    Band
        The law itself in the middle.

    Raises
    ------
    InputError
        If the law gives no band and none is passed, or the lower bound is not positive.

    References
    ----------
    docs/theory/measured_curves.md.  Verified in tests/unit/hinge/test_band.py.
    """
    width = law.validity.uncertainty if uncertainty is None else uncertainty
    if width is None:
        what = "the scatter of this law is unknown"
        todo = "omit the bound, or in Python give the relative half-width as uncertainty"
        raise InputError(Problem(what, law.title, "a law with a band", todo, "uncertainty"))
    if not 0.0 <= width < 1.0:
        what, todo = "the half-width of the band is out of range", "0.1 means plus or minus 10 %"
        raise InputError(Problem(what, f"{width:g}", "0 to below 1", todo, "uncertainty"))
    return Band(law, ScaledLaw(law, 1.0 - width, "lower"), ScaledLaw(law, 1.0 + width, "upper"))
