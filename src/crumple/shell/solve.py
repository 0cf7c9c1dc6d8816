"""The shell answer: mesh, step, note, and say how far to believe it."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from crumple._core.shell import ShellState
from crumple.errors import InputError, Problem, Status
from crumple.result import Channel, Provenance, Result
from crumple.shell import trust
from crumple.shell.contour import Floats
from crumple.shell.histories import channels_of, summaries
from crumple.shell.model import Lowered, lower
from crumple.shell.record import ENERGIES, Record, Sampler
from crumple.shell.restart import fingerprint, read_restart, write_restart
from crumple.shell.shapes import shape_of, states_of
from crumple.structure import Outputs, ShellSettings, Structure

Progress = Callable[[float], None]
Cancel = Callable[[], bool]

RUNAWAY = 0.5
"""Energy residual over the energy put in at which a run is stopped: nothing after it means anything."""
SAVE_EVERY = 300.0
"""Wall time between two restart files [s]: what a power cut may cost."""
WATCH_EVERY = 0.5
"""Wall time between two looks at the energies [s]; a look costs about as much as ten steps."""


@dataclass(frozen=True)
class ShellRun:
    """What the solver is told beside the structure: duration and output interval [s], settings, outputs."""

    duration: float
    every: float
    settings: ShellSettings = field(default_factory=ShellSettings)
    outputs: Outputs = field(default_factory=Outputs)
    title: str = ""
    threads: int = 1


@dataclass(frozen=True)
class Moment:
    """Where a run is: time and duration [s], time step [s], steps, energies [J], wall time left [s]."""

    time: float
    duration: float
    time_step: float
    steps: int
    energies: Mapping[str, float]
    seconds_left: float


@dataclass(frozen=True)
class LongRun:
    """What a long run needs beside: where to go on from, where to save itself, who watches.

    Attributes
    ----------
    restart_from
        Restart file of an interrupted run of the same input.
    restart_to
        Written now and then and when the run is cancelled; removed when it ends.
    watch
        Called about twice a second.
    """

    restart_from: Path | None = None
    restart_to: Path | None = None
    watch: Callable[[Moment], None] | None = None


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
        Asked about ten times a second; True ends the run with what it has.
    long_run
        Restart files and a watcher.

    Returns
    -------
    Result
        Provenance lacks version and input hash; they are the caller's.

    Raises
    ------
    InputError
        If the structure cannot be meshed, or the restart file is not of this run.

    References
    ----------
    docs/theory/shell_lowering.md.  Verified in tests/verification/test_shell_tube_reference.py.
    """
    begin = time.perf_counter()
    lowered = lower(structure, run.settings, run.outputs, run.duration)
    try:
        state = ShellState(lowered.model)
    except InputError as error:
        raise _named(error, lowered) from error
    lowered = replace(lowered, report=replace(lowered.report, time_step=state.first_time_step))
    hooks = _Hooks(begin, progress, cancel, long_run or LongRun())
    stepping = _Stepping(structure, run, lowered, state, hooks)
    status, reason = stepping.run_to_end()
    return _result(structure, run, stepping, status, reason)


def output_times(run: ShellRun) -> Floats:
    """Times at which the histories are noted: the interval's multiples, the end and the pictures' [s]."""
    number = int(np.floor(run.duration / run.every * (1 + 1e-12)))
    regular = np.minimum(run.every * np.arange(number + 1), run.duration)
    pictures = [t for t in picture_times(run) if t < run.duration]
    wanted = np.unique(np.concatenate([regular, [run.duration], pictures]))
    apart = np.concatenate([[True], np.diff(wanted) > 1e-9 * run.duration])
    return np.asarray(wanted[apart])


def picture_times(run: ShellRun) -> Floats:
    """Times at which shapes are stored [s]: those asked for, else six."""
    return np.array(run.outputs.pictures or np.linspace(0.0, run.duration, 6))


@dataclass(frozen=True)
class _Hooks:
    """Clock at the begin [s], and whom to tell and ask on the way."""

    begin: float
    progress: Progress | None
    cancel: Cancel | None
    long_run: LongRun


class _Stepping:
    """One run: the moving state and what was noted of it."""

    def __init__(
        self, structure: Structure, run: ShellRun, lowered: Lowered, state: ShellState, hooks: _Hooks
    ) -> None:
        self.run, self.lowered, self.state = run, lowered, state
        self.begin, self.progress, self.cancel = hooks.begin, hooks.progress, hooks.cancel
        self.long_run = hooks.long_run
        self.sampler, self.record = Sampler.of(lowered, run.outputs), Record()
        self.mark = fingerprint(structure, run.settings, run.outputs, run.duration, run.every)
        self.times = output_times(run)
        self.pictures = {
            int(np.argmin(np.abs(self.times - t))) for t in picture_times(run) if t <= run.duration
        }
        self.spent_before = self.first_time = 0.0
        self.saved = self.watched = self.begin
        if self.long_run.restart_from is not None:
            self.record, self.spent_before = read_restart(self.long_run.restart_from, state, self.mark)
            self.first_time = state.time

    @property
    def seconds(self) -> float:
        """Wall time spent, that before a restart included [s]."""
        return self.spent_before + time.perf_counter() - self.begin

    def run_to_end(self) -> tuple[Status, str]:
        """Step from output to output; gives how it ended and why."""
        for k in range(len(self.record), len(self.times)):
            status = self.state.advance(
                self.times[k], threads=self.run.threads, progress=self._look, cancel=self.cancel
            )
            if status is Status.CANCELLED:
                self._save()
            if not status.ok:
                return status, _with_place(self.state.reason, self.lowered)
            self.record.add(self.sampler.sample(self.state))
            if k in self.pictures:
                self.record.add_shape(shape_of(self.state, self.lowered.mesh))
            residual = trust.energy_residual(self.record)
            if not residual < RUNAWAY:
                return Status.RESIDUAL_EXCEEDED, f"the energies ran away at {self.state.time:.4g} s"
        if self.long_run.restart_to is not None:
            self.long_run.restart_to.unlink(missing_ok=True)
        bound = self.run.settings.energy_residual_bound
        if residual > bound:
            return Status.RESIDUAL_EXCEEDED, f"energy residual {residual:.2e} above its bound {bound:.2e}"
        return Status.COMPLETE, ""

    def _look(self, state: ShellState) -> None:
        """Tell the caller where the run is, and save it now and then."""
        if self.progress is not None:
            self.progress(min(state.time / self.run.duration, 1.0))
        now = time.perf_counter()
        if self.long_run.watch is not None and now - self.watched > WATCH_EVERY:
            self.watched = now
            self.long_run.watch(self._moment(now))
        if self.long_run.restart_to is not None and now - self.saved > SAVE_EVERY:
            self._save()

    def _moment(self, now: float) -> Moment:
        state = self.state
        done = state.time - self.first_time
        left = (self.run.duration - state.time) * (now - self.begin) / done if done > 0.0 else np.inf
        return Moment(state.time, self.run.duration, state.time_step, state.steps, state.energies, left)

    def _save(self) -> None:
        if self.long_run.restart_to is not None:
            write_restart(self.long_run.restart_to, self.state, self.record, self.mark, self.seconds)
        self.saved = time.perf_counter()


def _result(structure: Structure, run: ShellRun, stepping: _Stepping, status: Status, reason: str) -> Result:
    lowered, record, state = stepping.lowered, stepping.record, stepping.state
    if not len(record):
        stepping.record.add(stepping.sampler.sample(ShellState(lowered.model)))
    channels = channels_of(structure, stepping.sampler, record, run.outputs)
    asked = {*run.outputs.section_rotations}
    prefixes = tuple(f"node.{name}." for name in run.outputs.nodes)
    times = stepping.times[: len(record)]
    return Result(
        status=status,
        reason=reason,
        fidelity="shell",
        title=run.title,
        time=times,
        channels={channel.name: _at(channel, times, record["time"]) for channel in channels},
        hinges=summaries(stepping.sampler, record),
        states=states_of(lowered.mesh, record),
        energy_residual=trust.energy_residual(record),
        solve_seconds=stepping.seconds,
        warnings=trust.warnings(structure, lowered, record, state),
        assumptions=trust.assumptions(structure, lowered, run.settings),
        provenance=Provenance("", "", state.isa, run.threads, _settings(run, lowered, state)),
        output_names=tuple(
            channel.name for channel in channels if channel.name in asked or channel.name.startswith(prefixes)
        ),
    )


def _at(channel: Channel, times: Floats, noted: Floats) -> Channel:
    """Channel at the output times; the stepper stops at its first step at or after each."""
    return Channel(channel.name, channel.unit, np.interp(times, noted, channel.values))


def _settings(run: ShellRun, lowered: Lowered, state: ShellState) -> dict[str, float | int | str]:
    given = {
        key: value for key, value in run.settings.model_dump(mode="json").items() if value not in (None, [])
    }
    report = lowered.report
    return {
        **given,
        "elements": report.elements,
        "nodes": report.nodes,
        "smallest_side": report.smallest_side,
        "worst_aspect": report.worst_aspect,
        "worst_warp": report.worst_warp,
        "first_time_step": state.first_time_step,
        "steps": state.steps,
        "added_mass": state.added_mass,
        "deepest_penetration": state.deepest_penetration,
        "largest_hourglass_energy": _largest(state, "hourglass"),
    }


def _largest(state: ShellState, name: str) -> float:
    return float(state.energies[name]) if name in ENERGIES else 0.0


def _with_place(reason: str, lowered: Lowered) -> str:
    """A reason that names an element, with where the element lies."""
    found = re.search(r"element (\d+)", reason)
    return reason if found is None else f"{reason} ({lowered.mesh.place_of(int(found.group(1)))})"


def _named(error: InputError, lowered: Lowered) -> InputError:
    problems = [
        Problem(
            _with_place(problem.what, lowered),
            problem.came,
            problem.allowed,
            problem.todo,
            problem.where or "analysis.shell",
        )
        for problem in error.problems
    ]
    return InputError(problems)
