"""Differences between the runs of a batch, for both multibody kernels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from crumple.numeric.arrays import Floats

Case = TypeVar("Case")
Column = Floats | None


@dataclass(frozen=True, eq=False)
class Variants(Generic[Case]):
    """Values that differ from variant to variant, n rows; None for the case's own values.

    Attributes
    ----------
    cases
        As the kernel takes them (a `TreeModel`, or a `StagedModel`), alike but for numbers: with as many
        bodies, joints, hinges, loads, drives, obstacles and stages, between the same bodies.
    case_of
        (n,) which of the cases.
    velocity, impulse
        Twists of the bodies at the start and impulses on them, at the centres of mass: in a plane
        (n, bodies, 3), in space what every stage adds as it begins, (n, stages, bodies, 6).
    capacity_scale
        (n, hinges), times the case's capacities of all components; > 0.
    load_scale
        (n, loads), times the case's loads.
    bodies
        In a plane (n, bodies, 4): centre x, y [m], mass [kg], inertia [kg m^2]; in space (n, bodies, 13):
        centre, mass, inertia about the centre row by row.
    gravity
        (n, 2) or (n, 3) [m/s^2].
    """

    cases: Sequence[Case]
    case_of: NDArray[np.int64]
    velocity: Floats | None = None
    impulse: Floats | None = None
    capacity_scale: Floats | None = None
    load_scale: Floats | None = None
    bodies: Floats | None = None
    gravity: Floats | None = None

    def numbers(self) -> NDArray[np.int64]:
        """Number of the case of each variant, as the kernels take it."""
        return np.ascontiguousarray(self.case_of, dtype=np.int64)

    def columns(self) -> tuple[Column, Column, Column, Column, Column, Column]:
        """The arrays in the order of the kernels' arguments."""
        return (
            _column(self.velocity),
            _column(self.impulse),
            _column(self.capacity_scale),
            _column(self.load_scale),
            _column(self.bodies),
            _column(self.gravity),
        )


def _column(given: Column) -> Column:
    return None if given is None else np.ascontiguousarray(given, dtype=float)
