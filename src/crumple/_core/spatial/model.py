"""Constants of the spatial kernel's model: rigid bodies in space, joints, hinges, loads, obstacles.

Everything is given in world axes as it stands at the start; the kernel carries it along with the
bodies.  Body -1 is the ground.  The six relative freedoms of a joint are numbered 0, 1, 2: translations along
its local x, y, z, and 3, 4, 5: rotations about them; the motion is that of the second body relative to the
first.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import IntEnum
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from crumple._core.hinge import HingeConstants, as_list
from crumple.numeric.arrays import Floats

GROUND = -1


@dataclass(frozen=True, eq=False)
class SpatialBody:
    """Rigid body: mass [kg], inertia about its centre in world axes at the start (3, 3), centre (3,)."""

    mass: float
    inertia: Floats
    centre: Floats


@dataclass(frozen=True, eq=False)
class SpatialJoint:
    """Connection of two bodies at a point.

    Attributes
    ----------
    first, second
        Bodies; one of them may be the ground (-1).
    position
        Point [m] at the start, (3,).
    axes
        Rows are the local x, y, z in the world at the start, (3, 3).
    held
        Which of the six relative freedoms are held.  With one rotation held, turning about the other two axes
        has no twist about the held one (constant-velocity joint) unless `cross`.
    cross
        Universal joint with a cross: the next axis after the held one stays with the first body, the one
        after that with the second, at right angles.
    """

    first: int
    second: int
    position: Floats
    axes: Floats
    held: tuple[bool, bool, bool, bool, bool, bool]
    cross: bool = False


def _joint(held: str, first: int, second: int, position: ArrayLike, axes: ArrayLike | None) -> SpatialJoint:
    rows = np.eye(3) if axes is None else np.asarray(axes, float)
    mask = tuple(letter == "1" for letter in held)
    return SpatialJoint(first, second, np.asarray(position, float), rows, mask)  # type: ignore[arg-type]


def frame_of(axis: ArrayLike) -> Floats:
    """Right-handed axes (rows x, y, z) whose x lies along a direction; y and z are arbitrary."""
    x = np.asarray(axis, float) / np.linalg.norm(axis)
    y = np.cross(np.eye(3)[np.argmin(np.abs(x))], x)
    y /= np.linalg.norm(y)
    return np.array([x, y, np.cross(x, y)])


def fixed(first: int, second: int, position: ArrayLike, axes: ArrayLike | None = None) -> SpatialJoint:
    """No relative motion."""
    return _joint("111111", first, second, position, axes)


def revolute(first: int, second: int, position: ArrayLike, axis: ArrayLike) -> SpatialJoint:
    """Rotation about an axis, which is the joint's local x."""
    return _joint("111011", first, second, position, frame_of(axis))


def spherical(first: int, second: int, position: ArrayLike, axes: ArrayLike | None = None) -> SpatialJoint:
    """Any rotation about a point."""
    return _joint("111000", first, second, position, axes)


def universal(
    first: int, second: int, position: ArrayLike, first_axis: ArrayLike, second_axis: ArrayLike
) -> SpatialJoint:
    """Rotation about an axis (local y) of the first body and one (local z) of the second, at right angles."""
    y, z = (np.asarray(a, float) / np.linalg.norm(a) for a in (first_axis, second_axis))
    axes = np.array([np.cross(y, z), y, z])
    held = (True, True, True, True, False, False)
    return SpatialJoint(first, second, np.asarray(position, float), axes, held, cross=True)


def prismatic(first: int, second: int, position: ArrayLike, axis: ArrayLike) -> SpatialJoint:
    """Translation along an axis, which is the joint's local x."""
    return _joint("011111", first, second, position, frame_of(axis))


def cylindrical(first: int, second: int, position: ArrayLike, axis: ArrayLike) -> SpatialJoint:
    """Translation along and rotation about an axis, which is the joint's local x."""
    return _joint("011011", first, second, position, frame_of(axis))


def planar(first: int, second: int, position: ArrayLike, normal: ArrayLike) -> SpatialJoint:
    """Motion in a plane: its normal is the joint's local x."""
    return _joint("100011", first, second, position, frame_of(normal))


@dataclass(frozen=True, eq=False)
class SpatialComponent(HingeConstants):
    """One component of a hinge: a relative freedom of its joint, and its resistance.

    Over the largest rotation about the component `driver` (rotation, share; empty and -1: none): `shift`,
    where the centre of the set lies along it (the initial capacity of the driver is then its weight in the
    measure of softening), and `worn`, what is gone of its capacity.  `positive_spread`, `negative_spread`:
    see `Spread`.  `softens`: weight in the measure of softening, over the initial capacity.  `flange`:
    distance [m] of the flange about which its fold turns; 0: tension does not hold it.
    """

    freedom: int
    shift: tuple[Floats, Floats] = (np.zeros(0), np.zeros(0))
    worn: tuple[Floats, Floats] = (np.zeros(0), np.zeros(0))
    driver: int = -1
    positive_spread: tuple[Floats, Floats] = (np.zeros(0), np.zeros(0))
    negative_spread: tuple[Floats, Floats] = (np.zeros(0), np.zeros(0))
    softens: float = 1.0
    flange: float = 0.0

    def component(self) -> dict[str, Any]:
        """The constants and the freedom in the form that the kernel takes."""
        (rotation, share), (worn_rotation, worn_share) = self.shift, self.worn
        return self.constants() | {
            "freedom": self.freedom,
            "shift_rotation": as_list(rotation),
            "shift_share": as_list(share),
            "worn_rotation": as_list(worn_rotation),
            "worn_share": as_list(worn_share),
            "driver": self.driver,
            "positive_spread": [as_list(one) for one in self.positive_spread],
            "negative_spread": [as_list(one) for one in self.negative_spread],
            "softens": self.softens,
            "flange": self.flange,
        }


class Coupling(IntEnum):
    """How the components of a hinge share their capacity; native/spatial/hinge/surface.hpp."""

    NONE = 0
    ELLIPSOID = 1
    BALL = 2
    SECTION = 3
    TENSION_FLANGE = 4


@dataclass(frozen=True, eq=False)
class SpatialSurface:
    """Surface of interaction; `rows` (k, components), the column of component `torsion` is zero.

    `axisymmetric`, and `gains`, `growth` and `shortened_turn` of a tension flange: see `HingeSurface`.
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
    axisymmetric: bool = False


@dataclass(frozen=True, eq=False)
class SpatialHinge:
    """Plastic hinge in freedoms of a joint that are not held.

    Codes of form and softening variable are those of `crumple._core.planar.simulation.TreeHinge`.
    It opens for good at the plastic rotation `fracture` [rad].  `shear_loss`, `round_shear`,
    `cross_softening`, `edge_relief`: see `SpatialHingeRecord`.
    """

    joint: int
    components: tuple[SpatialComponent, ...]
    surface: SpatialSurface = SpatialSurface()
    form: int = 0
    softening: int = 0
    fracture: float = math.inf
    shear_loss: tuple[float, float] = (0.0, 0.0)
    round_shear: bool = False
    cross_softening: float = 1.0
    edge_relief: float = 0.0

    @cached_property
    def constants(self) -> dict[str, Any]:
        """The constants in the form that the kernel takes; runs of one model share them."""
        surface = self.surface
        return {
            "joint": self.joint,
            "form": self.form,
            "softening": self.softening,
            "fracture": self.fracture,
            "shear_loss": list(self.shear_loss),
            "round_shear": self.round_shear,
            "cross_softening": self.cross_softening,
            "edge_relief": self.edge_relief,
            "components": [component.component() for component in self.components],
            "coupling": int(surface.coupling),
            "rows": as_list(np.asarray(surface.rows, float).reshape(-1)),
            "power": surface.power,
            "torque_power": surface.torque_power,
            "torsion": surface.torsion,
            "axisymmetric": surface.axisymmetric,
            "arm": surface.arm,
            "arm_gains": [gain for gain, _ in surface.gains],
            "arm_gain_shares": [share for _, share in surface.gains],
            "growth_rotation": as_list(surface.growth[0]),
            "growth_share": as_list(surface.growth[1]),
            "shortened_turn": surface.shortened_turn,
        }


@dataclass(frozen=True, eq=False)
class SpatialLoad:
    """Force [N] and moment [N m] at a point of a body, fixed in the world's axes, times a factor of time."""

    body: int
    point: Floats
    force: Floats
    moment: Floats
    times: Floats
    values: Floats


@dataclass(frozen=True, eq=False)
class SpatialSpring:
    """Linear spring [N/m] with a damper [N s/m] between two points; a body may be the ground."""

    first: int
    second: int
    first_point: Floats
    second_point: Floats
    stiffness: float
    free_length: float
    damping: float = 0.0


@dataclass(frozen=True, eq=False)
class SpatialDrive:
    """Prescribed motion of one held freedom of a joint.

    The freedom's displacement is ``start`` plus the integral of ``rates``, piecewise linear over ``times``,
    which count from the start of a stage and keep their last value.
    """

    joint: int
    freedom: int
    times: Floats
    rates: Floats
    start: float = 0.0


@dataclass(frozen=True, eq=False)
class SpatialCam:
    """A held translation of a joint that follows one of its rotations.

    Over the angle [rad] by which the second body is turned relative to the first about the axis of the
    freedom `about`, it is displaced along that of `freedom` by the integral of `slope` [m/rad] from the first
    angle on, (n,) each; slopes keep their first and last value.
    """

    joint: int
    freedom: int
    about: int
    angle: Floats
    slope: Floats


class ObstacleKind(IntEnum):
    """Shape of an obstacle."""

    PLANE = 0
    CYLINDER = 1
    SPHERE = 2


@dataclass(frozen=True, eq=False)
class SpatialObstacle:
    """Rigid solid on a body (-1: the ground; driven and guided obstacles are bodies joined to the ground).

    Attributes
    ----------
    kind, body
        Shape; body it belongs to.
    point, direction
        Point, and a plane's outward normal or a cylinder's axis, in the world at the start, (3,).
    edge
        Plane: it ends at `point` across this direction; zero for none.
    radius, length
        Of cylinder or sphere [m]; length 0: without end.
    friction, restitution
        Coefficients.
    capsules
        Indices of the capsules that may touch it; None: all that are not on its own body.
    ends
        Ends of these capsules that it meets, 1 for the first, 2 for the second, 3 for both, 0 for none; None:
        both of all.
    """

    kind: ObstacleKind
    body: int
    point: Floats
    direction: Floats = field(default_factory=lambda: np.zeros(3))
    edge: Floats = field(default_factory=lambda: np.zeros(3))
    radius: float = 0.0
    length: float = 0.0
    friction: float = 0.0
    restitution: float = 0.0
    capsules: tuple[int, ...] | None = None
    ends: tuple[int, ...] | None = None


@dataclass(frozen=True, eq=False)
class SpatialFold:
    """A fold where a capsule ends: its middle on the member's axis at the start, half of its length [m]."""

    middle: Floats
    half_length: float


@dataclass(frozen=True, eq=False)
class SpatialCapsule:
    """Segment with a radius on a body, ends in the world at the start; a sphere where both are the same.

    `crush_force` is the force at which its wall crushes under a contact [N]; infinite: it is rigid.  `folds`
    are at its ends, two at most.
    """

    body: int
    first: Floats
    second: Floats
    radius: float
    crush_force: float = math.inf
    folds: tuple[SpatialFold, ...] = ()


@dataclass(frozen=True, eq=False)
class SpatialContact:
    """Contact between capsules: pairs of capsule indices that can come into contact."""

    pairs: tuple[tuple[int, int], ...] = ()
    friction: float = 0.0
    restitution: float = 0.0


@dataclass(frozen=True, eq=False)
class SpatialModel:
    """Constants of a spatial model; frozen."""

    bodies: tuple[SpatialBody, ...]
    joints: tuple[SpatialJoint, ...] = ()
    hinges: tuple[SpatialHinge, ...] = ()
    loads: tuple[SpatialLoad, ...] = ()
    springs: tuple[SpatialSpring, ...] = ()
    drives: tuple[SpatialDrive, ...] = ()
    cams: tuple[SpatialCam, ...] = ()
    obstacles: tuple[SpatialObstacle, ...] = ()
    capsules: tuple[SpatialCapsule, ...] = ()
    contact: SpatialContact = SpatialContact()
    gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    length: float = 1.0
    """Length [m] that converts displacements to angles in the error measure."""
    resolved_frequency: float = math.inf
    """Vibration of elastic hinges above it [1/s] does not count in the error measure."""
    breaks: Floats = field(default_factory=lambda: np.empty(0))
    """Times [s] after the start of every stage at which steps end: jumps and kinks of loads and drives,
    (n,)."""

    @property
    def component_offsets(self) -> list[int]:
        """First column of every hinge in arrays over components, and their number."""
        offsets = [0]
        for hinge in self.hinges:
            offsets.append(offsets[-1] + len(hinge.components))
        return offsets
