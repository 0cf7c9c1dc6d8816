"""Deformed shapes: the walls of every member as quadrilaterals that move with the rigid bodies."""

from __future__ import annotations

from bisect import bisect_left, bisect_right

import numpy as np

from crumple.cancelling import go_on
from crumple.errors import InputError, Problem
from crumple.multibody.answer.poses import Poses
from crumple.multibody.bodies.assembly import Piece
from crumple.numeric.arrays import Floats, Integers
from crumple.numeric.rotation import product, turned, vector_quaternion
from crumple.result import States
from crumple.structure import Structure, member_hinge_places

MOST_POINTS = 20_000_000
"""Largest number of points in all pictures of a run: 0.5 GB."""
MOST_AT_ONCE = 200_000
"""Points that are moved together: enough for NumPy, few enough for the memory."""
LONGEST_QUAD = 2.0
"""Length of a quadrilateral over the section's largest side: smooth enough to draw, few enough to store."""


def refuse_pictures(structure: Structure, pictures: int) -> None:
    """Refuse shapes that would exceed the memory, before anything is built or solved.

    Raises
    ------
    InputError
        Naming the member that takes the most points.
    """
    points = {}
    shapes: dict[str, tuple[int, float]] = {}
    for name, member in structure.members.items():
        go_on()
        if member.section not in shapes:
            outline = structure.section_of(name).outline()
            shapes[member.section] = len(outline), float(np.ptp(outline, axis=0).max())
        around, side = shapes[member.section]
        rings = structure.frame_of(name).length / (LONGEST_QUAD * side)
        points[name] = around * (rings + len(member_hinge_places(structure, name)) + 2.0)
    total = pictures * sum(points.values())
    if total > MOST_POINTS:
        most = max(points, key=lambda name: points[name])
        what, came = "the shapes of the members have too many points", f"{total:.3g} in {pictures} pictures"
        allowed, todo = (
            f"at most {MOST_POINTS:.3g}",
            "ask for fewer pictures, or correct the length of this member",
        )
        raise InputError(Problem(what, came, allowed, todo, f"members.{most}"))


def states_of(structure: Structure, poses: Poses, output_times: Floats, times: Floats) -> States:
    """Shapes at those of the given times [s] that the run reached, each at the nearest output."""
    reached = times[times <= output_times[-1] * (1 + 1e-12)]
    rows = np.searchsorted((output_times[1:] + output_times[:-1]) / 2.0, reached)
    points, middles, bodies, quads, member, station, contour = [], [], [], [], [], [], []
    count = 0
    for index, name in enumerate(structure.members):
        frame, outline = structure.frame_of(name), structure.section_of(name).outline()
        around = len(outline)
        stations = _stations(poses.pieces[name], float(np.ptp(outline, axis=0).max()))
        rings = frame.position(stations[:, None, None]) + outline @ frame.axes[1:]
        points.append(rings.reshape(-1, 3))
        middles.append(rings.mean(axis=1))
        bodies += [(*_meeting(poses, name, station), around) for station in stations]
        member.append(np.full(around * len(stations), index, dtype=np.int64))
        station.append(np.repeat(stations, around))
        contour.append(np.tile(np.arange(around), len(stations)))
        quads.append(count + _tube_quads(len(stations), around))
        count += around * len(stations)
    reference = np.concatenate(points)
    moved = _carried(poses, np.array(bodies), np.concatenate(middles), reference, rows)
    return States(
        points=reference,
        quads=np.concatenate(quads),
        member=np.concatenate(member),
        station=np.concatenate(station),
        contour=np.concatenate(contour).astype(np.int64),
        member_names=tuple(structure.members),
        times=output_times[rows],
        displacement=np.concatenate(moved, axis=1) - reference,
    )


def _stations(pieces: tuple[Piece, ...], side: float) -> Floats:
    """Stations along a member: at every cut, and evenly within its pieces."""
    found = [0.0]
    for piece in pieces:
        number = max(1, int(np.ceil((piece.end - piece.start) / (LONGEST_QUAD * side))))
        found += list(np.linspace(piece.start, piece.end, number + 1)[1:])
    return np.unique(np.array(found))


def _tube_quads(rings: int, around: int) -> Integers:
    i, j = np.divmod(np.arange((rings - 1) * around), around)
    k = (j + 1) % around
    return np.stack([i * around + j, (i + 1) * around + j, (i + 1) * around + k, i * around + k], axis=1)


def _meeting(poses: Poses, member: str, station: float) -> tuple[int, int]:
    """Bodies to which a station of a member belongs: one twice, or the two that a hinge joins there."""
    pieces = poses.pieces[member]
    first = bisect_left(pieces, station, key=lambda piece: piece.end)
    last = bisect_right(pieces, station, key=lambda piece: piece.start) - 1
    return pieces[first].body, pieces[last].body


def _carried(poses: Poses, rings: Integers, middles: Floats, points: Floats, rows: Integers) -> list[Floats]:
    """Positions of rings of points at some output times.

    Parameters
    ----------
    poses
        Of the bodies.
    rings
        The two bodies that carry each ring, and its number of points, (rings, 3); at a hinge, where they
        differ, a ring rotates by the mean of both about the hinge, so that the walls meet.
    middles, points
        Of the rings, (rings, 3), and of all of them in order, (points, 3).
    rows
        Output times.

    Returns
    -------
    list
        Parts of few enough points for the memory, (rows, points, 3), in order.
    """
    until = np.cumsum(rings[:, 2])
    part_of = until * max(1, len(rows)) // MOST_AT_ONCE
    found = []
    for part in np.unique(part_of):
        at = np.flatnonzero(part_of == part)
        first, second, around = rings[at].T
        place, turn = poses.places(first, middles[at], rows)
        hinges = np.flatnonzero(first != second)
        if len(hinges):
            other = poses.places(second[hinges], middles[at][hinges], rows)[0]
            place[:, hinges] = (place[:, hinges] + other) / 2.0
            bent = poses.relatives(first[hinges], second[hinges])[rows]
            turn[:, hinges] = product(turn[:, hinges], vector_quaternion(bent / 2.0))
        arms = points[until[at[0]] - around[0] : until[at[-1]]] - np.repeat(middles[at], around, axis=0)
        place, turn = (np.repeat(of_rings, around, axis=1) for of_rings in (place, turn))
        found.append(place + turned(turn, arms))
    return found
