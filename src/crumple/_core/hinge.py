"""Constants of one component of a hinge for both multibody kernels (native/hinge/hinge.hpp)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from crumple.numeric.arrays import Floats


@dataclass(frozen=True, eq=False, kw_only=True)
class HingeConstants:
    """Constants of a component: curves (rotation or travel, moment or force) in both senses, and the others.

    A stop is (place, stiffness, exponent, damping, penetration): empty for none, damping NaN for critical.
    """

    positive: tuple[Floats, Floats]
    negative: tuple[Floats, Floats]
    elastic_stiffness: float = math.inf
    regularisation_rate: float = 0.05
    rate_reference: float = math.inf
    rate_exponent: float = 1.0
    viscous_damping: float = 0.0
    stop_positive: tuple[float, ...] = ()
    stop_negative: tuple[float, ...] = ()

    def constants(self) -> dict[str, Any]:
        """The constants in the form that the kernels take."""
        return {
            "positive_rotation": as_list(self.positive[0]),
            "positive_moment": as_list(self.positive[1]),
            "negative_rotation": as_list(self.negative[0]),
            "negative_moment": as_list(self.negative[1]),
            "elastic_stiffness": self.elastic_stiffness,
            "regularisation_rate": self.regularisation_rate,
            "rate_reference": self.rate_reference,
            "rate_exponent": self.rate_exponent,
            "viscous_damping": self.viscous_damping,
            "stop_positive": list(self.stop_positive),
            "stop_negative": list(self.stop_negative),
        }


def as_list(values: Floats) -> list[Any]:
    """An array as the kernels take it."""
    plain: list[Any] = np.asarray(values, float).tolist()
    return plain
