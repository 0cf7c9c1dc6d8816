"""A law as a record for the solver: sampled envelopes, stiffness, stops, form.

The core has one hinge kernel for all laws: every law becomes one `HingeRecord`, so adding a law
is adding a file.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from crumple.hinge.law import SofteningVariable
from crumple.hinge.stop import Stop
from crumple.numeric.arrays import Floats

__all__ = ["Envelope", "Form", "HingeRecord", "Stop"]


class Form(Enum):
    """Relation between envelope and moment."""

    SET_VALUED = "set-valued"
    """Rigid until the capacity is reached; at rest any moment up to the capacity."""
    ELASTIC_PLASTIC = "elastic-plastic"
    """Spring in series: moment k (rotation - plastic rotation), bounded by the capacity."""
    REGULARISED = "regularised"
    """Capacity times HAVSIN ramp of the rate: creeps at rest."""


@dataclass(frozen=True)
class Envelope:
    """Piecewise linear capacity against the softening variable; constant beyond its last point.

    Attributes
    ----------
    rotation
        Softening variable [rad], strictly increasing from 0, shape (n,).
    moment
        Capacity [N m], > 0, shape (n,).
    """

    rotation: Floats
    moment: Floats


@dataclass(frozen=True)
class HingeRecord:
    """All data of one hinge for the solver.

    Attributes
    ----------
    form
        Set-valued, elastic-plastic or regularised.
    softening_variable
        Abscissa of the envelopes.
    positive, negative
        Envelope for each sense of rotation.
    elastic_stiffness
        [N m/rad]; inf for a rigid hinge.
    regularisation_rate
        Half-width of the HAVSIN ramp [rad/s]; used by the regularised form only.
    rate_reference, rate_exponent
        Capacity is multiplied by 1 + (abs(rate)/rate_reference)**(1/rate_exponent); reference inf: no effect.
    viscous_damping
        Linear rotational damper in parallel [N m s/rad].
    stop_positive, stop_negative
        Stops of both senses, or None.
    """

    form: Form
    softening_variable: SofteningVariable
    positive: Envelope
    negative: Envelope
    elastic_stiffness: float = float("inf")
    regularisation_rate: float = 0.05
    rate_reference: float = float("inf")
    rate_exponent: float = 1.0
    viscous_damping: float = 0.0
    stop_positive: Stop | None = None
    stop_negative: Stop | None = None
