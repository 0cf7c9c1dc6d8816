"""Fold of a round tube in a dent.

Unknown: the capacity M(theta) of a tube that an obstacle has dented before it bends.  The dent leaves the
share m of its moment (`crumple.hinge.dent`):

    M(theta) = min(m M_0(0), M_0(theta))

Derived here; compared with shells in docs/theory/dents.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from crumple.hinge.inside import LawInside
from crumple.numeric.arrays import Floats
from crumple.numeric.sign_change import sign_change

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
    """

    left: float

    @property
    def title(self) -> str:
        """One line for people."""
        return f"{self.law.title}, dented: at most {self.left:.3g} of the moment"

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Kinks [rad]: those of the law inside, and where it falls below the limit."""
        grid = np.linspace(0.0, math.pi, GRID)
        below = self.law.moment_capacity(grid, sense) < self._limit(sense)
        changes = np.flatnonzero(below[1:] != below[:-1])
        crossings = (self._crossing(grid[i], grid[i + 1], sense) for i in changes)
        return tuple(sorted({*self.law.kinks(sense), *crossings}))

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]."""
        moment: Floats = np.minimum(self.law.moment_capacity(rotation, sense), self._limit(sense))
        return moment

    def _limit(self, sense: int) -> float:
        return float(self.left * self.law.moment_capacity(0.0, sense))

    def _crossing(self, low: float, high: float, sense: int) -> float:
        limit = self._limit(sense)
        up = 1.0 if float(self.law.moment_capacity(low, sense)) < limit else -1.0
        found = sign_change(lambda at: up * (self.law.moment_capacity(at, sense) - limit), low, high)
        return high if found is None else found
