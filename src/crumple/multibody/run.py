"""Settings of a run, and what the runs of both kernels share: output times, progress, status."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from crumple._core.outcome import Outcome
from crumple.errors import CancelledError, Status
from crumple.numeric.arrays import Floats
from crumple.structure import MultibodySettings, Outputs, Stage, time_in_motion

Progress = Callable[[float], None]
Cancel = Callable[[], bool]

CHECK_FACTOR = 4.0
"""The answer is computed this much tighter than asked for, which halves the step of a second-order method.
A run at the accuracy asked for follows, without outputs on the way, so that its steps are those which the
error control chooses; the difference bounds the error of the answer."""

CANNOT_GO_ON = frozenset({Outcome.STEP_COLLAPSED, Outcome.STALLED, Outcome.NOT_FINITE})
"""Ends of a run that is then repeated, aside of dead centres or with walls that crush, or with rigid bars."""

STATUS = {
    Outcome.COMPLETE: Status.COMPLETE,
    Outcome.STEP_COLLAPSED: Status.STEP_COLLAPSED,
    Outcome.NOT_FINITE: Status.NOT_FINITE,
    Outcome.CANCELLED: Status.CANCELLED,
    Outcome.REFUSED: Status.REFUSED,
    Outcome.UNHELD: Status.UNHELD,
    Outcome.LIMIT_LOAD: Status.LIMIT_LOAD,
    Outcome.STALLED: Status.STALLED,
}


@dataclass(frozen=True)
class Run:
    """Settings of a run: duration and output interval [s], outputs, factors on the capacities of hinges.

    Without `checks` its error is not estimated, nor whether its mechanism is unique.  With `bending_tried`
    members that bend ended an earlier run, so that nothing advises them.
    """

    duration: float
    every: float
    settings: MultibodySettings = field(default_factory=MultibodySettings)
    outputs: Outputs = field(default_factory=Outputs)
    title: str = ""
    stages: tuple[Stage, ...] = ()
    capacities: Mapping[str, float] = field(default_factory=dict)
    checks: bool = True
    bending_tried: bool = False

    @property
    def time_in_motion(self) -> float:
        """Duration without quasi-static stages [s]."""
        return time_in_motion(self.duration, self.stages)


def output_times(run: Run, *, ends_only: bool = False) -> Floats:
    """Times at which the histories are recorded: the interval's multiples, the end and the pictures' [s]."""
    if ends_only:
        return np.array([0.0, run.duration])
    number = int(np.floor(run.duration / run.every * (1 + 1e-12)))
    regular = np.minimum(run.every * np.arange(number + 1), run.duration)
    pictures = [t for t in run.outputs.pictures if t < run.duration]
    times = np.sort(np.concatenate([regular, [run.duration], pictures]))
    apart = times[1:] - times[:-1] > 1e-9 * run.duration
    return np.concatenate([times[:1], times[1:][apart]])


def step_bounds(run: Run, *, ends_only: bool) -> tuple[float, int]:
    """Largest step [s], and least number of steps between two breaks.

    The answer makes twice as many steps as the run that shows its error: were both bounded alike, they
    would take the same steps and show no error.
    """
    longest = run.settings.maximum_time_step
    return (2.0 * longest, 1) if ends_only else (longest, 2)


def poll_of(
    duration: float, share: tuple[float, float], progress: Progress | None, cancel: Cancel | None
) -> Callable[[float], bool]:
    """Callback of a kernel: passes the share done on, and returns whether to continue."""
    since, until = share

    def poll(reached: float) -> bool:
        if progress is not None:
            progress(since + (until - since) * reached / duration)
        return not (cancel is not None and cancel())

    return poll


def refuse_unbegun(outcome: Outcome, time: Floats) -> None:
    """Raise if a run was cancelled before its first output, so that there is no result.

    Raises
    ------
    CancelledError
        If there is no output yet.
    """
    if outcome is Outcome.CANCELLED and len(time) <= 1:
        raise CancelledError("cancelled before the first output: nothing was kept")


def outcome_status(outcome: Outcome, reason: str, residual: float, bound: float) -> tuple[Status, str]:
    """Status and reason of a run; its energy residual is compared with the allowed one."""
    status = STATUS[outcome]
    if status.ok and residual > bound:
        return Status.RESIDUAL_EXCEEDED, f"energy residual {residual:.2e} above its bound {bound:.2e}"
    return status, reason


def picture_times(run: Run) -> Floats:
    """Times at which the deformed shape is stored [s]."""
    return np.array(run.outputs.pictures or np.linspace(0.0, run.duration, 6))
