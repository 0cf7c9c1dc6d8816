"""A folding mechanism under a largest moment: M = min(Mmax, M_mech), the start of every folding law.

Mechanisms are singular at zero rotation (M ~ theta^(-1/2)), so the cap always governs first; theta_T is the
rotation from which the mechanism governs.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crumple.numeric.arrays import Floats
from crumple.numeric.sign_change import sign_change


class Mechanism(Protocol):
    """A folding mechanism; frozen."""

    @property
    def jamming_angle(self) -> float:
        """Rotation at which its walls touch [rad]."""
        ...

    @property
    def kinks(self) -> tuple[float, ...]:
        """Rotations where the slope of its moment jumps [rad]."""
        ...

    def energy(self, rotation: ArrayLike) -> NDArray[Any]:
        """Plastic work from flat walls [J] at a rotation [rad]."""
        ...

    def moment(self, rotation: ArrayLike) -> Floats:
        """Moment dW/dtheta [N m]."""
        ...


@dataclass(frozen=True)
class CappedMechanism:
    """One fold of a law: largest moment, then the mechanism, up to its jamming angle.

    Attributes
    ----------
    peak
        Mmax [N m].
    mechanism
        Folding mechanism.
    """

    peak: float
    mechanism: Mechanism

    @property
    def jamming_angle(self) -> float:
        """Rotation at which the walls touch [rad]."""
        return self.mechanism.jamming_angle

    @cached_property
    def folding_from(self) -> float:
        """theta_T: rotation from which the mechanism governs [rad]; infinite if it never does."""
        jamming = self.mechanism.jamming_angle
        crossing = sign_change(lambda at: self.peak - self.mechanism.moment(at), 1e-4 * jamming, jamming)
        return np.inf if crossing is None else crossing

    @property
    def kinks(self) -> tuple[float, ...]:
        """Kinks within the fold [rad]."""
        own = (self.folding_from, *self.mechanism.kinks)
        return tuple(sorted(kink for kink in own if self.folding_from <= kink < self.jamming_angle))

    def moment(self, rotation: ArrayLike) -> Floats:
        """Capacity [N m] up to jamming."""
        return np.minimum(self.peak, self.mechanism.moment(rotation))
