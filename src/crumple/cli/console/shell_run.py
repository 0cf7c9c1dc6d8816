"""What `crumple run --fidelity shell` adds: threads, restart files, status lines, notes before the run."""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from crumple.analysis import Analysis
    from crumple.cli.console.progress import Bar
    from crumple.shell import LongRun, Moment

RESTART = "restart.npz"
"""Name of the restart file in the folder of the results."""
STATUS_INTERVAL = 10.0
"""Wall time between two status lines if there is no terminal for a progress bar [s]."""
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

    last = time.monotonic()

    def watch(moment: Moment) -> None:
        nonlocal last
        text = status_line(moment)
        if bar.drawn:
            bar.describe(text)
        elif not sys.stderr.isatty() and time.monotonic() - last > STATUS_INTERVAL:
            last = time.monotonic()
            print(text, file=sys.stderr, flush=True)

    return LongRun(restart_from=restart, restart_to=folder / RESTART, watch=watch)


def status_line(moment: Moment) -> str:
    """One line: simulated time, time step, energies, and estimated wall time left."""
    energies = ", ".join(f"{name} {moment.energies[name]:.4g} J" for name in PUT_IN)
    return (
        f"{1e3 * moment.time:.4g} of {1e3 * moment.duration:.4g} ms, step {1e6 * moment.time_step:.3g} us, "
        f"{energies}; about {duration(moment.seconds_left)} left"
    )


def duration(seconds: float) -> str:
    """Wall time in readable units."""
    if seconds < 100.0:
        return f"{seconds:.0f} s"
    return f"{seconds / 60.0:.0f} min" if seconds < 6000.0 else f"{seconds / 3600.0:.1f} h"
