"""Rotations of the sections of a member: best-fit planes of its rings of points, in any result with states.

A ring is the set of points of one member at one station.  Its plane is the least-squares plane through the
displaced points: the eigenvector of their scatter matrix with the smallest eigenvalue, with the sign given by
the sense of the outline.  The rotation of a section about an axis is the angle between its normal now and at
the start, both projected along the axis, continued without a jump at half a turn.  The rotation of one
section relative to another is the same as seen from the first one: everything is rotated back as its ring has
turned, by the smallest rotation that restores its normal and by the mean turn of its points about that, so
that a part that rotates as a whole shows no rotation.  (Rings of a mitre lie oblique: the normals of two
rings then are not parallel, and a turn about the first one moves the second.)

Limits: a section that is flattened to a line has no plane; its angle is then noise.  The rings within a fold
warp, so a relative rotation is measured between rings on both sides of it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.result import States

SAME_STATION = 1e-6
"""Stations closer than this share of the member's length count as one: far below any element size."""
SMALL = 1e-12
"""Prevents division by zero at half a turn, where the smallest rotation back is not defined."""
FEWEST = 3
"""Number of points that define a plane."""


@dataclass(frozen=True, eq=False)
class Sections:
    """Rings of one member over time.

    Attributes
    ----------
    member
        Its name.
    stations
        Of the rings, increasing [m], (n_rings,).
    times
        [s], (n_states,).
    centres, start_centres
        Means of the points [m] over time, (n_states, n_rings, 3), and at the start, (n_rings, 3).
    normals, start_normals
        Unit normals over time, (n_states, n_rings, 3), and at the start, (n_rings, 3).
    spins
        Mean turn of the points about the start normal beside the smallest rotation that restores it [rad],
        (n_states, n_rings).
    """

    member: str
    stations: Floats
    times: Floats
    centres: Floats
    start_centres: Floats
    normals: Floats
    start_normals: Floats
    spins: Floats

    def rotation(self, axis: Floats) -> Floats:
        """Rotation of every section about a fixed axis since the start [rad], (n_states, n_rings).

        Parameters
        ----------
        axis
            Unit vector, right-handed, across the member, (3,).
        """
        first = self.start_normals - np.outer(self.start_normals @ axis, axis)
        second = np.cross(axis, first)
        angle = np.arctan2(
            np.einsum("tri,ri->tr", self.normals, second), np.einsum("tri,ri->tr", self.normals, first)
        )
        return np.asarray(np.unwrap(angle, axis=0))

    def relative_rotation(self, axis: Floats, first: int, last: int) -> Floats:
        """Rotation of one section relative to another about an axis of the latter [rad], (n_states,).

        Parameters
        ----------
        axis
            Unit vector at the start, right-handed, across the member, (3,).
        first, last
            Indices of the section that carries the axis, and of the one whose rotation is measured.
        """
        return _turn(self.start_normals[last], self.seen_from(first, self.normals[:, last]), axis)

    def bend(self, first: int, last: int) -> Floats:
        """Angle by which one section has rotated relative to another, about any axis [rad], (n_states,)."""
        return _opening(self.start_normals[last], self.seen_from(first, self.normals[:, last]))

    def bend_axes(self, first: int, last: int) -> Floats:
        """Unit vectors about which one section has rotated relative to another; zero at rest, (n, 3)."""
        start = self.start_normals[last]
        # the normal that the last section would have if it had followed the first one
        followed = _swung(
            _spun(
                np.broadcast_to(start, self.normals[:, first].shape),
                self.start_normals[first],
                self.spins[:, first],
            ),
            self.start_normals[first],
            self.normals[:, first],
        )
        across = np.cross(followed, self.normals[:, last])
        return np.asarray(across / np.maximum(np.linalg.norm(across, axis=1), SMALL)[:, None])

    def seen_from(self, ring: int, vectors: Floats) -> Floats:
        """Vectors over time as seen from one section: rotated back with its ring, (n_states, 3)."""
        now, start = self.normals[:, ring], self.start_normals[ring]
        return _spun(_swung_back(vectors, start, now), start, -self.spins[:, ring])

    def nearest(self, station: float) -> int:
        """Index of the ring nearest to a station [m]."""
        return int(np.argmin(np.abs(self.stations - station)))

    def chord_rotation(self, axis: Floats, ring: int | None = None) -> Floats:
        """Rotation of the line from the first to the last section about an axis [rad], (n_states,).

        Parameters
        ----------
        axis
            Unit vector at the start, (3,).
        ring
            Section that carries the axis and that the rotation is relative to; None: an axis fixed in space.
        """
        line = self.centres[:, -1] - self.centres[:, 0]
        seen = line if ring is None else self.seen_from(ring, line)
        return _turn(self.start_centres[-1] - self.start_centres[0], seen, axis)

    def chord_bend(self, ring: int) -> Floats:
        """Angle of the line between the end sections relative to one of them [rad], (n_states,)."""
        line = self.centres[:, -1] - self.centres[:, 0]
        return _opening(self.start_centres[-1] - self.start_centres[0], self.seen_from(ring, line))


def _swung(vectors: Floats, start: Floats, now: Floats) -> Floats:
    """Vectors turned by the smallest rotations that carry one direction (3,) to others, (n, 3) each."""
    middle = now + start
    along = np.einsum("ti,ti->t", middle, vectors) / np.maximum(1.0 + now @ start, SMALL)
    return np.asarray(vectors - along[:, None] * middle + 2.0 * (vectors @ start)[:, None] * now)


def _swung_back(vectors: Floats, start: Floats, now: Floats) -> Floats:
    """Vectors turned back by these rotations, (n, 3)."""
    middle = now + start
    along = np.einsum("ti,ti->t", middle, vectors) / np.maximum(1.0 + now @ start, SMALL)
    back = 2.0 * np.einsum("ti,ti->t", now, vectors)
    return np.asarray(vectors - along[:, None] * middle + back[:, None] * start)


def _spun(vectors: Floats, about: Floats, angle: Floats) -> Floats:
    """Vectors (n, 3) turned about a direction (3,) by angles (n,)."""
    along = (vectors @ about)[:, None] * about
    return np.asarray(
        along + np.cos(angle)[:, None] * (vectors - along) + np.sin(angle)[:, None] * np.cross(about, vectors)
    )


def _opening(start: Floats, now: Floats) -> Floats:
    """Angle between a vector (3,) and others (n, 3) [rad]."""
    across = np.linalg.norm(np.cross(start, now), axis=1)
    return np.asarray(np.arctan2(across, now @ start))


def _turn(start: Floats, now: Floats, axis: Floats) -> Floats:
    """Angle from a vector (3,) to others (n, 3) about an axis, continued beyond half a turn [rad]."""
    first = start - (start @ axis) * axis
    angle = np.arctan2(now @ np.cross(axis, first), now @ first)
    return np.asarray(np.unwrap(angle))


def sections_of(states: States, member: str) -> Sections | None:
    """Rings of a member, or None if the result has no shapes of it.

    Parameters
    ----------
    states
        Of any result; rings with fewer than three points are left out.
    member
        Its name.
    """
    if member not in states.member_names or not len(states.times):
        return None
    own = np.flatnonzero(states.member == states.member_names.index(member))
    if not own.size:
        return None
    order = own[np.lexsort((states.contour[own], states.station[own]))]
    station = states.station[order]
    gap = SAME_STATION * max(float(np.ptp(station)), 1e-9)
    rings = [
        ring for ring in np.split(order, np.flatnonzero(np.diff(station) > gap) + 1) if len(ring) >= FEWEST
    ]
    if len(rings) < 2:
        return None
    planes = [_planes(states.points[None, ring] + states.displacement[:, ring]) for ring in rings]
    start = [_planes(states.points[None, ring]) for ring in rings]
    spins = [
        _spins(states.points[ring], states.points[ring] + states.displacement[:, ring], first[0], now)
        for ring, (_, first), (_, now) in zip(rings, start, planes, strict=True)
    ]
    return Sections(
        member=member,
        stations=np.array([float(states.station[ring].mean()) for ring in rings]),
        times=states.times,
        centres=np.stack([centre for centre, _ in planes], axis=1),
        normals=np.stack([normal for _, normal in planes], axis=1),
        start_centres=np.concatenate([centre for centre, _ in start]),
        start_normals=np.concatenate([normal for _, normal in start]),
        spins=np.stack(spins, axis=1),
    )


def _spins(start: Floats, now: Floats, normal: Floats, normals: Floats) -> Floats:
    """Mean turn of points (n, 3) about their normal (3,), swung back from (n_states, 3); [rad]."""
    arms = start - start.mean(axis=0)
    arms = arms - np.outer(arms @ normal, normal)
    moved = now - now.mean(axis=1)[:, None]
    swung = np.stack([_swung_back(point, normal, normals) for point in np.swapaxes(moved, 0, 1)], axis=1)
    across = np.cross(normal, arms)
    return np.asarray(np.arctan2(np.einsum("tpi,pi->t", swung, across), np.einsum("tpi,pi->t", swung, arms)))


def _planes(points: Floats) -> tuple[Floats, Floats]:
    """Centre and unit normal of one ring in every state, from (n_states, n, 3): (n_states, 3) each."""
    centre = points.mean(axis=1)
    arm = points - centre[:, None]
    scatter = np.einsum("tni,tnj->tij", arm, arm)
    normal = np.linalg.eigh(scatter)[1][:, :, 0]
    # the outline runs counter-clockwise about the normal
    area = np.cross(arm, np.roll(arm, -1, axis=1)).sum(axis=1)
    side = np.where(np.einsum("ti,ti->t", normal, area) < 0.0, -1.0, 1.0)
    return centre, normal * side[:, None]
