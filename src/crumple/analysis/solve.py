"""Solution of an analysis by one of the solvers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from crumple.analysis.analysis import Analysis
from crumple.analysis.canonical import canonical, hash_of
from crumple.analysis.criteria import with_criteria
from crumple.analysis.filters import with_filters
from crumple.analysis.unmet import with_unmet
from crumple.errors import InputError, Problem, Status
from crumple.structure.schema.spec import raise_all
from crumple.units import format_quantity
from crumple.version import __version__

if TYPE_CHECKING:
    from crumple.multibody import Run
    from crumple.result import Result
    from crumple.shell import LongRun

FIDELITIES = ("multibody", "shell")
"""Solvers by name."""
UNSOLVED: dict[str, tuple[str, ...]] = {
    "multibody": (),
    "shell": ("joints", "outputs.section_forces"),
}
"""Parts of an input that a solver does not support."""


def solve(
    analysis: Analysis,
    fidelity: str = "multibody",
    threads: int = 1,
    progress: Callable[[float], None] | None = None,
    cancel: Callable[[], bool] | None = None,
    *,
    long_run: LongRun | None = None,
    checks: bool = True,
) -> Result:
    """Result of one solver for an analysis.

    Parameters
    ----------
    analysis
        Analysis to solve; not changed.
    fidelity
        Which solver: ``multibody`` or ``shell``.
    threads
        Threads to use, at least 1; the result is bitwise independent of it.
    progress
        Called with the simulated share of the duration, 0 to 1.
    cancel
        Called repeatedly; True ends the run with a status and the result so far.
    long_run
        Restart files and a callback of the shell solver; not used by the multibody solver.
    checks
        Whether the multibody solver estimates its error, and whether its mechanism is unique, which solves up
        to five times more; the answer is the same.  Not used by the shell solver.

    Returns
    -------
    Result
        Result with its status; a failed run is also returned.

    Raises
    ------
    InputError
        If the fidelity is unknown or the solver cannot take the structure.
    """
    result = solved_alone(analysis, fidelity, threads, progress, cancel, long_run=long_run, checks=checks)
    if not result.time.size:
        # cancelled before it had anything to say: nobody waits for the hash of its input
        return result
    plain = canonical(analysis)
    settings = {**plain[fidelity], **result.provenance.settings}
    provenance = replace(
        result.provenance,
        version=__version__,
        input_hash=hash_of(plain),
        threads=threads,
        settings=settings,
    )
    reason = result.reason
    if result.status is Status.CANCELLED and not reason:
        reached = format_quantity(float(result.time[-1]), "s", 3)
        total = format_quantity(analysis.duration, "s", 3)
        reason = f"stopped on request; the last output is at {reached} of {total}"
    return replace(result, provenance=provenance, reason=reason)


def with_law_range(
    result: Result, analysis: Analysis, threads: int = 1, cancel: Callable[[], bool] | None = None
) -> Result:
    """A multibody result with its range from the bands of the hinge laws, see `Result.law_range`.

    Parameters
    ----------
    result
        Of the analysis.
    analysis
        As it was solved.
    threads, cancel
        As in `solve`.
    """
    from crumple.multibody import law_range  # noqa: PLC0415

    found = law_range(analysis.structure, run_of(analysis), result, threads, cancel)
    return replace(result, law_range=found)


def with_modes(
    result: Result,
    analysis: Analysis,
    threads: int = 1,
    progress: Callable[[float], None] | None = None,
    cancel: Callable[[], bool] | None = None,
) -> Result:
    """A multibody result of an impact with the modes of collapse that appear, see `Result.modes`.

    Several modes are a caution.  Parameters as in `with_law_range` and `solve`.
    """
    from crumple.multibody import modes  # noqa: PLC0415
    from crumple.result import Caution  # noqa: PLC0415

    found = modes(analysis.structure, run_of(analysis), result, threads, progress, cancel)
    if found is None or found.unique:
        return replace(result, modes=found)
    caution = Caution("modes", float(len(found.modes)), 1.0, "1", "", found.sentence)
    warnings = (found.sentence, *result.warnings)
    return replace(result, modes=found, cautions=(*result.cautions, caution), warnings=warnings)


def with_doubts(result: Result, analysis: Analysis) -> Result:
    """A result with cautions about its input: nothing acts, unusual values, doubtful members."""
    from crumple.result import Caution, sentences  # noqa: PLC0415
    from crumple.structure import with_elastic_members  # noqa: PLC0415
    from crumple.structure.checks.doubtful import input_doubts  # noqa: PLC0415
    from crumple.structure.checks.section_axes import section_doubts  # noqa: PLC0415

    found = input_doubts(analysis.structure, analysis.duration, analysis.stages)
    if result.fidelity == "multibody":
        found += section_doubts(
            with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
        )
    if not found or not result.time.size:
        return result
    own = [Caution(one.code, one.value, one.limit, one.unit, one.place, one.text) for one in found]
    return replace(result, cautions=(*own, *result.cautions), warnings=(*sentences(own), *result.warnings))


def solved_alone(
    analysis: Analysis,
    fidelity: str,
    threads: int = 1,
    progress: Callable[[float], None] | None = None,
    cancel: Callable[[], bool] | None = None,
    *,
    long_run: LongRun | None = None,
    checks: bool = True,
) -> Result:
    """`solve` without what the result says of its input: for a solver that is only to look at it."""
    if not isinstance(analysis, Analysis):
        allowed, todo = "an Analysis", "load an input file, or build an Analysis"
        raise InputError(Problem("an analysis is needed", type(analysis).__name__, allowed, todo, "analysis"))
    if fidelity not in FIDELITIES:
        allowed = ", ".join(FIDELITIES)
        raise InputError(Problem("unknown fidelity", fidelity, allowed, "choose one of these", "fidelity"))
    if threads < 1:
        raise InputError(
            Problem("the number of threads is below 1", str(threads), "at least 1", "", "threads")
        )
    _refuse_unsolved(analysis, fidelity)
    if fidelity == "shell":
        solved = _shell(analysis, threads, progress, cancel, long_run)
    else:
        from crumple.multibody import solve_multibody  # noqa: PLC0415

        run = replace(run_of(analysis), checks=checks)
        solved = solve_multibody(analysis.structure, run, progress, cancel)
    told = with_doubts(with_unmet(solved, analysis.stages), analysis)
    return with_criteria(with_filters(told, analysis.outputs, analysis.output_interval), analysis.criteria)


def _refuse_unsolved(analysis: Analysis, fidelity: str) -> None:
    """Refuse parts of an input that this solver does not support, instead of ignoring them."""
    structure = analysis.structure
    given = {
        "obstacles": structure.obstacles,
        "member_contact": structure.member_contact,
        "analysis.stages": analysis.stages,
        "joints": structure.joints,
        "outputs.section_forces": analysis.outputs.section_forces,
    }
    problems = [
        Problem(f"the {fidelity} solver does not support '{where}'", where=where, todo="remove it")
        for where, part in given.items()
        if part and where in UNSOLVED[fidelity]
    ]
    raise_all(problems)


# the solvers need the compiled kernels; reading and checking input does not


def run_of(analysis: Analysis) -> Run:
    """Duration, settings, stages and outputs of an analysis, for `crumple.multibody`."""
    from crumple.multibody import Run  # noqa: PLC0415

    return Run(
        duration=analysis.duration,
        every=analysis.output_interval,
        settings=analysis.multibody,
        outputs=analysis.outputs,
        title=analysis.title,
        stages=analysis.stages,
    )


def _shell(
    analysis: Analysis,
    threads: int,
    progress: Callable[[float], None] | None,
    cancel: Callable[[], bool] | None,
    long_run: LongRun | None,
) -> Result:
    from crumple.shell import ShellRun, solve_shell  # noqa: PLC0415

    run = ShellRun(
        duration=analysis.duration,
        every=analysis.output_interval,
        settings=analysis.shell,
        outputs=analysis.outputs,
        title=analysis.title,
        threads=threads,
        stages=analysis.stages,
    )
    return solve_shell(analysis.structure, run, progress, cancel, long_run)
