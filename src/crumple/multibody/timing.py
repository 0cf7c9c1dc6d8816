"""Time of a solve when it is repeated, and of its time integration alone."""

from __future__ import annotations

from collections.abc import Callable

from crumple._core.outcome import Outcome
from crumple.multibody.run import Run
from crumple.multibody.solve import solver_of
from crumple.structure import Structure, with_elastic_members

REPEATS = 20
"""Number of runs of which the fastest counts: the first one fills caches, and others may be interrupted."""
LONG = 1.0
"""Time spent on repeats [s] after which no further one is started."""


def least_seconds(once: Callable[[], float]) -> float:
    """Shortest of several wall times [s]; ``once`` does the work and returns its wall time."""
    found: list[float] = []
    while not found or (len(found) < REPEATS and sum(found) < LONG):
        found.append(once())
    return min(found)


def stepping_seconds(structure: Structure, run: Run) -> float | None:
    """Wall time of the time integration alone, with its outputs [s], fastest of several; None if it fails.

    Parameters
    ----------
    structure
        What is simulated.
    run
        How long, with which settings and outputs.
    """
    solver = solver_of(with_elastic_members(structure, run.settings, run.time_in_motion), run)
    if solver.run(run.settings.accuracy, None).outcome is not Outcome.COMPLETE:
        return None
    return least_seconds(lambda: solver.run(run.settings.accuracy, None).stepping_seconds)
