"""A structure in a plane: the tree kernel's run."""

from __future__ import annotations

import time
from collections.abc import Iterator
from functools import cached_property
from typing import Any

import numpy as np

from crumple._core.planar.simulation import Simulation, TreeRecord, kernel_model
from crumple.multibody.answer.poses import TreePoses
from crumple.multibody.answer.solved import HingeHistory, Poll, Solved
from crumple.multibody.planar.mechanism import Mechanism, hinge_links, lower
from crumple.multibody.planar.model import start_of, tree_model
from crumple.multibody.run import Run, output_times
from crumple.numeric.arrays import Floats
from crumple.structure import PlacedHinge, Structure


class TreeSolver:
    """A mechanism with parallel hinges, ready to step.

    Parameters
    ----------
    structure, run
        What is solved, and how long with which outputs.
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
        self._model = tree_model(structure, self.mechanism, run.duration)
        self._start = start_of(structure, self.mechanism)

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
        return tuple(hinge for _, hinge, _ in hinge_links(self.mechanism.links))

    def with_hinges(self, hinges: tuple[PlacedHinge, ...]) -> TreeSolver:
        """See `Solver`."""
        return TreeSolver(self._structure, self._run, hinges)

    def run(self, accuracy: float, poll: Poll | None, *, ends_only: bool = False) -> Solved:
        """See `Solver`."""
        settings = self._run.settings
        bounds = settings.minimum_time_step, settings.maximum_time_step
        simulation = Simulation(self._model, accuracy, *bounds, self._compiled)
        lost = simulation.set_motion(self._start.velocity, self._start.impulse)
        begin = time.perf_counter()
        record = simulation.run(output_times(self._run, ends_only=ends_only), poll)
        seconds = time.perf_counter() - begin
        return Solved(
            outcome=record.outcome,
            reason=record.reason,
            residual=record.residual,
            steps=record.steps,
            rejected=record.rejected,
            forced=record.forced,
            given=self._start.given_energy,
            lost=lost,
            struck=bool(self._start.impulse.any()),
            poses=TreePoses(self.mechanism, record),
            hinges=tuple(hinge_histories(self.mechanism, record)),
            energy=energy_of(record),
            stepping_seconds=seconds,
        )


def hinge_histories(mechanism: Mechanism, record: TreeRecord) -> Iterator[HingeHistory]:
    """What every hinge did, in the kernel's order."""
    for (hinge, columns), row in zip(hinge_columns(mechanism, record), record.summary, strict=True):
        largest, moment_max, rest, turning, energy = row
        at_rest = None if turning else float(rest)
        yield HingeHistory(hinge, columns, float(largest), float(moment_max), at_rest, float(energy))


def hinge_columns(
    mechanism: Mechanism, record: TreeRecord
) -> Iterator[tuple[PlacedHinge, dict[str, tuple[str, Floats]]]]:
    """Unit and values, (n,), of every hinge's quantities, in the kernel's order."""
    for k, (dof, hinge, sign) in enumerate(hinge_links(mechanism.links)):
        plastic, moment, capacity, dissipated = record.hinge[:, k, :4].T
        columns = {
            "rotation": ("rad", sign * record.q[:, dof]),
            "rotation_rate": ("rad/s", sign * record.w[:, dof]),
            "plastic_rotation": ("rad", sign * plastic),
            "moment": ("N*m", sign * moment),
            "capacity": ("N*m", np.array(capacity)),
            "energy": ("J", np.array(dissipated)),
        }
        yield hinge, columns


def energy_of(record: TreeRecord) -> dict[str, Floats]:
    """Terms of the energy ledger [J], (n,) each."""
    dissipated = record.hinge[:, :, 3].sum(axis=1)
    return {
        "kinetic": record.energy[:, 0],
        "elastic": record.energy[:, 1:5].sum(axis=1) - dissipated,
        "dissipated": dissipated,
        "external_work": record.energy[:, 5],
    }
