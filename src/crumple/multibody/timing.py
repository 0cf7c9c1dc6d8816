"""How long the stepping itself takes, apart from reading laws and arranging bodies."""

from __future__ import annotations

from crumple._core.tree import Outcome
from crumple.multibody.run import Run
from crumple.multibody.solve import solver_of
from crumple.structure import Structure

REPEATS = 5
"""Runs of which the fastest counts: the first one warms caches, and others may be interrupted."""


def stepping_seconds(structure: Structure, run: Run) -> float | None:
    """Wall time of one run of the stepper with its outputs [s], fastest of several; None if it fails.

    Parameters
    ----------
    structure
        What is simulated.
    run
        How long, with which settings and outputs.
    """
    solver = solver_of(structure, run)
    found = []
    for _ in range(REPEATS):
        solved = solver.run(run.settings.accuracy, None)
        if solved.outcome is not Outcome.COMPLETE:
            return None
        found.append(solved.stepping_seconds)
    return min(found)
