"""The plane in which a mechanism moves, and the freedoms that its supports hold there.

Hinges with parallel axes move every body parallel to one plane, wherever in space the bodies lie: forces
and constraints across it are carried by the hinges.  So the mechanism is solved exactly in that plane.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.structure import PlacedHinge, Structure
from crumple.structure.geometry import cross
from crumple.structure.keys.motion import FREEDOMS

PARALLEL = 1e-6
"""Sine of the angle between two axes below which they count as parallel."""


@dataclass(frozen=True)
class Held:
    """Freedoms of one node that supports hold in the plane: rows are directions (rotation, x, y)."""

    rows: tuple[tuple[float, float, float], ...]

    @property
    def clamped(self) -> bool:
        """Both displacements and the rotation."""
        return self._turns and self._directions == 2

    @property
    def pinned(self) -> bool:
        """Both displacements, not the rotation."""
        return not self._turns and self._directions == 2

    @property
    def _turns(self) -> bool:
        return any(row[0] for row in self.rows)

    @property
    def _directions(self) -> int:
        """Number of independent displacements among the rows."""
        moves = [(x, y) for _, x, y in self.rows if x or y]
        across = (abs(moves[0][0] * y - moves[0][1] * x) > PARALLEL for x, y in moves)
        return 2 if any(across) else len(moves[:1])


@dataclass(frozen=True, eq=False)
class Plane:
    """Plane through the world's origin with a right-handed basis (first, second, normal).

    Attributes
    ----------
    normal
        Unit vector about which rotations count, (3,).
    first, second
        Unit vectors in the plane, (3,).
    """

    normal: Floats
    first: Floats
    second: Floats

    def flat(self, vector: Floats) -> Floats:
        """Components in the plane, (..., 2)."""
        flat: Floats = vector @ self._basis
        return flat

    @cached_property
    def _basis(self) -> Floats:
        return np.array([self.first, self.second]).T

    def raised(self, flat: Floats) -> Floats:
        """Vectors in space from components in the plane, (..., 2) to (..., 3)."""
        return flat[..., :1] * self.first + flat[..., 1:] * self.second

    def row(self, freedom: str) -> tuple[float, float, float]:
        """Direction (rotation, x, y) of a global freedom in the plane; zero if it is normal to the plane."""
        turn, i = divmod(FREEDOMS.index(freedom), 3)
        across = float(self.normal[i])
        row = (across, 0.0, 0.0) if turn else (0.0, float(self.first[i]), float(self.second[i]))
        return tuple(value if abs(value) > PARALLEL else 0.0 for value in row)  # type: ignore[return-value]

    def held(self, structure: Structure, node: str) -> Held:
        """Freedoms of a node that supports hold, without driven freedoms."""
        supports = structure.supports_at.get(node, ())
        rows = [self.row(freedom) for _, support in supports for freedom in support.held]
        return Held(tuple(row for row in rows if any(row)))


def plane_of(structure: Structure, hinges: tuple[PlacedHinge, ...]) -> Plane:
    """Plane of motion: normal to the hinges' axes, or without hinges to the axis of the initial rotation.

    Raises
    ------
    InputError
        If hinges have axes that are not parallel, or several components.
    """
    several = next((hinge for hinge in hinges if hinge.spatial is not None), None)
    if several is not None:
        what = f"the hinge '{several.name}' has several axes, slips or breaks"
        todo, where = "write kernel: auto", f"members.{several.member}.hinges"
        raise InputError(Problem(what, "", "hinges that bend about one axis in the plane", todo, where))
    if hinges:
        directions = np.array([hinge.direction for hinge in hinges])
        normal = hinges[0].direction
        crossing = np.linalg.norm(np.cross(directions[:1], directions), axis=1) > PARALLEL
        if np.any(crossing):
            raise _crossing(hinges[0], hinges[int(np.argmax(crossing))])
    else:
        axes = [field.axis for field in structure.initial_velocity if field.axis and field.rotation]
        normal = np.asarray(axes[0] if axes else (0.0, 1.0, 0.0), float)
    normal = normal / math.hypot(*normal)
    # the normal has the sense of the nearest global axis, so that rotations have the expected sign
    if normal[np.argmax(np.abs(normal))] < 0.0:
        normal = -normal
    first = np.eye(3)[(int(np.argmax(np.abs(normal))) + 1) % 3]
    first = first - (first @ normal) * normal
    first /= math.hypot(*first)
    return Plane(normal, first, cross(normal, first))


def _crossing(first: PlacedHinge, other: PlacedHinge) -> InputError:
    return InputError(
        Problem(
            "hinges turn about different axes; the multibody engine solves planar motion only",
            f"{first.name}: {_text(first.direction)}, {other.name}: {_text(other.direction)}",
            "hinges whose axes are all parallel",
            "set axis, up or roll of the members so that their hinges' axes are parallel",
            f"members.{other.member}.hinges",
        )
    )


def _text(vector: Floats) -> str:
    return "[" + ", ".join(f"{value:.3g}" for value in vector + 0.0) + "]"
