"""Fold of a rectangular tube under a pole that bends it.

Unknown: the capacity M(theta) of the fold, and the depth d(theta) by which the pole sinks into it.  The
force F of the pole and the moment together make the fold yield,

    M = M_0(theta) (1 - g (F/F_0)^2)

with M_0 the moment without a force, F_0 the force that dents the tube where it does not fold, and g the share
of F that presses on the fold: 1 for a pole of a radius up to 1.5 half lengths of the fold, 0 from 4 on, which
presses on its shoulders, and linear between.  By the normality of plastic flow the pole sinks at

    d'(theta) = 2 g F M_0(theta)/F_0^2

so that the fold dissipates M_0 (1 + g (F/F_0)^2) dtheta: the work of M by rotation, and of F by depth.  F is
that of collapse at each rotation, with what the ends of the tube carry.

Derived here; 1.5 and 4 were read off tubes in shells, see docs/theory/dents.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.hinge.inside import LawInside
from crumple.hinge.law import Validity
from crumple.numeric.arrays import Floats

ROTATION = np.radians(np.concatenate([np.arange(0.0, 20.0, 0.5), np.arange(20.0, 180.1, 2.0)]))
"""Rotations between which capacity and slope are straight, with the kinks of the law inside [rad]."""
COMPARED = math.radians(15.0)
"""Rotation up to which folds under poles were compared with shells, and were within 35 % [rad]."""
NARROW, WIDE = 1.5, 4.0
"""Radii of a pole up to which it presses on the fold alone, and from which on beside it alone, over half the
length of the fold."""


@dataclass(frozen=True)
class Press:
    """A pole that bends a tube.

    Attributes
    ----------
    force
        Force F_0 that dents the tube where it does not fold [N].
    radius, half_length
        Of the pole, and half the length of the fold [m].
    spans
        Distances of the pole from what holds the tube on both sides [m].
    held
        Moments that are carried there [N m].
    """

    force: float
    radius: float
    half_length: float
    spans: tuple[float, float]
    held: tuple[float, float]

    @property
    def on_fold(self) -> float:
        """Share g of the force that presses on the fold."""
        return min(max((WIDE - self.radius / self.half_length) / (WIDE - NARROW), 0.0), 1.0)

    def at_collapse(self, moment: Floats) -> Floats:
        """Force F over F_0 at collapse, at most 1, for moments M_0 of the fold [N m].

        F = (M + M_1)/a_1 + (M + M_2)/a_2, M by the force, with the distances a and moments M_1, M_2 of ends.
        """
        here = moment * sum(1.0 / span for span in self.spans)
        there = sum(carried / span for carried, span in zip(self.held, self.spans, strict=True))
        root = np.sqrt(self.force**2 + 4.0 * self.on_fold * here * (here + there))
        return np.minimum(2.0 * (here + there) / (self.force + root), 1.0)


@dataclass(frozen=True)
class PressedLaw(LawInside):
    """A law of a fold under a pole.

    Attributes
    ----------
    law
        That without a force.
    press, sense
        The pole, and the sense of the rotation by which it bends the tube: 1 or -1.
    """

    press: Press
    sense: int

    straight: ClassVar[bool] = True

    @property
    def title(self) -> str:
        """One line for people."""
        return f"{self.law.title}, under a pole"

    @property
    def validity(self) -> Validity:
        """Range of the law inside, at most that in which folds under poles were compared with shells."""
        own = self.law.validity
        if own.rotation_max <= COMPARED:
            return own
        basis = "tubes under poles in shells; those that turned further did so by 25 % less to 40 % more"
        return replace(own, rotation_max=COMPARED, basis=basis)

    @property
    def symmetric(self) -> bool:
        """Whether both senses have one curve: no."""
        return False

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Rotations between which it is straight [rad]."""
        return tuple(_curve(self, sense).rotation.tolist())

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Work of the fold by its rotation [N m], that of its moment and of the pole, at rotations [rad]."""
        curve = _curve(self, sense)
        found: Floats = np.interp(np.asarray(rotation, float), curve.rotation, curve.work)
        return found

    def slope(self, rotation: ArrayLike) -> Floats:
        """Depth over rotation [m/rad] at rotations in its sense [rad]."""
        curve = _curve(self, self.sense)
        found: Floats = np.interp(np.asarray(rotation, float), curve.rotation, curve.slope)
        return found

    def depth(self, rotation: ArrayLike) -> Floats:
        """Depth [m] at rotations in its sense [rad]; at others it is 0."""
        curve = _curve(self, self.sense)
        found: Floats = np.interp(np.asarray(rotation, float), curve.rotation, curve.depth)
        return found


@dataclass(frozen=True, eq=False)
class _Curve:
    """Work [N m], slope [m/rad] and depth [m] of a fold over its rotation [rad], (n,) each."""

    rotation: Floats
    work: Floats
    slope: Floats
    depth: Floats


@lru_cache(maxsize=256)
def _curve(law: PressedLaw, sense: int) -> _Curve:
    inside, press = law.law, law.press
    rotation = np.union1d(ROTATION, [kink for kink in inside.kinks(sense) if kink < math.pi])
    moment = np.asarray(inside.moment_capacity(rotation, sense), float)
    if sense != law.sense:
        return _Curve(rotation, moment, 0.0 * moment, 0.0 * moment)
    share = press.at_collapse(moment)
    slope = 2.0 * press.on_fold * share * moment / press.force
    steps = np.diff(rotation) * (slope[1:] + slope[:-1]) / 2.0
    return _Curve(
        rotation,
        moment * (1.0 + press.on_fold * share**2),
        slope,
        np.append(0.0, np.cumsum(steps)),
    )
