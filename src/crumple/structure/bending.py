"""Which way a structure bends: the direction that hinges turn about where the input does not say.

A frame whose nodes span a plane bends in it.  A straight structure bends in the plane of its members and
of what moves or loads it: initial velocities, impulses, loads, driven supports, gravity, in this order.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Literal

import numpy as np

from crumple.numeric.arrays import Floats

if TYPE_CHECKING:
    from crumple.structure.structure import Structure

FLAT = 1e-6
"""Ratio of singular values of the node positions below which they count as in line or in a plane."""


def bending_axis(structure: Structure, member: str) -> Literal["y", "z"]:
    """Section axis of a member nearest to the normal of the bending plane; "y" where nothing bends it.

    Parameters
    ----------
    structure
        Its members must have nodes that exist and are apart.
    member
        Name of the member.
    """
    frame = structure.frame_of(member)
    normal = structure.bending_normal
    if normal is None:
        return "y"
    return "z" if abs(frame.z @ normal) > abs(frame.y @ normal) * (1.0 + FLAT) else "y"


def bending_normal(structure: Structure) -> Floats | None:
    """Normal of the plane in which a structure bends, (3,); None where nothing says so."""
    ends = {node for member in structure.members.values() for node in member.nodes}
    points = np.array([structure.nodes[node] for node in ends if node in structure.nodes], float)
    if len(points) < 2:
        return None
    _, sizes, axes = np.linalg.svd(points - points.mean(axis=0), full_matrices=False)
    if sizes[1] > FLAT * sizes[0]:
        in_plane = len(sizes) < 3 or sizes[2] <= FLAT * sizes[0]
        return axes[2] if in_plane else None
    line = axes[0]
    for across in _turned(structure, line):
        size = float(np.linalg.norm(across))
        if size > 0.0:
            normal: Floats = across / size
            return normal
    return None


def _turned(structure: Structure, line: Floats) -> Iterator[Floats]:
    """Vectors that a straight structure is turned about, strongest reason first; zero where there is none."""
    for field in structure.initial_velocity:
        if field.axis is not None and field.rotation:
            yield _across(np.asarray(field.axis, float), line)
        yield np.cross(line, field.translation)
    for impulse in structure.impulses:
        yield _across(np.asarray(impulse.angular_impulse), line)
        yield np.cross(line, impulse.impulse)
    for load in structure.loads:
        yield _across(np.array([getattr(load.moment, axis) is not None for axis in "xyz"], float), line)
        yield np.cross(line, [getattr(load.force, axis) is not None for axis in "xyz"])
    for support in structure.supports.values():
        yield _across(np.array([f"r{axis}" in support.driven for axis in "xyz"], float), line)
        yield np.cross(line, [axis in support.driven for axis in "xyz"])
    yield np.cross(line, structure.gravity)


def _across(vector: Floats, line: Floats) -> Floats:
    across: Floats = vector - (vector @ line) * line
    return across if float(np.linalg.norm(across)) > FLAT * float(np.linalg.norm(vector)) else 0.0 * line


def planar(structure: Structure) -> bool:
    """Whether a structure lies in a plane, and nothing moves or loads it across that plane."""
    normal = structure.bending_normal
    return normal is not None and across_plane(structure, np.asarray(normal)) is None


def across_plane(structure: Structure, normal: Floats) -> str | None:
    """Path of the first input that moves or loads a structure across a plane; None where all lies in it.

    Parameters
    ----------
    structure
        Sound.
    normal
        Unit vector across the plane, (3,).
    """
    return next((where for where, part in _parts_across(structure, normal) if part > FLAT), None)


def _parts_across(structure: Structure, normal: Floats) -> Iterator[tuple[str, float]]:
    """Share of every velocity, impulse, force and driven motion that leads out of a plane, by its path."""

    def along(vector: Iterable[float]) -> float:
        given = np.asarray(tuple(vector), float)
        return abs(float(given @ normal)) / (float(np.linalg.norm(given)) or 1.0)

    def aside(vector: Iterable[float]) -> float:
        given = np.asarray(tuple(vector), float)
        return float(np.linalg.norm(np.cross(given, normal))) / (float(np.linalg.norm(given)) or 1.0)

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
    for name, support in structure.supports.items():
        for freedom in support.driven:
            unit = np.eye(3)["xyz".index(freedom[-1])]
            yield f"supports.{name}.motion", aside(unit) if freedom[0] == "r" else along(unit)
    for name, mass in structure.masses.items():
        size = float(np.linalg.norm(mass.offset))
        yield f"masses.{name}.offset", along(mass.offset) if size > 0.0 else 0.0
    yield "gravity", along(structure.gravity)
