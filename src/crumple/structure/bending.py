"""Plane in which a structure bends: the default hinge axis if the input does not give one.

A frame whose nodes span a plane bends in it.  A straight structure bends in the plane of its members and
of its motion and loads: initial velocities, impulses, loads, driven supports, gravity, in this order.
Parts that no node connects have planes of their own.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Literal

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.geometry import FLAT, LEVEL, SQUARE
from crumple.structure.keys.member import Member
from crumple.structure.keys.obstacles import CylinderObstacle, Obstacle, PlaneObstacle
from crumple.structure.parts import StructureParts

PLANAR = ("planar", "")
"""Key of the answer of `planar` among the structure's derived data."""


def bending_axis(structure: StructureParts, member: str) -> Literal["y", "z"]:
    """Section axis of a member nearest to the normal of the bending plane; "y" if nothing bends it.

    Parameters
    ----------
    structure
        Its members must have nodes that exist and are apart.
    member
        Name of the member.
    """
    frame = structure.frame_of(member)
    normal = structure.normal_of(member)
    if normal is None:
        return "y"
    _, y, z = np.abs(frame.axes @ np.array(normal)).tolist()
    return "z" if z > y * (1.0 + FLAT) else "y"


def planar(structure: StructureParts) -> bool:
    """Whether a structure lies in a plane and bends in it.

    No motion, load or obstacle pushes out of it, and no section is turned to it: one whose axes are at an
    angle to the plane also bends across it.
    """
    normal = structure.bending_normal
    return normal is not None and structure.kept.once(
        *PLANAR,
        lambda: (
            not _turned(structure, np.asarray(normal)) and across_plane(structure, np.asarray(normal)) is None
        ),
    )


def _turned(structure: StructureParts, normal: Floats) -> bool:
    """Whether a section has neither axis along the normal of a plane; round ones have one along any.

    Those within `SQUARE` of it were turned into the plane.
    """
    least = np.cos(SQUARE)
    return any(
        structure.has_line(name)
        and _axes_matter(structure, member)
        and np.abs(structure.frame_of(name).axes @ normal).max() < least
        for name, member in structure.members.items()
    )


def _axes_matter(structure: StructureParts, member: Member) -> bool:
    """Whether a section has axes of its own; one that is not there is refused elsewhere."""
    section = structure.sections.get(member.section)
    return section is not None and section.type != "circular_tube"


def across_plane(structure: StructureParts, normal: Floats) -> str | None:
    """Path of the first input that moves or pushes out of a plane; None if all is in the plane.

    Parameters
    ----------
    structure
        Sound.
    normal
        Unit vector across the plane, (3,).
    """
    return next((where for where, part in _parts_across(structure, normal) if part > LEVEL), None)


def driven_across(structure: StructureParts, normal: Floats) -> str | None:
    """Path of the first support that drives its node out of a plane; None if all do so in the plane."""
    return next((where for where, part in _drives_across(structure, normal) if part > LEVEL), None)


def _drives_across(structure: StructureParts, normal: Floats) -> Iterator[tuple[str, float]]:
    """Share of the motion of all driven supports out of a plane, by path."""
    for name, support in structure.supports.items():
        for freedom in support.driven:
            unit = np.eye(3)["xyz".index(freedom[-1])]
            part = _aside(unit, normal) if freedom[0] == "r" else _along(unit, normal)
            yield f"supports.{name}.motion", part


def _parts_across(structure: StructureParts, normal: Floats) -> Iterator[tuple[str, float]]:
    """Share of all velocities, impulses, forces, driven motions and obstacles out of a plane, by path."""

    def along(vector: Iterable[float]) -> float:
        return _along(vector, normal)

    def aside(vector: Iterable[float]) -> float:
        return _aside(vector, normal)

    for i, field in enumerate(structure.initial_velocity):
        yield f"initial_velocity[{i}]", along(field.translation)
        if field.axis is not None and field.rotation:
            yield f"initial_velocity[{i}]", aside(field.axis)
    for i, impulse in enumerate(structure.impulses):
        yield f"impulses[{i}]", max(along(impulse.impulse), aside(impulse.angular_impulse))
    for i, load in enumerate(structure.loads):
        for axis, unit in zip("xyz", np.eye(3), strict=True):
            if getattr(load.force, axis) is not None:
                yield f"loads[{i}].force", along(unit)
            if getattr(load.moment, axis) is not None:
                yield f"loads[{i}].moment", aside(unit)
    yield from _drives_across(structure, normal)
    for name, mass in structure.masses.items():
        size = float(np.linalg.norm(mass.offset))
        yield f"masses.{name}.offset", along(mass.offset) if size > 0.0 else 0.0
    yield "gravity", along(structure.gravity)
    for name, obstacle in structure.obstacles.items():
        for key, part in _obstacle_across(structure, obstacle, normal):
            yield f"obstacles.{name}.{key}", part


def _obstacle_across(
    structure: StructureParts, obstacle: Obstacle, normal: Floats
) -> Iterator[tuple[str, float]]:
    """Share of an obstacle's push out of a plane, by key.

    Its force acts across its surface and, with friction, along the relative motion.  The surfaces of planes
    whose normals are in the plane, of poles across the plane that reach through the structure, and of poles
    and balls whose axis or centre is in the plane are symmetric to it, so that they push in the plane.
    """
    height = float((np.asarray(obstacle.point) - structure.nodes[_any_node(structure)]) @ normal)
    endless = isinstance(obstacle, PlaneObstacle) or getattr(obstacle, "length", 1.0) is None
    if isinstance(obstacle, PlaneObstacle):
        yield "normal", _along(obstacle.normal, normal)
        yield "edge", _along(obstacle.edge or (0.0, 0.0, 0.0), normal)
    elif isinstance(obstacle, CylinderObstacle):
        across = _aside(obstacle.axis, normal)
        yield "axis", min(across, _along(obstacle.axis, normal))
        if across > 0.5:
            yield "point", abs(height) / obstacle.radius
        elif obstacle.length is not None:
            yield "length", _uncovered(structure, height, float(np.dot(obstacle.axis, normal)), obstacle)
    else:
        yield "point", abs(height) / float(getattr(obstacle, "radius", 1.0))
    # a surface without end along the normal of the plane drags the structure along by friction only
    if obstacle.friction > 0.0 or not endless:
        guide = obstacle.guide_direction
        yield "velocity", _along(obstacle.velocity if guide is None else guide, normal)
        for axis, unit in zip("xyz", np.eye(3), strict=True):
            if getattr(obstacle.motion, axis) is not None:
                yield "motion", _along(unit, normal)
    if obstacle.turning is not None:
        yield "turning", _aside(obstacle.turning.axis, normal)


def _uncovered(structure: StructureParts, height: float, sense: float, pole: CylinderObstacle) -> float:
    """How far from symmetric to the plane a pole across it is [-]; 0 if it reaches through the sections."""
    assert pole.length is not None
    sections = (structure.section_of(name) for name in structure.members if structure.is_whole(name))
    reach = max((float(np.linalg.norm(one.outline(), axis=1).max()) for one in sections), default=0.0)
    low, high = sorted((height, height + float(np.copysign(pole.length, sense))))
    return 0.0 if low <= -reach and high >= reach else abs(low + high) / pole.length


def _any_node(structure: StructureParts) -> str:
    """A node of a member: all are in the plane.  One that exists: a refused one is not among them."""
    return next(
        node for member in structure.members.values() for node in member.nodes if node in structure.nodes
    )


def _along(vector: Iterable[float], normal: Floats) -> float:
    """Share of a vector along a unit vector [-]; 0 of a zero vector."""
    given = np.asarray(tuple(vector), float)
    return abs(float(given @ normal)) / (float(np.linalg.norm(given)) or 1.0)


def _aside(vector: Iterable[float], normal: Floats) -> float:
    """Share of a vector at right angles to a unit vector [-]; 0 of a zero vector."""
    given = np.asarray(tuple(vector), float)
    return float(np.linalg.norm(np.cross(given, normal))) / (float(np.linalg.norm(given)) or 1.0)
