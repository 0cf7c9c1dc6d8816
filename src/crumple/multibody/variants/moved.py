"""A parameter changed in both directions: steps, cases above and below its value, and slopes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from crumple._core.outcome import Outcome
from crumple.errors import InputError, Problem
from crumple.multibody.variants.batch import Batch, Case
from crumple.structure import changed, value_at


@dataclass(frozen=True, eq=False)
class Moved:
    """End values with a parameter above and below its value, and the difference of the parameter."""

    above: Mapping[str, float]
    below: Mapping[str, float]
    width: float

    def slope(self, quantity: str) -> float:
        """Derivative of a quantity."""
        return (self.above[quantity] - self.below[quantity]) / self.width


@dataclass(frozen=True, eq=False)
class MovedEnds:
    """Final values of a run, and of runs with each of its parameters changed.

    Attributes
    ----------
    quantities
        Of the run itself, by name.
    moved
        By parameter.
    outcome, reason, residual
        Of the run itself.
    """

    quantities: Mapping[str, float]
    moved: Mapping[str, Moved]
    outcome: Outcome
    reason: str
    residual: float


SMALLEST_STEP = 1e-9
"""Smallest step over the value; below, the difference of two answers is rounding."""


def step_of(base: Case, name: str, step: float | None, share: float) -> float:
    """Step by which a path of the input is changed in both directions: as given, or a share of its value.

    Raises
    ------
    InputError
        If its value is zero and no step is given, or the step is lost in rounding.
    """
    value = value_at(base.structure, name)
    if step is None:
        step = share * (base.model.length if name.startswith("nodes.") else abs(value))
    if not step > 0.0:
        what, todo = "the step of a parameter that is zero is not defined", "give its step: {path: step}"
        raise InputError(Problem(what, f"{name} = {value:g}", "a step > 0", todo, name))
    if step < SMALLEST_STEP * abs(value):
        raise _lost(name, step, f"at least {SMALLEST_STEP * abs(value):g}")
    return step


def factor_step(name: str, step: float | None, share: float) -> float:
    """Step by which a factor is moved from 1 in both directions: as given, or the share.

    Raises
    ------
    InputError
        If the step is lost in rounding, or is not below 1.
    """
    if step is None:
        return share
    if not SMALLEST_STEP <= step < 1.0:
        raise _lost(name, step, f"{SMALLEST_STEP:g} to below 1")
    return step


def _lost(name: str, step: float, allowed: str) -> InputError:
    what, todo = "the step of this parameter is out of range", "give another step, or none"
    return InputError(Problem(what, f"{step:g}", allowed, todo, name))


def cases_beside(batch: Batch, base: Case, name: str, step: float) -> tuple[Case, Case]:
    """Cases with a path of the input above and below its value.

    Raises
    ------
    InputError
        If the structure joins other parts there.
    """
    value = value_at(base.structure, name)
    above, below = (batch.case(changed(base.structure, {name: end})) for end in (value + step, value - step))
    if above.topology != base.topology or below.topology != base.topology:
        raise InputError(
            Problem("a change of this parameter connects other parts", name, "", "omit it", name)
        )
    return above, below
