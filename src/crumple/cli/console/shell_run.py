"""What `crumple run --fidelity shell` adds: threads, restart files, status lines, notes before the run."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from crumple.cli.console.progress import duration
from crumple.errors import Status

if TYPE_CHECKING:
    from crumple.analysis import Analysis
    from crumple.cli.console.progress import Bar
    from crumple.result import Result
    from crumple.shell import LongRun, Moment

RESTART = "restart.npz"
"""Name of the restart file in the folder of the results."""
PUT_IN = ("kinetic", "elastic", "plastic", "hourglass", "contact")
"""Energies in the status line."""


def shell_notes(analysis: Analysis) -> tuple[str, ...]:
    """Notes of the shell solver about an analysis before its first step: mesh and warnings.

    Raises
    ------
    InputError
        If it cannot take the structure, or a setting does not fit its mesh.
    """
    from crumple.shell import ShellRun, start_notes

    run = ShellRun(
        duration=analysis.duration,
        every=analysis.output_interval,
        settings=analysis.shell,
        outputs=analysis.outputs,
        stages=analysis.stages,
    )
    return start_notes(analysis.structure, run)


def long_run_of(folder: Path, restart: Path | None, bar: Bar) -> LongRun:
    """Restart files and a callback that reports the state of the run on standard error."""
    from crumple.shell import LongRun

    def watch(moment: Moment) -> None:
        bar.describe(status_line(moment))

    def warn(text: str) -> None:
        print(f"Warning: {text}", file=sys.stderr, flush=True)

    return LongRun(restart_from=restart, restart_to=folder / RESTART, watch=watch, warn=warn)


def remove_restart(folder: Path, result: Result) -> None:
    """Remove the restart file of a run that has ended and whose results are stored."""
    if result.status in (Status.COMPLETE, Status.RESIDUAL_EXCEEDED):
        (folder / RESTART).unlink(missing_ok=True)


def status_line(moment: Moment) -> str:
    """One line: simulated time, time step, energies, and estimated wall time left."""
    energies = ", ".join(f"{name} {moment.energies[name]:.4g} J" for name in PUT_IN)
    return (
        f"{1e3 * moment.time:.4g} of {1e3 * moment.duration:.4g} ms, step {1e6 * moment.time_step:.3g} us, "
        f"{energies}; about {duration(moment.seconds_left)} left"
    )
