"""Interface of every hinge law: a pure function from rotation to capacity, with source and range of validity.

A law is the envelope of the moment that a collapsing section can carry, against one named softening
variable.  The moment itself is computed by the solver: a rigid-plastic hinge at rest carries any moment
up to its capacity.

Unloading is the same for every law: along the elastic line in the elastic-plastic form, at once in the
rigid forms.  The capacity recovers only if the softening variable allows it.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from crumple.hinge.rate import HingeRate
from crumple.hinge.stop import Stop
from crumple.numeric.arrays import Floats

BEYOND_RANGE = "Use a law from shells that holds there (crumple characterise), or solve with shells."
"""What to do about a rotation beyond the range of a law."""
NEGLIGIBLE = float(np.radians(0.5))
"""Plastic rotation [rad] up to which a law without a range is not judged: no fold has begun, and what it
takes is a few percent of what one takes.  Hinges creep by as much about the axis across their fold."""


class SofteningVariable(Enum):
    """Rotation that is the abscissa of the collapse curve, per sense of rotation."""

    PEAK = "peak"
    """Largest plastic rotation so far, of both senses: a hinge bent back does not regain strength."""
    ROTATION = "rotation"
    """Current plastic rotation in this sense (zero when bent the other way): reversible curve."""
    ACCUMULATED = "accumulated"
    """Sum of all plastic rotation, both senses together."""


class Trust(Enum):
    """How far a formula can be trusted; given by every law."""

    PUBLISHED = "read in the cited publication"
    DERIVED = "derived here and checked numerically; the concept, not the formula, is from the cited work"
    QUOTED = "widely quoted; the original text was not seen"
    MEASURED = "measured curve supplied by the user"
    COMPUTED = "computed with shell finite elements of this program"
    ASSUMED = "chosen by the user"
    FITTED = "derived here, with constants fitted to a few shell solutions and checked against others"
    ESTIMATED = "estimated here; not checked against anything"


@dataclass(frozen=True)
class Source:
    """Source of a law: citation, how far it can be trusted, and a note in one sentence."""

    citation: str
    trust: Trust
    note: str = ""


@dataclass(frozen=True)
class Validity:
    """Range of validity of a law.

    Attributes
    ----------
    rotation_max
        Largest rotation of the softening variable [rad] up to which the law is valid.
    basis
        Evidence for it, in one sentence.
    warnings
        One sentence for each condition on section or material that is not met.
    uncertainty
        Relative half-width of the band in which the moment is expected inside the range
        (for example 0.11), or None if unknown.
    """

    rotation_max: float
    basis: str
    warnings: tuple[str, ...] = ()
    uncertainty: float | None = None

    def is_left_at(self, rotation: float) -> bool:
        """Whether a rotation [rad] of the softening variable lies beyond the range (see `left_range`)."""
        return left_range(self.rotation_max, rotation)

    def warning_at(self, rotation: float) -> str | None:
        """Warning for a rotation [rad] of the softening variable beyond the range, else None."""
        if rotation <= self.rotation_max:
            return None
        turned = f"{np.degrees(rotation):.1f} deg"
        return f"the hinge turned by {turned}, its law {self.range_text}. {BEYOND_RANGE}"

    @property
    def range_text(self) -> str:
        """What the law is valid for, as the end of a sentence whose subject it is."""
        if self.rotation_max <= 0.0:
            return f"has no range of validity ({self.basis})"
        return f"is valid up to {np.degrees(self.rotation_max):.1f} deg only ({self.basis})"


def left_range(limit: float, rotation: float) -> bool:
    """Whether a rotation lies beyond the limit of a law [rad]; a limit of 0 says that it has no range."""
    return rotation > (limit if limit > 0.0 else NEGLIGIBLE)


@runtime_checkable
class HingeLaw(Protocol):
    """A collapse law of one section about one axis; pure, frozen, without memory.

    Attributes
    ----------
    name, title
        Short key (``kecman``) and one line for people.
    softening_variable
        What ``rotation`` means in `moment_capacity`.
    elastic_stiffness
        Rotational stiffness of the hinge [N m/rad] if the law gives its own, else None: the
        elastic form then uses the tributary length of the member.
    jamming_angle
        Rotation [rad] at which the walls touch, or None.
    rate
        Strain-rate law of the hinge, or None.
    stop
        Stop that the law itself requires (jammed walls), or None.
    symmetric
        Whether both senses have one curve, so that it is sampled once.
    """

    def __hash__(self) -> int: ...
    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def source(self) -> Source: ...
    @property
    def softening_variable(self) -> SofteningVariable: ...
    @property
    def elastic_stiffness(self) -> float | None: ...
    @property
    def jamming_angle(self) -> float | None: ...
    @property
    def validity(self) -> Validity: ...

    @property
    def rate(self) -> HingeRate | None: ...
    @property
    def stop(self) -> Stop | None: ...
    @property
    def symmetric(self) -> bool: ...

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Rotations [rad] up to half a turn where the slope of the capacity jumps; sampling keeps them."""
        ...

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Quasi-static moment capacity.

        Parameters
        ----------
        rotation
            Softening variable [rad], >= 0, any shape.
        sense
            +1 or -1: the sense in which the hinge turns.

        Returns
        -------
        NDArray
            Capacity [N m], >= 0, same shape.
        """
        ...

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor on the capacity at a rotation rate [rad/s]; 1 at rest, same shape as the rate."""
        ...
