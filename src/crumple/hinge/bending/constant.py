"""Constant capacity: the classical rigid-plastic hinge.

    M(theta) = M_0

Without a given moment M_0 is the plastic moment of the section, yield_stress * Z_pl: every wall at yield, an
upper bound.  Compact walls keep it over large rotations; thin walls fold and lose it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.hinge.law import SofteningVariable, Source, Trust, Validity
from crumple.hinge.rate import HingeRate, hinge_rate, rate_factor, rate_warnings
from crumple.hinge.stop import Stop
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.registry.quantity import PositiveMoment
from crumple.section import Axis, Section

CHOSEN = Source("none", Trust.ASSUMED, "the moment is given by the user")
PLASTIC_MOMENT = Source(
    "plastic moment, yield stress times plastic section modulus",
    Trust.DERIVED,
    "an upper bound of the peak moment; thin walls fold and carry less",
)


@dataclass(frozen=True)
class ConstantLaw:
    """Constant moment: a perfectly plastic hinge.

    Attributes
    ----------
    moment
        Capacity [N m], > 0.

    References
    ----------
    docs/theory/constant_and_table.md.  Verified in tests/unit/hinge/bending/test_constant.py.
    """

    name: ClassVar[str] = "constant"
    symmetric: ClassVar[bool] = True
    straight: ClassVar[bool] = True

    moment: float
    source: Source = CHOSEN
    validity: Validity = Validity(math.inf, "the moment is given by the user")  # noqa: RUF009  (frozen)
    rate: HingeRate | None = None
    softening_variable: SofteningVariable = SofteningVariable.PEAK
    elastic_stiffness: float | None = None
    jamming_angle: float | None = None
    stop: Stop | None = None

    def __post_init__(self) -> None:
        if not (math.isfinite(self.moment) and self.moment > 0.0):
            todo = "give the moment at which the hinge yields"
            raise InputError(
                Problem("the moment must be positive", f"{self.moment:g} N m", "> 0 N m", todo, "moment")
            )

    @classmethod
    def of(
        cls, section: Section, material: Material, axis: Axis = "y", *, moment: PositiveMoment | None = None
    ) -> ConstantLaw:
        """Law of a section.

        Parameters
        ----------
        section, material, axis
            For the plastic moment, and for the strain-rate factor at flow.
        moment
            Moment [N m]; without it the plastic moment of the section.
        """
        rate, warnings = hinge_rate(material.flow_rate), rate_warnings(material)
        if moment is not None:
            given = cls(moment, rate=rate)
            return replace(given, validity=replace(given.validity, warnings=warnings))
        validity = Validity(
            math.inf,
            "plastic moment of the section, held at every rotation",
            (
                "the moment falls if walls fold: a constant capacity then overestimates the absorbed energy",
                *warnings,
            ),
        )
        return cls(_plastic_moment(section, material, axis), PLASTIC_MOMENT, validity, rate)

    @property
    def title(self) -> str:
        """One line for people."""
        return f"constant moment {self.moment:.4g} N m"

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """No kinks."""
        return ()

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m], the same at every rotation."""
        return np.full_like(np.asarray(rotation, np.float64), self.moment)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor on the capacity at a rotation rate [rad/s]."""
        return rate_factor(self.rate, rotation_rate)


def _plastic_moment(section: Section, material: Material, axis: Axis) -> float:
    """Plastic moment [N m]; walls with their own material use its yield stress."""
    if any(wall.material is not None for wall in getattr(section, "walls", ())):
        from crumple.section import moment_capacity  # noqa: PLC0415  (tubes need none of it)

        return moment_capacity(section, material, axis).plastic_moment
    return material.yield_stress * section.plastic_section_modulus(axis)
