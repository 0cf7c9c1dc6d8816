"""Sensitivity of a capacity to a property of section or material: central differences of the law.

A law is a pure function of its section and material, but some of them search for roots and kinks, so
finite differences are used.  Two steps, one twice the other, cancel the error of second order
(Richardson); what is left is of fourth order and rounding.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from crumple.hinge.law import HingeLaw
from crumple.numeric.arrays import Floats

STEP = 1e-3
"""Relative change of the property: fourth-order error near 1e-12, rounding near 1e-13 over it."""


def capacity_sensitivity(
    law_of: Callable[[float], HingeLaw],
    value: float,
    rotation: ArrayLike,
    sense: int = 1,
    *,
    step: float = STEP,
) -> Floats:
    """Derivative of the capacity over a property.

    Parameters
    ----------
    law_of
        Builds the law at a value of the property, for example of a wall thickness [m] or a yield stress [Pa].
    value
        Value of the property, not zero.
    rotation
        Softening variable [rad], any shape.
    sense
        +1 or -1.
    step
        Relative change of the property.

    Returns
    -------
    NDArray
        d capacity / d property [N m per unit of the property], same shape as the rotation.

    Notes
    -----
    Where a kink of the law moves with the property (the end of a plateau, jamming), the derivative there is a
    mean over both sides.

    References
    ----------
    Verified in tests/unit/hinge/record/test_spatial_recording.py.
    """
    places = np.asarray(rotation, np.float64)

    def difference(change: float) -> Floats:
        up, down = (law_of(value + sign * change).moment_capacity(places, sense) for sign in (1.0, -1.0))
        return np.asarray((up - down) / (2.0 * change))

    change = step * abs(value)
    near, far = difference(change), difference(2.0 * change)
    return np.asarray((4.0 * near - far) / 3.0)
