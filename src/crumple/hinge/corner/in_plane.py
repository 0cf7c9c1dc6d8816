"""Common part of the laws of mitred corners bent in their plane: angle, sense, and the straight member."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass, field
from enum import Enum
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.hinge.law import HingeLaw, SofteningVariable, Validity
from crumple.hinge.rate import HingeRate, rate_factor
from crumple.hinge.stop import Stop
from crumple.hinge.tube_library.hardening import HardeningEffect
from crumple.numeric.arrays import Floats

SMALLEST, LARGEST = math.radians(5.0) * (1.0 - 1e-9), math.radians(100.0) * (1.0 + 1e-9)
"""Angles between the members, with room for rounding.  Beyond the largest a mitre is longer than the section;
shells join such members rigidly, and automatic hinges have no corner there."""
SOFT = 0.7
"""e of the hardening of a closed corner [-]."""
TOUCHING = (0.27, 1.35)
"""Rotations between which the walls of a fold come to lie on each other, over its jamming angle."""
JAMMING, WIDE, SLENDER = 1.25, 0.55, 2.0
"""j, w and the largest q of the moment of a fold that jams [-]; no thinner walls were solved."""
ROUNDING = 3.0
"""p of the transition from the start to the fold [-]."""


class Closing(Enum):
    """Sense of the hinge's rotation that closes the corner."""

    POSITIVE = "positive"
    NEGATIVE = "negative"


@dataclass(frozen=True)
class InPlaneLaw:
    """Base of the laws of corners; a subclass gives the moments of both senses.

    Attributes
    ----------
    start
        Moment at which it begins to fold when it is closed [N m].
    plastic
        Plastic moment of the members [N m], which no capacity exceeds.
    slope
        s, sine of half the angle between the members [-].
    tube
        Law of the straight member.
    closing
        Sense that closes the corner.
    elastic_stiffness
        Of the corner's own walls [N m/rad].
    effect
        Of hardening on the straight member's fold.
    jamming
        Growth of the moment while the walls of the fold come to lie on each other [-].
    """

    name: ClassVar[str] = "mitred_corner"
    softening_variable: ClassVar[SofteningVariable] = SofteningVariable.PEAK
    stop: ClassVar[Stop | None] = None
    symmetric: ClassVar[bool] = False

    start: float
    plastic: float
    slope: float
    tube: HingeLaw
    closing: Closing
    elastic_stiffness: float | None
    validity: Validity
    effect: HardeningEffect = field(default_factory=HardeningEffect, kw_only=True)
    jamming: float = field(default=0.0, kw_only=True)

    @property
    def title(self) -> str:
        """One line for people."""
        angle = math.degrees(2.0 * math.asin(self.slope))
        return f"mitred corner of {angle:.4g} deg, {self.start / 1e3:.4g} kN m at the start"

    @property
    def jamming_angle(self) -> float | None:
        """Not known."""
        return None

    @property
    def rate(self) -> HingeRate | None:
        """That of the straight member."""
        return self.tube.rate

    @abstractmethod
    def at_yield(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad] of a metal that stays at its yield stress."""

    def hardening(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Factor of hardening on the capacity at a rotation [rad] [-]."""
        share = 1.0 - SOFT * self.slope if self.closes(sense) else 1.0
        return 1.0 + share * (self.effect.at(rotation) - 1.0)

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]; see `HingeLaw`."""
        return self.at_yield(rotation, sense) * self.hardening(rotation, sense)

    def closes(self, sense: int) -> bool:
        """Whether a sense of the rotation closes the corner."""
        return (sense > 0) == (self.closing is Closing.POSITIVE)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor on the capacity at a rotation rate [rad/s]."""
        return rate_factor(self.rate, rotation_rate)


def slope_of(angle: float) -> float:
    """Sine of half the angle between the members [rad].

    Raises
    ------
    InputError
        If the angle is outside 5 to 100 degrees.
    """
    if not SMALLEST <= angle <= LARGEST:
        what, came = "no mitred corner has this angle", f"{math.degrees(angle):.4g} deg"
        todo = "use the law of the member, or one from shells"
        raise InputError(Problem(what, came, "5 to 100 deg", todo, "angle"))
    return math.sin(angle / 2.0)


def jamming_of(across: float, deep: float, wall: float) -> float:
    """Growth of the moment of a fold that jams [-], from the mid-lines of its faces and webs [m]."""
    return JAMMING * max(0.0, deep / across - WIDE) * min(across / (25.0 * wall), SLENDER) ** 2


def jammed(rotation: Floats, jamming_angle: float, amount: float) -> Floats:
    """Factor on the moment of a fold whose walls come to lie on each other: 1, rising smoothly to 1 + amount.

    It begins long before the angle at which the mechanism's walls would meet [rad], since those of a real
    fold are not flat, and ends beyond it.
    """
    done = np.clip((rotation / jamming_angle - TOUCHING[0]) / (TOUCHING[1] - TOUCHING[0]), 0.0, 1.0)
    return np.asarray(1.0 + amount * done**2 * (3.0 - 2.0 * done))


def rounded(start: Floats | float, fold: Floats, power: float = ROUNDING) -> Floats:
    """Moment [N m] of a corner that begins to yield at one moment and whose fold carries another."""
    return start * (1.0 + (start / fold) ** power) ** (-1.0 / power)
