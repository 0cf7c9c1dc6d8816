"""How long the stepping itself takes, apart from reading laws and arranging bodies."""

from __future__ import annotations

import time

from crumple._core.tree import Outcome, Simulation
from crumple.multibody.mechanism import lower
from crumple.multibody.model import start_of, tree_model
from crumple.multibody.solve import Run, output_times
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
    mechanism = lower(structure)
    model, start, times = (
        tree_model(structure, mechanism, run.duration),
        start_of(structure, mechanism),
        output_times(run),
    )
    found = []
    for _ in range(REPEATS):
        settings = run.settings
        simulation = Simulation(
            model, settings.accuracy, settings.minimum_time_step, settings.maximum_time_step
        )
        simulation.set_motion(start.velocity, start.impulse)
        begin = time.perf_counter()
        record = simulation.run(times, None)
        found.append(time.perf_counter() - begin)
        if record.outcome is not Outcome.COMPLETE:
            return None
    return min(found)
