"""A law inside another: what a modified law has in common with the one that it modifies."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.typing import ArrayLike

from crumple.hinge.law import HingeLaw, SofteningVariable, Source, Validity
from crumple.hinge.rate import HingeRate
from crumple.hinge.stop import Stop
from crumple.numeric.arrays import Floats


@dataclass(frozen=True)
class LawInside:
    """All properties of a law, for laws that change some of them.

    Attributes
    ----------
    law
        Any law.
    """

    law: HingeLaw

    @property
    def name(self) -> str:
        """Key of the law inside."""
        return self.law.name

    @property
    def title(self) -> str:
        """One line for people."""
        return self.law.title

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
        """Stiffness of the law inside [N m/rad]."""
        return self.law.elastic_stiffness

    @property
    def jamming_angle(self) -> float | None:
        """Jamming angle of the law inside [rad]."""
        return self.law.jamming_angle

    @property
    def validity(self) -> Validity:
        """Range of the law inside."""
        return self.law.validity

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
        return self.law.moment_capacity(rotation, sense)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor on the capacity at a rotation rate [rad/s]."""
        return self.law.rate_factor(rotation_rate)
