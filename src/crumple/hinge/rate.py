"""Strain-rate factor of a hinge from the rate law of its material.

A fold of width s that turns at rate w strains its wall at (t/2) w/s.  A bending hinge shares its rotation
rate among about three folds, each about 2.5 wall thicknesses wide, so

    strain_rate = (t/2) (rotation_rate/3) / (2.5 t) = rotation_rate/15

and the Cowper-Symonds pair (D, q) becomes a pair for the hinge: reference 15 D [rad/s], exponent q.
An estimate of the order of magnitude, not a fit: with q = 4 to 5 the factor is insensitive to the value 15.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crumple.errors import InputError, Problem
from crumple.material import CowperSymonds, Material, RateLaw

FOLDS_PER_HINGE = 3.0
"""Number of folds that share the rotation; more would lower the strain rate in proportion."""
FOLD_WIDTH = 2.5
"""Width of a fold in wall thicknesses; folds are 2 to 3 thicknesses wide."""


@dataclass(frozen=True)
class HingeRate:
    """Capacity factor 1 + (abs(rotation_rate)/reference)**(1/exponent).

    Attributes
    ----------
    reference
        Rotation rate [rad/s] at which the capacity doubles, > 0.
    exponent
        [-], >= 1.
    """

    reference: float
    exponent: float

    def __post_init__(self) -> None:
        if not (self.reference > 0.0 and math.isfinite(self.exponent) and self.exponent >= 1.0):
            came = f"reference {self.reference:g} rad/s, exponent {self.exponent:g}"
            raise InputError(
                Problem("the rate law of the hinge is out of range", came, "reference > 0, exponent >= 1")
            )


def hinge_rate(strain_rate_law: RateLaw | None) -> HingeRate | None:
    """Rate law of a bending hinge whose folds follow a strain-rate law; None stays None.

    Notes
    -----
    Mechanisms work at large strain, so they take the material's flow pair.  A Johnson-Cook law becomes the
    power law with the same factor at 10 and 1000 1/s.

    References
    ----------
    docs/theory/rate.md.  Verified in tests/unit/hinge/test_rate.py.
    """
    if strain_rate_law is not None and not isinstance(strain_rate_law, CowperSymonds):
        strain_rate_law = strain_rate_law.as_cowper_symonds()
    if strain_rate_law is None:
        return None
    return HingeRate(2.0 * FOLDS_PER_HINGE * FOLD_WIDTH * strain_rate_law.D, strain_rate_law.q)


def rate_factor(rate: HingeRate | None, rotation_rate: ArrayLike) -> NDArray[np.float64]:
    """Factor on the capacity at a rotation rate [rad/s]; ones without a rate law."""
    rotation_rate = np.abs(np.asarray(rotation_rate, np.float64))
    if rate is None:
        return np.ones_like(rotation_rate)
    return np.asarray(1.0 + (rotation_rate / rate.reference) ** (1.0 / rate.exponent), np.float64)


def rate_warnings(material: Material) -> tuple[str, ...]:
    """Warning for a material whose rate law is at yield only, while folds work at large strain."""
    if material.yield_rate is None or material.flow_rate is not None:
        return ()
    return (
        "the material has a rate law at yield only, which overestimates the effect in a fold and is not "
        "used: give flow_rate",
    )
