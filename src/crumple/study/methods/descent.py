"""Optimisation along gradients: SciPy's SLSQP with the derivatives that the multibody kernels integrate.

Every point is a row.  Derivatives are found again when a study is resumed; they depend on the point alone, so
it asks for the same points.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np

from crumple.analysis.criteria import Measured
from crumple.analysis.solve import run_of
from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.structure import value_at
from crumple.study.answer import columns_of
from crumple.study.formula import Formula
from crumple.study.rows import masses_of
from crumple.study.setting import Setting
from crumple.study.shapes import SCALED, structure_of
from crumple.study.space import Axis
from crumple.study.table import Table

STEP = 1e-5
"""Step of the differences of masses and formulas, over the range of a variable."""
CLEAR = 1e-6
"""Share of its limit by which a constraint is kept, so that rounding does not violate it."""
FAILED = 1e3
"""Goal of a row that failed, over that of the start: the line search turns back there."""


class _EnoughError(Exception):
    """The number of rows is reached."""


def descend(setting: Setting, table: Table, progress: Callable[[float], None]) -> None:
    """Ask for points from the base's values downhill, until the constrained optimum or the number of rows.

    Parameters
    ----------
    setting
        Of a study with one objective whose variables are ranges.
    table
        Takes the rows.
    progress
        Called with the share of the rows that is used.

    Raises
    ------
    InputError
        If a variable is no range, or derivatives of a response are not known.

    References
    ----------
    D. Kraft, A software package for sequential quadratic programming, DFVLR-FB 88-28, 1988.  Derivatives:
    docs/theory/sensitivities.md.
    """
    from scipy.optimize import minimize  # noqa: PLC0415  (slow to import)

    for axis in setting.axes:
        ranged = not (axis.values or axis.integer or axis.low is None or axis.high is None)
        known = not _factor(axis) or (axis.places[0] in SCALED and (axis.low or 0.0) > 0.0)
        if not (ranged and known):
            what, todo = f"'{axis.name}' has no gradient", "give low and high, or leave 'gradient' out"
            allowed = f"a continuous range of a path, or of a positive factor on {' or '.join(SCALED)}"
            raise InputError(Problem(what, "", allowed, todo, f"variables.{axis.name}"))
    search = _Search(setting, table, progress)
    bounds = [(0.0, 1.0)] * len(setting.axes)
    margins = [
        {"type": "ineq", "fun": partial(search.margin, k), "jac": partial(search.margin_slope, k)}
        for k in range(len(search.ends))
    ]
    try:
        minimize(  # type: ignore[call-overload]  # constraints as dictionaries
            search.goal,
            search.start(),
            jac=search.goal_slope,
            method="SLSQP",
            bounds=bounds,
            constraints=margins,
            options={"maxiter": setting.study.method.rows, "ftol": 1e-8},
        )
    except _EnoughError:
        return


class _Search:
    """Goal and margins of points of the unit cube, each point a row."""

    def __init__(self, setting: Setting, table: Table, progress: Callable[[float], None]) -> None:
        self._setting, self._table, self._progress = setting, table, progress
        self._rows: dict[bytes, int] = {}
        self._slopes: dict[bytes, dict[str, Floats]] = {}
        axes = setting.axes
        self._low = np.array([axis.low for axis in axes], float)
        self._span = np.array([axis.high for axis in axes], float) - self._low
        self.ends = [
            (name, sign, limit)
            for name, low, high in setting.limits
            for sign, limit in ((1.0, low), (-1.0, high))
            if np.isfinite(limit)
        ]
        self._worst = 1.0

    def start(self) -> Floats:
        """The values that the base has, within their ranges."""
        base = self._setting.base
        assert base is not None
        given = [
            value_at(base.structure, axis.places[0]) if not _factor(axis) else 1.0
            for axis in self._setting.axes
        ]
        return np.asarray(np.clip((np.array(given) - self._low) / self._span, 0.0, 1.0))

    def goal(self, x: Floats) -> float:
        """What is made small, over its value at the start."""
        objective = self._setting.study.goals[0]
        value = objective.sign * self._values(x)[objective.response]
        if not np.isfinite(value):
            return FAILED
        if len(self._rows) == 1:
            self._worst = abs(value) or 1.0
        return value / self._worst

    def goal_slope(self, x: Floats) -> Floats:
        """Derivatives of `goal`, (variables,)."""
        objective = self._setting.study.goals[0]
        return np.asarray(objective.sign * self._slope(x)[objective.response] / self._worst)

    def margin(self, k: int, x: Floats) -> float:
        """How far a row is from a limit, over the limit: negative where it violates it."""
        name, sign, limit = self.ends[k]
        value = self._values(x)[name]
        return sign * (value - limit) / (abs(limit) or 1.0) - CLEAR if np.isfinite(value) else -1.0

    def margin_slope(self, k: int, x: Floats) -> Floats:
        """Derivatives of `margin`, (variables,)."""
        name, sign, limit = self.ends[k]
        return np.asarray(sign * self._slope(x)[name] / (abs(limit) or 1.0))

    def _point(self, x: Floats) -> tuple[float, ...]:
        return tuple((self._low + self._span * np.clip(x, 0.0, 1.0)).tolist())

    def _values(self, x: Floats) -> Mapping[str, float]:
        key = np.asarray(x, float).tobytes()
        if key not in self._rows:
            if len(self._table.rows) >= self._setting.study.method.rows:
                raise _EnoughError
            self._rows[key] = len(self._table.rows)
            self._table.solve([self._point(x)])
            self._progress(min(len(self._table.rows) / self._setting.study.method.rows, 1.0))
        row, columns = self._rows[key], columns_of(self._setting.study, self._table)
        return {name: float(column[row]) for name, column in columns.items()}

    def _slope(self, x: Floats) -> dict[str, Floats]:
        """Derivatives of variables and responses over the unit cube, (variables,) each."""
        key = np.asarray(x, float).tobytes()
        if key not in self._slopes:
            values, axes = self._values(x), self._setting.axes
            found = {axis.name: self._span * (np.arange(len(axes)) == k) for k, axis in enumerate(axes)}
            found |= self._measured_slopes(x)
            for name, response in self._setting.study.responses.items():
                if response.formula:
                    found[name] = self._formula_slope(Formula(response.formula), values, found)
            self._slopes[key] = {name: np.nan_to_num(slope) for name, slope in found.items()}
        return self._slopes[key]

    def _measured_slopes(self, x: Floats) -> dict[str, Floats]:
        from crumple.multibody import sensitivities  # noqa: PLC0415  (needs the kernels)

        base, axes, point = self._setting.base, self._setting.axes, self._point(x)
        assert base is not None
        structure, _ = structure_of(base, axes, point)
        places = [place for axis in axes for place in axis.places]
        found = sensitivities(structure, run_of(base), places)
        return {
            one.name: self._mass_slope(point)
            if not one.channel
            else self._slope_of(one, found.derivatives, point)
            for one in self._setting.measured
        }

    def _slope_of(
        self, one: Measured, known: Mapping[str, Mapping[str, float]], point: tuple[float, ...]
    ) -> Floats:
        if one.quantity is None or one.quantity not in known or one.take == "at":
            what, todo = f"the gradient of '{one.name}' is not known", "leave 'gradient' out"
            allowed = "final values, largest rotations and moments of hinges, mass"
            raise InputError(Problem(what, one.channel, allowed, todo, f"responses.{one.name}"))
        own, axes = known[one.quantity], self._setting.axes
        # factors of the kernel count from the structure of the point, which has its own factors
        per = [1.0 if not _factor(axis) else value for axis, value in zip(axes, point, strict=True)]
        slopes = [sum(own[place] for place in axis.places) for axis in axes]
        return np.asarray(self._span * np.array(slopes) / np.array(per))

    def _mass_slope(self, point: tuple[float, ...]) -> Floats:
        base, axes = self._setting.base, self._setting.axes
        assert base is not None
        step = STEP * np.eye(len(axes)) * self._span
        moved = np.concatenate([np.array(point) + step, np.array(point) - step])
        columns = {place: moved[:, k] for k, axis in enumerate(axes) for place in axis.places}
        masses = masses_of(base.structure, columns).reshape(2, -1)
        return np.asarray((masses[0] - masses[1]) / (2.0 * STEP))

    def _formula_slope(
        self, formula: Formula, values: Mapping[str, float], slopes: Mapping[str, Floats]
    ) -> Floats:
        """By differences along each variable, with the responses moved as their derivatives say."""
        ends = [
            formula({name: values[name] + way * STEP * slopes[name] for name in slopes})
            for way in (1.0, -1.0)
        ]
        size = len(self._setting.axes)
        upper, lower = (np.broadcast_to(np.asarray(end, float), size) for end in ends)
        return np.asarray((upper - lower) / (2.0 * STEP))


def _factor(axis: Axis) -> bool:
    return "." not in axis.places[0] or axis.places[0].startswith("hinges.")
