"""Folds of round tubes under a pole: in a dent, or wrapped around it.

Unknown: the capacity M(theta) of a tube that an obstacle has dented before it bends.  The dent leaves the
share m of its moment (`crumple.hinge.dent`):

    M(theta) = min(m M_0(0), M_0(theta))

of flat walls.  In a round tube the fold goes on from the dent, and softens with it from the start:

    1/M(theta)^2 = 1/M_0(theta)^2 + (1/m^2 - 1)/M_0(0)^2

A fold of the length l under a pole of the radius R bends until it has the curvature of the pole, at
phi = l/rho with rho = R + d/2 and the depth d of the tube.  From there on the tube touches the pole along an
arc rho theta and bends at its ends, with the moment of this fold:

    M(theta) = M_0(min(theta, l/rho))

Limits: under a sharp edge a single fold bends on; so it does if it has softened before, since the rotation
gathers in it.  Derived here; compared with shells in docs/theory/dents.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from crumple.hinge.inside import LawInside
from crumple.hinge.law import HingeLaw, Validity
from crumple.numeric.arrays import Floats
from crumple.numeric.sign_change import sign_change

KEPT = 0.85
"""Share of its largest moment below which a fold has softened: more rotation gathers in it.  Of ten tubes in
shells those with 0.92 and more wrap around the pole, and those with 0.79 and less do not."""
GRID = 1441
"""Rotations up to half a turn at which a limit of the capacity is looked for."""


@dataclass(frozen=True)
class DentedLaw(LawInside):
    """A law below the moment of the dented section.

    Attributes
    ----------
    law
        Any law.
    left
        Share of its first moment that the dent leaves [-].
    is_round
        Whether the tube is round.
    """

    left: float
    is_round: bool = False

    @property
    def title(self) -> str:
        """One line for people."""
        return f"{self.law.title}, dented: at most {self.left:.3g} of the moment"

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Kinks [rad]: those of the law inside, and where it falls below the limit of flat walls."""
        if self.is_round:
            return self.law.kinks(sense)
        grid = np.linspace(0.0, math.pi, GRID)
        below = self.law.moment_capacity(grid, sense) < self._limit(sense)
        changes = np.flatnonzero(below[1:] != below[:-1])
        crossings = (self._crossing(grid[i], grid[i + 1], sense) for i in changes)
        return tuple(sorted({*self.law.kinks(sense), *crossings}))

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]."""
        inside, limit = self.law.moment_capacity(rotation, sense), self._limit(sense)
        if not self.is_round:
            return np.asarray(np.minimum(inside, limit))
        lost = 1.0 / limit**2 - (self.left / limit) ** 2
        return np.asarray(1.0 / np.sqrt(1.0 / inside**2 + lost))

    def _limit(self, sense: int) -> float:
        return float(self.left * self.law.moment_capacity(0.0, sense))

    def _crossing(self, low: float, high: float, sense: int) -> float:
        limit = self._limit(sense)
        up = 1.0 if float(self.law.moment_capacity(low, sense)) < limit else -1.0
        found = sign_change(lambda at: up * (self.law.moment_capacity(at, sense) - limit), low, high)
        return high if found is None else found


@dataclass(frozen=True)
class WrappedLaw(LawInside):
    """A law of one fold for a tube that bends on around a pole.

    Attributes
    ----------
    law
        Any law.
    most
        Rotation of the fold at which it has the curvature of the pole [rad].
    """

    most: float

    @property
    def title(self) -> str:
        """One line for people."""
        return f"{self.law.title}, wrapped around a pole from {math.degrees(self.most):.3g} deg on"

    @property
    def jamming_angle(self) -> float | None:
        """Jamming angle of the law inside, if a fold reaches it [rad]."""
        inside = self.law.jamming_angle
        return inside if inside is None or inside < self.most else None

    @property
    def validity(self) -> Validity:
        """Range of the law inside; the whole rotation if no fold leaves it."""
        inside = self.law.validity
        return inside if inside.rotation_max < self.most else replace(inside, rotation_max=math.inf)

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Kinks of the law inside up to that rotation, and this [rad]."""
        return (*(kink for kink in self.law.kinks(sense) if kink < self.most), self.most)

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]."""
        return self.law.moment_capacity(np.minimum(rotation, self.most), sense)


def wraps(law: HingeLaw, most: float, sense: int) -> bool:
    """Whether a tube bends on around a pole: its fold has not softened when it has the curvature of the pole.

    Parameters
    ----------
    law, most
        As of `WrappedLaw`.
    sense
        Of the rotation.
    """
    moment = law.moment_capacity(np.linspace(0.0, most, GRID), sense)
    return most < math.pi / 2.0 and float(moment[-1]) >= KEPT * float(moment.max())
