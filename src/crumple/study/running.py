"""A study from its file to its answer: points, rows, and what they say."""

from __future__ import annotations

import gc
import hashlib
import json
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path

from crumple.analysis import Analysis
from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats
from crumple.processes import process_pool
from crumple.study.answer import Answer, derived_columns, write_front
from crumple.study.methods.asking import GROUP, asked
from crumple.study.methods.points import sampled
from crumple.study.parts import MergedModel, part_file, part_of, part_table
from crumple.study.rows import (
    BatchModel,
    FunctionModel,
    LayoutModel,
    Model,
    ProcessModel,
    batched,
    changed_laws,
    layout_place,
)
from crumple.study.setting import Setting, setting_for, setting_of
from crumple.study.space import Axis
from crumple.study.study_file import LAYOUT, LoadedStudy, Study
from crumple.study.table import CSV, FILE, FRONT, VERIFY_FILE, Table, unwatched, write_csv
from crumple.study.verify import chosen_rows, verification

Function = Callable[[Mapping[str, Floats]], Mapping[str, Floats]]
AT_ONCE = 64
"""Rows that are given to a slow model at a time; each is kept as soon as it is known."""


def run_study(
    study: LoadedStudy,
    out: Path,
    workers: int = 1,
    *,
    executor: Executor | None = None,
    progress: Callable[[float], None] | None = None,
    merge: bool = False,
) -> tuple[Table, Answer]:
    """Solve a study; rows that its folder holds already are not solved again.

    Parameters
    ----------
    study
        With its base.
    out
        Folder of ``study.sqlite``, ``study.csv`` and ``study.json``.
    workers
        Threads of the batch kernels, or processes; rows do not depend on it.
    executor
        Solves rows that batches cannot; None for processes of this machine.
    progress
        Called with the share of the rows that is known.
    merge
        Take the rows of the parts in the folder, see `run_part`, instead of solving them.

    Returns
    -------
    tuple
        All rows, closed, and what they say.

    Raises
    ------
    InputError
        If the study cannot be solved as it is; failures of rows are rows.
    """
    setting = setting_of(study)
    with study.lines():
        if merge:
            table, answer = _run(setting, MergedModel(setting, out), out, progress)
        else:
            with _model(setting, study, workers, executor) as model:
                table, answer = _run(setting, model, out, progress)
        if setting.study.verify is not None:
            with _model(setting, study, workers, executor, slow=True) as slow:
                answer = _verified(setting, slow, table, answer, out, progress)
        if setting.study.fidelity == "multibody":
            bases = {name: base.analysis for name, base in study.bases.items()}
            answer = replace(answer, law_changes=changed_laws(setting.axes, table.points, bases))
        _write(setting, table, answer, out)
    return table, answer


def run_part(
    study: LoadedStudy,
    out: Path,
    part: tuple[int, int],
    workers: int = 1,
    *,
    executor: Executor | None = None,
    progress: Callable[[float], None] | None = None,
) -> tuple[int, int]:
    """Solve one of several equal parts of a study into a file of its own; rows it holds are not solved again.

    Parameters
    ----------
    study, out, workers, executor, progress
        As in `run_study`.
    part
        Which part, from 1, of how many.

    Returns
    -------
    tuple
        Number of rows of the part, and of those that were solved now.

    Raises
    ------
    InputError
        If the method does not know its points beforehand, or as in `run_study`.
    """
    setting = setting_of(study)
    with study.lines():
        points = part_of(setting, part)
        part_file(out, part).parent.mkdir(parents=True, exist_ok=True)
        with _model(setting, study, workers, executor) as model:
            table = part_table(setting, model, out, part)
            try:
                table.solve_in_groups(points, GROUP, progress or unwatched)
            finally:
                table.close()
    return len(points), table.solved


def check_study(study: LoadedStudy) -> None:
    """Refuse what `run_study` would refuse before its first row.

    Raises
    ------
    InputError
        With file and line.
    """
    setting = setting_of(study)
    if setting.study.verify is not None:
        with study.lines():
            _refuse_factors([axis for axis in setting.axes if axis.places != (LAYOUT,)], "verify")
    kind = setting.study.method.type
    if kind not in {"optimise", "lightest", "sobol_indices"}:
        with study.lines():
            sampled(setting.axes, setting.study.method, setting.folder)


def study_of(
    function: Function, study: Study, out: Path | None = None, *, slow: Function | None = None
) -> tuple[Table, Answer]:
    """Solve a study of a function instead of a structure.

    Parameters
    ----------
    function
        Columns of variables to columns of responses, (n,) each; what is not finite is a failed row.
    study
        Without base; all its quantities are plain numbers.
    out
        As in `run_study`; None keeps the rows in memory.
    slow
        Slower function that verifies rows.
    """
    setting = setting_for(study, Path(), None, None)
    table, answer = _run(setting, FunctionModel(function, setting.axes, setting.measured), out, None)
    if slow is not None and study.verify is not None:
        model = FunctionModel(slow, setting.axes, setting.measured)
        answer = _verified(setting, model, table, answer, out, None)
    _write(setting, table, answer, out)
    return table, answer


@contextmanager
def _model(
    setting: Setting, study: LoadedStudy, workers: int, executor: Executor | None, *, slow: bool = False
) -> Iterator[Model]:
    """What solves the rows, or verifies them: of each base one, if a variable chooses among several."""
    made, place = _slow_model if slow else _fast_model, layout_place(setting.axes)
    if place is None:
        with made(setting, study.base.analysis, workers, executor) as model:
            yield model
        return
    own = replace(setting, axes=[axis for k, axis in enumerate(setting.axes) if k != place])
    with ExitStack() as stack:
        models = {
            name: stack.enter_context(made(own, base.analysis, workers, executor))
            for name, base in study.bases.items()
        }
        yield LayoutModel(place, models)


@contextmanager
def _fast_model(setting: Setting, base: Analysis, workers: int, executor: Executor | None) -> Iterator[Model]:
    """Batches if all variables and responses are among what they take and give, else processes."""
    axes, measured, fidelity = setting.axes, setting.measured, setting.study.fidelity
    if executor is not None:
        yield ProcessModel(base, fidelity, axes, measured, executor, workers)
    elif fidelity == "multibody" and all(axis.numeric for axis in axes) and batched(base, measured):
        from crumple.multibody.variants.factors import quick  # noqa: PLC0415  (needs the kernels)

        if workers == 1 or all(quick(place) for axis in axes for place in axis.places):
            yield BatchModel(base, axes, measured, workers)
            return
        with process_pool(workers) as pool:
            yield BatchModel(base, axes, measured, workers, pool)
    else:
        if fidelity != "multibody" or not batched(base, measured):
            _refuse_factors(axes, "variables")
        with process_pool(workers) as pool:
            yield ProcessModel(base, fidelity, axes, measured, pool, workers)


def _refuse_factors(axes: list[Axis], where: str) -> None:
    """Refuse factors, which only batches take."""
    places = [place for axis in axes for place in axis.places]
    factors = [place for place in places if "." not in place or place.startswith("hinges.")]
    if factors:
        what = "a factor is possible only where batches give all responses"
        todo = "vary paths of the input, or reduce the responses"
        if where == "verify":
            what, todo = "single runs that verify rows take no factors", "vary paths of the input"
        raise InputError(Problem(what, factors[0], "", todo, where))


def _run(
    setting: Setting, model: Model, out: Path | None, progress: Callable[[float], None] | None
) -> tuple[Table, Answer]:
    path = None if out is None else out / FILE
    names = [one.name for one in setting.measured]
    table = Table(setting.axes, names, model, path, setting.identity)
    try:
        with _frozen():
            answer = asked(setting, table, progress or unwatched)
    finally:
        table.close()
    return table, answer


@contextmanager
def _frozen() -> Iterator[None]:
    """Leave what there is out of garbage collections: many small rows would make these search all of it."""
    own = gc.get_freeze_count() == 0
    if own:
        gc.freeze()
    try:
        yield
    finally:
        if own:
            gc.unfreeze()


def _write(setting: Setting, table: Table, answer: Answer, out: Path | None) -> None:
    table.derived = derived_columns(setting.study, table)
    if out is not None:
        write_csv(table, table.derived, out / CSV)
        text = json.dumps(answer.plain(), indent=2, allow_nan=False)
        (out / "study.json").write_text(text + "\n", encoding="utf-8")
        write_front(answer, out / FRONT)


@contextmanager
def _slow_model(setting: Setting, base: Analysis, workers: int, executor: Executor | None) -> Iterator[Model]:
    """What verifies rows: single runs in processes."""
    assert setting.study.verify is not None
    _refuse_factors(setting.axes, "verify")
    given = base, setting.study.verify.fidelity, setting.axes, setting.measured
    if executor is not None:
        yield ProcessModel(*given, executor, workers)
        return
    with process_pool(workers) as pool:
        yield ProcessModel(*given, pool, workers)


def _verified(
    setting: Setting,
    model: Model,
    table: Table,
    answer: Answer,
    out: Path | None,
    progress: Callable[[float], None] | None,
) -> Answer:
    """The answer with its verification; slow rows have a file of their own, which is resumed likewise."""
    study, verify = setting.study, setting.study.verify
    assert verify is not None
    chosen = chosen_rows(study, verify, table, setting.limits)
    path = None if out is None else out / VERIFY_FILE
    names = [one.name for one in setting.measured]
    identity = hashlib.sha256(f"{setting.identity} {verify.fidelity}".encode()).hexdigest()
    numbers = [*chosen[0], *chosen[1]]
    slow = Table(setting.axes, names, model, path, identity, by_point=True)
    try:
        slow.solve_in_groups([table.points[i] for i in numbers], AT_ONCE, progress or unwatched)
    finally:
        slow.close()
    return replace(answer, verification=verification(study, table, slow, setting.slow_limits, chosen))
