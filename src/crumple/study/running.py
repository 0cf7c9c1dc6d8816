"""A study from its file to its answer: points, rows, and what they say."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from crumple.analysis import Analysis, input_hash, solve
from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats, Integers
from crumple.processes import process_pool
from crumple.structure.schema.problems import one_of, suggestion
from crumple.study.answer import Answer, answer_of, derived_columns, sobol_answer, violation_of
from crumple.study.models import BatchModel, FunctionModel, Measured, Model, ProcessModel
from crumple.study.optimise import optimise
from crumple.study.points import blocks, sampled
from crumple.study.space import Axis, axes_of, number
from crumple.study.study_file import LoadedStudy, Study, refuse_contradictions
from crumple.study.table import CSV, FILE, Table, write_csv

Function = Callable[[Mapping[str, Floats]], Mapping[str, Floats]]
GROUP = 10_000
"""Points that are given to a model at a time: progress and cancellation are looked at in between."""
SPARE = 20
"""One block in so many may fail before Sobol' indices are not stated."""


@dataclass(frozen=True)
class Setting:
    """A study with all quantities in SI.

    Attributes
    ----------
    study
        As described.
    axes, measured
        Variables, and responses that are read from results.
    limits
        Of each constraint: response, lower limit and upper limit.
    units
        SI unit of each response; "1" if it has none.
    folder
        That file names are relative to.
    identity
        Hash of study and base.
    """

    study: Study
    axes: list[Axis]
    measured: list[Measured]
    limits: list[tuple[str, float, float]]
    units: Mapping[str, str]
    folder: Path
    identity: str


def run_study(
    study: LoadedStudy,
    out: Path,
    workers: int = 1,
    *,
    executor: Executor | None = None,
    progress: Callable[[float], None] | None = None,
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

    Returns
    -------
    tuple
        All rows, closed, and what they say.

    Raises
    ------
    InputError
        If the study cannot be solved as it is; failures of rows are rows.
    """
    setting = _setting_of(study)
    with study.lines(), _model(setting, study.base.analysis, workers, executor) as model:
        return _run(setting, model, out, progress)


def check_study(study: LoadedStudy) -> None:
    """Refuse what `run_study` would refuse before its first row.

    Raises
    ------
    InputError
        With file and line.
    """
    setting = _setting_of(study)
    kind = setting.study.method.type
    if kind not in {"optimise", "sobol_indices"}:
        with study.lines():
            sampled(setting.axes, setting.study.method, setting.folder)


def _setting_of(study: LoadedStudy) -> Setting:
    with study.lines():
        return _setting(study.study, study.folder, study.base.analysis, study.base.document.data)


def study_of(function: Function, study: Study, out: Path | None = None) -> tuple[Table, Answer]:
    """Solve a study of a function instead of a structure.

    Parameters
    ----------
    function
        Columns of variables to columns of responses, (n,) each; what is not finite is a failed row.
    study
        Without base; all its quantities are plain numbers.
    out
        As in `run_study`; None keeps the rows in memory.
    """
    setting = _setting(study, Path(), None, None)
    return _run(setting, FunctionModel(function, setting.axes, setting.measured), out, None)


def _setting(study: Study, folder: Path, base: Analysis | None, document: object | None) -> Setting:
    refuse_contradictions(study)
    axes = axes_of(study, document)
    units = dict.fromkeys(study.responses, "1")
    if base is not None:
        units |= _units(study, base)
    measured = [
        Measured(
            name,
            response.channel if base is not None else name,
            response.take,
            0.0 if response.time is None else number(response.time, "s", f"responses.{name}.time"),
        )
        for name, response in study.responses.items()
        if not response.formula
    ]
    limits = []
    for i, limit in enumerate(study.constraints):
        unit, where = units[limit.response], f"constraints.{i}"
        low = -np.inf if limit.at_least is None else number(limit.at_least, unit, f"{where}.at_least")
        high = np.inf if limit.at_most is None else number(limit.at_most, unit, f"{where}.at_most")
        limits.append((limit.response, low, high))
    content = study.model_dump_json(exclude={"base", "title"})
    content += "" if base is None else input_hash(base)
    identity = hashlib.sha256(content.encode()).hexdigest()
    return Setting(study, axes, measured, limits, units, folder, identity)


def _units(study: Study, base: Analysis) -> dict[str, str]:
    """Units of responses by the channels of the base, solved as a multibody model."""
    found, result = {}, solve(base)
    for name, response in study.responses.items():
        if response.mass:
            found[name] = "kg"
        elif response.channel:
            channel = result.channels.get(response.channel)
            if channel is None:
                known = sorted(result.channels)
                todo = suggestion(response.channel, known) or "name a channel of the result"
                what, where = "the result has no such channel", f"responses.{name}.channel"
                raise InputError(Problem(what, response.channel[:80], one_of(known), todo, where))
            found[name] = channel.unit
    return found


@contextmanager
def _model(setting: Setting, base: Analysis, workers: int, executor: Executor | None) -> Iterator[Model]:
    """Batches if all variables and responses are among what they take and give, else processes."""
    axes, measured, fidelity = setting.axes, setting.measured, setting.study.fidelity
    if executor is not None:
        yield ProcessModel(base, fidelity, axes, measured, executor, workers)
    elif fidelity == "multibody" and _batched(axes, measured, base):
        yield BatchModel(base, axes, measured, workers)
    else:
        places = [place for axis in axes for place in axis.places]
        factors = [place for place in places if "." not in place or place.startswith("hinges.")]
        if factors:
            what = (
                "a factor is possible only where all responses are final values or largest values of hinges"
            )
            todo = "vary paths of the input, or reduce the responses"
            raise InputError(Problem(what, factors[0], "", todo, "variables"))
        with process_pool(workers) as pool:
            yield ProcessModel(base, fidelity, axes, measured, pool, workers)


def _batched(axes: list[Axis], measured: list[Measured], base: Analysis) -> bool:
    filtered = set(base.outputs.filters)
    return all(axis.numeric for axis in axes) and all(
        one.quantity is not None and one.channel not in filtered for one in measured
    )


def _run(
    setting: Setting, model: Model, out: Path | None, progress: Callable[[float], None] | None
) -> tuple[Table, Answer]:
    path = None if out is None else out / FILE
    names = [one.name for one in setting.measured]
    table = Table(setting.axes, names, model, path, setting.identity)
    try:
        answer = _asked(setting, table, progress or (lambda share: None))
    finally:
        table.close()
    if out is not None:
        write_csv(table, derived_columns(setting.study, table), out / CSV)
        text = json.dumps(answer.plain(), indent=2, allow_nan=False)
        (out / "study.json").write_text(text + "\n", encoding="utf-8")
    return table, answer


def _asked(setting: Setting, table: Table, progress: Callable[[float], None]) -> Answer:
    """Ask for the rows of the method, and say what they are."""
    study, method = setting.study, setting.study.method
    more: dict[str, Any] = {}
    if method.type == "sobol_indices":
        more["indices"] = _indices(setting, table)
    elif method.type == "optimise":

        def judged(points: list[Any]) -> tuple[Floats, Floats]:
            first = len(table.points)
            table.solve(points)
            progress(min(len(table.points) / method.rows, 1.0))
            return violation_of(study, table, setting.limits, first)

        optimise(setting.axes, judged, method.rows, method.seed)
    else:
        points = sampled(setting.axes, method, setting.folder)
        for first in range(0, len(points), GROUP):
            table.solve(points[first : first + GROUP])
            progress(min((first + GROUP) / len(points), 1.0))
    return answer_of(study, table, setting.limits, setting.units, **more)


def _indices(setting: Setting, table: Table) -> dict[str, Any] | str:
    """Sobol' indices; failed blocks are dropped and replaced by further ones of the sequence."""
    method, size = setting.study.method, len(setting.axes)
    count = method.rows
    if count & (count - 1):
        what, todo = "the number of blocks must be a power of 2", "write 256, 512, 1024, ..."
        raise InputError(Problem(what, str(count), "1, 2, 4, 8, ...", todo, "method.rows"))

    def ask(first: int, number: int) -> Integers:
        a, b, mixed = blocks(setting.axes, first, number, method.seed)
        table.solve([*a, *b, *(point for one in mixed for point in one)])
        return (
            np.arange(len(table.points) - number * (size + 2), len(table.points))
            .reshape(-1, number)
            .astype(np.int64)
        )

    rows = ask(0, count)
    failed = int(np.sum(~table.ok[rows].all(axis=0)))
    if SPARE * failed > count:
        return f"{failed} of {count} blocks contain a failed row, more than 5 %: no indices"
    if failed:
        rows = np.concatenate([rows, ask(count, max(count // SPARE, 1))], axis=1)
    good = rows[:, table.ok[rows].all(axis=0)][:, :count]
    if good.shape[1] < count:
        return "too many blocks contain a failed row: no indices"
    return sobol_answer(setting.study, table, good)
