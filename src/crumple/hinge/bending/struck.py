"""Fold where an obstacle presses on the wall of a tube.

Unknown: the capacity M(theta) of a tube that is bent by a force on its wall in place of end moments.

A flat wall that is pressed is uneven from the start: a rectangular tube folds without the rotation that
straight walls need before they buckle.  With theta_1 where the law has begun to fall,

    M(theta) = M_0(theta + theta_1)

A round tube is dented first, and the dent leaves the share m of its moment (`crumple.hinge.dent`):

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

BEGUN = 1e-3
"""Share of the largest moment that a law has lost when it has begun to fall."""
GRID = 1441
"""Rotations up to half a turn at which a limit of the capacity is looked for."""
HALVINGS = 60


@dataclass(frozen=True)
class StruckLaw(LawInside):
    """A law whose fold an obstacle starts: without its plateau, or below the moment of the dented section.

    Attributes
    ----------
    law
        Any law.
    left
        Share of its first moment that a dent leaves [-]; None: it folds at once.
    """

    left: float | None = None

    @property
    def title(self) -> str:
        """One line for people."""
        how = "without plateau" if self.left is None else f"dented, at most {self.left:.3g} of the moment"
        return f"{self.law.title}, struck: {how}"

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Kinks [rad]: those of the law inside, and where it falls below the limit."""
        own = self.law.kinks(sense)
        if self.left is None:
            begins = self._begins(sense)
            return tuple(kink - begins for kink in (*own, math.pi) if kink > begins)
        grid = np.linspace(0.0, math.pi, GRID)
        below = self.law.moment_capacity(grid, sense) < self._limit(sense)
        changes = np.flatnonzero(below[1:] != below[:-1])
        return tuple(sorted({*own, *(self._crossing(grid[i], grid[i + 1], sense) for i in changes)}))

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]."""
        if self.left is None:
            # laws report their kinks up to half a turn
            further = np.minimum(np.asarray(rotation, float) + self._begins(sense), math.pi)
            return self.law.moment_capacity(further, sense)
        moment: Floats = np.minimum(self.law.moment_capacity(rotation, sense), self._limit(sense))
        return moment

    def _begins(self, sense: int) -> float:
        """Rotation at which the law inside first begins to fall; 0 if it falls nowhere [rad]."""
        places = np.array([0.0, *self.law.kinks(sense), math.pi])
        moments = self.law.moment_capacity(places, sense)
        falls = moments[1:] < (1.0 - BEGUN) * moments[:-1]
        return float(places[np.argmax(falls)]) if falls.any() else 0.0

    def _limit(self, sense: int) -> float:
        assert self.left is not None
        return float(self.left * self.law.moment_capacity(0.0, sense))

    def _crossing(self, low: float, high: float, sense: int) -> float:
        limit = self._limit(sense)
        falls = float(self.law.moment_capacity(low, sense)) >= limit
        for _ in range(HALVINGS):
            middle = (low + high) / 2.0
            above = float(self.law.moment_capacity(middle, sense)) >= limit
            low, high = (middle, high) if above == falls else (low, middle)
        return high
