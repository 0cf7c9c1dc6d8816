"""Exact derivatives of the final quantities of a planar run, integrated along with the run."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from crumple._core.planar.batch import TreeEnds
from crumple._core.planar.tangent import TreeDirection, solve_tangent
from crumple._core.records import each_array
from crumple.hinge import HingeLaw
from crumple.multibody.answer.end_values import end_quantities
from crumple.multibody.answer.solved import Poll
from crumple.multibody.planar.case import PlanarCase
from crumple.multibody.variants.batch import Batch, hinge_names
from crumple.multibody.variants.factors import checked_names
from crumple.multibody.variants.moved import Moved, MovedEnds, cases_beside, factor_step, step_of
from crumple.numeric.arrays import Floats
from crumple.structure import Outputs, Structure

RELATIVE_STEP = 1e-4
"""By this share of its value a parameter is moved either way to see how the model's arrays follow it.  They
are smooth functions, so the error goes with its square; far smaller, rounding would show."""


def planar_ends(
    batch: Batch, structure: Structure, steps: Mapping[str, float | None], poll: Poll | None
) -> MovedEnds:
    """Final values of a planar run, and their derivatives along each parameter's direction.

    Parameters
    ----------
    batch, structure
        The structure and the batch that solves it.
    steps
        Parameters, each with the step [SI] by which it is moved, or None for a share of its value.
    poll
        As in a batch.

    Raises
    ------
    InputError
        If a parameter does not exist or cannot be moved.
    """
    base = _planar(batch.case(structure))
    checked_names(structure, hinge_names(base), list(steps))
    beside = {name: _beside(batch, base, name, step) for name, step in steps.items()}
    run = batch.run
    tangent = solve_tangent(
        base.model,
        base.velocity,
        base.impulse,
        [_direction(*ends) for ends in beside.values()],
        run.duration,
        run.settings.accuracy,
        minimum_step=run.settings.minimum_time_step,
        maximum_step=run.settings.maximum_time_step,
        poll=poll,
    )

    def along(case: PlanarCase, k: int, distance: float) -> dict[str, float]:
        """End values of a run whose case and initial motion vary along a direction."""
        moved = each_array(tangent.ends, lambda rows: rows[:1] + distance * rows[1 + k : 2 + k])
        return _quantities(case, moved, run.outputs)

    moved = {
        name: Moved(along(up, k, width / 2), along(down, k, -width / 2), width)
        for k, (name, (up, down, width)) in enumerate(beside.items())
    }
    quantities = _quantities(base, each_array(tangent.ends, lambda rows: rows[:1]), run.outputs)
    return MovedEnds(quantities, moved, tangent.outcome, tangent.reason, tangent.residual)


def _quantities(case: PlanarCase, ends: TreeEnds, outputs: Outputs) -> dict[str, float]:
    return {name: float(column[0]) for name, column in end_quantities(case, ends, outputs).items()}


def _beside(
    batch: Batch, base: PlanarCase, name: str, step: float | None
) -> tuple[PlanarCase, PlanarCase, float]:
    """Cases with a parameter above and below its value, and the difference of the parameter."""
    factor = _scaled(base, name)
    if factor is not None:
        step = factor_step(name, step, RELATIVE_STEP)
        return factor(1.0 + step), factor(1.0 - step), 2.0 * step
    step = step_of(base, name, step, RELATIVE_STEP)
    above, below = cases_beside(batch, base, name, step)
    return _at_places_of(base, _planar(above)), _at_places_of(base, _planar(below)), 2.0 * step


def _planar(case: object) -> PlanarCase:
    assert isinstance(case, PlanarCase)
    return case


def _scaled(base: PlanarCase, name: str) -> Callable[[float], PlanarCase] | None:
    """For a factor: the case with it; None for a path of the input."""
    tree, start = base.model, base.start

    def capacity(factor: float) -> PlanarCase:
        hinge_name = name.split(".")[1]
        hinges = tuple(
            replace(hinge, capacity_scale=factor if own == hinge_name else 1.0)
            for hinge, own in zip(tree.hinges, hinge_names(base), strict=True)
        )
        return replace(base, model=replace(tree, hinges=hinges))

    def loads(factor: float) -> PlanarCase:
        loads = tuple(replace(load, values=factor * load.values) for load in tree.loads)
        return replace(base, model=replace(tree, loads=loads))

    def gravity(factor: float) -> PlanarCase:
        x, y = tree.gravity
        return replace(base, model=replace(tree, gravity=(factor * x, factor * y)))

    def velocity(factor: float) -> PlanarCase:
        return replace(base, start=replace(start, velocity=factor * start.velocity))

    def impulses(factor: float) -> PlanarCase:
        return replace(base, start=replace(start, impulse=factor * start.impulse))

    if name.startswith("hinges."):
        return capacity
    return {"initial_velocity": velocity, "impulses": impulses, "loads": loads, "gravity": gravity}.get(name)


def _at_places_of(base: PlanarCase, case: PlanarCase) -> PlanarCase:
    """A case whose laws are sampled at the same places as those of the base case.

    Were its own samples taken, the difference of two samplings' errors would be divided by a small step.
    """
    hinges = []
    for old, new, own, samples in zip(
        base.hinges, case.hinges, case.model.hinges, base.model.hinges, strict=True
    ):
        laws, first = (old.hinge.law, new.hinge.law), 1 if new.sign > 0.0 else -1
        positive = _curve(*laws, samples.positive[0], first)
        negative = _curve(*laws, samples.negative[0], -first)
        hinges.append(replace(own, positive=positive, negative=negative))
    return replace(case, model=replace(case.model, hinges=tuple(hinges)))


def _curve(base: HingeLaw, law: HingeLaw, places: Floats, sense: int) -> tuple[Floats, Floats]:
    """Capacity of a law at the places of the base's samples, which move with the kinks."""
    ends = []
    for of in (base, law):
        kinks = sorted(kink for kink in of.kinks(sense) if 0.0 < kink < places[-1])
        ends.append([0.0, *kinks, places[-1]])
    if len(ends[0]) == len(ends[1]):
        places = np.interp(places, np.array(ends[0]), np.array(ends[1]))
    return places, law.moment_capacity(places, sense)


def _direction(up: PlanarCase, down: PlanarCase, width: float) -> TreeDirection:
    return TreeDirection(up.model, down.model, up.velocity, down.velocity, up.impulse, down.impulse, width)
