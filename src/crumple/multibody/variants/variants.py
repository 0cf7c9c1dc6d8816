"""Many variants of one structure in one call: a table of the final values of each.

A parameter is a path in the input (``materials.steel.yield_stress``, ``sections.tube.thickness``,
``masses.payload.mass``) with one value per variant, or one of the factors ``initial_velocity``, ``impulses``,
``loads``, ``gravity`` and ``hinges.NAME.capacity``, which multiply what the structure has.

Factors and masses only scale arrays of the kernel, so they cost nothing.  Every other distinct
combination of values is lowered once, with its laws sampled again.  The kernel then solves all variants
without Python in between.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crumple._core.outcome import Outcome
from crumple.errors import CancelledError, InputError, Problem, Status
from crumple.multibody.answer.end_values import OF_NODES
from crumple.multibody.answer.solved import Poll
from crumple.multibody.kernel_choice import why_spatial
from crumple.multibody.run import Cancel, Progress, Run, outcome_status, output_times
from crumple.multibody.variants.batch import (
    Batch,
    Case,
    EndValues,
    PlanarBatch,
    SpatialBatch,
    hinge_names,
    samples_of,
)
from crumple.multibody.variants.factors import checked_names, quick
from crumple.numeric.arrays import Floats
from crumple.portable import available_cores
from crumple.result.tables import imported_pandas
from crumple.structure import Structure, changed, placed_hinges, with_elastic_members

if TYPE_CHECKING:
    import pandas as pd

REASONS = {
    Outcome.REFUSED: "masses, inertias and capacities must be positive, and every value finite",
    Outcome.STEP_COLLAPSED: "the equations of a step did not converge at the smallest step",
    Outcome.NOT_FINITE: "the position of a body is not a number",
    Outcome.UNHELD: "loads or gravity move it in a quasi-static stage without resistance",
    Outcome.STALLED: "the run hardly advanced any more",
    Outcome.LIMIT_LOAD: "loads or gravity exceed the limit load of the structure in a quasi-static stage",
}

OTHER_PARTS = "these values connect other parts than in the structure"
"""Why a variant is refused that has other bodies and joints: as a structure of its own it can be solved."""
PREPARED = 0.5
"""Share of the progress that is the preparation of variants with laws of their own, which has one thread."""


@dataclass(frozen=True, eq=False)
class VariantTable:
    """Final values of every variant; n rows.

    Attributes
    ----------
    parameters
        The values that were asked for, (n,) each.
    quantities
        Final values by channel name, (n,) each; NaN, which stands for no value, in rows that were refused.
        ``hinge.NAME.`` rotation, plastic_rotation, moment, capacity, energy, rotation_max, moment_max, and of
        a hinge with several components each of them; ``energy.`` kinetic, elastic, dissipated,
        external_work, with obstacles also contact and friction; ``node.NAME.displacement.x`` and
        ``node.NAME.rotation.x`` of the nodes asked for; section rotations, distances and clearances asked
        for; ``energy_residual``.
    status
        How each variant ended.
    reason
        Why, where it did not reach its end.
    times, histories
        Times that were asked for [s], (m,), and the same quantities at them, (n, m) each, without the largest
        values and with ``node.NAME.velocity.x`` of the nodes asked for; NaN at times that a variant did not
        reach.
    """

    parameters: Mapping[str, Floats]
    quantities: Mapping[str, Floats]
    status: tuple[Status, ...]
    reason: tuple[str, ...]
    times: Floats = field(default_factory=lambda: np.empty(0))
    histories: Mapping[str, Floats] = field(default_factory=dict)

    def __len__(self) -> int:
        """Number of variants."""
        return len(self.status)

    def __getitem__(self, name: str) -> Floats:
        """A quantity or a parameter by name."""
        return self.quantities[name] if name in self.quantities else self.parameters[name]

    def need_all(self, what: str) -> None:
        """Refuse rows that were not solved because the caller cancelled: they say nothing of their variants.

        Raises
        ------
        CancelledError
            If there are any; `what` is not known then.
        """
        if Status.CANCELLED in self.status:
            raise CancelledError(f"cancelled while the variants were solved: {what} not known")

    def to_pandas(self) -> pd.DataFrame:
        """One row per variant in SI units: parameters, quantities, status and reason.

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        pandas = imported_pandas()
        ended = {"status": [status.value for status in self.status], "reason": list(self.reason)}
        found: pd.DataFrame = pandas.DataFrame({**self.parameters, **self.quantities, **ended})
        return found


def solve_variants(
    structure: Structure,
    run: Run,
    parameters: Mapping[str, ArrayLike],
    threads: int | None = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
    *,
    times: ArrayLike = (),
    as_answer: bool = False,
    guided: bool = False,
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
        Number of threads; None for as many as there are cores for this process.  Results do not depend on it.
    progress, cancel
        As in `solve_multibody`; variants not begun when cancelled have that status.  The first `PREPARED` of
        the progress is the preparation of variants that change more than factors and masses.
    times
        Increasing times [s] at which quantities are wanted too.  In a plane and in quasi-static stages steps
        end at them, so that final values differ from those without them within the accuracy.
    as_answer
        Take the steps of the answer of `solve_multibody`, at a quarter of the accuracy and ending at the
        outputs where its do: a variant without changes has its bits.  `times` must then be left out.
    guided
        In space, the first variant leads: the others take the lengths of its steps and the starts of their
        solution.  This takes half to two thirds of the time and is for variants near it.

    Returns
    -------
    VariantTable
        A variant that cannot be built or solved is a row with its status and reason.

    Raises
    ------
    InputError
        If the structure itself cannot be solved, or a parameter does not exist.
    CancelledError
        If it is cancelled while the variants are prepared: there are no rows yet.

    Notes
    -----
    Each variant is solved once, at the accuracy of the settings; `solve_multibody` solves a second time at a
    quarter of it to state an error.  In space a variant that cannot go on is repeated as there.  All have
    the kernel that the structure itself gets, in space with its stages.  Rows have the bits of a single run
    of the kernel with the same arrays; masses enter these arrays to rounding as they do in
    `solve_multibody`.

    References
    ----------
    docs/theory/variants.md.  Verified in tests/unit/multibody/variants/test_variants.py.
    """
    structure = with_elastic_members(structure, run.settings, run.time_in_motion)
    count = threads or available_cores()
    poll = _poll(progress, cancel)
    sampled = np.asarray(times, float)
    planar = why_spatial(structure, placed_hinges(structure), run) is None
    batch = (PlanarBatch if planar else SpatialBatch)(run, as_answer=as_answer, guided=guided)
    return _table(batch, structure, parameters, count, poll, sampled)


def _table(
    batch: Batch,
    structure: Structure,
    parameters: Mapping[str, ArrayLike],
    threads: int,
    poll: Poll | None,
    times: Floats,
) -> VariantTable:
    base = batch.case(structure)
    values = _columns(structure, hinge_names(base), parameters)
    cases, case_of, refused = _cases(batch, structure, values, base, poll)
    solving = _later(poll, PREPARED) if len(cases) > 1 else poll
    stops = output_times(batch.run)[1:] if batch.as_answer else times
    ends = batch.solve(values, cases, case_of, threads, solving, times=stops.tolist())
    bound = batch.run.settings.energy_residual_bound
    status, reason = _outcomes(ends.outcome, ends.residual, refused, bound)
    quantities = batch.quantities(cases, case_of, ends)
    lost = np.array([state is Status.REFUSED for state in status])
    for column in quantities.values():
        column[lost] = np.nan
    histories = _histories(batch, cases, case_of, ends, times) if times.size else {}
    for column in histories.values():
        column[lost] = np.nan
        column[ends.time[:, None] < times * (1.0 - 1e-12)] = np.nan
    return VariantTable(values, quantities, status, reason, times, histories)


def _columns(
    structure: Structure, hinges: Sequence[str], parameters: Mapping[str, ArrayLike]
) -> dict[str, Floats]:
    """One array per parameter, all of the same length."""
    values = {name: _column(name, given) for name, given in parameters.items()}
    count = max((column.size for column in values.values()), default=0)
    problems = []
    for name, column in values.items():
        if column.ndim != 1 or column.size not in (1, count):
            allowed = f"one value, or {count} as the longest has"
            problems.append(Problem("parameters differ in length", f"{column.shape}", allowed, "", name))
    if count == 0:
        what, todo = "no parameter is varied", "give at least one"
        problems.append(Problem(what, "", "a path of the input, or a factor", todo, "parameters"))
    if problems:
        raise InputError(problems)
    checked_names(structure, hinges, list(values))
    return {name: np.broadcast_to(column, (count,)).copy() for name, column in values.items()}


def _column(name: str, given: ArrayLike) -> Floats:
    try:
        return np.atleast_1d(np.asarray(given, float))
    except (TypeError, ValueError):
        allowed, todo = "numbers, in SI units", "solve structures that differ in words one by one"
        raise InputError(Problem("a parameter is not a number", repr(given), allowed, todo, name)) from None


def _cases(
    batch: Batch, structure: Structure, values: Mapping[str, Floats], base: Case, poll: Poll | None
) -> tuple[list[Case], NDArray[np.int64], dict[int, str]]:
    """A case for every distinct combination of slow parameters, the case of each variant, and refusals."""
    count = len(next(iter(values.values())))
    slow = [name for name in values if not quick(name)]
    if not slow:
        return [base], np.zeros(count, np.int64), {}
    moved = any(name.startswith("nodes.") for name in slow)
    rows = np.stack([values[name] for name in slow], axis=1)
    distinct, combination = np.unique(rows, axis=0, return_inverse=True)
    cases, number, failed = [base], np.zeros(len(distinct), np.int64), {}
    for i, combined in enumerate(distinct):
        if poll is not None and not poll(PREPARED * i / len(distinct)):
            raise CancelledError("cancelled while the variants were prepared: none was solved")
        try:
            new = changed(structure, dict(zip(slow, map(float, combined), strict=True)))
            case = batch.case(new, moved=moved)
            if case.topology != base.topology:
                raise InputError(OTHER_PARTS)
        except InputError as error:
            failed[i] = str(error)
            continue
        number[i] = len(cases)
        cases.append(case)
    combination = combination.reshape(-1)
    refused = {row: failed[i] for row, i in enumerate(combination.tolist()) if i in failed}
    return cases, number[combination], refused


def _poll(progress: Progress | None, cancel: Cancel | None) -> Callable[[float], bool] | None:
    if progress is None and cancel is None:
        return None

    def poll(share: float) -> bool:
        if progress is not None:
            progress(share)
        return not (cancel is not None and cancel())

    return poll


def _later(poll: Poll | None, begun: float) -> Poll | None:
    """A poll whose share done begins at this one."""
    return None if poll is None else lambda share: poll(begun + (1.0 - begun) * share)


def _outcomes(
    outcomes: NDArray[np.int64], residuals: Floats, refused: Mapping[int, str], bound: float
) -> tuple[tuple[Status, ...], tuple[str, ...]]:
    status, reason = [], []
    for row, (code, residual) in enumerate(zip(outcomes, residuals, strict=True)):
        outcome = Outcome(int(code))
        state, why = outcome_status(outcome, REASONS.get(outcome, ""), residual, bound)
        if row in refused:
            state, why = Status.REFUSED, refused[row]
        status.append(state)
        reason.append(why)
    return tuple(status), tuple(reason)


def _histories(
    batch: Batch, cases: Sequence[Case], case_of: NDArray[np.int64], ends: EndValues, times: Floats
) -> dict[str, Floats]:
    """Quantities at the times of samples, (n, times) each; the largest values of whole runs are left out."""
    rows = samples_of(ends, times.size)
    found = batch.quantities(cases, np.repeat(case_of, times.size), rows, (*OF_NODES, "velocity"))
    return {
        name: column.reshape(-1, times.size)
        for name, column in found.items()
        if not name.endswith(("_max", "energy_residual"))
    }
