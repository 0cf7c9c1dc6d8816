"""From one analysis to a comparison: both engines, further multibody models, time taken."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from crumple.analysis import Analysis, input_hash, solve
from crumple.comparison.comparing import compare
from crumple.comparison.comparison import Comparison, Timing
from crumple.comparison.measure.sections import at_times
from crumple.comparison.rating.curve_file import CurveFile
from crumple.comparison.variant import (
    ELASTIC_HINGES,
    ELASTIC_MEMBERS,
    SHELL_LAWS,
    with_elastic_hinges,
    with_elastic_members,
    with_measured_laws,
)
from crumple.errors import InputError, Problem, Status
from crumple.multibody import Run, least_seconds, stepping_seconds
from crumple.result import Result
from crumple.structure import Structure
from crumple.structure.remembered import forget

if TYPE_CHECKING:
    from crumple.shell import LongRun

FRAMES = 101
"""Shapes stored over the run: rotations are measured in them, and the moving picture plays them."""
ROUNDING = 1e-9
"""Share of the duration below which two times are one."""
TIMED_BELOW = 1.0
"""Solve time [s] up to which a model is solved again for its times: caches matter little to longer ones."""

Progress = Callable[[float], None]
Cancel = Callable[[], bool]


def solve_and_compare(
    analysis: Analysis,
    *,
    threads: int = 1,
    curves: Sequence[CurveFile] = (),
    variants: bool = True,
    second_mesh: float | None = None,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
    long_run: LongRun | None = None,
) -> Comparison:
    """Solve an analysis with both engines and compare the answers.

    Parameters
    ----------
    analysis
        What to solve; its pictures are supplemented by others at even times.
    threads
        Of the shell run.
    curves
        From files, to be compared too.
    variants
        Whether to solve further multibody models: elastic hinges, elastic members, laws of the shell run.
    second_mesh
        Factor on the size of all elements of a further shell run, which shows how well the reference is
        known; None: no such run.
    progress, cancel, long_run
        As `crumple.analysis.solve` takes them; progress is that of the shell run.  Cancelled, the further
        models and meshes that are not yet solved are left out.

    Returns
    -------
    Comparison
        Candidate multibody, reference shell.  A run that failed is compared as far as it got.

    Raises
    ------
    InputError
        If an engine cannot take the structure.
    """
    dense = with_frames(analysis)
    other = None if second_mesh is None else with_mesh(dense, second_mesh)
    candidate = _hashed(solve(dense, cancel=cancel), analysis)
    begin, worked = time.perf_counter(), time.process_time()
    shell = solve(dense, "shell", threads, progress, cancel, long_run=long_run)
    busy = (time.process_time() - worked) / (threads * (time.perf_counter() - begin))
    reference = _hashed(shell, analysis)
    models = {candidate.fidelity: (analysis.structure, candidate)}
    if variants and reference.time.size:
        models |= _variants(dense, candidate, reference, cancel)
    results = {name: result for name, (_, result) in models.items() if result is not candidate}
    if other is not None and reference.status.ok and not _stopped(cancel):
        results[mesh_name(other)] = solve(other, "shell", threads, progress, cancel)
    timings = {
        name: _timing(dense.model_copy(update={"structure": model}))
        for name, (model, result) in models.items()
        if result.solve_seconds < TIMED_BELOW and not _stopped(cancel)
    }
    found = compare(
        candidate,
        reference,
        analysis.structure,
        variants=results,
        curves=curves,
    )
    return replace(found, timings=timings, busy_share=busy)


def with_frames(analysis: Analysis, number: int = FRAMES) -> Analysis:
    """The same analysis with shapes at even times beside those asked for."""
    asked = np.array([t for t in analysis.outputs.pictures if t <= analysis.duration])
    even = np.linspace(0.0, analysis.duration, number)
    # of two times a rounding apart the one that is asked for stays
    apart = np.abs(even[:, None] - asked).min(axis=1, initial=math.inf) > ROUNDING * analysis.duration
    wanted = tuple(np.union1d(even[apart], asked).tolist())
    return analysis.model_copy(update={"outputs": analysis.outputs.model_copy(update={"pictures": wanted})})


def with_mesh(analysis: Analysis, factor: float) -> Analysis:
    """The same analysis with shell elements of another size.

    Raises
    ------
    InputError
        If the factor is not positive, or is 1, which would be the same mesh.
    """
    if not (math.isfinite(factor) and factor > 0.0 and factor != 1.0):
        allowed, todo = "above 0 and not 1", "give 2 for elements twice as long, 0.5 for half as long"
        raise InputError(Problem("this is no other mesh", f"{factor:g}", allowed, todo, where="second_mesh"))
    shell = analysis.shell
    sizes = {"element_size": factor * shell.element_size}
    if shell.fine_size is not None:
        sizes["fine_size"] = factor * shell.fine_size
    return analysis.model_copy(update={"shell": shell.model_copy(update=sizes)})


def mesh_name(analysis: Analysis) -> str:
    """What a comparison calls a further shell run: by the size of its finest elements."""
    shell = analysis.shell
    return f"shell, {1e3 * (shell.fine_size or shell.element_size):.3g} mm"


def picture_times(analysis: Analysis) -> tuple[float, ...]:
    """Times of the pictures that the input asks for [s], else six over the run."""
    return analysis.outputs.pictures or tuple(float(t) for t in np.linspace(0.0, analysis.duration, 6))


def with_pictures(result: Result, times: Sequence[float]) -> Result:
    """The same result with shapes at the given times alone, as a run of its own stores them."""
    if result.states is None or not len(result.states.times):
        return result
    reached = np.array([t for t in times if t <= result.states.times[-1] * (1 + 1e-9)])
    return replace(result, states=at_times(result.states, reached)) if reached.size else result


def _stopped(cancel: Cancel | None) -> bool:
    return cancel is not None and cancel()


def _variants(
    dense: Analysis, candidate: Result, reference: Result, cancel: Cancel | None
) -> dict[str, tuple[Structure, Result]]:
    """Further models and their results, by name; a model that is not solved is left out."""
    structure = dense.structure
    shell = compare(candidate, reference, structure).reference
    wanted = {
        ELASTIC_HINGES: with_elastic_hinges(structure),
        ELASTIC_MEMBERS: with_elastic_members(structure),
        SHELL_LAWS: with_measured_laws(structure, shell.hinges),
    }
    found = {}
    for name, model in wanted.items():
        if model is None:
            continue
        try:
            result = solve(dense.model_copy(update={"structure": model}), cancel=cancel)
        except InputError:
            continue
        if result.status is not Status.CANCELLED:
            found[name] = (model, result)
    return found


def _timing(dense: Analysis) -> Timing:
    """Times of a multibody model, solved again."""

    def once() -> float:
        forget()
        return solve(dense).solve_seconds

    again = least_seconds(once)
    run = Run(
        dense.duration, dense.output_interval, dense.multibody, dense.outputs, dense.title, dense.stages
    )
    return Timing(again, stepping_seconds(dense.structure, run))


def _hashed(result: Result, analysis: Analysis) -> Result:
    """With the hash of the input as its author wrote it: the further shapes are not his."""
    return replace(result, provenance=replace(result.provenance, input_hash=input_hash(analysis)))
