"""Constant plastic torque: the walls shear at yield and do not fold.

    T = T_p

T_p is the largest torque of the section, see `crumple.section.properties.plastic_torsion`.  An upper bound of
the peak: thin walls buckle in shear and fold.  Limits: one closed cell has Bredt's 2 A t s_y/sqrt(3).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.hinge.law import SofteningVariable, Source, Trust, Validity
from crumple.hinge.rate import HingeRate, rate_factor
from crumple.hinge.stop import Stop
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.registry.quantity import PositiveMoment
from crumple.section import Section

SOURCE = Source(
    "plastic torque of the section",
    Trust.DERIVED,
    "an upper bound; walls that fold in shear carry less",
)


@dataclass(frozen=True)
class PlasticTorsion:
    """Constant torque, the same in both senses.

    Attributes
    ----------
    initial_torque, steady_torque
        Both the torque [N m].

    References
    ----------
    docs/theory/torsion.md.  Verified in tests/unit/hinge/record/test_spatial_recording.py.
    """

    name: ClassVar[str] = "plastic"
    symmetric: ClassVar[bool] = True
    straight: ClassVar[bool] = True

    initial_torque: float
    steady_torque: float
    elastic_stiffness: float | None = None
    validity: Validity = Validity(  # noqa: RUF009  (frozen)
        math.inf,
        "plastic torque, constant over the twist",
        (
            "the torque falls if walls fold in shear: the energy of torsion is overestimated",
            "no strain-rate factor: the strain rate of folds in torsion is not known",
        ),
    )
    rate: HingeRate | None = None
    softening_variable: SofteningVariable = SofteningVariable.PEAK
    source: Source = SOURCE
    jamming_angle: float | None = None
    stop: Stop | None = None

    @classmethod
    def of(
        cls, section: Section, material: Material, length: float, *, torque: PositiveMoment | None = None
    ) -> PlasticTorsion:
        """Law of a section twisted over a length.

        Parameters
        ----------
        section, material
            For the plastic torque and the elastic stiffness.
        length
            Twisted length [m].
        torque
            Constant torque [N m]; without it the plastic torque of the section.

        Raises
        ------
        InputError
            If the length or the torque is not positive.
        """
        for name, value in (("length", length), ("torque", 1.0 if torque is None else torque)):
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(Problem(f"the {name} must be positive", f"{value:g}", "> 0", "", name))
        if torque is None:
            from crumple.section import plastic_interaction  # noqa: PLC0415  (only this case needs walls)

            torque = float(plastic_interaction(section, material).plastic_torque)
        stiffness = material.shear_modulus * section.torsion_constant / length
        return cls(torque, torque, elastic_stiffness=stiffness)

    @property
    def title(self) -> str:
        """One line for people."""
        return f"constant torque {self.steady_torque:.4g} N m"

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """No kinks."""
        return ()

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Torque [N m], the same at every twist."""
        return np.full_like(np.asarray(rotation, np.float64), self.steady_torque)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Ones."""
        return rate_factor(self.rate, rotation_rate)
