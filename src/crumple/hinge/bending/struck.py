"""Fold where an obstacle presses on the wall of a tube.

Unknown: the capacity M(theta) of a tube that is bent by a force on its wall in place of end moments.

A flat wall that is pressed is uneven from the start: a rectangular tube folds without the rotation that
straight walls need before they buckle.  With theta_1 where the law has begun to fall,

    M(theta) = M_0(theta + theta_1)

A round tube of mean radius R and wall t is dented first.  Where a chord replaces the arc 2 beta that is
dented to the depth d, and carries nothing,

    m(d) = cos(beta/2) - sin(beta)/2,    cos(beta) = 1 - d/R

of the plastic moment M_p are left.  The dent takes the force F = 4 s t^1.5 sqrt(2 pi d/3), s the flow
stress, and grows until the force bends the tube, F = m M_p a + b, with a, b from its spans and the moments
at their ends:

    M(theta) = min(m M_0(0), M_0(theta))

The wall of a rectangular tube gives way at F = 27 s t^2, fitted to shells of five tubes on a rigid floor
under a pole (25 to 30, up to a depth of 0.3 sides).

Limits: d <= R.  The force of the dent is that of a tube on a rigid floor; bending makes it smaller.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from crumple.hinge.inside import LawInside
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.section import CircularTube, RectangularTube

BEGUN = 1e-3
"""Share of the largest moment that a law has lost when it has begun to fall."""
CRUSHED = 27.0
"""Force at which walls of a rectangular tube give way under an obstacle, over flow stress and wall squared."""
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


@dataclass(frozen=True)
class Dent:
    """Force of a dent over its depth d: force + root sqrt(d), up to the deepest one.

    Attributes
    ----------
    force, root
        [N], [N/m^(1/2)].
    deepest
        At which the walls meet or the tube is flat [m].
    """

    force: float
    root: float
    deepest: float


def dent_of(section: CircularTube | RectangularTube, material: Material) -> Dent:
    """Dent that a pole or ball makes in the wall of a tube."""
    stress, wall = material.flow_stress, section.thickness
    if isinstance(section, CircularTube):
        return Dent(0.0, dent_force(1.0, wall, stress), section.diameter - 2.0 * wall)
    return Dent(CRUSHED * stress * wall**2, 0.0, min(section.width, section.depth) - 2.0 * wall)


def left_by_dent(depth: float, radius: float) -> float:
    """Share of the plastic moment of a round tube that a dent leaves.

    Parameters
    ----------
    depth, radius
        Of the dent, and mean radius of the tube [m]; the depth is at most the radius.
    """
    half_arc = math.acos(1.0 - depth / radius)
    return math.cos(half_arc / 2.0) - math.sin(half_arc) / 2.0


def dent_force(depth: float, thickness: float, stress: float) -> float:
    """Force of a dent of a depth [m] in a round tube with a wall [m] and a flow stress [Pa]; [N]."""
    return 4.0 * stress * thickness * math.sqrt(2.0 * math.pi * thickness * depth / 3.0)


def left_in_bending(
    moment: float, diameter: float, thickness: float, spans: tuple[float, float], held: tuple[bool, bool]
) -> float:
    """Share of the plastic moment that is left where a force dents and bends a round tube.

    Parameters
    ----------
    moment
        Its plastic moment M_p [N m].
    diameter, thickness
        Of the tube [m].
    spans
        Distances of the force from the next hinges on both sides [m].
    held
        Whether the tube carries its moment there.

    Returns
    -------
    float
        That of a dent as deep as the radius, if the tube bends no earlier.
    """
    radius = (diameter - thickness) / 2.0
    stress = moment / (4.0 * radius**2 * thickness)
    here = sum(1.0 / span for span in spans)
    there = sum(carries / span for carries, span in zip(held, spans, strict=True))
    low, high = 0.0, radius
    for _ in range(HALVINGS):
        depth = (low + high) / 2.0
        bends = moment * (left_by_dent(depth, radius) * here + there)
        low, high = (low, depth) if dent_force(depth, thickness, stress) > bends else (depth, high)
    return left_by_dent(high, radius)
