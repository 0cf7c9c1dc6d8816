"""Round tubes whose ends meet in mitres: where the points of their sections begin.

The nodes around a round tube begin at its section axes, which the input turns freely, and the axes of
members that do not lie in one plane are turned against each other.  Points that are to meet in the plane of a
mitre must begin alike, so each tube takes over the points of its neighbour: turned with the change of
direction, about the normal of their common plane, which keeps all of them on the same lines along the walls.
The points lie on the chords of an outline, alike in every quarter of it.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.section import CircularTube
from crumple.shell.mesh.end import End
from crumple.shell.mesh.profile import Contour
from crumple.structure import Structure

ALIKE = 1e-7
"""Angle up to which points begin alike [rad]: far below what a mitre allows."""


def with_rings_alike(
    structure: Structure, contours: dict[str, Contour], ends: dict[str, tuple[End, ...]]
) -> dict[str, Contour]:
    """Sections of round tubes turned so that those of two members that meet at a node begin alike.

    Sections that fit stay as they are; around a closed loop that is not plane, the last corner may not fit.

    Parameters
    ----------
    structure, contours
        Members and their divided sections.
    ends
        Those that meet at each node.
    """
    beside: dict[str, list[tuple[End, End]]] = {name: [] for name in contours}
    for meeting in ends.values():
        if len(meeting) == 2 and _are_round(structure, contours, meeting):
            first, second = meeting
            beside[first.member].append((first, second))
            beside[second.member].append((second, first))
    new, done = dict(contours), set()
    for name in contours:
        waiting = [] if name in done else [name]
        while waiting:
            member = waiting.pop()
            done.add(member)
            for own, other in beside[member]:
                if other.member not in done:
                    new[other.member] = _like(structure, new, own, other)
                    waiting.append(other.member)
    return new


def _are_round(structure: Structure, contours: dict[str, Contour], ends: tuple[End, ...]) -> bool:
    """Whether the members are round tubes of the same number of points around the same circle."""
    first, second = (structure.section_of(end.member) for end in ends)
    if not isinstance(first, CircularTube) or not isinstance(second, CircularTube):
        return False
    same = math.isclose(first.diameter - first.thickness, second.diameter - second.thickness, rel_tol=1e-9)
    return same and len(contours[ends[0].member].points) == len(contours[ends[1].member].points)


def _like(structure: Structure, contours: dict[str, Contour], own: End, other: End) -> Contour:
    """Section of the member of ``other`` whose points begin like those of the member of ``own``."""
    mine, theirs = structure.frame_of(own.member), structure.frame_of(other.member)
    before = mine.axes[0] if own.second else -mine.axes[0]
    after = -theirs.axes[0] if other.second else theirs.axes[0]
    arm = _turned(contours[own.member].points[0] @ mine.axes[1:], before, after)
    contour = contours[other.member]
    wanted, came = (math.atan2(z, y) for y, z in (theirs.axes[1:] @ arm, contour.points[0]))
    # a quarter turn changes nothing
    angle = math.remainder(wanted - came, math.pi / 2.0)
    if abs(angle) < ALIKE:
        return contour
    c, s = math.cos(angle), math.sin(angle)
    return replace(contour, points=contour.points @ np.array([[c, s], [-s, c]]))


def _turned(arm: Floats, before: Floats, after: Floats) -> Floats:
    """A vector turned as the direction ``before`` turns into ``after``, both units and not opposite."""
    # the turn about their common normal is the reflection in `before` + `after` after that in `before`
    both = before + after
    flipped = 2.0 * float(before @ arm) * before - arm
    return np.asarray(2.0 * float(both @ flipped) / float(both @ both) * both - flipped)
