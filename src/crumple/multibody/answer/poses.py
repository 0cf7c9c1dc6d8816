"""Positions and velocities of the bodies of a solved structure: one interface to both kernels' records."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Generic, Protocol, TypeVar

import numpy as np

from crumple._core.planar.simulation import TreeRows
from crumple._core.spatial.batch import SpatialEndValues
from crumple._core.spatial.simulation import SpatialRecord, SpatialRows
from crumple.multibody.bodies.assembly import Piece
from crumple.multibody.bodies.linkage import GROUND, Linkage
from crumple.multibody.planar.mechanism import Mechanism
from crumple.numeric.arrays import Floats, Integers
from crumple.numeric.rotation import (
    continuous,
    cross,
    inverse,
    product,
    quaternion_vector,
    turned,
    vector_quaternion,
)


class Poses(Protocol):
    """Motion of the bodies in n rows, of output times or of runs; body -1 is the ground."""

    @property
    def rows(self) -> int:
        """Number of rows."""

    @property
    def pieces(self) -> Mapping[str, tuple[Piece, ...]]:
        """Pieces of members, by member."""

    @property
    def node_body(self) -> Mapping[str, int]:
        """Body of each node."""

    def node_sides(self, node: str) -> tuple[int, ...]:
        """Bodies whose mean a node is: both sides of the hinge of a mitred corner, else its own."""

    @property
    def normal(self) -> Floats | None:
        """Unit vector normal to the plane of motion, (3,); None in space."""

    def place(self, body: int, point: Floats) -> tuple[Floats, Floats]:
        """Position [m] and velocity [m/s] of a point of a body, given at the start, (n, 3) each."""

    def quaternion(self, body: int) -> Floats:
        """Rotation of a body from the start, (n, 4)."""

    def motions(self, bodies: Integers, points: Floats) -> tuple[Floats, Floats]:
        """`place` of m points given at the start, (m, 3), each on a body, (m,): (n, m, 3) each."""

    def relatives(self, first: Integers, second: Integers) -> Floats:
        """`relative` of m pairs of bodies, (m,) each: (n, m, 3)."""

    def places(self, bodies: Integers, points: Floats, rows: Integers) -> tuple[Floats, Floats]:
        """Positions [m], (r, m, 3), and rotations from the start, (r, m, 4), in r of the rows.

        Of m points given at the start, (m, 3), each on a body, (m,).
        """

    def rotation(self, body: int) -> tuple[Floats, Floats]:
        """Rotation vector [rad] and angular velocity [rad/s] of a body, (n, 3) each."""

    def relative(self, first: int, second: int) -> Floats:
        """Rotation vector of one body against another [rad], in axes that move with the first, (n, 3)."""


@dataclass(frozen=True, eq=False)
class TreePoses:
    """Motion in a plane."""

    mechanism: Mechanism
    record: TreeRows

    @cached_property
    def _joints(self) -> Floats:
        """Origins of the bodies' frames at the start [m], at the end that of the ground, (bodies + 1, 3)."""
        return np.array([*(link.position for link in self.mechanism.links), np.zeros(3)])

    @property
    def rows(self) -> int:
        """See `Poses`."""
        return self.record.rows

    @property
    def pieces(self) -> Mapping[str, tuple[Piece, ...]]:
        """See `Poses`."""
        return self.mechanism.pieces

    @property
    def node_body(self) -> Mapping[str, int]:
        """See `Poses`."""
        return self.mechanism.node_body

    def node_sides(self, node: str) -> tuple[int, ...]:
        """See `Poses`."""
        return self.mechanism.corner_sides.get(node, (self.node_body[node],))

    @property
    def normal(self) -> Floats | None:
        """See `Poses`."""
        return self.mechanism.plane.normal

    def place(self, body: int, point: Floats) -> tuple[Floats, Floats]:
        """See `Poses`."""
        if body == GROUND:
            return _still(self.rows, point)
        mechanism, record = self.mechanism, self.record
        plane, of = mechanism.plane, mechanism.bodies[body]
        angle, rate = record.pose[:, body, 0], record.velocity[:, body, 0]
        arm = _rotated(plane.flat(point - of.centre), angle)
        origin = _rotated(plane.flat(of.centre - mechanism.links[body].position), angle)
        across = float(point @ plane.normal) * plane.normal
        velocity = record.velocity[:, body, 1:] + rate[:, None] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
        return plane.raised(record.pose[:, body, 1:] + origin + arm) + across, plane.raised(velocity)

    def motions(self, bodies: Integers, points: Floats) -> tuple[Floats, Floats]:
        """See `Poses`."""
        found = [self.place(int(body), point) for body, point in zip(bodies, points, strict=True)]
        return _side_by_side([place for place, _ in found]), _side_by_side([rate for _, rate in found])

    def relatives(self, first: Integers, second: Integers) -> Floats:
        """See `Poses`."""
        return _side_by_side([self.relative(a, b) for a, b in zip(first, second, strict=True)])

    def quaternion(self, body: int) -> Floats:
        """See `Poses`."""
        return vector_quaternion(self.rotation(body)[0])

    def places(self, bodies: Integers, points: Floats, rows: Integers) -> tuple[Floats, Floats]:
        """See `Poses`."""
        plane = self.mechanism.plane
        pose = self.record.pose[rows[:, None], bodies]
        # the ground stays where it is
        pose[:, bodies == GROUND] = 0.0
        cosine, sine = np.cos(pose[..., 0]), np.sin(pose[..., 0])
        x, y = np.moveaxis(plane.flat(points - self._joints[bodies]), -1, 0)
        turned_arms = np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=-1)
        across = (points @ plane.normal)[:, None] * plane.normal
        place = plane.raised(pose[..., 1:] + turned_arms) + across
        return place, vector_quaternion(pose[..., :1] * plane.normal)

    def rotation(self, body: int) -> tuple[Floats, Floats]:
        """See `Poses`."""
        if body == GROUND:
            return _still(self.rows, np.zeros(3))
        normal = self.mechanism.plane.normal
        angle, rate = self.record.pose[:, body, :1], self.record.velocity[:, body, :1]
        return angle * normal, rate * normal

    def relative(self, first: int, second: int) -> Floats:
        """See `Poses`."""
        return self.rotation(second)[0] - self.rotation(first)[0]


SpatialKind = TypeVar("SpatialKind", bound=SpatialRows)


@dataclass(frozen=True, eq=False)
class SpatialPoses(Generic[SpatialKind]):
    """Motion in space."""

    linkage: Linkage
    record: SpatialKind

    @cached_property
    def _centres(self) -> Floats:
        """Centres of the bodies at the start [m], at the end the origin for the ground, (bodies + 1, 3)."""
        return np.array([*(body.centre for body in self.linkage.bodies), np.zeros(3)])

    @cached_property
    def _turns(self) -> Floats:
        """Rotations of the bodies, at the end that of the ground, (n, bodies + 1, 4)."""
        return _with_ground(self.record.rotation, (1.0, 0.0, 0.0, 0.0))

    @cached_property
    def wrenches(self) -> dict[int, Any]:
        """Forces of connections that were asked for, by number, for `on_second`."""
        return {}

    @property
    def rows(self) -> int:
        """See `Poses`."""
        return self.record.rows

    @property
    def pieces(self) -> Mapping[str, tuple[Piece, ...]]:
        """See `Poses`."""
        return self.linkage.pieces

    @property
    def node_body(self) -> Mapping[str, int]:
        """See `Poses`."""
        return self.linkage.node_body

    def node_sides(self, node: str) -> tuple[int, ...]:
        """See `Poses`."""
        return self.linkage.corner_sides.get(node, (self.node_body[node],))

    @property
    def normal(self) -> Floats | None:
        """See `Poses`."""
        return None

    def place(self, body: int, point: Floats) -> tuple[Floats, Floats]:
        """See `Poses`."""
        if body == GROUND:
            return _still(self.rows, point)
        arm = turned(self.quaternion(body), np.asarray(point - self.linkage.bodies[body].centre))
        spin, velocity = np.split(self.record.velocity[:, body], 2, axis=1)
        return self.record.centre[:, body] + arm, velocity + cross(spin, arm)

    def quaternion(self, body: int) -> Floats:
        """See `Poses`."""
        if body == GROUND:
            return np.tile([1.0, 0.0, 0.0, 0.0], (self.rows, 1))
        return self.record.rotation[:, body]

    def quaternions(self, bodies: Integers) -> Floats:
        """Rotations of m bodies from the start, (n, m, 4)."""
        return self._turns[:, bodies]

    def motions(self, bodies: Integers, points: Floats) -> tuple[Floats, Floats]:
        """See `Poses`."""
        arm = turned(self.quaternions(bodies), points - self._centres[bodies])
        centre, twist = self.record.centre[:, bodies], self.record.velocity[:, bodies]
        # the ground stays where it is
        centre[:, bodies == GROUND], twist[:, bodies == GROUND] = 0.0, 0.0
        return centre + arm, twist[..., 3:] + cross(twist[..., :3], arm)

    def relatives(self, first: Integers, second: Integers) -> Floats:
        """See `Poses`."""
        turns = product(inverse(self.quaternions(first)), self.quaternions(second))
        return continuous(quaternion_vector(turns))

    def places(self, bodies: Integers, points: Floats, rows: Integers) -> tuple[Floats, Floats]:
        """See `Poses`."""
        centre, rotation = self.record.centre[rows[:, None], bodies], self._turns[rows[:, None], bodies]
        # the ground stays where it is
        centre[:, bodies == GROUND] = 0.0
        return centre + turned(rotation, points - self._centres[bodies]), rotation

    def rotation(self, body: int) -> tuple[Floats, Floats]:
        """See `Poses`."""
        if body == GROUND:
            return _still(self.rows, np.zeros(3))
        return continuous(quaternion_vector(self.quaternion(body))), self.record.velocity[:, body, :3]

    def relative(self, first: int, second: int) -> Floats:
        """See `Poses`."""
        return continuous(
            quaternion_vector(product(inverse(self.quaternion(first)), self.quaternion(second)))
        )


SpatialHistory = SpatialPoses[SpatialRecord]
"""Motion of one run."""


@dataclass(frozen=True, eq=False)
class SpatialEndPoses(SpatialPoses[SpatialEndValues]):
    """Final positions and velocities of runs.

    No row follows another, so rotation vectors are the shortest; and every row has its own centres of mass at
    the start.
    """

    def place(self, body: int, point: Floats) -> tuple[Floats, Floats]:
        """See `Poses`."""
        if body == GROUND:
            return super().place(body, point)
        arm = turned(self.quaternion(body), point - self.record.start[:, body])
        spin, velocity = np.split(self.record.velocity[:, body], 2, axis=1)
        return self.record.centre[:, body] + arm, velocity + cross(spin, arm)

    def rotation(self, body: int) -> tuple[Floats, Floats]:
        """See `Poses`."""
        if body == GROUND:
            return super().rotation(body)
        return quaternion_vector(self.quaternion(body)), self.record.velocity[:, body, :3]

    def relative(self, first: int, second: int) -> Floats:
        """See `Poses`."""
        return quaternion_vector(product(inverse(self.quaternion(first)), self.quaternion(second)))


def piece_at(pieces: Mapping[str, tuple[Piece, ...]], member: str, station: float) -> Piece:
    """Piece that contains a station [m] of a member; at a cut the one before it, at the end the last."""
    *inner, last = pieces[member]
    return next((piece for piece in inner if station <= piece.end and station < last.end), last)


def _with_ground(values: Floats, ground: tuple[float, ...]) -> Floats:
    """Values of bodies, (n, bodies, k), and at the end those of the ground, (k,)."""
    n, _, k = values.shape
    return np.concatenate([values, np.broadcast_to(ground, (n, 1, k))], axis=1)


def _side_by_side(columns: list[Floats]) -> Floats:
    """Rows of m bodies, (n, 3) each, as (n, m, 3)."""
    return np.stack(columns, axis=1) if columns else np.zeros((0, 0, 3))


def _still(rows: int, vector: Floats) -> tuple[Floats, Floats]:
    return np.tile(vector, (rows, 1)), np.zeros((rows, 3))


def _rotated(vector: Floats, angle: Floats) -> Floats:
    """A plane vector (2,) rotated by every angle (n,): (n, 2)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]], axis=1)
