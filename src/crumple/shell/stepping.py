"""One run, stage by stage and output by output: the state and its record."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from crumple._core.shell.simulation import ShellState
from crumple.errors import Status
from crumple.numeric.arrays import Floats
from crumple.result import StageSummary
from crumple.shell.answer.histories import channels_of
from crumple.shell.answer.record import Record, Sampler
from crumple.shell.answer.shapes import shape_of
from crumple.shell.checks import trust
from crumple.shell.model.bodies import moved
from crumple.shell.model.initial_motion import shell_initial_motion
from crumple.shell.model.model import ShellCase, model_of_stage
from crumple.shell.model.obstacles import appeared_inside
from crumple.shell.restart import Saved, fingerprint, read_restart, unreadable, write_restart
from crumple.shell.until import LOOK_STEPS, Watch
from crumple.structure import Outputs, ShellSettings, Stage, Structure

Progress = Callable[[float], None]
Cancel = Callable[[], bool]

RUNAWAY = 0.5
"""Energy residual over the energy input at which a run is stopped, since later results are meaningless."""
SAVE_EVERY = 300.0
"""Wall time between two restart files [s]."""
WATCH_EVERY = 0.5
"""Wall time between two looks at the energies [s]; a look costs about as much as ten steps."""
SAVE_AT_END = 10.0
"""Wall time of a run [s] from which its end is saved too: drawing and further solves may follow."""
REPORT_INTERVAL = 0.1
"""Wall time between two calls of what watches a run that is looked at more often [s]."""
ENOUGH_EVERY = 4
"""Outputs between two questions whether they are enough; the channels so far take some milliseconds."""
SAME_TIME = 1e-9
"""Share of the duration below which two times are one."""


@dataclass(frozen=True)
class ShellRun:
    """Settings of a run: longest duration and output interval [s], settings."""

    duration: float
    every: float
    settings: ShellSettings = field(default_factory=ShellSettings)
    outputs: Outputs = field(default_factory=Outputs)
    title: str = ""
    threads: int = 1
    stages: tuple[Stage, ...] = ()

    @property
    def sequence(self) -> tuple[Stage, ...]:
        """Stages, one where none is described."""
        return self.stages or (Stage(name="run", duration=self.duration),)


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
    """Options of a long run: restart files to read and to write, progress reports, warnings.

    Attributes
    ----------
    restart_from
        Restart file of an interrupted run of the same input.
    restart_to
        Written at intervals, when the run is cancelled, and at the end of a long run; the caller removes it
        after the results are stored.
    watch
        Called about twice a second.
    warn
        Called with a sentence as soon as a restart file cannot be written; the run continues.
    enough
        Called at every fourth output with the channels at the outputs so far; if it returns True, the run is
        complete there, with a picture.
    """

    restart_from: Path | None = None
    restart_to: Path | None = None
    watch: Callable[[Moment], None] | None = None
    warn: Callable[[str], None] | None = None
    enough: Callable[[Mapping[str, Floats]], bool] | None = None


def output_times(run: ShellRun, begin: float, duration: float) -> Floats:
    """Times at which a stage's histories are noted [s]: the interval's multiples, its end, the pictures'."""
    end = begin + duration
    first, last = (int(np.floor(t / run.every * (1 + 1e-12))) for t in (begin, end))
    # one grid for all stages, so that filters find equal steps
    regular = np.clip(run.every * np.arange(first, last + 1), begin, end)
    pictures = [t for t in picture_times(run) if begin < t < end]
    wanted = np.unique(np.concatenate([regular, [end], pictures]))
    apart = np.concatenate([[True], np.diff(wanted) > SAME_TIME * duration])
    return np.asarray(wanted[apart])


def picture_times(run: ShellRun) -> Floats:
    """Times at which shapes are stored [s]: those requested, else six."""
    return np.array(run.outputs.pictures or np.linspace(0.0, run.duration, 6))


@dataclass(frozen=True)
class Hooks:
    """Clock at the start [s], and the callbacks during the run."""

    begin: float
    progress: Progress | None
    cancel: Cancel | None
    long_run: LongRun


class Stepping:
    """One run: the current state, its record, and the stages that have ended."""

    def __init__(
        self, structure: Structure, run: ShellRun, case: ShellCase, state: ShellState, hooks: Hooks
    ) -> None:
        self.structure, self.run, self.case, self.state = structure, run, case, state
        self.begin, self.progress, self.cancel = hooks.begin, hooks.progress, hooks.cancel
        self.long_run = hooks.long_run
        self.sampler, self.record = Sampler.of(case, run.outputs), Record()
        self.mark = fingerprint(structure, run.settings, run.outputs, run.sequence, run.every)
        self.ended: tuple[StageSummary, ...] = ()
        self.watch: Watch | None = None
        self.spent_before = self.first_time = 0.0
        self.saved = self.watched = self.reported = self.begin
        self.resumed: Saved | None = None
        self.unsaved, self.done = "", False
        if self.long_run.restart_from is not None:
            self._resume(self.long_run.restart_from)

    @property
    def seconds(self) -> float:
        """Wall time spent, that before a restart included [s]."""
        return self.spent_before + time.perf_counter() - self.begin

    @property
    def times(self) -> Floats:
        """Output times so far [s]; the state is noted at its first step at or after each."""
        return self.record["at"]

    def run_to_end(self) -> tuple[Status, str]:
        """Step through the stages; gives how it ended and why."""
        for number in range(len(self.ended), len(self.run.sequence)):
            status, reason = self._run_stage(number)
            if not status.ok:
                return status, reason
            if self.done:
                break
        # a run that goes on from its end has been saved there
        if self.seconds > SAVE_AT_END and self.resumed is None:
            self._save()
        residual, bound = trust.energy_residual(self.record), self.run.settings.energy_residual_bound
        if residual > bound:
            return Status.RESIDUAL_EXCEEDED, f"energy residual {residual:.2e} above its bound {bound:.2e}"
        return Status.COMPLETE, ""

    def _run_stage(self, number: int) -> tuple[Status, str]:
        stage = self.run.sequence[number]
        begin = self.ended[-1].end if self.ended else 0.0
        if self.resumed is None:
            self._enter(stage, begin, number)
            inside = appeared_inside(self.structure, self.case.mesh, self.state)
            if number > 0 and inside:
                return Status.OVERLAPPING, f"stage {stage.name}: {inside}"
        self.watch = Watch(self.structure, self.case, stage, self.state)
        if self.resumed is not None:
            self._restore_watch(self.watch, self.resumed)
            self.resumed = None
        why = ""
        for at in output_times(self.run, begin, stage.duration):
            if len(self.record) and at <= self.times[-1] + SAME_TIME * stage.duration:
                continue
            status, why = self._step_to(float(at), self.watch)
            if status is Status.CANCELLED:
                self._save()
            if not status.ok:
                return status, with_place(self.state.reason, self.case)
            if not self._note(self.state.time if why else float(at), bool(why)):
                return Status.RESIDUAL_EXCEEDED, f"the energies grew without bound at {self.state.time:.4g} s"
            if why or self.done:
                break
        if stage.kind == "quasi-static":
            self.state.stop()
        lasted = not (why or self.done)
        why = why or ("its duration" if lasted else "all that is needed")
        self.ended += (StageSummary(stage.name, begin, float(self.times[-1]), why, lasted),)
        return Status.COMPLETE, ""

    def _enter(self, stage: Stage, begin: float, number: int) -> None:
        """Set the state up for a stage: its drives, loads, obstacles, damping and added motion."""
        if number > 0:
            before = self.state.checkpoint()
            self.state = self._state_of(stage, begin)
            self.state.restore(before, of_stage_before=True)
            if stage.initial_velocity or stage.impulses:
                self._push(stage)
        if stage.kind == "quasi-static":
            self.state.stop()

    def _state_of(self, stage: Stage, begin: float) -> ShellState:
        return ShellState(
            model_of_stage(self.structure, self.run.settings, self.case, stage, begin), self.state.isa
        )

    def _push(self, stage: Stage) -> None:
        """Add a stage's velocity fields and impulses to the deformed structure."""
        before, now = self.case.mesh.position, self.state.position
        mesh = replace(self.case.mesh, position=now)
        bodies = tuple(
            moved(body, before[body.nodes[-1]], now[body.nodes[-1]], row)
            for body, row in zip(self.case.bodies, self.state.rigid_sets, strict=True)
        )
        fields = {"initial_velocity": stage.initial_velocity, "impulses": stage.impulses}
        added = shell_initial_motion(self.structure.model_copy(update=fields), mesh, bodies)
        self.state.add_motion(added.velocity, added.spin)

    def _step_to(self, at: float, watch: Watch) -> tuple[Status, str]:
        """Step to an output; gives how that went, and what ended the stage on the way."""
        if not watch.stage.until:
            return self.state.advance(
                at, threads=self.run.threads, progress=self._look, cancel=self.cancel
            ), ""
        while self.state.time < at:
            recent = time.perf_counter() - self.reported < REPORT_INTERVAL
            status = self.state.advance(
                at,
                threads=self.run.threads,
                # looks lie at multiples, so that an interrupted run makes the same ones
                steps=LOOK_STEPS - self.state.steps % LOOK_STEPS,
                progress=None if recent else self._look,
                cancel=None if recent else self.cancel,
            )
            if not status.ok:
                return status, ""
            met = watch.met(self.state) if self.state.steps % LOOK_STEPS == 0 else ""
            if met:
                return Status.COMPLETE, met
        return Status.COMPLETE, ""

    def _note(self, at: float, shape: bool) -> bool:
        """Record the state; False when its energies are not meaningful."""
        self.record.add({"at": np.array(at), **self.sampler.sample(self.state)})
        self.done = self._enough()
        near = np.abs(picture_times(self.run) - at) <= SAME_TIME * self.run.duration
        if shape or self.done or near.any():
            self.record.add_shape(shape_of(self.state, self.case.mesh))
        return trust.energy_residual(self.record) < RUNAWAY

    def _enough(self) -> bool:
        """Whether the caller has all that it needs."""
        enough = self.long_run.enough
        if enough is None or len(self.record) % ENOUGH_EVERY:
            return False
        noted = self.record["time"]
        channels = channels_of(self.structure, self.sampler, self.record, self.run.outputs)
        return enough({one.name: np.interp(self.times, noted, one.values) for one in channels})

    def _look(self, state: ShellState) -> None:
        """Report progress to the caller, and write the restart file at intervals."""
        now = self.reported = time.perf_counter()
        if self.progress is not None:
            self.progress(min(state.time / self.run.duration, 1.0))
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
            watch = {} if self.watch is None else self.watch.to_arrays()
            state = self.state
            saved = Saved(self.record, self.seconds, self.ended, state.checkpoint(), watch, state.isa)
            try:
                write_restart(self.long_run.restart_to, saved, self.mark)
                self.unsaved = ""
            except OSError as error:
                self._warn_unsaved(self.long_run.restart_to, error)
        self.saved = time.perf_counter()

    def _warn_unsaved(self, path: Path, error: OSError) -> None:
        """A run that is healthy goes on without a restart file."""
        reason = error.strerror or "the system refused"
        self.unsaved = f"The restart file {path} could not be written at {self.state.time:.4g} s: {reason}."
        if self.long_run.warn is not None:
            self.long_run.warn(self.unsaved)

    def _resume(self, path: Path) -> None:
        """Go back to where a restart file was written."""
        saved = read_restart(path, self.mark, self.state.isa)
        self.record, self.spent_before, self.ended = saved.record, saved.seconds, saved.ended
        if saved.ended:
            # a run that was saved at its end is still in its last stage
            number = min(len(saved.ended), len(self.run.sequence) - 1)
            self.state = self._state_of(
                self.run.sequence[number], saved.ended[number - 1].end if number else 0.0
            )
        self.state.restore(saved.state)
        fresh = Record()
        fresh.add({"at": np.array(0.0), **self.sampler.sample(self.state)})
        fresh.add_shape(shape_of(self.state, self.case.mesh))
        if not saved.record.is_like(fresh):
            raise unreadable(path, ValueError("record"))
        self.first_time, self.resumed = self.state.time, saved

    def _restore_watch(self, watch: Watch, saved: Saved) -> None:
        try:
            watch.restore(saved.watch)
        except ValueError as error:
            assert self.long_run.restart_from is not None
            raise unreadable(self.long_run.restart_from, error) from error


def with_place(reason: str, case: ShellCase) -> str:
    """A reason that names an element, with where the element lies."""
    found = re.search(r"element (\d+)", reason)
    return reason if found is None else f"{reason} ({case.mesh.place_of(int(found.group(1)))})"
