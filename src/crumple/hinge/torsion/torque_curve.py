"""Torque that follows straight lines over the plastic twist, or is constant: what such laws share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.hinge.law import SofteningVariable, Source, Validity
from crumple.hinge.rate import HingeRate, rate_factor
from crumple.hinge.stop import Stop
from crumple.numeric.arrays import Floats


@dataclass(frozen=True)
class TorqueCurve:
    """Torque of a law, the same in both senses.

    Attributes
    ----------
    initial_torque, steady_torque
        At the start and the end [N m].
    validity, source
        Of the law.
    twist, torque
        Plastic twists [rad] and torques there [N m] of one that rises; empty: constant.
    """

    symmetric: ClassVar[bool] = True
    straight: ClassVar[bool] = True

    initial_torque: float
    steady_torque: float
    validity: Validity
    source: Source
    elastic_stiffness: float | None = None
    rate: HingeRate | None = None
    softening_variable: SofteningVariable = SofteningVariable.PEAK
    jamming_angle: float | None = None
    stop: Stop | None = None
    twist: tuple[float, ...] = ()
    torque: tuple[float, ...] = ()

    @property
    def title(self) -> str:
        """One line for people."""
        if self.twist:
            return f"torque {self.initial_torque:.4g} N m, hardening to {self.steady_torque:.4g} N m"
        return f"constant torque {self.steady_torque:.4g} N m"

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Twists where the slope jumps [rad]."""
        return self.twist[1:]

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Torque [N m] at a twist [rad]."""
        twist = np.asarray(rotation, np.float64)
        if not self.twist:
            return np.full_like(twist, self.steady_torque)
        return np.asarray(np.interp(twist, self.twist, self.torque), np.float64)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Ones."""
        return rate_factor(self.rate, rotation_rate)
