"""Many variants of one structure in one call: a table of where each of them ended.

A parameter is a path in the input (``materials.steel.yield_stress``, ``sections.tube.thickness``,
``masses.payload.mass``) with one value per variant, or one of the factors ``initial_velocity``, ``impulses``,
``loads``, ``gravity`` and ``hinges.NAME.capacity``, which multiply what the structure has.

Factors and masses only scale arrays of the kernel, so they cost nothing.  Every other distinct
combination of values is lowered once, its laws sampled anew.  The kernel then solves all variants without
Python in between.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crumple._core.batch import TreeFinals, TreeVariants, solve_many
from crumple._core.tree import Outcome
from crumple.errors import InputError, Problem, Status
from crumple.multibody.choice import refuse_spatial
from crumple.multibody.factors import FACTORS, checked_names
from crumple.multibody.finals import final_quantities, part_of
from crumple.multibody.lowered import Lowered, RawMass, lowered, raw_mass, tree_arrays
from crumple.multibody.rigid import Floats
from crumple.multibody.run import Cancel, Progress, Run, outcome_status
from crumple.structure import Structure, changed, value_at


@dataclass(frozen=True, eq=False)
class VariantTable:
    """Where every variant ended; n rows.

    Attributes
    ----------
    parameters
        The values that were asked for, (n,) each.
    quantities
        Final values by channel name, (n,) each; NaN, which stands for no value, in rows that were refused.
        ``hinge.NAME.`` rotation, plastic_rotation, moment, capacity, energy, rotation_max, moment_max;
        ``energy.``kinetic, elastic, dissipated, external_work; ``node.NAME.displacement.x`` and
        ``node.NAME.rotation.x`` of the nodes asked for; section rotations asked for; ``energy_residual``.
    status
        How each variant ended.
    reason
        Why, where it did not reach its end.
    """

    parameters: Mapping[str, Floats]
    quantities: Mapping[str, Floats]
    status: tuple[Status, ...]
    reason: tuple[str, ...]

    def __len__(self) -> int:
        """Number of variants."""
        return len(self.status)

    def __getitem__(self, name: str) -> Floats:
        """A quantity or a parameter by name."""
        return self.quantities[name] if name in self.quantities else self.parameters[name]


def solve_variants(
    structure: Structure,
    run: Run,
    parameters: Mapping[str, ArrayLike],
    threads: int | None = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
) -> VariantTable:
    """Solve a structure for many values of its parameters.

    Parameters
    ----------
    structure
        Gives what the parameters leave alone.
    run
        Duration, settings, and outputs; histories are not kept.
    parameters
        Values [SI] or factors by path, one per variant; a scalar serves all.
    threads
        Number of threads; None for as many as the machine has.  Results do not depend on it.
    progress, cancel
        As in `solve_multibody`; variants not begun when cancelled have that status.

    Returns
    -------
    VariantTable
        A variant that cannot be built or solved is a row with its status and reason.

    Raises
    ------
    InputError
        If the structure itself cannot be solved, or a parameter does not exist.

    Notes
    -----
    Each variant is solved once, at the accuracy of the settings; `solve_multibody` solves a second time at a
    quarter of it to state an error.  Rows have the bits of a single run of the kernel with the same arrays;
    masses enter these arrays to rounding as they do in `solve_multibody`.

    References
    ----------
    docs/theory/variants.md.  Verified in tests/unit/multibody/test_variants.py.
    """
    refuse_spatial(structure, run)
    base = lowered(structure, run.duration)
    values = _columns(structure, base, parameters)
    slow = [name for name in values if not _quick(name)]
    models, model_of, refused = _models(structure, run, values, slow, base)
    arrays = _variants(values, models, model_of)
    settings = run.settings
    finals = solve_many(
        arrays,
        run.duration,
        settings.accuracy,
        settings.minimum_time_step,
        settings.maximum_time_step,
        threads or os.cpu_count() or 1,
        poll=_poll(progress, cancel),
    )
    status, reason = _outcomes(finals, refused, run.settings.energy_residual_bound)
    quantities = _quantities(models, model_of, finals, run)
    lost = np.array([state is Status.REFUSED for state in status])
    for column in quantities.values():
        column[lost] = np.nan
    return VariantTable(values, quantities, status, reason)


def _quick(name: str) -> bool:
    """Whether a parameter only scales arrays of the kernel."""
    head, *rest = name.split(".")
    return (not rest and head in FACTORS) or (head == "hinges") or (head == "masses" and rest[1:] == ["mass"])


def _columns(structure: Structure, base: Lowered, parameters: Mapping[str, ArrayLike]) -> dict[str, Floats]:
    """One array per parameter, all as long."""
    values = {name: np.atleast_1d(np.asarray(given, float)) for name, given in parameters.items()}
    count = max((column.size for column in values.values()), default=0)
    problems = []
    for name, column in values.items():
        if column.ndim != 1 or column.size not in (1, count):
            allowed = f"one value, or {count} as the longest has"
            problems.append(Problem("parameters differ in length", f"{column.shape}", allowed, "", name))
    if count == 0:
        what, todo = "no parameter is varied", "name at least one"
        problems.append(Problem(what, "", "a path of the input, or a factor", todo, "parameters"))
    if problems:
        raise InputError(problems)
    checked_names(structure, base, list(values))
    return {name: np.broadcast_to(column, (count,)).copy() for name, column in values.items()}


def _models(
    structure: Structure, run: Run, values: Mapping[str, Floats], slow: Sequence[str], base: Lowered
) -> tuple[list[Lowered], NDArray[np.int64], dict[int, str]]:
    """A model for every distinct combination of slow parameters, which one each variant has, and refusals."""
    count = len(next(iter(values.values())))
    if not slow:
        return [base], np.zeros(count, np.int64), {}
    rows = np.stack([values[name] for name in slow], axis=1)
    distinct, combination = np.unique(rows, axis=0, return_inverse=True)
    models, number, failed = [base], np.zeros(len(distinct), np.int64), {}
    for i, combined in enumerate(distinct):
        try:
            new = changed(structure, dict(zip(slow, map(float, combined), strict=True)))
            if any(name.startswith("nodes.") for name in slow):
                refuse_spatial(new, run)
            model = lowered(new, run.duration)
            if model.topology != base.topology:
                raise InputError("these values join other parts than the structure's own")
        except InputError as error:
            failed[i] = str(error)
            continue
        number[i] = len(models)
        models.append(model)
    combination = combination.reshape(-1)
    refused = {row: failed[i] for row, i in enumerate(combination.tolist()) if i in failed}
    return models, number[combination], refused


def _variants(
    values: Mapping[str, Floats], models: Sequence[Lowered], model_of: NDArray[np.int64]
) -> TreeVariants:
    """The kernel's arrays: what each model has, with masses and factors."""
    count = model_of.size
    velocity = np.stack([model.start.velocity for model in models])[model_of]
    impulse = np.stack([model.start.impulse for model in models])[model_of]
    bodies = None
    masses = {name: column for name, column in values.items() if name.startswith("masses.") and _quick(name)}
    if masses:
        raw = np.stack([raw_mass(model) for model in models])[model_of]
        for name, column in masses.items():
            steps = np.stack([_per_kilogram(model, name) for model in models])
            since = np.array([value_at(model.structure, name) for model in models])
            raw += (column - since[model_of])[:, None, None] * steps[model_of]
        bodies, velocity, impulse = tree_arrays(raw)
    velocity *= values.get("initial_velocity", np.ones(count))[:, None, None]
    impulse *= values.get("impulses", np.ones(count))[:, None, None]
    base = models[0]
    scale = np.ones((count, len(base.hinges)))
    for k, (name, _) in enumerate(base.hinges):
        scale[:, k] = values.get(f"hinges.{name}.capacity", 1.0)
    loads = np.ones((count, len(base.tree.loads))) * values.get("loads", np.ones(count))[:, None]
    gravity = np.stack([model.tree.gravity for model in models])[model_of]
    gravity = gravity * values.get("gravity", np.ones(count))[:, None]
    trees = [model.tree for model in models]
    return TreeVariants(trees, model_of, velocity, impulse, scale, loads, bodies, gravity)


def _per_kilogram(model: Lowered, name: str) -> RawMass:
    """What one more kilogram of a lump adds to mass, moments and momentum, which are linear in it."""
    since = value_at(model.structure, name)
    more = lowered(changed(model.structure, {name: since + 1.0}), 1.0)
    step: RawMass = raw_mass(more) - raw_mass(model)
    return step


def _poll(progress: Progress | None, cancel: Cancel | None) -> Callable[[float], bool] | None:
    if progress is None and cancel is None:
        return None

    def poll(share: float) -> bool:
        if progress is not None:
            progress(share)
        return not (cancel is not None and cancel())

    return poll


def _outcomes(
    finals: TreeFinals, refused: Mapping[int, str], bound: float
) -> tuple[tuple[Status, ...], tuple[str, ...]]:
    status, reason = [], []
    for row, (code, residual) in enumerate(zip(finals.outcome, finals.residual, strict=True)):
        outcome = Outcome(int(code))
        nonsense = "masses, inertias and capacities must be positive, and every value finite"
        state, why = outcome_status(outcome, nonsense if outcome is Outcome.REFUSED else "", residual, bound)
        if row in refused:
            state, why = Status.REFUSED, refused[row]
        status.append(state)
        reason.append(why)
    return tuple(status), tuple(reason)


def _quantities(
    models: Sequence[Lowered], model_of: NDArray[np.int64], finals: TreeFinals, run: Run
) -> dict[str, Floats]:
    """Final quantities of all variants, model by model."""
    found: dict[str, Floats] = {}
    order = np.argsort(model_of, kind="stable")
    ends = np.searchsorted(model_of[order], np.arange(len(models) + 1))
    for i, model in enumerate(models):
        rows = order[ends[i] : ends[i + 1]]
        if rows.size == 0:
            continue
        for name, column in final_quantities(model, part_of(finals, rows), run.outputs).items():
            found.setdefault(name, np.zeros(model_of.size))[rows] = column
    return found
