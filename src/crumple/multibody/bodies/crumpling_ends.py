"""Free ends of members that a plane meets obliquely: the walls that it meets first crumple.

The face of such an end is points along its outline, each with its share of the force at which the end
crumples; docs/theory/crumpling_ends.md.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from crumple._core.spatial.model import SpatialCapsule
from crumple.hinge.registry import build_axial_law
from crumple.numeric.arrays import Floats
from crumple.structure import PlaneObstacle, Structure
from crumple.structure.hinges.corners import leaving
from crumple.structure.hinges.law_choice import FOLDING

OBLIQUE = {"rectangular_tube": 1.3, "circular_tube": 1.0}
"""Force at which a whole oblique face crumples, over the mean crushing force of the section's law of axial
crushing, by kind of section: measured with shells, docs/theory/crumpling_ends.md."""
POINT = 1e-3
"""Radius of a point of a face, over half the smaller side of the section."""
POINTS = 8
"""Directions in which an outline has a point."""
FEW = 4
"""Corners of an outline up to which the middles of its sides are points too."""
STEEPEST = 0.5
"""Least cosine of the angle between a plane's normal and a member's axis: beyond 60 deg it meets a side."""


@dataclass(frozen=True, eq=False)
class CrumplingEnd:
    """A free end of a member that crumples on a plane.

    Attributes
    ----------
    obstacle, member, node
        Names.
    force
        At which the whole face crumples [N].
    inwards
        Direction along the member, away from the end, (3,).
    place
        Of the end [m], (3,).
    side
        Largest side of the section [m]: how far the end can crumple.
    """

    obstacle: str
    member: str
    node: str
    force: float
    inwards: Floats
    place: Floats
    side: float

    def reaches(self, capsule: SpatialCapsule) -> bool:
        """Whether a capsule of the member lies where the end can crumple."""
        return min(self._along(capsule)) < self.side + capsule.radius

    def shortened(self, capsule: SpatialCapsule) -> SpatialCapsule | None:
        """What remains of such a capsule beyond; None without any."""
        least, along = self.side + capsule.radius, self._along(capsule)
        if max(along) < least:
            return None
        ends = (capsule.first, capsule.second)
        moved = [end + max(least - at, 0.0) * self.inwards for end, at in zip(ends, along, strict=True)]
        return replace(capsule, first=moved[0], second=moved[1])

    def face(self, structure: Structure, body: int) -> Iterator[SpatialCapsule]:
        """Small balls along the outline of the face, each with its share of the force."""
        outline = structure.section_of(self.member).outer_outline()
        across = structure.frame_of(self.member).axes[1:]
        radius = POINT * float(np.ptp(outline, axis=0).min()) / 2.0
        for point, share in points_around(outline):
            middle = (outline.min(axis=0) + outline.max(axis=0)) / 2.0
            inner = point - radius * np.sign(np.round(point - middle, 9))
            place = self.place + inner @ across + radius * self.inwards
            yield SpatialCapsule(body, place, place, radius, crush_force=share * self.force)

    def _along(self, capsule: SpatialCapsule) -> list[float]:
        return [
            float((np.asarray(end, float) - self.place) @ self.inwards)
            for end in (capsule.first, capsule.second)
        ]


def crumpling_ends(structure: Structure) -> Iterator[CrumplingEnd]:
    """Free ends that a plane meets obliquely at the start, of sections that have a law of crushing.

    The corner of a face that a plane meets squarely carries the whole section at once.  A face counts as
    oblique if its first point is ahead of its last one, along the member, by a wall's thickness at least.
    """
    closed = structure.loaded_nodes | set(structure.joints_at)
    for name, plane in structure.obstacles.items():
        if not isinstance(plane, PlaneObstacle):
            continue
        normal = np.asarray(plane.normal, float) / np.linalg.norm(plane.normal)
        for node, members in structure.members_at.items():
            met = plane.members is None or members[0] in plane.members
            if len(members) > 1 or not met or node in closed or _rigid(structure, members[0], node):
                continue
            if structure.section_of(members[0]).kind not in OBLIQUE:
                continue
            end = _end(structure, name, members[0], node)
            along = float(end.inwards @ normal)
            section = structure.section_of(end.member)
            outline = section.outer_outline() @ structure.frame_of(end.member).axes[1:]
            if along >= STEEPEST and float(np.ptp(outline @ normal)) / along >= section.thickness:
                yield end


def _rigid(structure: Structure, member: str, node: str) -> bool:
    """Whether a member does not deform at its end."""
    length = structure.frame_of(member).length
    station = 0.0 if structure.members[member].nodes[0] == node else length
    return any(start <= station <= end for start, end in structure.members[member].rigid_parts(length))


def _end(structure: Structure, obstacle: str, member: str, node: str) -> CrumplingEnd:
    section, material = structure.section_of(member), structure.material_of(member)
    law = build_axial_law(FOLDING[section.kind], section, material)
    return CrumplingEnd(
        obstacle,
        member,
        node,
        OBLIQUE[section.kind] * law.mean_crushing_force,
        leaving(structure, member, node),
        np.asarray(structure.nodes[node], float),
        float(np.ptp(section.outer_outline(), axis=0).max()),
    )


def points_around(outline: Floats) -> list[tuple[Floats, float]]:
    """Points of an outline, (2,) [m], and the share of the perimeter that each stands for.

    The points are outermost in eight directions.  Of a rectangle these are its four corners, to which the
    middles of its sides are added.
    """
    turns = 2.0 * np.pi * (np.arange(POINTS) + 0.5) / POINTS
    outwards = np.stack([np.cos(turns), np.sin(turns)])
    ring = np.vstack([outline, outline[:1]])
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(ring, axis=0), axis=1))])
    at = np.unique(along[(outline @ outwards).argmax(axis=0)])
    if at.size <= FEW:
        at = np.sort(np.concatenate([at, at + np.diff(at, append=at[0] + along[-1]) / 2.0]) % along[-1])
    before, after = np.diff(at, prepend=at[-1] - along[-1]), np.diff(at, append=at[0] + along[-1])
    places = np.stack([np.interp(at, along, ring[:, axis]) for axis in range(2)], axis=1)
    return list(zip(places, (before + after) / (2.0 * along[-1]), strict=True))
