"""What `crumple run --fidelity shell` needs beside: threads, restart files, news, and notes before it."""

from __future__ import annotations

import os
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
"""Energies that the news tell."""


def available_threads() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def shell_notes(analysis: Analysis) -> tuple[str, ...]:
    """What the shell solver says of an analysis before its first step: mesh and warnings.

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
    """Restart files and a watcher that tells on standard error where the run is."""
    from crumple.shell import LongRun

    def watch(moment: Moment) -> None:
        bar.say(news(moment))

    def warn(text: str) -> None:
        print(f"Warning: {text}", file=sys.stderr, flush=True)

    return LongRun(restart_from=restart, restart_to=folder / RESTART, watch=watch, warn=warn)


def remove_restart(folder: Path, result: Result) -> None:
    """Remove the restart file of a run that came to its end and whose results are on the disk."""
    if result.status in (Status.COMPLETE, Status.RESIDUAL_EXCEEDED):
        (folder / RESTART).unlink(missing_ok=True)


def news(moment: Moment) -> str:
    """One line: where the run is, its step, its energies, and how long it will take."""
    energies = ", ".join(f"{name} {moment.energies[name]:.4g} J" for name in PUT_IN)
    return (
        f"{1e3 * moment.time:.4g} of {1e3 * moment.duration:.4g} ms, step {1e6 * moment.time_step:.3g} us, "
        f"{energies}; about {duration(moment.seconds_left)} left"
    )
