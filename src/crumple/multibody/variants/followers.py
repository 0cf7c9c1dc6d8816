"""Derivatives of the final quantities of a run in space, from runs close above and below that take its steps.

Every parameter gives two variants, moved either way by a small step, which follow the run of the structure
itself (`solve_many` with a leader).  Half their difference over the step is the derivative.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from crumple._core.outcome import Outcome
from crumple._core.spatial.model import SpatialModel
from crumple.errors import InputError, Problem
from crumple.multibody.answer.solved import Poll
from crumple.multibody.run import Run
from crumple.multibody.variants.batch import Batch, Case, hinge_names, part_of
from crumple.multibody.variants.factors import checked_names, is_factor
from crumple.multibody.variants.moved import Moved, MovedEnds, cases_beside, factor_step, step_of
from crumple.numeric.arrays import Floats
from crumple.portable import available_cores
from crumple.structure import Structure

RELATIVE_STEP = 1e-5
"""By this share of its value a parameter is moved either way.  Ten times more, and hinges of followers pass
kinks that the leader does not; a hundred times less, and rounding shows."""
SMOOTH = 1e3
"""Largest change of a surface coefficient over the parameter's step; above it the fit has changed."""
SHORTER, MOST_TRIES = 0.3, 5
"""Number of times that a step is shortened if the number of samples of a law changes in it."""


@dataclass
class _Rows:
    """Variants by row: the structure itself, then each parameter above and below its value."""

    cases: list[Case]
    case_of: list[int] = field(default_factory=lambda: [0])
    moved: list[tuple[str, float]] = field(default_factory=list)
    """For every row but the first: a factor and its value, or no name."""
    widths: list[float] = field(default_factory=list)

    def add(self, case: int, name: str = "", value: float = 1.0) -> None:
        """One more row."""
        self.case_of.append(case)
        self.moved.append((name, value))


def spatial_ends(
    batch: Batch, structure: Structure, steps: Mapping[str, float | None], poll: Poll | None
) -> MovedEnds:
    """Final values of a run in space, and of its followers with each parameter changed.

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
        If a parameter does not exist or cannot be moved, or the run has contact, stages that end on
        conditions, or quasi-static ones.
    """
    _refuse_events(structure, batch.run)
    base = batch.case(structure)
    checked_names(structure, hinge_names(base), list(steps))
    rows = _Rows([base])
    for name, step in steps.items():
        _move(batch, base, rows, name, step)
    case_of = np.array(rows.case_of)
    threads = available_cores()
    found = batch.solve(_values(rows), rows.cases, case_of, threads, poll, led=True)
    ends = []
    for row, number in enumerate(rows.case_of):
        alone = part_of(found, np.array([row]))
        of_row = batch.quantities([rows.cases[number]], np.zeros(1, np.int64), alone)
        ends.append({key: float(column[0]) for key, column in of_row.items()})
        if found.outcome[row] != Outcome.COMPLETE and row > 0:
            ends[-1] = dict.fromkeys(ends[-1], np.nan)
    moved = {name: Moved(ends[1 + 2 * k], ends[2 + 2 * k], rows.widths[k]) for k, name in enumerate(steps)}
    return MovedEnds(ends[0], moved, Outcome(int(found.outcome[0])), "", float(found.residual[0]))


def _refuse_events(structure: Structure, run: Run) -> None:
    """Refuse what makes the steps of a run depend on the time of an event."""
    why = None
    if structure.obstacles or structure.member_contact is not None:
        why = "contact: the time of an impact moves with the parameter, and velocities jump there"
    elif any(stage.until for stage in run.stages):
        why = "stages that end on a condition: their end moves with the parameter"
    elif any(stage.kind == "quasi-static" for stage in run.stages):
        why = "quasi-static stages: a millionth of the inertia leaves too few digits to derivatives"
    if why is not None:
        todo = "take differences of `solve_variants`"
        raise InputError(Problem("sensitivities follow a run at fixed times", why, "runs without", todo))


def _move(batch: Batch, base: Case, rows: _Rows, name: str, step: float | None) -> None:
    """Two rows for a parameter."""
    if is_factor(name):
        step = factor_step(name, step, RELATIVE_STEP)
        for end in (1.0 + step, 1.0 - step):
            rows.add(0, name, end)
        rows.widths.append(2.0 * step)
        return
    step = step_of(base, name, step, RELATIVE_STEP)
    for _ in range(MOST_TRIES):
        ends = cases_beside(batch, base, name, step)
        if all(_alike(base.model, end.model) for end in ends):
            break
        step *= SHORTER
    else:
        what, todo = (
            "a law is sampled or a surface fitted otherwise however little this parameter moves",
            "give another step",
        )
        raise InputError(Problem(what, name, "", todo, name))
    for case in ends:
        rows.add(len(rows.cases))
        rows.cases.append(case)
    rows.widths.append(2.0 * step)


def _alike(base: SpatialModel, moved: SpatialModel) -> bool:
    """Whether curves have equally many samples and surfaces the same fit, so that both change smoothly."""
    if _sizes(base) != _sizes(moved):
        return False
    pairs = zip(base.hinges, moved.hinges, strict=True)
    return all(
        np.abs(a.surface.rows - b.surface.rows).max(initial=0.0) < SMOOTH * RELATIVE_STEP for a, b in pairs
    )


def _sizes(model: SpatialModel) -> tuple[object, ...]:
    curves = [
        (part.positive[0].size, part.negative[0].size) for hinge in model.hinges for part in hinge.components
    ]
    surfaces = [np.shape(hinge.surface.rows) for hinge in model.hinges]
    times = [load.times.size for load in model.loads] + [drive.times.size for drive in model.drives]
    return (*curves, *surfaces, *times)


def _values(rows: _Rows) -> dict[str, Floats]:
    """Factors row by row: 1 except in the rows that change them."""
    values: dict[str, Floats] = {}
    for row, (name, value) in enumerate(rows.moved, start=1):
        if not name:
            continue
        values.setdefault(name, np.ones(len(rows.case_of)))[row] = value
    return values
