"""Common part of the laws of folding sections: one fold up to jamming, and the behaviour beyond it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

from numpy.typing import ArrayLike

from crumple.hinge.bending.jamming import AfterJamming, continued, continued_kinks
from crumple.hinge.law import SofteningVariable, Source, Validity
from crumple.hinge.rate import HingeRate, rate_factor
from crumple.hinge.stop import Stop
from crumple.numeric.arrays import Floats


@dataclass(frozen=True, kw_only=True)
class FoldingLaw(ABC):
    """Base of laws whose sections fold, the same in both senses; a subclass gives the curve of one fold.

    Attributes
    ----------
    validity
        Range and warnings.
    after_jamming
        Behaviour beyond the fold.
    rate
        Strain-rate law of the hinge, or None.
    stop
        Stop at the jamming angle, if ``after_jamming`` selects it.
    """

    name: ClassVar[str]
    source: ClassVar[Source]
    symmetric: ClassVar[bool] = True
    softening_variable: ClassVar[SofteningVariable] = SofteningVariable.PEAK
    elastic_stiffness: ClassVar[float | None] = None

    validity: Validity
    after_jamming: AfterJamming
    rate: HingeRate | None = None
    stop: Stop | None = None

    @property
    @abstractmethod
    def title(self) -> str:
        """One line for people."""

    @property
    @abstractmethod
    def jamming_angle(self) -> float:
        """Rotation at which the walls touch [rad]."""

    @property
    @abstractmethod
    def fold_kinks(self) -> tuple[float, ...]:
        """Rotations up to jamming where the slope jumps [rad]."""

    @abstractmethod
    def single_fold(self, rotation: Floats) -> Floats:
        """Capacity of one fold [N m] at rotations up to jamming [rad]."""

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Rotations where the slope jumps [rad]."""
        return continued_kinks(self.fold_kinks, self.jamming_angle, self.after_jamming)

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]; see `HingeLaw`."""
        return continued(self.single_fold, rotation, self.jamming_angle, self.after_jamming)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor on the capacity at a rotation rate [rad/s]."""
        return rate_factor(self.rate, rotation_rate)
