"""Variables in numbers: from the unit cube to values, in SI units."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import special

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.study.study_file import Distribution, Study, Value, Variable
from crumple.units import QuantityError, parse_quantity

Point = tuple[float | str, ...]
"""Values of all variables, in their order."""
_UNIT = re.compile(r"\s*[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?\s*(\D.*?)\s*")
_EDGE = 2.0**-53
"""Probabilities are kept this far from 0 and 1, where unbounded distributions are infinite."""


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
        found = self._quantile(np.clip(share, _EDGE, 1.0 - _EDGE))
        values: list[float | str] = (np.round(found) if self.integer else found).tolist()
        return values

    def _quantile(self, share: Floats) -> Floats:
        kind = self.distribution.type if self.distribution is not None else ""
        given = self.numbers
        if kind == "normal":
            return np.asarray(given["mean"] + given["deviation"] * special.ndtri(share))
        if kind == "lognormal":
            spread = math.log1p((given["deviation"] / given["mean"]) ** 2)
            centre = math.log(given["mean"]) - 0.5 * spread
            return np.asarray(np.exp(centre + math.sqrt(spread) * special.ndtri(share)))
        if kind == "table":
            return np.asarray(np.interp(share, given["cumulative"], given["values"]), float)
        low = given["low"] if kind == "uniform" else float(self.low or 0.0)
        high = given["high"] if kind == "uniform" else float(self.high or 0.0)
        if self.integer:
            # each whole number equally likely
            low, high = low - 0.5 + _EDGE, high + 0.5 - _EDGE
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
    axes = []
    for name, variable in study.variables.items():
        try:
            axes.append(_axis(name, variable, document))
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(problems)
    return axes


def points_of(axes: Sequence[Axis], shares: NDArray[np.float64]) -> list[Point]:
    """Points at places in the unit cube, (n, variables)."""
    return list(zip(*(axis.at(shares[:, k]) for k, axis in enumerate(axes)), strict=True))


def number(value: Value, unit: str, where: str) -> float:
    """SI value of a quantity of a study.

    Raises
    ------
    InputError
        If the unit is missing or of another dimension.
    """
    if isinstance(value, str):
        try:
            return parse_quantity(value, unit)
        except QuantityError as error:
            found = error.problems[0]
            raise InputError(Problem(found.what, found.came, found.allowed, found.todo, where)) from None
    if unit != "1" and value != 0.0:
        what, todo = "the unit is missing", "write the number with its unit"
        raise InputError(Problem(what, f"{value:g}", f"a quantity such as '{value:g} {unit}'", todo, where))
    return float(value)


def _axis(name: str, variable: Variable, document: object | None) -> Axis:
    where = f"variables.{name}"
    units = {_unit_at(document, place, where) for place in variable.places} or {"1"}
    words = None in units
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
    if low is not None and high is not None and not low < high:
        what, came = "low must be below high", f"{variable.low} to {variable.high}"
        raise InputError(Problem(what, came, "", "correct one of them", where))
    numbers = _numbers(variable.distribution, unit, f"{where}.distribution")
    steps, whole = variable.steps, variable.integer
    return Axis(name, variable.places, unit, low, high, values, steps, whole, variable.distribution, numbers)


def _numbers(given: Distribution | None, unit: str, where: str) -> dict[str, Any]:
    """Values of a distribution in SI."""
    if given is None:
        return {}
    needed = ("mean", "deviation") if given.type in {"normal", "lognormal"} else ("low", "high")
    found: dict[str, Any] = {}
    if given.type == "table":
        found["values"] = [number(value, unit, f"{where}.values") for value in given.values]
        found["cumulative"] = list(given.cumulative)
        rising = all(np.all(np.diff(column) > 0.0) for column in found.values())
        ends = (found["cumulative"][:1], found["cumulative"][-1:]) == ([0.0], [1.0])
        if len(given.values) != len(given.cumulative) or not (ends and rising):
            allowed = "as many increasing values as probabilities, which increase from 0 to 1"
            raise InputError(Problem("this is not a distribution", "", allowed, "correct the table", where))
        return found
    for key in needed:
        value = getattr(given, key)
        if value is None:
            what = f"a {given.type} distribution needs '{key}'"
            raise InputError(Problem(what, "", "", f"add '{key}'", where))
        found[key] = number(value, unit, f"{where}.{key}")
    positive = [found.get("deviation", 1.0)] + ([found["mean"]] if given.type == "lognormal" else [])
    if min(positive) <= 0.0 or ("low" in found and not found["low"] < found["high"]):
        allowed = "deviation above 0; lognormal: mean above 0; uniform: low below high"
        raise InputError(Problem("this is not a distribution", "", allowed, "correct it", where))
    return found


def _unit_at(document: object | None, place: str, where: str) -> str | None:
    """Unit of the quantity at a path of the base input; None if a text without number is there."""
    part: object = document
    if "." not in place or place.startswith("hinges."):
        return "1"
    for key in place.split("."):
        if isinstance(part, dict):
            part = part.get(key, part.get(int(key)) if key.isdigit() else None)
        elif isinstance(part, list) and key.isdigit() and int(key) < len(part):
            part = part[int(key)]
        else:
            part = None
    if part is None:
        what, todo = "the base input has nothing at this path", "correct the path, or write the value there"
        raise InputError(Problem(what, place, "a path that is written in the base input", todo, where))
    if isinstance(part, int | float):
        return "1"
    match = _UNIT.fullmatch(part) if isinstance(part, str) else None
    return match[1] if match else None
