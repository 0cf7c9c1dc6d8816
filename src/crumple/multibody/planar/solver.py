"""Solution of a structure in a plane by the tree kernel."""

from __future__ import annotations

import time
from functools import cached_property
from typing import Any

from crumple._core.planar.simulation import Simulation, kernel_model
from crumple.multibody.answer.hinge_histories import hinge_histories, ledger, spread_energy
from crumple.multibody.answer.poses import TreePoses
from crumple.multibody.answer.solved import Poll, Solved
from crumple.multibody.planar.case import recorded_hinges
from crumple.multibody.planar.mechanism import Mechanism, lower
from crumple.multibody.planar.model import planar_initial_motion, tree_model
from crumple.multibody.run import Run, output_times, refuse_unbegun, step_bounds
from crumple.structure import PlacedHinge, Structure


class TreeSolver:
    """A mechanism with parallel hinges, ready for time integration.

    Parameters
    ----------
    structure, run
        The structure, and duration, settings and outputs of the run.
    hinges
        The structure's.

    Raises
    ------
    InputError
        If the structure does not move in a plane, or cannot be solved.
    """

    kernel = "tree"

    def __init__(self, structure: Structure, run: Run, hinges: tuple[PlacedHinge, ...]) -> None:
        self._structure, self._run = structure, run
        self.mechanism: Mechanism = lower(structure, hinges)
        frequency = run.settings.resolved_frequency
        self._model = tree_model(structure, self.mechanism, run.duration, resolved_frequency=frequency)
        self._start = planar_initial_motion(structure, self.mechanism)

    @cached_property
    def _compiled(self) -> Any:
        return kernel_model(self._model)

    @property
    def moving(self) -> bool:
        """See `Solver`."""
        return bool(self.mechanism.bodies)

    @cached_property
    def hinges(self) -> tuple[PlacedHinge, ...]:
        """See `Solver`."""
        return tuple(recorded.hinge for recorded in recorded_hinges(self.mechanism))

    @property
    def notes(self) -> tuple[str, ...]:
        """See `Solver`: the spatial kernel solves what stands at a dead centre."""
        return ()

    def with_hinges(self, hinges: tuple[PlacedHinge, ...]) -> TreeSolver:
        """See `Solver`."""
        return TreeSolver(self._structure, self._run, hinges)

    def run(self, accuracy: float, poll: Poll | None, *, ends_only: bool = False) -> Solved:
        """See `Solver`."""
        settings = self._run.settings
        longest, parts = step_bounds(self._run, ends_only=ends_only)
        bounds = settings.minimum_time_step, longest
        simulation = Simulation(self._model, accuracy, *bounds, self._compiled, parts=parts)
        lost = simulation.set_motion(self._start.velocity, self._start.impulse)
        begin = time.perf_counter()
        record = simulation.run(output_times(self._run, ends_only=ends_only), poll)
        seconds = time.perf_counter() - begin
        refuse_unbegun(record.outcome, record.time)
        return Solved(
            outcome=record.outcome,
            reason=record.reason,
            residual=record.residual,
            unseen=record.unseen,
            steps=record.steps,
            rejected=record.rejected,
            forced=record.forced,
            time=record.time,
            solves=record.solves,
            given=self._start.given_energy,
            lost=lost,
            struck=bool(self._start.impulse.any()),
            poses=TreePoses(self.mechanism, record),
            hinges=tuple(hinge_histories(recorded_hinges(self.mechanism), record, record.summary)),
            energy=ledger(record),
            stepping_seconds=seconds,
            spread=spread_energy(recorded_hinges(self.mechanism), record),
        )
