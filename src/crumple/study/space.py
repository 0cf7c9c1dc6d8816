"""Variables in numbers: from the unit cube to values, in SI units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from crumple.analysis.distribution import (
    EDGE,
    Distribution,
    Value,
    number,
    numbers_of,
    quantile,
    unit_at,
)
from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.study.study_file import LAYOUT, Study, Variable

Point = tuple[float | str, ...]
"""Values of all variables, in their order."""


@dataclass(frozen=True)
class Axis:
    """One variable in numbers.

    Attributes
    ----------
    name, places
        Its name, and its paths in the input.
    unit
        As written in the base input; sets the dimension.
    low, high
        Range in SI; None without one.
    values
        The only values, SI numbers or names; empty if there is a range.
    steps, integer
        As in the study file.
    distribution
        As in the study file, None if it does not scatter; `numbers` are its values in SI.
    """

    name: str
    places: tuple[str, ...]
    unit: str
    low: float | None
    high: float | None
    values: tuple[float | str, ...]
    steps: int | None
    integer: bool
    distribution: Distribution | None
    numbers: Mapping[str, Any] = field(default_factory=dict)

    @property
    def numeric(self) -> bool:
        """Whether its values are numbers."""
        return not any(isinstance(value, str) for value in self.values)

    def grid(self) -> tuple[float | str, ...]:
        """Values of a grid."""
        if self.values:
            return self.values
        assert self.low is not None
        assert self.high is not None
        found = np.linspace(self.low, self.high, self.steps or 1)
        return tuple(dict.fromkeys((np.round(found) if self.integer else found).tolist()))

    def at(self, share: Floats) -> list[float | str]:
        """Values at probabilities, (n,), 0 to 1: of the distribution, or else uniform in the range."""
        if self.values and self.distribution is None:
            places = np.minimum((share * len(self.values)).astype(int), len(self.values) - 1)
            return [self.values[i] for i in places.tolist()]
        found = self._quantile(np.clip(share, EDGE, 1.0 - EDGE))
        values: list[float | str] = (np.round(found) if self.integer else found).tolist()
        return values

    def _quantile(self, share: Floats) -> Floats:
        kind = self.distribution.type if self.distribution is not None else ""
        if kind not in {"", "uniform"}:
            return quantile(kind, self.numbers, share)
        low = self.numbers["low"] if kind else float(self.low or 0.0)
        high = self.numbers["high"] if kind else float(self.high or 0.0)
        if self.integer:
            # each whole number equally likely
            low, high = low - 0.5 + EDGE, high + 0.5 - EDGE
        return np.asarray(low + (high - low) * share)


def axes_of(study: Study, document: object | None) -> list[Axis]:
    """Variables of a study in numbers.

    Parameters
    ----------
    study
        Its quantities are converted by the units that the base input has at their paths.
    document
        Data of the base input; None if there is none: then all are plain numbers.

    Raises
    ------
    InputError
        If a quantity has another dimension than in the base input, or a distribution is not one.
    """
    problems: list[Problem] = []
    axes: list[Axis] = []
    for name, variable in study.variables.items():
        try:
            axis = _axis(name, variable, document)
            # factors, which have no unit, multiply each other
            shared = [one.name for one in axes if axis.unit != "1" and {*one.places} & {*axis.places}]
            if shared:
                what, todo = f"the variable '{shared[0]}' varies the same path", "remove one of them"
                came = ", ".join(variable.places)
                raise InputError(Problem(what, came, "a path of its own", todo, f"variables.{name}"))
            axes.append(axis)
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(problems)
    return axes


def points_of(axes: Sequence[Axis], shares: NDArray[np.float64]) -> list[Point]:
    """Points at places in the unit cube, (n, variables)."""
    return list(zip(*(axis.at(shares[:, k]) for k, axis in enumerate(axes)), strict=True))


def _axis(name: str, variable: Variable, document: object | None) -> Axis:
    where = f"variables.{name}"
    units = {unit_at(document, place, where) for place in variable.places} or {"1"}
    # the variable that chooses among base inputs has their names
    words = None in units or (variable.places == (LAYOUT,) and document is not None)
    unit = "1" if words else str(sorted(map(str, units))[0])

    def given(value: Value | None, key: str) -> float | None:
        return None if value is None else number(value, unit, f"{where}.{key}")

    values: tuple[float | str, ...] = tuple(map(str, variable.values))
    if not words:
        values = tuple(number(value, unit, f"{where}.values") for value in variable.values)
    elif not values:
        what, todo = "this path leads to no number of the base input", "correct it, or list 'values'"
        raise InputError(Problem(what, ", ".join(variable.places), "the path of a quantity", todo, where))
    low, high = given(variable.low, "low"), given(variable.high, "high")
    if values and not (low is None and high is None):
        what, todo = "a variable has a range or values", "keep low and high, or values"
        raise InputError(Problem(what, f"{variable.low} to {variable.high}, and values", "", todo, where))
    if low is not None and high is not None and not low < high:
        what, came = "low must be below high", f"{variable.low} to {variable.high}"
        raise InputError(Problem(what, came, "", "correct one of them", where))
    numbers = numbers_of(variable.distribution, unit, f"{where}.distribution")
    steps, whole = variable.steps, variable.integer
    return Axis(name, variable.places, unit, low, high, values, steps, whole, variable.distribution, numbers)
