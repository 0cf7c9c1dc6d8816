"""Solve one analysis with both solvers and compare: further multibody models, second mesh, solve times."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from crumple.analysis import Analysis, input_hash, solve, with_law_range, with_modes
from crumple.comparison.comparing import compare
from crumple.comparison.comparison import Comparison, Timing
from crumple.comparison.rating.curve_file import CurveFile
from crumple.comparison.variant import variants_of
from crumple.errors import CancelledError, InputError, Problem, Status
from crumple.multibody import Run, least_seconds, stepping_seconds
from crumple.result import Result
from crumple.structure import with_elastic_members
from crumple.structure.remembered import forget

if TYPE_CHECKING:
    from crumple.shell import LongRun

FRAMES = 101
"""Number of shapes stored over the run, for measured rotations and the animation."""
ROUNDING = 1e-9
"""Share of the duration below which two times count as equal."""
TIMED_BELOW = 1.0
"""Solve time [s] up to which a model is timed repeatedly; for longer ones caches matter little."""
RANGED_BELOW = 10.0
"""Processor time of the candidate [s] up to which its range and modes are computed: shells take far longer.
Wall time depends on what else the machine does, and what a comparison reports must not."""

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
    keep: Callable[[Result], None] | None = None,
) -> Comparison:
    """Solve an analysis with both solvers and compare the results.

    Parameters
    ----------
    analysis
        What to solve; pictures at equal intervals are added to its own.
    threads
        Of the shell run.
    curves
        Curves from files, to be compared as well.
    variants
        Whether to solve further multibody models (see `variants_of`), and the range from the bands of the
        laws and the modes of an impact.
    second_mesh
        Factor on the size of all elements of a further shell run, which shows how accurate the reference
        is; None: no such run.
    progress, cancel, long_run
        As for `crumple.analysis.solve`; progress is that of the shell run.  After a cancellation, further
        models and meshes that are not yet solved are left out.
    keep
        Called with each engine's result as soon as there is one: what follows may take long.

    Returns
    -------
    Comparison
        Candidate multibody, reference shell.  A run that failed is compared as far as it got.

    Raises
    ------
    InputError
        If a solver cannot handle the structure.
    """
    dense = with_frames(analysis)
    other = None if second_mesh is None else with_mesh(dense, second_mesh)
    begun = time.process_time()
    candidate = _hashed(solve(dense, cancel=cancel), analysis)
    took = time.process_time() - begun
    if not candidate.time.size:
        raise CancelledError(candidate.reason)
    if variants and candidate.status.ok and took < RANGED_BELOW:
        candidate = _with_neighbours(candidate, analysis, threads, cancel)
    if keep is not None:
        keep(candidate)
    begin, worked = time.perf_counter(), time.process_time()
    shell = solve(dense, "shell", threads, progress, cancel, long_run=long_run)
    busy = (time.process_time() - worked) / (threads * (time.perf_counter() - begin))
    reference = _hashed(shell, analysis)
    if keep is not None:
        keep(reference)
    models = {candidate.fidelity: (dense, candidate)}
    if variants and reference.time.size:
        models |= _variants(dense, candidate, reference, cancel)
    results = {name: result for name, (_, result) in models.items() if result is not candidate}
    if other is not None and reference.status.ok and not _stopped(cancel):
        results[mesh_name(other)] = solve(other, "shell", threads, progress, cancel)
    timings = {
        name: _timing(model)
        for name, (model, result) in models.items()
        if result.solve_seconds < TIMED_BELOW and not _stopped(cancel)
    }
    found = compare(
        candidate,
        reference,
        with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion),
        variants=results,
        curves=curves,
    )
    return replace(found, timings=timings, busy_share=busy)


def _with_neighbours(result: Result, analysis: Analysis, threads: int, cancel: Cancel | None) -> Result:
    """A multibody result with its range from the bands of the laws, and the modes of an impact."""
    # some structures have no variants, and a user may stop them; what is solved can be compared without
    with suppress(InputError, CancelledError):
        result = with_law_range(result, analysis, threads, cancel)
    with suppress(CancelledError):
        result = with_modes(result, analysis, threads, cancel=cancel)
    return result


def with_frames(analysis: Analysis, number: int = FRAMES) -> Analysis:
    """The same analysis with shapes at equal intervals in addition to those requested."""
    requested = np.array([t for t in analysis.outputs.pictures if t <= analysis.duration])
    even = np.linspace(0.0, analysis.duration, number)
    # of two times that differ by rounding the requested one is kept
    apart = np.abs(even[:, None] - requested).min(axis=1, initial=math.inf) > ROUNDING * analysis.duration
    wanted = tuple(np.union1d(even[apart], requested).tolist())
    return analysis.model_copy(update={"outputs": analysis.outputs.model_copy(update={"pictures": wanted})})


def with_mesh(analysis: Analysis, factor: float) -> Analysis:
    """The same analysis with another size of shell elements.

    Raises
    ------
    InputError
        If the factor is not positive, or is 1, which would be the same mesh.
    """
    if not (math.isfinite(factor) and factor > 0.0 and factor != 1.0):
        allowed, todo = "above 0 and not 1", "give 2 for elements twice as long, 0.5 for half as long"
        what = "this factor gives no second mesh"
        raise InputError(Problem(what, f"{factor:g}", allowed, todo, where="second_mesh"))
    shell = analysis.shell
    sizes = {"element_size": factor * shell.element_size}
    if shell.fine_size is not None:
        sizes["fine_size"] = factor * shell.fine_size
    return analysis.model_copy(update={"shell": shell.model_copy(update=sizes)})


def mesh_name(analysis: Analysis) -> str:
    """Name of a further shell run in a comparison: by the size of its finest elements."""
    shell = analysis.shell
    return f"shell, {1e3 * (shell.fine_size or shell.element_size):.3g} mm"


def picture_times(analysis: Analysis) -> tuple[float, ...]:
    """Times of the pictures requested in the input [s], else six over the run."""
    return analysis.outputs.pictures or tuple(float(t) for t in np.linspace(0.0, analysis.duration, 6))


def with_pictures(result: Result, times: Sequence[float]) -> Result:
    """The same result with shapes at the given times only, as a separate run would store them."""
    if result.states is None or not len(result.states.times):
        return result
    reached = np.array([t for t in times if t <= result.states.times[-1] * (1 + 1e-9)])
    return replace(result, states=result.states.at_times(reached)) if reached.size else result


def _stopped(cancel: Cancel | None) -> bool:
    return cancel is not None and cancel()


def _variants(
    dense: Analysis, candidate: Result, reference: Result, cancel: Cancel | None
) -> dict[str, tuple[Analysis, Result]]:
    """Further models and their results, by name; a model that is not solved is left out."""
    structure = with_elastic_members(dense.structure, dense.multibody, dense.time_in_motion)
    shell = compare(candidate, reference, structure).reference
    found = {}
    for name, model in variants_of(dense, shell.hinges).items():
        try:
            result = solve(model, cancel=cancel)
        except InputError:
            continue
        if result.status is not Status.CANCELLED:
            found[name] = (model, result)
    return found


def _timing(dense: Analysis) -> Timing:
    """Solve times of a multibody model, solved repeatedly."""

    def once() -> float:
        forget()
        return solve(dense).solve_seconds

    again = least_seconds(once)
    run = Run(
        dense.duration, dense.output_interval, dense.multibody, dense.outputs, dense.title, dense.stages
    )
    return Timing(again, stepping_seconds(dense.structure, run))


def _hashed(result: Result, analysis: Analysis) -> Result:
    """Result with the hash of the input as written, without the added shapes."""
    return replace(result, provenance=replace(result.provenance, input_hash=input_hash(analysis)))
