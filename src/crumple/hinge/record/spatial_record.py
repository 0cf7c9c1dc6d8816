"""Record of a hinge of several components for the spatial solver: one record per component and a surface."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum, IntEnum

import numpy as np

from crumple.hinge.law import SofteningVariable
from crumple.hinge.record.record import Form, HingeRecord
from crumple.numeric.arrays import Floats


class Freedom(IntEnum):
    """Relative freedom of a hinge's two sides, in the member's local axes; second side against first."""

    AXIAL = 0
    """Lengthening along x [m]; its force is positive in tension."""
    X = 3
    """Twist about x [rad]."""
    Y = 4
    """Bending about y [rad]; a positive moment stretches +z."""
    Z = 5
    """Bending about z [rad]; a positive moment stretches -y."""

    @property
    def label(self) -> str:
        """Short name: axial, x, y or z."""
        return self.name.lower()


class Coupling(Enum):
    """Interaction of the components of a hinge."""

    NONE = "none"
    """No interaction: a box."""
    ELLIPSOID = "ellipsoid"
    """The squares of the ratios to the capacities add up to 1."""
    BALL = "ball"
    """The same with one capacity, which falls with the angle of the relative rotation."""
    SECTION = "section"
    """Plastic interaction of the walls of the section."""
    TENSION_FLANGE = "tension-flange"
    """The fold turns about its tension flange: compression lowers the moment, bending shortens the hinge."""


@dataclass(frozen=True)
class DrivenShare:
    """Share that depends on the rotation about another component; piecewise linear, then constant.

    Attributes
    ----------
    rotation
        Largest plastic rotation so far about `driver` [rad], strictly increasing, shape (n,).
    share
        Between -1 and 1 [-], shape (n,).
    driver
        Freedom on whose rotation the share depends.
    """

    rotation: Floats
    share: Floats
    driver: Freedom


@dataclass(frozen=True)
class Spread:
    """Slip that spreads over the member before a fold or a neck has it, and does not soften the hinge.

    Attributes
    ----------
    lengthening, shortening
        Largest slip so far in either sense [m], strictly increasing from 0, and share of the capacity in
        this sense [-], not falling, up to 1 at the end of the spread; each of shape (n,), empty: none.
    """

    lengthening: tuple[Floats, Floats]
    shortening: tuple[Floats, Floats]


@dataclass(frozen=True)
class HingeComponent:
    """Curves of both senses, stiffness, rate factor, damper and stops about or along one axis.

    Attributes
    ----------
    freedom
        Degree of freedom.
    record
        As of a planar hinge; for the axial freedom lengths [m] stand for rotations and forces [N] for
        moments, and the negative sense is shortening.
    shift
        Of an ellipsoid whose centre moves along this axis: centre over the half axis of the sense from which
        it moves away; the record keeps the capacities about the axis alone. Rotations along it soften the
        hinge as those about the driver.
    worn
        Of an ellipsoid: share of the capacity about this axis that is gone, at least 0.
    spread
        Of the axial freedom, where the components share one measure of softening: the record then begins at
        the end of the spread.
    softens
        Weight of its rotation in the measure of softening that components share, over its capacity.
    origin
        Of the axial freedom: its law in words, with its source.
    warnings
        Of the axial freedom: conditions of its law that section, metal or length do not meet.
    """

    freedom: Freedom
    record: HingeRecord
    shift: DrivenShare | None = None
    worn: DrivenShare | None = None
    spread: Spread | None = None
    softens: float = 1.0
    origin: str = ""
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class HingeSurface:
    """Surface g = 1 in the shares x_k of the components' capacities.

    Attributes
    ----------
    coupling
        Kind of surface.
    rows
        Of the section: linear forms a in g^r = (sum |a.x|^p)^(r/p) + |x_torsion|^r, shape (rows, components);
        the column of the twist is zero.  Of an axisymmetric one x is the axial force and the resultant of
        the moments about y and z, shape (rows, 2).
    power, torque_power
        p and r, at least 2.
    torsion
        Component that is the twist, or -1.
    arm
        Tension flange: its distance from the centroid [m].
    gains
        Tension flange: what the arm gains [m] for the part of a compressive force beyond a share [-] of the
        yield force, both increasing, at most three.
    growth
        Tension flange: largest plastic rotation so far [rad] and share of `arm` [-], below 1; empty: all.
    shortened_turn
        Tension flange: rotation that a shortening counts as where the moment softens [rad/m].
    error
        Largest relative distance between this surface and that of the walls.
    axisymmetric
        Section: all axes of bending are alike; the first component is axial, the last two are y and z.
    """

    coupling: Coupling = Coupling.NONE
    rows: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    power: float = 2.0
    torque_power: float = 2.0
    torsion: int = -1
    arm: float = 0.0
    gains: tuple[tuple[float, float], ...] = ()
    growth: tuple[Floats, Floats] = (np.zeros(0), np.zeros(0))
    shortened_turn: float = 0.0
    error: float = 0.0
    axisymmetric: bool = False

    def gauge(self, shares: Floats) -> Floats:
        """Value g of shares of the capacities, shapes (...) and (..., components).

        Not of the tension flange, whose sides are not shares alone.
        """
        x = np.asarray(shares, float)
        if self.coupling is Coupling.NONE:
            return np.asarray(np.abs(x).max(axis=-1))
        if self.coupling is not Coupling.SECTION:
            return np.asarray(np.linalg.norm(x, axis=-1))
        loads = x
        if self.axisymmetric:
            loads = np.stack([x[..., 0], np.hypot(x[..., -2], x[..., -1])], axis=-1)
        forms = np.abs(loads @ self.rows.T)
        top = np.maximum(forms.max(axis=-1, keepdims=True), 1e-300)
        direct = top[..., 0] * ((forms / top) ** self.power).sum(axis=-1) ** (1.0 / self.power)
        twist = np.abs(x[..., self.torsion]) if self.torsion >= 0 else np.zeros_like(direct)
        return np.asarray((direct**self.torque_power + twist**self.torque_power) ** (1.0 / self.torque_power))


@dataclass(frozen=True)
class SpatialHingeRecord:
    """All data of one hinge for the spatial solver; made by `spatial_record`.

    Attributes
    ----------
    components
        One to four, in the order axial, twist, bending about y, about z.
    surface
        Their interaction.
    fracture
        Plastic rotation (length of the vector) [rad] at which the hinge breaks; inf: never.
    shear_loss
        Share of the torque that a shear force along local y, and one along z, takes from the walls [1/N].
    round_shear
        Whether the walls of a round tube see the resultant of both forces; else their parts add up.
    cross_softening
        Weight of a rotation about one bending axis in what softens the moment about the other; 1: all of it.
    edge_relief
        Share of the measure that does not soften the bending moments if both do the same work, see
        `crumple.hinge.bending.edge_fold`; without effect if `cross_softening` is 1.
    """

    components: tuple[HingeComponent, ...]
    surface: HingeSurface
    fracture: float = math.inf
    shear_loss: tuple[float, float] = (0.0, 0.0)
    round_shear: bool = False
    cross_softening: float = 1.0
    edge_relief: float = 0.0

    @property
    def freedoms(self) -> tuple[Freedom, ...]:
        """Freedoms of the components, in their order."""
        return tuple(component.freedom for component in self.components)

    @property
    def form(self) -> Form:
        """Form of all components."""
        return self.components[0].record.form

    @property
    def softening_variable(self) -> SofteningVariable:
        """Softening variable of all components."""
        return self.components[0].record.softening_variable
