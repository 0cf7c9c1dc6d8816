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
from crumple.hinge.law import HingeLaw, SofteningVariable, Source, Validity
from crumple.hinge.options import choice
from crumple.hinge.rate import HingeRate
from crumple.hinge.stop import Stop
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
class ScaledLaw:
    """A law whose capacity is multiplied by a constant; all other properties are those of the law.

    Attributes
    ----------
    law
        Any law.
    factor
        > 0 [-].
    reason
        Reason of the factor, for the title.
    """

    law: HingeLaw
    factor: float
    reason: str = "scaled"

    def __post_init__(self) -> None:
        if not (np.isfinite(self.factor) and self.factor > 0.0):
            what, todo = "the factor on a law must be positive", "a band of 100 % or more has no lower law"
            raise InputError(Problem(what, f"{self.factor:g}", "> 0", todo, "factor"))

    @property
    def name(self) -> str:
        """Key of the law inside."""
        return self.law.name

    @property
    def title(self) -> str:
        """One line for people."""
        return f"{self.law.title}, {self.reason} (times {self.factor:.3g})"

    @property
    def source(self) -> Source:
        """Source of the law inside."""
        return self.law.source

    @property
    def softening_variable(self) -> SofteningVariable:
        """Variable of the law inside."""
        return self.law.softening_variable

    @property
    def elastic_stiffness(self) -> float | None:
        """Stiffness of the law inside [N m/rad]: the scatter of strength does not affect it."""
        return self.law.elastic_stiffness

    @property
    def jamming_angle(self) -> float | None:
        """Jamming angle of the law inside [rad]."""
        return self.law.jamming_angle

    @property
    def validity(self) -> Validity:
        """Range of the law inside, without the band: this is one edge of it."""
        return replace(self.law.validity, uncertainty=None)

    @property
    def rate(self) -> HingeRate | None:
        """Rate law of the law inside."""
        return self.law.rate

    @property
    def stop(self) -> Stop | None:
        """Stop of the law inside."""
        return self.law.stop

    @property
    def symmetric(self) -> bool:
        """Whether both senses have one curve."""
        return self.law.symmetric

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Kinks of the law inside [rad]."""
        return self.law.kinks(sense)

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]."""
        return self.factor * self.law.moment_capacity(rotation, sense)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor on the capacity at a rotation rate [rad/s]."""
        return self.law.rate_factor(rotation_rate)


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
