"""Where a member is and how its section lies in space."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.remembered import remembered

Triple = tuple[float, ...]

NEARLY_PARALLEL = 1e-6
"""Sine of the angle between member and `up` below which the direction across the member is noise."""
FLAT = 1e-6
"""Ratio of singular values of the node positions below which they count as in line or in a plane."""


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
    direction = None if up is None else tuple(map(float, up))
    return _frame(tuple(map(float, first)), tuple(map(float, second)), direction, float(roll))


# every solver uses the same few frames repeatedly
@remembered(4096)
def _frame(first: Triple, second: Triple, up: Triple | None, roll: float) -> Frame:
    origin = np.asarray(first, float)
    span = np.asarray(second, float) - origin
    length = _size(span)
    if length == 0.0:
        raise ValueError("the nodes of the member coincide")
    x = span / length
    if up is None:
        up = (0.0, 0.0, 1.0) if math.hypot(x[0], x[1]) > NEARLY_PARALLEL else (1.0, 0.0, 0.0)
    direction = np.asarray(up, float)
    direction = direction / _size(direction)
    across = direction - (direction @ x) * x
    size = _size(across)
    if size <= NEARLY_PARALLEL:
        raise ValueError("'up' lies along the member")
    z = across / size
    y = cross(z, x)
    cosine, sine = np.cos(roll), np.sin(roll)
    axes = np.array([x, cosine * y + sine * z, cosine * z - sine * y])
    # shared by all callers
    origin.flags.writeable = axes.flags.writeable = False
    return Frame(origin, axes, length)


def _size(vector: Floats) -> float:
    """Length of one vector; NumPy's own function takes five times as long."""
    return math.sqrt(float(vector @ vector))


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
    if sizes[1] > FLAT * sizes[0]:
        in_plane = len(sizes) < 3 or sizes[2] <= FLAT * sizes[0]
        return axes[2] if in_plane else None
    line = axes[0]
    for axis, push in reasons:
        for across in (_across(axis, line), np.cross(line, push)):
            size = float(np.linalg.norm(across))
            if size > 0.0:
                normal: Floats = across / size
                return normal
    return None


def _across(vector: Floats, line: Floats) -> Floats:
    across: Floats = vector - (vector @ line) * line
    return across if float(np.linalg.norm(across)) > FLAT * float(np.linalg.norm(vector)) else 0.0 * line
