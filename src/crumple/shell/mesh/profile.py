"""A divided section, and how many sides a wall or bend gets."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from crumple.errors import InputError, Problem
from crumple.material import Material
from crumple.numeric.arrays import Floats, Integers

SHORTEST_BEND = 0.3
"""Length of a bend over the element size below which it is drawn as a sharp corner: a shorter side would cost
more than three times the time steps, and a bend that small has almost no length to fold in."""
MOST_SIDES = 100_000
"""Elements along a wall of a section."""
ONE_SIDE = 1.2
"""Length of a wall over the element size up to which it is one side, not two."""


@dataclass(frozen=True, eq=False)
class Contour:
    """A section as the mesh takes it.

    Attributes
    ----------
    points
        (y, z) [m] on the mid-lines, (n, 2).
    sides
        Pairs of points that a wall joins, (k, 2); around a closed section counter-clockwise.
    thickness
        Of every side [m], (k,).
    metals
        Of every side, None where it is the member's; empty: all are.
    welds
        Pairs of points that lines of spot welds tie, (w, 2).
    """

    points: Floats
    sides: Integers
    thickness: Floats
    metals: tuple[Material | None, ...] = ()
    welds: Integers = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))

    def metals_of(self, member: Material) -> tuple[Material, ...]:
        """Metal of every side of a member of a metal, (k,)."""
        return tuple(metal or member for metal in self.metals or (None,) * len(self.sides))

    @property
    def area(self) -> float:
        """Area of the metal [m^2]."""
        ends = self.points[self.sides]
        return float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) @ self.thickness)


def number_of_sides(length: float, size: float, *, bend: bool) -> int:
    """Sides of a wall or bend of a length [m]; of a wall an even number: nodes in its middle."""
    if length / size > MOST_SIDES:
        what, todo = "the elements are far too small for a section", "give larger elements"
        came, allowed = f"{1e3 * size:.3g} mm", f"at most {MOST_SIDES} along a wall"
        raise InputError(Problem(what, came, allowed, todo, "analysis.shell"))
    if bend:
        return max(1, round(length / size))
    return 1 if length < ONE_SIDE * size else 2 * max(1, round(length / (2.0 * size)))
