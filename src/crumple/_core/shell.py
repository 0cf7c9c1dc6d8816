"""Typed face of the compiled shell engine: a frozen model of plain arrays, and the state that advances it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crumple._core import _kernels  # type: ignore[attr-defined]
from crumple.errors import InputError, Status

Floats = NDArray[np.float64]
Indices = NDArray[np.uint32]

_kernel: Any = _kernels.shell
_SLOTS: Mapping[str, int] = _kernel.slots
_INFINITY = float("inf")
# Wall time after which a running advance() comes back to look for cancellation and to report progress [s].
_LOOK_EVERY = 0.1
# Point quantities by their place in the state, see native/shell/layout.hpp.
_POINT_SLOTS = {"stress_x": 0, "stress_y": 1, "stress_xy": 2, "plastic_strain": 3}
_DOFS = {"x": 0, "y": 1, "z": 2, "rx": 3, "ry": 4, "rz": 5}


class Hourglass(Enum):
    """How the modes that one-point integration cannot see are held."""

    STIFFNESS = "stiffness"
    VISCOUS = "viscous"


@dataclass(frozen=True)
class ShellMaterial:
    """Isotropic metal sheet.

    Attributes
    ----------
    density, youngs_modulus, poissons_ratio
        [kg/m3], [Pa], [-].
    yield_stress
        Constant yield stress [Pa], or None for an elastic material (unless ``hardening`` is given).
    hardening_modulus
        Slope of the yield stress against plastic strain [Pa] behind ``yield_stress``.
    hardening
        (plastic strain, yield stress [Pa]) of a table that starts at strain 0 and does not soften; constant
        beyond its last point.  Replaces ``yield_stress``.
    rate_reference, rate_exponent
        Cowper-Symonds D [1/s] and q: yield times 1 + (rate/D)**(1/q); infinite D: no effect.
    rate_time
        Time constant of the smoothing of the total strain rate [s].
    failure_strain
        Plastic strain at which a thickness point has failed; infinite: never.
    fails_at_any_point
        Delete the element when its first point has failed; else when all have.
    """

    density: float
    youngs_modulus: float
    poissons_ratio: float
    yield_stress: float | None = None
    hardening_modulus: float = 0.0
    hardening: tuple[ArrayLike, ArrayLike] | None = None
    rate_reference: float = _INFINITY
    rate_exponent: float = 1.0
    rate_time: float = 1e-5
    failure_strain: float = _INFINITY
    fails_at_any_point: bool = False

    def table(self) -> tuple[Floats, Floats]:
        """Plastic strains and yield stresses [Pa]; empty for an elastic material."""
        if self.hardening is not None:
            strain, stress = (_floats(column) for column in self.hardening)
            return strain, stress
        if self.yield_stress is None:
            return np.zeros(0), np.zeros(0)
        if self.hardening_modulus and np.isfinite(self.rate_reference):
            # the law with rate takes a table: the line, far beyond any strain that a sheet reaches
            return np.array([0.0, 1e3]), self.yield_stress + self.hardening_modulus * np.array([0.0, 1e3])
        return np.zeros(1), np.array([self.yield_stress])


@dataclass(frozen=True)
class Sheet:
    """Elements of one material and one rule of ``points`` points through the thickness (Gauss, or Lobatto)."""

    material: int = 0
    points: int = 5
    lobatto: bool = False


@dataclass(frozen=True)
class RigidSet:
    """Nodes that move as one rigid body, with their own mass and what is added.

    Attributes
    ----------
    nodes
        Indices.
    mass, at, inertia
        Added mass [kg], where it sits [m] (None: mean of the nodes), its inertia about that place
        (xx, yy, zz, xy, yz, zx) [kg m2].
    fixed
        Held degrees of freedom of the centre of mass, of "x", "y", "z", "rx", "ry", "rz".
    """

    nodes: Sequence[int] | Indices
    mass: float = 0.0
    at: tuple[float, float, float] | None = None
    inertia: tuple[float, float, float, float, float, float] = (0.0,) * 6
    fixed: Sequence[str] = ()


@dataclass(frozen=True)
class NodalLoad:
    """Force [N] or moment [N m] on a node, piecewise linear in time and constant outside; ``dof`` as in `RigidSet`."""

    node: int
    dof: str
    time: ArrayLike
    value: ArrayLike


@dataclass(frozen=True)
class PrescribedVelocity:
    """Velocity [m/s, rad/s] of a node, or of the centre of mass of a rigid set, piecewise linear in time."""

    target: int
    dof: str
    time: ArrayLike
    value: ArrayLike
    rigid_set: bool = False


@dataclass(frozen=True)
class RigidPlane:
    """Solid half space behind a plane; ``gap`` is the distance of a node at first touch [m], ``nodes`` None means all."""

    point: tuple[float, float, float]
    normal: tuple[float, float, float]
    friction: float = 0.0
    gap: float = 0.0
    nodes: Sequence[int] | Indices | None = None


@dataclass(frozen=True)
class Cut:
    """Section force: what ``elements`` exert on ``nodes``, with its moment about the mean of the nodes."""

    elements: Sequence[int] | Indices
    nodes: Sequence[int] | Indices


@dataclass(frozen=True)
class ShellSettings:
    """Choices of the method.

    Attributes
    ----------
    safety
        Share of the stable time step that is used.
    scaled_step
        Elements whose step (with safety) is below get mass added [s]; 0: none.
    least_step
        A smaller stable step ends the run [s].
    damping
        Mass-proportional [1/s].
    gravity
        [m/s2].
    thickness_update
        Let the thickness follow the strain.
    warping_correction
        Belytschko-Wong-Chiang curvature terms.
    hourglass, hourglass_membrane, hourglass_shear, hourglass_bending
        Kind of control and its coefficients.
    self_contact, contact_gap
        Contact of walls with walls; distance kept [m], 0: half of both thicknesses.
    contact_stiffness, contact_friction, contact_damping
        Share of the stability limit; Coulomb coefficient of walls; share of critical damping.
    """

    safety: float = 0.9
    scaled_step: float = 0.0
    least_step: float = 1e-12
    damping: float = 0.0
    gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    thickness_update: bool = True
    warping_correction: bool = True
    hourglass: Hourglass = Hourglass.STIFFNESS
    hourglass_membrane: float = 0.01
    hourglass_shear: float = 0.01
    hourglass_bending: float = 0.01
    self_contact: bool = False
    contact_gap: float = 0.0
    contact_stiffness: float = 0.1
    contact_friction: float = 0.0
    contact_damping: float = 0.0


@dataclass(frozen=True)
class ShellModel:
    """Everything that stays the same during a run; SI units, world axes, indices from 0.

    Attributes
    ----------
    position
        Nodes [m], (n, 3).
    elements
        Corners, (m, 4), counter-clockwise seen from the side of the normal; a triangle repeats its third.
    thickness
        [m], one number or (m,).
    materials, sheets
        Tables that elements refer to.
    sheet
        Index into ``sheets`` per element, one number or (m,).
    fixed
        Held degrees of freedom (x, y, z, rx, ry, rz) per node, bool (n, 6).
    mass, inertia
        Added to nodes [kg], [kg m2], (n,); a node's rotary inertia is isotropic.
    velocity, spin
        At the start [m/s], [rad/s], (n, 3).
    """

    position: Floats
    elements: NDArray[np.integer[Any]]
    thickness: float | Floats
    materials: Sequence[ShellMaterial]
    sheets: Sequence[Sheet] = (Sheet(),)
    sheet: int | NDArray[np.integer[Any]] = 0
    fixed: NDArray[np.bool_] | None = None
    mass: Floats | None = None
    inertia: Floats | None = None
    velocity: Floats | None = None
    spin: Floats | None = None
    rigid_sets: Sequence[RigidSet] = ()
    loads: Sequence[NodalLoad] = ()
    motions: Sequence[PrescribedVelocity] = ()
    planes: Sequence[RigidPlane] = ()
    cuts: Sequence[Cut] = ()
    settings: ShellSettings = field(default_factory=ShellSettings)


class ShellState:
    """The moving state of a model.

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
            self._core = _kernel.Simulation(_built(model), isa or _environment_isa())
        except ValueError as error:
            raise InputError(str(error)) from error

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
            COMPLETE when the time or the steps are reached; else why not, and the state is the last one computed.
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
            if end in (2, 4):
                return Status.NOT_FINITE
            if end == 3:
                return Status.STEP_COLLAPSED
            if end == 1 or left <= 0:
                return Status.COMPLETE

    @property
    def reason(self) -> str:
        """Why the run stopped, in one sentence; empty while it can go on."""
        element = self._core.failed_element
        if self._core.end == 2:
            return f"the state of element {element} is not finite at {self.time:.6g} s"
        if self._core.end == 3:
            return f"element {element} has collapsed: its stable time step is below the least step at {self.time:.6g} s"
        if self._core.end == 4:
            return f"the run has gone astray: element {element} strained by more than a third in one step at {self.time:.6g} s"
        return ""

    @property
    def time(self) -> float:
        """[s]."""
        return float(self._core.time)

    @property
    def time_step(self) -> float:
        """Step to come [s]."""
        return float(self._core.step)

    @property
    def first_time_step(self) -> float:
        """Stable step of the first shape with safety and mass scaling [s]."""
        return float(self._core.first_step)

    @property
    def steps(self) -> int:
        """Steps made."""
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
        """Nodes with a contact force now."""
        return int(self._core.touching_nodes)

    @property
    def contact_searches(self) -> int:
        """Searches for contact so far."""
        return int(self._core.contact_searches)

    @property
    def position(self) -> Floats:
        """Nodes now [m], (n, 3)."""
        return _array(self._core.positions())

    @property
    def velocity(self) -> tuple[Floats, Floats]:
        """Velocities [m/s] and angular velocities [rad/s] at the time of the positions, (n, 3) each."""
        linear, angular = self._core.velocities()
        return _array(linear), _array(angular)

    @property
    def energies(self) -> dict[str, float]:
        """Ledger [J]: kinetic, elastic, plastic, hourglass, contact, damping, external_work, residual, eroded.

        ``residual`` = kinetic + elastic + plastic + hourglass + contact + damping - external_work - kinetic at the
        start.  ``eroded`` is the elastic energy of deleted elements, contained in ``elastic``.
        """
        return dict(self._core.energies())

    def cut(self, index: int) -> tuple[Floats, Floats, Floats]:
        """Force [N], moment [N m] and the place it is taken about [m] of one cut, each (3,)."""
        force, moment, centre = self._core.cut(index)
        return _array(force), _array(moment), _array(centre)

    def element_field(self, name: str) -> Floats:
        """Per element, (m,): thickness [m]; internal_, plastic_ or hourglass_energy [J]; shear_xz, shear_yz [Pa]; alive."""
        return _array(self._core.element_slot(_SLOTS[name]))

    def point_field(self, name: str) -> Floats:
        """Per element and thickness point, (m, points): stress_x, stress_y, stress_xy [Pa] in the element's axes, plastic_strain."""
        return _array(self._core.point_slot(_POINT_SLOTS[name]))

    @property
    def rigid_sets(self) -> Floats:
        """Per rigid set, (k, 18): centre of mass [m], velocity, angular velocity, rotation matrix from the start by rows."""
        return _array(self._core.rigid_states())

    @property
    def internal_forces(self) -> Floats:
        """Internal force [N] and moment [N m] of each node, (n, 6): what has to be applied from outside to hold it."""
        return _array(self._core.node_forces())

    def deform(self, position: Floats, velocity: Floats, spin: Floats, dt: float) -> Floats:
        """Run the elements once over ``dt`` [s] to a given position, without time integration; returns internal_forces."""
        self._core.deform(_floats(position), _floats(velocity), _floats(spin), dt)
        return self.internal_forces

    def checkpoint(self) -> dict[str, Floats]:
        """Full state as named arrays, fit for np.savez; a restored run gives the same bits on the same instruction set."""
        return {name: _array(values) for name, values in self._core.save().items()}

    def restore(self, saved: Mapping[str, Floats]) -> None:
        """Go back to a checkpoint of the same model.

        Raises
        ------
        InputError
            If the checkpoint belongs to another model or instruction set.
        """
        try:
            self._core.restore({name: _floats(saved[name]) for name in saved})
        except ValueError as error:
            raise InputError(str(error)) from error


def thickness_rule(points: int, lobatto: bool = False) -> tuple[Floats, Floats]:
    """Places z/t in [-1/2, 1/2] and weights (sum 1) of the points through the thickness."""
    z, weight = _kernel.thickness_rule(points, lobatto)
    return _array(z), _array(weight)


def _environment_isa() -> str:
    import os  # noqa: PLC0415  (read when a state is made, so that tests can set it)

    return os.environ.get("CRUMPLE_ISA", "")


def _array(values: Any) -> Floats:
    return np.asarray(values, dtype=np.float64)


def _floats(values: ArrayLike) -> Floats:
    return np.ascontiguousarray(values, dtype=np.float64)


def _indices(values: ArrayLike) -> Indices:
    return np.ascontiguousarray(values, dtype=np.uint32)


def _or_zero(values: ArrayLike | None, shape: tuple[int, ...]) -> Floats:
    return np.zeros(shape) if values is None else _floats(np.broadcast_to(_floats(values), shape))


def _bits(dofs: Sequence[str]) -> int:
    return sum(1 << _DOFS[dof] for dof in set(dofs))


def _built(model: ShellModel) -> Any:
    """Model of the core from the arrays of a `ShellModel`."""
    core = _kernel.Model()
    n, m = len(model.position), len(model.elements)
    fixed = np.zeros((n, 6), dtype=bool) if model.fixed is None else np.asarray(model.fixed, dtype=bool)
    core.nodes(
        _floats(model.position),
        _or_zero(model.velocity, (n, 3)),
        _or_zero(model.spin, (n, 3)),
        _or_zero(model.mass, (n,)),
        _or_zero(model.inertia, (n,)),
        (fixed @ (1 << np.arange(6))).astype(np.uint8),
    )
    thickness = np.broadcast_to(_floats(model.thickness), (m,))
    core.elements(_indices(model.elements), _floats(thickness), _indices(np.broadcast_to(model.sheet, (m,))))
    for material in model.materials:
        _add_material(core, material)
    for sheet in model.sheets:
        core.sheet(sheet.material, sheet.points, sheet.lobatto)
    _add_sets(core, model)
    _add_settings(core, model.settings)
    return core


def _add_material(core: Any, material: ShellMaterial) -> None:
    strain, stress = material.table()
    names = ("density", "youngs_modulus", "poissons_ratio", "hardening_modulus", "rate_reference", "rate_exponent")
    names += ("rate_time", "failure_strain", "fails_at_any_point")  # type: ignore[assignment]
    values = {name: getattr(material, name) for name in names}
    core.material({**values, "plastic_strain": strain, "yield_stress": stress})


def _add_sets(core: Any, model: ShellModel) -> None:
    for rigid in model.rigid_sets:
        nodes = _indices(rigid.nodes)
        at = model.position[nodes].mean(axis=0) if rigid.at is None else rigid.at
        core.rigid_set(nodes, rigid.mass, _floats(at), _floats(rigid.inertia), _bits(rigid.fixed))
    for load in model.loads:
        core.load(load.node, _DOFS[load.dof], _floats(load.time), _floats(load.value))
    for motion in model.motions:
        core.motion(
            motion.rigid_set, motion.target, _DOFS[motion.dof], _floats(motion.time), _floats(motion.value)
        )
    for plane in model.planes:
        nodes = _indices(np.arange(len(model.position)) if plane.nodes is None else plane.nodes)
        core.plane(_floats(plane.point), _floats(plane.normal), plane.friction, plane.gap, nodes)
    for cut in model.cuts:
        core.cut(_indices(cut.elements), _indices(cut.nodes))


def _add_settings(core: Any, s: ShellSettings) -> None:
    names = ("safety", "scaled_step", "least_step", "damping", "thickness_update", "warping_correction")
    coefficients = ("hourglass_membrane", "hourglass_shear", "hourglass_bending")
    values = {name: getattr(s, name) for name in (*names, *coefficients)}
    viscous = s.hourglass is Hourglass.VISCOUS
    core.settings({**values, "gravity": _floats(s.gravity), "viscous_hourglass": viscous})
    contact = {"on": s.self_contact, "gap": s.contact_gap, "stiffness": s.contact_stiffness}
    core.contact({**contact, "friction": s.contact_friction, "damping": s.contact_damping})
