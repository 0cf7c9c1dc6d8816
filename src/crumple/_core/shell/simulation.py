"""Typed interface of the compiled shell engine: a model that does not change, and the state that advances."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from crumple._core.shell.build import built, floats, kernel
from crumple._core.shell.mark import marks
from crumple._core.shell.model import (
    Cut,
    Element,
    Hourglass,
    NodalLoad,
    PrescribedVelocity,
    RigidObstacle,
    RigidSet,
    Shape,
    Sheet,
    ShellMaterial,
    ShellModel,
    ShellSettings,
    SpotWeld,
)
from crumple.errors import InputError, Status
from crumple.numeric.arrays import Floats

__all__ = [
    "Cut",
    "Element",
    "Hourglass",
    "NodalLoad",
    "PrescribedVelocity",
    "RigidObstacle",
    "RigidSet",
    "Shape",
    "Sheet",
    "ShellMaterial",
    "ShellModel",
    "ShellSettings",
    "ShellState",
    "SpotWeld",
    "thickness_rule",
]

_SLOTS: Mapping[str, int] = kernel.slots
# Wall time after which advance() returns to check for cancellation and to report progress [s].
_LOOK_EVERY = 0.1
# Integration-point quantities by their place in the state, see native/shell/simd/layout.hpp.
_POINT_SLOTS = {"stress_x": 0, "stress_y": 1, "stress_xy": 2, "plastic_strain": 3}
# How the core reports the end of a run, see End in native/shell/run/simulation.hpp.
_REACHED, _NOT_FINITE, _COLLAPSED, _TORN, _INVERTED = 1, 2, 3, 4, 5
_ENDS = {
    _NOT_FINITE: Status.NOT_FINITE,
    _COLLAPSED: Status.STEP_COLLAPSED,
    _TORN: Status.NOT_FINITE,
    _INVERTED: Status.INVERTED,
}


class ShellState:
    """The changing state of a model.

    Parameters
    ----------
    model
        What is computed; copied, so later changes of its arrays have no effect.
    isa
        Instruction set of the kernels (``x86-64-v2``, ``-v3``, ``-v4``, ``generic``); empty: the variable
        ``CRUMPLE_ISA``, else the best of this machine.

    Raises
    ------
    InputError
        Naming the first node, element, part or set that cannot be computed.
    """

    def __init__(self, model: ShellModel, isa: str = "") -> None:
        self.model = model
        try:
            self._core = kernel.Simulation(built(model), isa or os.environ.get("CRUMPLE_ISA", ""))
        except ValueError as error:
            raise InputError(str(error)) from error
        self._marks = marks(model)

    def advance(
        self,
        until: float,
        *,
        threads: int = 1,
        steps: int | None = None,
        progress: Callable[[ShellState], None] | None = None,
        cancel: Callable[[], bool] | None = None,
    ) -> Status:
        """Step until the first step at or after ``until`` [s], or for ``steps`` steps.

        Parameters
        ----------
        threads
            At most so many; the result is the same to the last bit.
        progress
            Called about ten times a second with this state.
        cancel
            Polled as often; True ends the call.

        Returns
        -------
        Status
            COMPLETE when the time or the steps are reached; else why not. The state is the last computed.
        """
        left = np.iinfo(np.int64).max if steps is None else steps
        while True:
            if cancel is not None and cancel():
                return Status.CANCELLED
            before = self._core.steps
            end = self._core.advance(until, _LOOK_EVERY, left, threads)
            left -= self._core.steps - before
            if progress is not None:
                progress(self)
            if end in _ENDS:
                return _ENDS[end]
            if end == _REACHED or left <= 0:
                return Status.COMPLETE

    @property
    def reason(self) -> str:
        """Why the run stopped, in one sentence; empty while it can go on."""
        element = self._core.failed_element
        if self._core.end == _NOT_FINITE:
            return f"the state of element {element} is not finite at {self.time:.6g} s"
        if self._core.end == _COLLAPSED:
            return f"element {element} has collapsed: stable step below the least at {self.time:.6g} s"
        if self._core.end == _INVERTED:
            return f"element {element} is inverted: a corner has crossed it at {self.time:.6g} s"
        if self._core.end == _TORN:
            what = f"element {element} strained by more than a third in one step"
            return f"the solution has diverged: {what} at {self.time:.6g} s"
        return ""

    @property
    def time(self) -> float:
        """Time reached [s]."""
        return float(self._core.time)

    @property
    def time_step(self) -> float:
        """Length of the next step [s]."""
        return float(self._core.step)

    @property
    def first_time_step(self) -> float:
        """Stable step of the first shape with safety and mass scaling [s]."""
        return float(self._core.first_step)

    @property
    def steps(self) -> int:
        """Number of steps so far."""
        return int(self._core.steps)

    @property
    def isa(self) -> str:
        """Instruction set of the kernels in use."""
        return str(self._core.isa)

    @property
    def mass(self) -> float:
        """Mass of the elements without scaling [kg]."""
        return float(self._core.mass)

    @property
    def added_mass(self) -> float:
        """Mass added by mass scaling [kg]."""
        return float(self._core.added_mass)

    @property
    def deepest_penetration(self) -> float:
        """Largest penetration so far over the gap; above 1 a node has passed the mid-surface."""
        return float(self._core.deepest_penetration)

    @property
    def touching_nodes(self) -> int:
        """Number of nodes with a contact force at present."""
        return int(self._core.touching_nodes)

    @property
    def contact_searches(self) -> int:
        """Number of contact searches so far."""
        return int(self._core.contact_searches)

    @property
    def position(self) -> Floats:
        """Present position of the nodes [m], (n, 3)."""
        return _array(self._core.positions())

    @property
    def velocity(self) -> tuple[Floats, Floats]:
        """Velocities [m/s] and angular velocities [rad/s] at the time of the positions, (n, 3) each."""
        linear, angular = self._core.velocities()
        return _array(linear), _array(angular)

    @property
    def energies(self) -> dict[str, float]:
        """Ledger [J]: kinetic, elastic, plastic, hourglass, contact, damping, external_work, residual.

        ``residual`` = kinetic + elastic + plastic + hourglass + contact + damping - external_work - kinetic
        at the start; ``eroded``, elastic energy of deleted elements, is contained in ``elastic``.
        """
        return dict(self._core.energies())

    def cut(self, index: int) -> tuple[Floats, Floats, Floats]:
        """Force [N], moment [N m] and the place it is taken about [m] of one cut, each (3,)."""
        force, moment, centre = self._core.cut(index)
        return _array(force), _array(moment), _array(centre)

    def element_field(self, name: str) -> Floats:
        """Per element, (m,).

        Names: thickness [m]; internal_energy, plastic_energy, hourglass_energy [J]; shear_xz, shear_yz [Pa];
        alive.
        """
        return _array(self._core.element_slot(_SLOTS[name]))

    def point_field(self, name: str) -> Floats:
        """Per element and integration point through the thickness, (m, points).

        Names: stress_x, stress_y, stress_xy [Pa] in the element's axes; plastic_strain.
        """
        return _array(self._core.point_slot(_POINT_SLOTS[name]))

    @property
    def rigid_sets(self) -> Floats:
        """Per rigid set, (k, 18): centre of mass [m], velocity, angular velocity, rotation by rows."""
        return _array(self._core.rigid_states())

    @property
    def spot_welds(self) -> Floats:
        """Per spot weld, (k, 5).

        1 where it has failed; time of the last look or of failure [s]; normal force (tension positive) and
        shear force then [N]; largest left side of the criterion so far.
        """
        return _array(self._core.weld_states())

    @property
    def obstacles(self) -> Floats:
        """Motion of every obstacle and what acts on it, (k, 15).

        Displacement [m] and its rate, angle [rad] and its rate, force [N] and impulse so far [N s] of the
        structure on it, deepest penetration so far over half the wall's thickness.
        """
        return _array(self._core.obstacle_states())

    @property
    def appeared_inside(self) -> Floats:
        """Depth [m] and number of the deepest node in obstacles that appeared with this stage, (k, 2)."""
        return _array(self._core.appeared_inside())

    @property
    def external_work(self) -> float:
        """External work so far [J], as in `energies` but at less cost."""
        return float(self._core.external_work())

    @property
    def internal_forces(self) -> Floats:
        """Internal force [N] and moment [N m] per node, (n, 6): what from outside would hold it."""
        return _array(self._core.node_forces())

    def deform(self, position: Floats, velocity: Floats, spin: Floats, dt: float) -> Floats:
        """Move the nodes to a given position within ``dt`` [s] without time integration; internal_forces."""
        self._core.deform(floats(position), floats(velocity), floats(spin), dt)
        return self.internal_forces

    def checkpoint(self) -> dict[str, Floats]:
        """Full state as named arrays that np.savez can store; a restored run gives the same bits.

        It fits the instruction set that made it: the layout depends on its lanes.
        """
        saved = {name: _array(values) for name, values in self._core.save().items()}
        return saved | {"marks": self._marks.copy()}

    def add_motion(self, velocity: Floats, spin: Floats) -> None:
        """Add velocities [m/s] and angular velocities [rad/s], (n, 3) each; not to held or driven nodes."""
        self._core.add_motion(floats(velocity), floats(spin))

    def stop(self) -> None:
        """Set all velocities to zero; their energy counts as damped."""
        self._core.stop()

    def restore(self, saved: Mapping[str, Floats], *, of_stage_before: bool = False) -> None:
        """Return to a checkpoint of the same model.

        Parameters
        ----------
        of_stage_before
            Go on from a model that differs in drives, loads, damping and present obstacles alone.

        Raises
        ------
        InputError
            If the checkpoint belongs to another model or instruction set.
        """
        own = self._marks[:1] if of_stage_before else self._marks
        try:
            given = np.asarray(saved["marks"])
            if given.shape != self._marks.shape or not np.array_equal(given[: len(own)], own):
                raise ValueError("the checkpoint belongs to another model")
            self._core.restore({name: floats(saved[name]) for name in saved}, not of_stage_before)
        except ValueError as error:
            raise InputError(str(error)) from error
        except KeyError as error:
            raise InputError(f"the checkpoint lacks {error}") from error


def thickness_rule(points: int, lobatto: bool = False) -> tuple[Floats, Floats]:
    """Places z/t in [-1/2, 1/2] and weights (sum 1) of the points through the thickness."""
    z, weight = kernel.thickness_rule(points, lobatto)
    return _array(z), _array(weight)


def _array(values: Any) -> Floats:
    return np.asarray(values, dtype=np.float64)
