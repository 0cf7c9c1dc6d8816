"""Where spot welds lie, and the width of the walls on which they lie."""

from __future__ import annotations

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.section import Section
from crumple.structure.geometry import Frame
from crumple.structure.parts import StructureParts

FLAT = np.cos(np.radians(30.0))
"""Cosine of the angle by which a wall may turn and still be the one on which a spot lies: two sheets may be
as far from parallel."""


def spot_places(structure: StructureParts, name: str) -> Floats:
    """Places of every spot of an entry of a sound structure [m], (k, 3)."""
    welds = structure.spot_welds[name]
    frame = structure.frame_of(welds.members[0])
    if len(welds.members) == len(("first", "second")):
        return welds.places(frame)
    along = frame.origin + welds.stations(frame.length)[:, None] * frame.x
    return np.concatenate([along + middle @ frame.axes[1:] for middle in _lines(structure, welds.members[0])])


def widest_spot(structure: StructureParts, name: str) -> tuple[float, str]:
    """Largest diameter [m] that every spot of an entry has room for, and the member that has the least.

    A spot has room up to the nearer edge of the wall on which it lies; a bend is an edge.
    """
    welds = structure.spot_welds[name]
    found = []
    for member in dict.fromkeys(welds.members):
        section, frame = structure.section_of(member), structure.frame_of(member)
        points = (
            _lines(structure, member)
            if len(welds.members) == 1
            else _across(spot_places(structure, name), frame)
        )
        found.append((2.0 * min(_to_the_edge(section, point) for point in np.unique(points, axis=0)), member))
    # of two with the same room the first
    return min(found, key=lambda one: round(one[0], 9))


def _lines(structure: StructureParts, member: str) -> Floats:
    """Middles of the weld lines of a member's section (y, z) [m], (n, 2)."""
    lines = getattr(structure.section_of(member), "welds", ())
    return np.asarray(
        np.array([[weld.first, weld.second] for weld in lines], float).mean(axis=1).reshape(-1, 2)
    )


def _across(places: Floats, frame: Frame) -> Floats:
    """Places in the section's axes (y, z) [m], rounded to a micrometre, (k, 2)."""
    return np.asarray(np.round((places - frame.origin) @ frame.axes[1:].T, 6))


def _walls(section: Section) -> list[tuple[Floats, bool]]:
    """Mid-lines (y, z) [m], (n, 2) each, and whether each is closed."""
    walls = getattr(section, "walls", ())
    if walls:
        return [(np.array(wall.points), wall.closed) for wall in walls]
    return [(np.asarray(section.outline()), True)]


def _to_the_edge(section: Section, point: Floats) -> float:
    """Distance along the wall nearest to a point to the nearer of its two ends or bends [m]."""
    best, room = np.inf, 0.0
    for points, closed in _walls(section):
        corners = np.concatenate([points, points[:1]]) if closed else points
        side = np.diff(corners, axis=0)
        length = np.linalg.norm(side, axis=1)
        share = np.clip(((point - corners[:-1]) * side).sum(axis=1) / length**2, 0.0, 1.0)
        away = np.linalg.norm(corners[:-1] + share[:, None] * side - point, axis=1)
        i = int(away.argmin())
        if away[i] < best:
            directions = side / length[:, None]
            ways = [share[i] * length[i], (1.0 - share[i]) * length[i]]
            for way, step in ((0, -1), (1, 1)):
                ways[way] += _straight_on(directions, length, (i, step), closed)
            best, room = float(away[i]), float(min(ways))
    return room


def _straight_on(directions: Floats, length: Floats, at: tuple[int, int], closed: bool) -> float:
    """Length of the sides that continue from one side in a direction without a bend [m]."""
    (i, step), going = at, 0.0
    for number in range(1, len(length)):
        j = i + step * number
        if not closed and not 0 <= j < len(length):
            break
        if directions[j % len(length)] @ directions[i] < FLAT:
            break
        going += float(length[j % len(length)])
    return going
