"""How final quantities answer to small changes of parameters: derivatives carried along with one run."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from crumple._core.planar.batch import TreeFinals
from crumple._core.planar.tangent import TreeDirection, TreeTangent, solve_tangent
from crumple.errors import InputError, Problem, Status
from crumple.hinge import HingeLaw
from crumple.multibody.answer.end_values import final_quantities
from crumple.multibody.kernel_choice import why_spatial
from crumple.multibody.planar.case import Lowered, lowered
from crumple.multibody.run import Cancel, Run, outcome_status
from crumple.multibody.spatial.sensitivity import space_sensitivities
from crumple.multibody.variants.factors import checked_names, scaled
from crumple.numeric.arrays import Floats
from crumple.structure import Structure, changed, placed_hinges, value_at

RELATIVE_STEP = 1e-4
"""By this share of its value a parameter is moved either way to see how the model's arrays follow it.  They
are smooth functions, so the error goes with its square; far smaller, rounding would show."""


@dataclass(frozen=True, eq=False)
class Sensitivities:
    """Final quantities of one run and their derivatives.

    Attributes
    ----------
    quantities
        Final values by name, as in `VariantTable`.
    derivatives
        By quantity, then by parameter: d quantity/d parameter in SI units; factors count from 1.
    status, reason
        How the run ended.
    """

    quantities: Mapping[str, float]
    derivatives: Mapping[str, Mapping[str, float]]
    status: Status
    reason: str

    def __getitem__(self, quantity: str) -> Mapping[str, float]:
        """Derivatives of a quantity, by parameter."""
        return self.derivatives[quantity]


def sensitivities(
    structure: Structure,
    run: Run,
    parameters: str | Sequence[str] | Mapping[str, float],
    cancel: Cancel | None = None,
) -> Sensitivities:
    """Derivatives of where a run ends.

    Parameters
    ----------
    structure, run
        What is solved; the quantities are those of `solve_variants`.
    parameters
        Paths and factors as in `solve_variants`, or one of them; as a mapping, with the step [SI] by which
        each is moved to see how the model's arrays follow it, needed where its value is zero.
    cancel
        As in `solve_multibody`.

    Returns
    -------
    Sensitivities
        Of the very motion that `solve_variants` finds.

    Raises
    ------
    InputError
        If the structure cannot be solved, a parameter does not exist, or it cannot be moved either way; in
        space also if there is contact, or a stage is quasi-static or ends on a condition.

    Notes
    -----
    The derivatives are those of the chain of steps that was taken.  They hold on one side alone where the
    answer has a kink: a hinge that just does not open, a stop that is just touched.  In space a derivative is
    NaN where a run close by cannot be solved in the same steps.

    References
    ----------
    Derivation and limits in docs/theory/sensitivities.md.
    Verified in tests/verification/derivatives/test_sensitivities.py and test_space_sensitivities.py.
    """
    if isinstance(parameters, str):
        parameters = (parameters,)
    if why_spatial(structure, placed_hinges(structure), run) is not None:
        given = parameters if isinstance(parameters, Mapping) else dict.fromkeys(parameters)
        threads = os.cpu_count() or 1
        return Sensitivities(*space_sensitivities(structure, run, given, threads, _poll(cancel)))
    base = lowered(structure, run.duration)
    names = list(parameters)
    checked_names(structure, [name for name, _ in base.hinges], names)
    given = dict(parameters) if isinstance(parameters, Mapping) else {}
    moved = [_moved(base, run, name, given.get(name)) for name in names]
    settings = run.settings
    tangent = solve_tangent(
        base.tree,
        base.start.velocity,
        base.start.impulse,
        [_direction(*ends) for ends in moved],
        run.duration,
        settings.accuracy,
        minimum_step=settings.minimum_time_step,
        maximum_step=settings.maximum_time_step,
        poll=_poll(cancel),
    )
    status, reason = outcome_status(
        tangent.outcome, tangent.reason, tangent.residual, settings.energy_residual_bound
    )
    quantities = _quantities(base, tangent, run, lambda rows: rows[:1])
    columns = {}
    for k, (name, (up, down, width)) in enumerate(zip(names, moved, strict=True)):
        above = _quantities(up, tangent, run, _along(k, width / 2))
        below = _quantities(down, tangent, run, _along(k, -width / 2))
        columns[name] = {key: (above[key] - below[key]) / width for key in quantities}
    derivatives = {key: {name: columns[name][key] for name in names} for key in quantities}
    return Sensitivities(quantities, derivatives, status, reason)


def _moved(base: Lowered, run: Run, name: str, step: float | None) -> tuple[Lowered, Lowered, float]:
    """Models with a parameter above and below its value, and the difference of the parameter."""
    factor = scaled(base, name)
    if factor is not None:
        step = RELATIVE_STEP if step is None else step
        return factor(1.0 + step), factor(1.0 - step), 2.0 * step
    value = value_at(base.structure, name)
    if step is None:
        step = RELATIVE_STEP * (base.tree.length if name.startswith("nodes.") else abs(value))
    if not step > 0.0:
        what, todo = "no step follows from a parameter that is zero", "give its step: {path: step}"
        raise InputError(Problem(what, f"{name} = {value:g}", "a step > 0", todo, name))
    ends = []
    for end in (value + step, value - step):
        model = lowered(changed(base.structure, {name: end}), run.duration)
        if model.topology != base.topology:
            raise InputError(
                Problem("moving this parameter joins other parts", name, "", "leave it out", name)
            )
        ends.append(_at_places_of(base, model))
    return ends[0], ends[1], 2.0 * step


def _at_places_of(base: Lowered, model: Lowered) -> Lowered:
    """A model whose capacities are its laws' own at the places at which the base's are sampled.

    Were its own samples taken, the difference of two samplings' errors would be divided by a small step.
    """
    pairs = [
        (old.hinge.law, new.hinge.law)
        for old, new in zip(base.mechanism.links, model.mechanism.links, strict=True)
        if old.hinge is not None and new.hinge is not None
    ]
    hinges = []
    for laws, hinge, old, (_, sign) in zip(
        pairs, model.tree.hinges, base.tree.hinges, base.hinges, strict=True
    ):
        first = 1 if sign > 0.0 else -1
        positive, negative = _curve(*laws, old.positive[0], first), _curve(*laws, old.negative[0], -first)
        hinges.append(replace(hinge, positive=positive, negative=negative))
    return replace(model, tree=replace(model.tree, hinges=tuple(hinges)))


def _curve(base: HingeLaw, law: HingeLaw, places: Floats, sense: int) -> tuple[Floats, Floats]:
    """Capacity of a law at the places of the base's samples, which move with the kinks."""
    ends = []
    for of in (base, law):
        kinks = sorted(kink for kink in of.kinks(sense) if 0.0 < kink < places[-1])
        ends.append([0.0, *kinks, places[-1]])
    if len(ends[0]) == len(ends[1]):
        places = np.interp(places, np.array(ends[0]), np.array(ends[1]))
    return places, law.moment_capacity(places, sense)


def _direction(up: Lowered, down: Lowered, width: float) -> TreeDirection:
    return TreeDirection(
        up.tree,
        down.tree,
        up.start.velocity,
        down.start.velocity,
        up.start.impulse,
        down.start.impulse,
        width,
    )


def _along(k: int, distance: float) -> Callable[[Floats], Floats]:
    """Rows of values and derivatives -> one row: the values moved along direction k."""

    def moved(rows: Floats) -> Floats:
        row: Floats = rows[:1] + distance * rows[1 + k : 2 + k]
        return row

    return moved


def _quantities(
    model: Lowered, tangent: TreeTangent, run: Run, moved: Callable[[Floats], Floats]
) -> dict[str, float]:
    """Final quantities with the model and the end of the motion moved along a direction."""
    finals = TreeFinals(
        time=np.array([tangent.time]),
        q=moved(tangent.q),
        w=moved(tangent.w),
        pose=moved(tangent.pose),
        velocity=moved(tangent.velocity),
        hinge=moved(tangent.hinge),
        energy=moved(tangent.energy),
        summary=moved(tangent.summary),
        residual=np.zeros(1),
        lost=np.zeros(1),
        outcome=np.zeros(1, np.int64),
        steps=np.zeros(1, np.int64),
    )
    found = final_quantities(model, finals, run.outputs)
    return {name: float(column[0]) for name, column in found.items() if name != "energy_residual"}


def _poll(cancel: Cancel | None) -> Callable[[float], bool] | None:
    return None if cancel is None else lambda _: not cancel()
