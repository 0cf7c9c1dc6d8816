"""Model of the shell engine: plain arrays that do not change, SI units, world axes, indices from 0."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from crumple.numeric.arrays import Floats

Indices = NDArray[np.uint32]
History = tuple[ArrayLike, ArrayLike]
"""Times and values."""

_INFINITY = float("inf")


class Hourglass(Enum):
    """How the modes that one-point integration does not resist are controlled."""

    STIFFNESS = "stiffness"
    VISCOUS = "viscous"


class Element(Enum):
    """How a quadrilateral with one point resists the modes that have no strain at the point."""

    BELYTSCHKO_TSAY = "belytschko-tsay"
    STABILISED = "stabilised"


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
    rate_logarithm
        Johnson-Cook C: yield times 1 + C ln(rate/D), 1 below D, in place of the power law; 0: power law.
    rate_time
        Time constant of the smoothing of the total strain rate [s].
    failure_strain
        Plastic strain at which a thickness point has failed; infinite: never.
    fails_at_any_point
        Delete the element when its first point has failed; else when all have.
    rigid
        Elements move as one rigid body per sheet: their nodes become a rigid set.
    """

    density: float
    youngs_modulus: float
    poissons_ratio: float
    yield_stress: float | None = None
    hardening_modulus: float = 0.0
    hardening: tuple[ArrayLike, ArrayLike] | None = None
    rate_reference: float = _INFINITY
    rate_exponent: float = 1.0
    rate_logarithm: float = 0.0
    rate_time: float = 1e-5
    failure_strain: float = _INFINITY
    fails_at_any_point: bool = False
    rigid: bool = False

    def table(self) -> tuple[Floats, Floats]:
        """Plastic strains and yield stresses [Pa]; empty for an elastic material."""
        if self.hardening is not None:
            strain, stress = (np.ascontiguousarray(column, dtype=np.float64) for column in self.hardening)
            return strain, stress
        if self.yield_stress is None:
            return np.zeros(0), np.zeros(0)
        if self.hardening_modulus and np.isfinite(self.rate_reference):
            # the law with rate takes a table: the line, far beyond any strain that a sheet reaches
            return np.array([0.0, 1e3]), self.yield_stress + self.hardening_modulus * np.array([0.0, 1e3])
        return np.zeros(1), np.array([self.yield_stress])


@dataclass(frozen=True)
class Sheet:
    """Elements of one material and one rule of 1 to 10 points through the thickness, Gauss or Lobatto."""

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
    pin
        Place at which x, y and z are held instead [m]; no prescribed motion then.
    """

    nodes: Sequence[int] | Indices
    mass: float = 0.0
    at: tuple[float, float, float] | None = None
    inertia: tuple[float, float, float, float, float, float] = (0.0,) * 6
    fixed: Sequence[str] = ()
    pin: tuple[float, float, float] | None = None


@dataclass(frozen=True)
class SpotWeld:
    """Tie of two sheets between means of their nodes, which fails at a limit of its force.

    Attributes
    ----------
    first, second
        Nodes of both sheets.
    first_weight, second_weight
        Of each node, adding up to 1, such that the means of both sheets' positions lie across each other.
    normal_strength, shear_strength
        Sn and Ss [N] of (max(Fn, 0)/Sn)^2 + (Fs/Ss)^2 >= 1; infinite: never.
    """

    first: Sequence[int] | Indices
    second: Sequence[int] | Indices
    first_weight: Sequence[float] | Floats
    second_weight: Sequence[float] | Floats
    normal_strength: float = _INFINITY
    shear_strength: float = _INFINITY


@dataclass(frozen=True)
class NodalLoad:
    """Force [N] or moment [N m] on a node, piecewise linear in time; ``dof`` as in `RigidSet`."""

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


class Shape(Enum):
    """Shape of an obstacle: half space, half space behind an edge, capsule, endless cylinder, sphere."""

    PLANE = 0
    EDGE = 1
    CYLINDER = 2
    POLE = 3
    SPHERE = 4


@dataclass(frozen=True)
class RigidObstacle:
    """Rigid obstacle with which nodes can come into contact.

    Attributes
    ----------
    shape, point
        What it is; a point on the plane or its edge, on the axis (one end of a capsule's), or the centre [m].
    axis
        Normal out of the plane, or direction of the cylinder; of any length.
    edge
        Of an edge: direction out of the solid beyond it, across the axis.
    radius, length
        [m].
    friction, gap
        Coulomb coefficient; distance kept beside half the wall's thickness [m].
    damping
        Share of critical damping of rigid sets that touch it; None: that of contact in the settings.
    mass, guide, velocity
        Mass on a guide [kg], the guide's direction, velocity at the start [m/s]; 0 kg: fixed or driven.
    motion
        (times [s], velocities [m/s]) along x, y and z, None where it stays.
    turn_about, turn_axis, turning
        Axis of a prescribed rotation after the displacements, and (times, rates [rad/s]).
    active
        Whether it is there.
    nodes
        That can touch it; None: all.
    """

    shape: Shape
    point: tuple[float, float, float]
    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    edge: tuple[float, float, float] = (1.0, 0.0, 0.0)
    radius: float = 0.0
    length: float = 0.0
    friction: float = 0.0
    gap: float = 0.0
    damping: float | None = None
    mass: float = 0.0
    guide: tuple[float, float, float] = (0.0, 0.0, 1.0)
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    motion: tuple[History | None, History | None, History | None] = (None, None, None)
    turn_about: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turn_axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    turning: History | None = None
    active: bool = True
    nodes: Sequence[int] | Indices | None = None


@dataclass(frozen=True)
class Cut:
    """Section force: what ``elements`` exert on ``nodes``, with its moment about the mean of the nodes."""

    elements: Sequence[int] | Indices
    nodes: Sequence[int] | Indices


@dataclass(frozen=True)
class ShellSettings:
    """Settings of the method.

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
        Belytschko-Wong-Chiang curvature terms with the drill projected out: needed for twisted members, too
        soft in tight folds (docs/theory/shell_element.md).
    element
        Quadrilateral: hourglass control by coefficients, or physical stabilisation.
    drill_stiffness
        What holds the turning of corners about the normal of a quadrilateral, as a share of G times volume.
    hourglass, hourglass_membrane, hourglass_shear, hourglass_bending
        Kind of control and its coefficients; not used by the stabilised element.
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
    warping_correction: bool = False
    element: Element = Element.BELYTSCHKO_TSAY
    drill_stiffness: float = 0.0
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
    """Everything that does not change during a run; SI units, world axes, indices from 0.

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
    spot_welds: Sequence[SpotWeld] = ()
    loads: Sequence[NodalLoad] = ()
    motions: Sequence[PrescribedVelocity] = ()
    obstacles: Sequence[RigidObstacle] = ()
    cuts: Sequence[Cut] = ()
    settings: ShellSettings = field(default_factory=ShellSettings)
