"""A law read from a law file: curves of both senses, with the information about their origin.

Straight lines between points, the last capacity held.  Its origin (formula, test, shell model) is kept
with source, range, band, rate and stop.  See crumple.hinge.measured.law_file for the format.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from crumple.errors import InputError, Problem
from crumple.hinge.band import Band, Bound, band_of
from crumple.hinge.law import HingeLaw, SofteningVariable, Source, Validity
from crumple.hinge.options import choice
from crumple.hinge.rate import HingeRate, rate_factor
from crumple.hinge.stop import Stop
from crumple.numeric.arrays import Floats

Points = tuple[tuple[float, ...], tuple[float, ...]]


@dataclass(frozen=True)
class StoredCurve:
    """Capacity of both senses.

    Attributes
    ----------
    positive, negative
        Rotation [rad] strictly increasing from 0, and capacity [N m] > 0.
    """

    positive: Points
    negative: Points

    def __post_init__(self) -> None:
        problems = [*_problems("positive", self.positive), *_problems("negative", self.negative)]
        if problems:
            raise InputError(problems)


@dataclass(frozen=True)
class StoredLaw:
    """Law of a law file.

    Attributes
    ----------
    title
        One line for people.
    law
        Name of the law from which it was made, for example ``kecman``.
    origin
        Pairs of key and text: method (formula, library, estimate, measured, shell), section, axis, material,
        made_by, ...
    curve
        Nominal capacity.
    sampling_error
        Bound of the relative error of the curve against the law it was made from [-].
    lower, upper
        Capacities at the edges of the band, where they are not the nominal one times a factor.
    slip
        Whether it is a law along the member: force [N] in place of moment, lengthening (negative sense:
        shortening) [m] in place of rotation.
    has_checksum
        Whether its file shows that it is as a program wrote it; without, somebody may have changed it.

    References
    ----------
    docs/law_file.md.  Verified in tests/unit/hinge/measured/test_law_file.py.
    """

    name: ClassVar[str] = "file"

    title: str
    law: str
    origin: tuple[tuple[str, str], ...]
    curve: StoredCurve
    source: Source
    validity: Validity
    softening_variable: SofteningVariable = SofteningVariable.PEAK
    elastic_stiffness: float | None = None
    jamming_angle: float | None = None
    rate: HingeRate | None = None
    stop: Stop | None = None
    sampling_error: float = 0.0
    lower: StoredCurve | None = None
    upper: StoredCurve | None = None
    slip: bool = False
    has_checksum: bool = field(default=True, compare=False)

    def at(self, bound: Bound) -> StoredLaw:
        """Law of a bound: the stored curve, or the nominal one times 1 -+ the uncertainty."""
        if bound is Bound.NOMINAL:
            return self
        stored = self.lower if bound is Bound.LOWER else self.upper
        if stored is None:
            scaled = band_of(self).law(bound)
            factor = float(scaled.moment_capacity(0.0)) / float(self.moment_capacity(0.0))
            stored = StoredCurve(*(_times(points, factor) for points in _both(self.curve)))
        edge = Validity(self.validity.rotation_max, self.validity.basis, self.validity.warnings)
        title = f"{self.title}, {bound.value}"
        return replace(self, title=title, curve=stored, validity=edge, lower=None, upper=None)

    @property
    def band(self) -> Band:
        """Nominal, lower and upper law; `InputError` if the scatter is unknown."""
        return Band(self, self.at(Bound.LOWER), self.at(Bound.UPPER))

    @property
    def symmetric(self) -> bool:
        """Whether both senses have one curve."""
        return self.curve.positive == self.curve.negative

    def points(self, sense: int = 1) -> Points:
        """Rotations [rad] and capacities [N m] of the curve of a sense."""
        return self.curve.positive if sense > 0 else self.curve.negative

    def kinks(self, sense: int = 1) -> tuple[float, ...]:
        """Every point of the curve [rad]."""
        return self.points(sense)[0]

    def moment_capacity(self, rotation: ArrayLike, sense: int = 1) -> Floats:
        """Capacity [N m] at a rotation [rad]; see `HingeLaw`."""
        at, moment = self.points(sense)
        return np.asarray(np.interp(np.asarray(rotation, np.float64), at, moment), np.float64)

    def rate_factor(self, rotation_rate: ArrayLike) -> Floats:
        """Factor on the capacity at a rotation rate [rad/s]."""
        return rate_factor(self.rate, rotation_rate)


def bounded(law: HingeLaw, bound: Bound | str) -> HingeLaw:
    """Law of a bound: of a stored law its own bound, of any other the law times 1 -+ its uncertainty.

    Raises
    ------
    InputError
        If a bound is requested and the scatter is unknown.
    """
    which = choice("bound", bound, Bound)
    if which is Bound.NOMINAL:
        return law
    return law.at(which) if isinstance(law, StoredLaw) else band_of(law).law(which)


def _both(curve: StoredCurve) -> tuple[Points, Points]:
    return curve.positive, curve.negative


def _times(points: Points, factor: float) -> Points:
    return points[0], tuple(factor * moment for moment in points[1])


def _problems(where: str, points: Points) -> list[Problem]:
    rotation, moment = (np.asarray(values, np.float64) for values in points)
    if rotation.size != moment.size or rotation.size == 0:
        return [
            Problem("the curve needs pairs of rotation and moment", f"{rotation.size} points", where=where)
        ]
    problems = []
    if not np.all(np.isfinite(rotation)) or rotation[0] != 0.0 or np.any(np.diff(rotation) <= 0.0):
        problems.append(Problem("rotations must increase strictly from 0", where=where))
    if not np.all(np.isfinite(moment)) or np.any(moment <= 0.0):
        problems.append(Problem("capacities must be positive", where=where))
    return problems
