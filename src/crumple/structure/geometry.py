"""Where a member is and how its section lies in space."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.remembered import remembered

Triple = tuple[float, float, float]

NEARLY_PARALLEL = 1e-6
"""Sine of the angle between member and `up` below which the direction across the member is noise."""
UPRIGHT = 1e-3
"""Sine of the angle to global z below which a member stands along it: 0.01 mm in 10 mm."""
NARROWEST = math.radians(10.0)
"""Angle between two members, or to a line, below which they lie along each other."""
FLAT = 1e-6
"""Share of a direction below which it is none."""
LEVEL = 1e-4
"""Ratio of singular values of the node positions below which they count as in line or in a plane, and angle
to a plane that is none: above that of coordinates which are rounded to 0.01 mm, and a tenth of the
straightness of tubes."""
SQUARE = 1e-3
"""Angle of a member to the plane, and of its section to the normal, that is one of rounded coordinates: those
of the shortest members."""
EXACT = 1e-11
"""Angle that is rounding of the calculation."""


@dataclass(frozen=True, eq=False)
class Frame:
    """A member's local axes at the start.

    Attributes
    ----------
    origin
        First node [m], shape (3,).
    axes
        Rows are the unit vectors of local x, y, z in global axes, shape (3, 3).
    length
        Distance of the two nodes [m].
    """

    origin: Floats
    axes: Floats
    length: float

    @property
    def x(self) -> Floats:
        """Unit vector from the first to the second node, shape (3,)."""
        return np.asarray(self.axes[0])

    @property
    def y(self) -> Floats:
        """Unit vector of the section's y, shape (3,)."""
        return np.asarray(self.axes[1])

    @property
    def z(self) -> Floats:
        """Unit vector of the section's z, shape (3,)."""
        return np.asarray(self.axes[2])

    def position(self, station: float | Floats) -> Floats:
        """Point on the member's line at a distance [m] from its first node, (3,); (..., 3) for (..., 1)."""
        return self.origin + station * self.x

    def axis(self, name: str) -> Floats:
        """Unit vector of local "x", "y" or "z", shape (3,)."""
        return np.asarray(self.axes["xyz".index(name)])


def frame_of(
    first: Sequence[float], second: Sequence[float], *, up: Sequence[float] | None = None, roll: float = 0.0
) -> Frame:
    """Local axes of a straight member.

    Parameters
    ----------
    first, second
        Positions of its nodes [m], apart.
    up
        Direction whose part across the member is local z; None: global z, or global x for a member along z.
    roll
        Right-handed turn of local y and z about local x [rad].

    Returns
    -------
    Frame
        Right-handed.

    Raises
    ------
    ValueError
        If the nodes coincide or ``up`` is along the member.
    """
    return _frame(_triple(first), _triple(second), None if up is None else _triple(up), float(roll))


def _triple(vector: Sequence[float]) -> Triple:
    x, y, z = vector
    return float(x), float(y), float(z)


# every solver uses the same few frames repeatedly
@remembered(4096)
def _frame(first: Triple, second: Triple, up: Triple | None, roll: float) -> Frame:
    # plain numbers: NumPy takes five times as long for single vectors
    span = _along(second, -1.0, first)
    length = _size(span)
    if length == 0.0:
        raise ValueError("the nodes of the member coincide")
    x = (span[0] / length, span[1] / length, span[2] / length)
    if up is None:
        up = (0.0, 0.0, 1.0) if math.hypot(x[0], x[1]) > UPRIGHT else (1.0, 0.0, 0.0)
    size = _size(up)
    direction = (up[0] / size, up[1] / size, up[2] / size)
    across = _along(direction, -(direction[0] * x[0] + direction[1] * x[1] + direction[2] * x[2]), x)
    size = _size(across)
    if size <= NEARLY_PARALLEL:
        raise ValueError("'up' lies along the member")
    z = (across[0] / size, across[1] / size, across[2] / size)
    y = (z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0])
    if roll != 0.0:
        cosine, sine = math.cos(roll), math.sin(roll)
        y, z = (
            _triple([cosine * b + sine * c for b, c in zip(y, z, strict=True)]),
            _triple([cosine * c - sine * b for b, c in zip(y, z, strict=True)]),
        )
    origin, axes = np.array(first, float), np.array((x, y, z))
    # shared by all callers
    origin.flags.writeable = axes.flags.writeable = False
    return Frame(origin, axes, length)


def _along(start: Triple, distance: float, direction: Triple) -> Triple:
    """Start, and a distance along a direction."""
    return (
        start[0] + distance * direction[0],
        start[1] + distance * direction[1],
        start[2] + distance * direction[2],
    )


def _size(vector: Triple) -> float:
    """Length of one vector."""
    return math.sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2])


def cross(a: Sequence[float] | Floats, b: Sequence[float] | Floats) -> Floats:
    """Cross product of two vectors, (3,); for a single pair NumPy's own takes ten times as long."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def plane_normal(points: Floats, reasons: Iterable[tuple[Floats, Floats]]) -> Floats | None:
    """Normal of the plane in which a structure bends, (3,); None if it is not determined.

    Parameters
    ----------
    points
        Ends of its members [m], (n, 3).
    reasons
        Axis (3,) and direction (3,) of rotations and loads, the largest first; they
        decide where the points lie in line.
    """
    if len(points) < 2:
        return None
    _, sizes, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    in_plane = len(sizes) < 3 or sizes[2] <= LEVEL * sizes[0]
    if sizes[1] > LEVEL * sizes[0]:
        return _near_global(axes[2]) if in_plane else None
    line = axes[0]
    # what points out of a line by no more than its nodes do is along it
    noise = 4.0 * float(sizes[1]) / (float(sizes[0]) or 1.0)
    for axis, push in reasons:
        for across, whole in ((_across(axis, line), axis), (np.cross(line, push), push)):
            size = float(np.linalg.norm(across))
            if size > noise * float(np.linalg.norm(whole)):
                return _near_global(across / size)
    # nothing bends it but that it is not quite straight
    return _near_global(axes[2]) if in_plane and sizes[1] > FLAT * sizes[0] else None


def _across(vector: Floats, line: Floats) -> Floats:
    across: Floats = vector - (vector @ line) * line
    return across if float(np.linalg.norm(across)) > FLAT * float(np.linalg.norm(vector)) else 0.0 * line


def _near_global(normal: Floats) -> Floats:
    """A normal, or the global axis from which it differs by no more than rounded coordinates make it."""
    nearest = int(np.argmax(np.abs(normal)))
    unit: Floats = math.copysign(1.0, float(normal[nearest])) * np.eye(3)[nearest]
    return unit if EXACT < float(np.linalg.norm(normal - unit)) < LEVEL else normal


def are_level(frames: Sequence[Frame], normal: Floats) -> bool:
    """Whether members lie in a plane, and their sections in one way to it, but for rounding."""
    if not frames:
        return True
    axes = np.array([frame.axes for frame in frames])
    if np.abs(axes[:, 0] @ normal).max() > EXACT:
        return False
    across = _square_axes(axes, normal)
    return not len(across) or float(np.linalg.norm(across - across[0], axis=1).max()) <= EXACT


def _square_axes(axes: Floats, normal: Floats) -> Floats:
    """Axes of sections, (m, 3), that are a plane's normal but for rounded coordinates; of axes (n, 3, 3)."""
    shares = axes[:, 1:] @ normal
    nearer = np.arange(len(axes)), np.abs(shares).argmax(axis=1)
    turned = axes[:, 1:][nearer] * np.sign(shares[nearer])[:, None]
    aside = turned - np.abs(shares[nearer])[:, None] * normal
    square: Floats = turned[np.linalg.norm(aside, axis=1) < SQUARE]
    return square


def levelled(frame: Frame, normal: Floats, *, is_round: bool) -> Frame:
    """A frame turned into a plane, if it leads out of it by no more than rounded coordinates make it.

    Its section is turned with it: an axis of it becomes the normal.  A round section has none.  Others that
    lie obliquely to the plane stay.
    """
    along = frame.x - float(frame.x @ normal) * normal
    along = along / float(np.linalg.norm(along) or 1.0)
    square = len(_square_axes(frame.axes[None], normal)) > 0
    if abs(float(frame.x @ normal)) >= SQUARE or not (square or is_round):
        return frame
    y, z = frame.y, frame.z
    if square and abs(float(y @ normal)) > abs(float(z @ normal)):
        y = math.copysign(1.0, float(y @ normal)) * normal
    else:
        if square:
            z = math.copysign(1.0, float(z @ normal)) * normal
        y = cross(z, along)
        y = y / float(np.linalg.norm(y))
    axes = np.array((along, y, cross(along, y)))
    axes.flags.writeable = False
    return Frame(frame.origin, axes, frame.length)
