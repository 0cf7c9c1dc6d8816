"""When a stage ends before its time: the first of its conditions that is met."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from crumple._core.shell.simulation import ShellState
from crumple.numeric.arrays import Floats
from crumple.shell.answer.record import IMPULSE, ring_of_node
from crumple.shell.mesh.mesh import Mesh
from crumple.shell.model.model import ShellCase
from crumple.structure import Stage, Structure, Until

LOOK_STEPS = 5
"""Steps between two checks: they cost little, and the stage ends late by less than a node's contact lasts."""
FORCE_WINDOW = 5e-3
"""Share of a stage's longest duration over which forces are averaged: contact forces are spikes."""


class Watch:
    """Checks the conditions of one stage.

    Parameters
    ----------
    structure, case
        What is computed.
    stage
        The stage with its conditions.
    state
        Where it starts.
    """

    def __init__(self, structure: Structure, case: ShellCase, stage: Stage, state: ShellState) -> None:
        self.structure, self.case, self.stage = structure, case, stage
        self.first = [self._reading(until, state) for until in stage.until]
        self.work = state.external_work
        # impulse of every force condition, at the start of the window and now
        self.since, self.seen = state.time, state.time
        self.impulse = [np.zeros(3) for _ in stage.until]
        self.mark = [self._impulse(until, state) for until in stage.until]

    def met(self, state: ShellState) -> str:
        """What ends the stage now, in words; empty while nothing does."""
        step, self.seen = state.time - self.seen, state.time
        window = state.time - self.since
        full = window >= FORCE_WINDOW * self.stage.duration
        found = ""
        for k, until in enumerate(self.stage.until):
            if until.quantity == "force":
                self._gather(k, until, state, step)
                if full and float(np.linalg.norm(self.impulse[k])) / window >= until.value:
                    found = found or f"force on {until.of} reached {until.value:g} N"
            elif self._reached(k, until, state):
                found = found or _in_words(until)
        if full:
            self.since = state.time
            self.impulse = [np.zeros(3) for _ in self.stage.until]
        return found

    def to_arrays(self) -> dict[str, Floats]:
        """Everything that a restart needs."""
        three = (self.first, self.impulse, self.mark)
        return {
            "numbers": np.array([self.work, self.since, self.seen]),
            "vectors": np.array(three, float).reshape(-1, 3),
        }

    def restore(self, arrays: Mapping[str, Floats]) -> None:
        """Restore the state from the arrays of `to_arrays`; ValueError if other conditions wrote them."""
        if {k: v.shape for k, v in arrays.items()} != {k: v.shape for k, v in self.to_arrays().items()}:
            raise ValueError("the conditions are not those of the stage")
        self.work, self.since, self.seen = (float(value) for value in arrays["numbers"])
        vectors = arrays["vectors"].reshape(3, -1, 3)
        self.first, self.impulse, self.mark = ([*part] for part in vectors)

    def _gather(self, k: int, until: Until, state: ShellState, step: float) -> None:
        """Add the impulse since the last look: an obstacle's own, a support's force now times the time."""
        if until.of in self.structure.obstacles:
            now = self._impulse(until, state)
            self.impulse[k] = self.impulse[k] + now - self.mark[k]
            self.mark[k] = now
        else:
            cut = len(self.case.zones) + list(self.case.supports).index(str(until.of))
            self.impulse[k] = self.impulse[k] + step * state.cut(cut)[0]

    def _impulse(self, until: Until, state: ShellState) -> Floats:
        if until.quantity != "force" or until.of not in self.structure.obstacles:
            return np.zeros(3)
        return np.asarray(state.obstacles[self._number(until), IMPULSE])

    def _number(self, until: Until) -> int:
        return list(self.structure.obstacles).index(str(until.of))

    def _reading(self, until: Until, state: ShellState) -> Floats:
        """Displacement of an obstacle or support, or distance of two nodes (in x), (3,)."""
        mesh = self.case.mesh
        if until.between is not None:
            a, b = (place_of(mesh, node, state) for node in until.between)
            return np.array([float(np.linalg.norm(a - b)), 0.0, 0.0])
        if until.quantity != "displacement":
            return np.zeros(3)
        if until.of in self.structure.obstacles:
            return np.asarray(state.obstacles[self._number(until), :3])
        return place_of(mesh, self.structure.supports[str(until.of)].node, state)

    def _reached(self, k: int, until: Until, state: ShellState) -> bool:
        if until.quantity == "energy":
            return state.external_work - self.work >= until.value
        change = self._reading(until, state) - self.first[k]
        if until.quantity == "displacement":
            return float(np.linalg.norm(change)) >= until.value
        return float(change[0]) / until.value >= 1.0


def place_of(mesh: Mesh, node: str, state: ShellState) -> Floats:
    """Where a structure node is now: its rigid body's reference, else the middle of its section [m]."""
    position = state.position
    if node in mesh.reference:
        return np.asarray(position[mesh.reference[node]])
    return np.asarray(position[ring_of_node(mesh, node)].mean(axis=0))


def _in_words(until: Until) -> str:
    if until.quantity == "energy":
        return f"work reached {until.value:g} J"
    if until.quantity == "displacement":
        return f"displacement of {until.of} reached {until.value:g} m"
    return f"distance between {' and '.join(until.between or ())} changed by {until.value:g} m"
