"""The multibody answer: lower, step, and say how far to believe it."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from crumple._core.tree import Outcome, Simulation, TreeRecord
from crumple.errors import InputError, Problem, Status
from crumple.multibody import trust
from crumple.multibody.histories import (
    energy_channels,
    hinge_channels,
    node_channels,
    section_channels,
    summaries,
)
from crumple.multibody.mechanism import Mechanism, lower
from crumple.multibody.model import start_of, tree_model
from crumple.multibody.poses import TreePoses
from crumple.multibody.rigid import Floats
from crumple.multibody.shapes import states_of
from crumple.multibody.start import Start
from crumple.result import Provenance, Result
from crumple.structure import MultibodySettings, Outputs, Structure

Progress = Callable[[float], None]
Cancel = Callable[[], bool]

CHECK_FACTOR = 4.0
"""The answer is computed at the accuracy asked for and again this much tighter, with at least two steps an
output interval: half the step of a second-order method.  The difference bounds the error of the second."""

STATUS = {
    Outcome.COMPLETE: Status.COMPLETE,
    Outcome.STEP_COLLAPSED: Status.STEP_COLLAPSED,
    Outcome.NOT_FINITE: Status.NOT_FINITE,
    Outcome.CANCELLED: Status.CANCELLED,
    Outcome.REFUSED: Status.REFUSED,
}


@dataclass(frozen=True)
class Run:
    """What the solver is told beside the structure: duration and output interval [s], settings, outputs."""

    duration: float
    every: float
    settings: MultibodySettings = field(default_factory=MultibodySettings)
    outputs: Outputs = field(default_factory=Outputs)
    title: str = ""


@dataclass(frozen=True, eq=False)
class _Solved:
    """What came out, before it is told."""

    mechanism: Mechanism
    start: Start
    record: TreeRecord
    errors: Floats
    lost: float
    seconds: float


def solve_multibody(
    structure: Structure, run: Run, progress: Progress | None = None, cancel: Cancel | None = None
) -> Result:
    """Solve a structure as rigid bodies joined by plastic hinges.

    Parameters
    ----------
    structure
        What is simulated.
    run
        How long, with which settings, reporting what.
    progress
        Called with the share done, 0 to 1.
    cancel
        Asked now and then; True ends the run with what it has.

    Returns
    -------
    Result
        Provenance holds the settings alone; version and input hash are the caller's.

    Raises
    ------
    InputError
        If the structure cannot be solved by this engine.

    References
    ----------
    Method in docs/theory/multibody_stepper.md.  Verified in tests/verification.
    """
    begin = time.perf_counter()
    mechanism = lower(structure)
    if not mechanism.bodies:
        raise _nothing_moves()
    model = tree_model(structure, mechanism, run.duration)
    start = start_of(structure, mechanism)
    times = output_times(run)
    settings = run.settings

    def stepped(accuracy: float, longest: float, share: tuple[float, float]) -> tuple[TreeRecord, float]:
        simulation = Simulation(model, accuracy, settings.minimum_time_step, longest)
        lost = simulation.set_motion(start.velocity, start.impulse)
        return simulation.run(times, _poll(run.duration, share, progress, cancel)), lost

    longest = settings.maximum_time_step
    record, lost = rough, _ = stepped(settings.accuracy, longest, (0.0, 0.4))
    if rough.outcome is Outcome.COMPLETE:
        longest = min(longest, run.every) / 2
        record, lost = stepped(settings.accuracy / CHECK_FACTOR, longest, (0.4, 1.0))
    errors = np.abs(rough.summary[:, 0] - record.summary[:, 0])
    seconds = time.perf_counter() - begin
    return _result(structure, run, _Solved(mechanism, start, record, errors, lost, seconds))


def output_times(run: Run) -> Floats:
    """Times at which the histories are recorded: the interval's multiples, the end and the pictures' [s]."""
    number = int(np.floor(run.duration / run.every * (1 + 1e-12)))
    regular = np.minimum(run.every * np.arange(number + 1), run.duration)
    wanted = np.concatenate([regular, [run.duration], [t for t in run.outputs.pictures if t < run.duration]])
    times = np.unique(wanted)
    apart = np.concatenate([[True], np.diff(times) > 1e-9 * run.duration])
    kept: Floats = times[apart]
    return kept


def _poll(
    duration: float, share: tuple[float, float], progress: Progress | None, cancel: Cancel | None
) -> Callable[[float], bool]:
    since, until = share

    def poll(reached: float) -> bool:
        if progress is not None:
            progress(since + (until - since) * reached / duration)
        return not (cancel is not None and cancel())

    return poll


def _result(structure: Structure, run: Run, solved: _Solved) -> Result:
    mechanism, record = solved.mechanism, solved.record
    status, reason = STATUS[record.outcome], record.reason
    bound = run.settings.energy_residual_bound
    if status.ok and record.residual > bound:
        status = Status.RESIDUAL_EXCEEDED
        reason = f"energy residual {record.residual:.2e} above its bound {bound:.2e}"
    poses = TreePoses(mechanism, record)
    wanted = list(node_channels(structure, poses, run.outputs.nodes))
    wanted += list(section_channels(structure, poses, run.outputs))
    channels = [*hinge_channels(mechanism, record), *energy_channels(record), *wanted]
    hinges = summaries(mechanism, record, solved.errors)
    result = Result(
        status=status,
        reason=reason,
        fidelity="multibody",
        title=run.title,
        time=record.time,
        channels={channel.name: channel for channel in channels},
        hinges=hinges,
        states=states_of(structure, poses, _picture_times(run)),
        energy_residual=record.residual,
        solve_seconds=solved.seconds,
        warnings=trust.warnings(structure, mechanism, hinges, record, lost=solved.lost, start=solved.start),
        assumptions=trust.assumptions(structure, mechanism),
        provenance=Provenance(version="", input_hash="", isa="scalar", settings=_settings(run, record)),
        output_names=tuple(channel.name for channel in wanted),
    )
    return result


def _picture_times(run: Run) -> Floats:
    return np.array(run.outputs.pictures or np.linspace(0.0, run.duration, 6))


def _settings(run: Run, record: TreeRecord) -> dict[str, float | int]:
    return {
        "accuracy": run.settings.accuracy,
        "minimum_time_step": run.settings.minimum_time_step,
        "maximum_time_step": run.settings.maximum_time_step,
        "energy_residual_bound": run.settings.energy_residual_bound,
        "steps": record.steps,
        "rejected_steps": record.rejected,
    }


def _nothing_moves() -> InputError:
    return InputError(
        Problem(
            "nothing can move: every part is held and no member has a hinge",
            "",
            "at least one hinge, or a part that is not clamped",
            "add hinges to the members that shall fold",
            "members",
        )
    )
