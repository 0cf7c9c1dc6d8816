"""Shell solution of a structure: mesh, time stepping, notes, and checks of the result."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from crumple._core.shell.simulation import ShellState
from crumple.errors import InputError, Problem, Status
from crumple.numeric.arrays import Floats
from crumple.result import Channel, Provenance, Result, missing_pictures
from crumple.shell.answer.hinge_histories import OPEN, hinge_histories, openings, summaries
from crumple.shell.answer.histories import channels_of
from crumple.shell.answer.record import ENERGIES, Record, Sampler
from crumple.shell.answer.shapes import states_of
from crumple.shell.checks import trust
from crumple.shell.checks.refusals import refuse_steps
from crumple.shell.mesh.time_step import stable_steps
from crumple.shell.model.model import ShellCase, lower
from crumple.shell.stepping import Cancel, Hooks, LongRun, Progress, ShellRun, Stepping, with_place
from crumple.structure import Structure


def solve_shell(
    structure: Structure,
    run: ShellRun,
    progress: Progress | None = None,
    cancel: Cancel | None = None,
    long_run: LongRun | None = None,
) -> Result:
    """Solve a structure as thin shells.

    Parameters
    ----------
    structure
        What is simulated.
    run
        How long, with which settings, reporting what.
    progress
        Called with the share done, 0 to 1.
    cancel
        Called about ten times a second; if it returns True, the run ends with its results so far.
    long_run
        Restart files and a watcher.

    Returns
    -------
    Result
        Its provenance lacks version and input hash; the caller adds them.

    Raises
    ------
    InputError
        If the structure cannot be meshed, a setting does not fit its mesh, or the restart file belongs to
        another input.

    References
    ----------
    docs/theory/shell_lowering.md.  Verified in tests/verification/shell/test_tube_reference.py.
    """
    begin = time.perf_counter()
    case, state = _started(structure, run)
    hooks = Hooks(begin, progress, cancel, long_run or LongRun())
    stepping = Stepping(structure, run, case, state, hooks)
    status, reason = stepping.run_to_end()
    return _result(structure, run, stepping, status, reason)


def start_notes(structure: Structure, run: ShellRun) -> tuple[str, ...]:
    """Notes of a shell run before its first step: its mesh, then its warnings.

    Parameters
    ----------
    structure, run
        As `solve_shell` takes them.

    Raises
    ------
    InputError
        As `solve_shell` does.
    """
    case, state = _started(structure, run)
    record = Record()
    record.add({"at": np.array(0.0), **Sampler.of(case, run.outputs).sample(state)})
    steps = sum(stage.duration for stage in run.sequence) / state.first_time_step
    mesh = f"Shells: {case.report}, some {steps:.2g} steps."
    return (mesh, *trust.warnings(structure, case, record, state))


def _started(structure: Structure, run: ShellRun) -> tuple[ShellCase, ShellState]:
    """Model and state before the first step, once every setting has been found to fit."""
    case = lower(structure, run.settings, run.outputs, stage=run.sequence[0])
    try:
        state = ShellState(case.model)
    except InputError as error:
        raise _named(error, case) from error
    slowest = _slowest(case)
    refuse_steps(run.settings, run.sequence, state.first_time_step, slowest)
    report = replace(case.report, time_step=state.first_time_step, slowest=slowest)
    return replace(case, report=report), state


def _slowest(case: ShellCase) -> str:
    """Where the element lies that sets the first time step; empty if added mass sets it."""
    steps, settings = stable_steps(case.model), case.model.settings
    least = int(np.argmin(steps))
    if not np.isfinite(steps[least]) or settings.safety * steps[least] < settings.scaled_step:
        return ""
    corner = case.mesh.position[case.mesh.quads[least]]
    sides = np.linalg.norm(np.roll(corner, -1, axis=0) - corner, axis=1)
    return f"{case.mesh.place_of(least)}, its smallest side {1e3 * sides[sides > 0.0].min():.3g} mm"


def _result(structure: Structure, run: ShellRun, stepping: Stepping, status: Status, reason: str) -> Result:
    case, record, state = stepping.case, stepping.record, stepping.state
    if not len(record):
        record.add({"at": np.array(0.0), **stepping.sampler.sample(ShellState(case.model))})
    channels = channels_of(structure, stepping.sampler, record, run.outputs)
    hinges = hinge_histories(stepping.sampler, record)
    asked = {*run.outputs.section_rotations, *run.outputs.distances, *run.outputs.clearances}
    prefixes = tuple(f"node.{name}." for name in run.outputs.nodes)
    times = stepping.times
    return Result(
        status=status,
        reason=reason,
        fidelity="shell",
        title=run.title,
        time=times,
        channels={channel.name: _at(channel, times, record["time"]) for channel in channels},
        hinges=summaries(stepping.sampler, record, hinges),
        states=states_of(case.mesh, record),
        energy_residual=trust.energy_residual(record),
        solve_seconds=stepping.seconds,
        warnings=trust.warnings(structure, case, record, state)
        + trust.slow_warnings(run.stages, stepping.ended, record)
        + ((stepping.unsaved,) if stepping.unsaved else ())
        + tuple(missing_pictures(run.outputs.pictures, float(times[-1]))),
        assumptions=trust.assumptions(structure, case, run.settings),
        provenance=Provenance("", "", state.isa, run.threads, _settings(run, case, state, record)),
        collapse=openings(record["time"], hinges),
        collapse_threshold=OPEN,
        stages=stepping.ended if run.stages else (),
        output_names=tuple(
            channel.name for channel in channels if channel.name in asked or channel.name.startswith(prefixes)
        ),
    )


def _at(channel: Channel, times: Floats, noted: Floats) -> Channel:
    """Channel at the output times; the stepper stops at its first step at or after each."""
    return Channel(channel.name, channel.unit, np.interp(times, noted, channel.values))


def _settings(
    run: ShellRun, case: ShellCase, state: ShellState, record: Record
) -> dict[str, float | int | str]:
    given = {
        key: value for key, value in run.settings.model_dump(mode="json").items() if value not in (None, [])
    }
    report = case.report
    return {
        **given,
        "elements": report.elements,
        "triangles": report.triangles,
        "nodes": report.nodes,
        "smallest_side": report.smallest_side,
        "worst_aspect": report.worst_aspect,
        "worst_warp": report.worst_warp,
        "first_time_step": state.first_time_step,
        "steps": state.steps,
        "added_mass": state.added_mass,
        "deepest_penetration": state.deepest_penetration,
        "largest_hourglass_energy": float(record["energy"][:, ENERGIES.index("hourglass")].max()),
    }


def _named(error: InputError, case: ShellCase) -> InputError:
    problems = [
        Problem(
            with_place(problem.what, case),
            problem.came,
            problem.allowed,
            problem.todo,
            problem.where or "analysis.shell",
        )
        for problem in error.problems
    ]
    return InputError(problems)
