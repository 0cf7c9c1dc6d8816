"""Plane in which a structure bends: the default hinge axis if the input does not give one.

A frame whose nodes span a plane bends in it.  A straight structure bends in the plane of its members and
of its motion and loads: initial velocities, impulses, loads, driven supports, gravity, in this order.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Literal

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.geometry import FLAT
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
    normal = structure.bending_normal
    if normal is None:
        return "y"
    _, y, z = np.abs(frame.axes @ np.array(normal)).tolist()
    return "z" if z > y * (1.0 + FLAT) else "y"


def planar(structure: StructureParts) -> bool:
    """Whether a structure lies in a plane and has no motion or load normal to it."""
    normal = structure.bending_normal
    return normal is not None and structure.kept.once(
        *PLANAR, lambda: across_plane(structure, np.asarray(normal)) is None
    )


def across_plane(structure: StructureParts, normal: Floats) -> str | None:
    """Path of the first input with motion or load normal to a plane; None if all is in the plane.

    Parameters
    ----------
    structure
        Sound.
    normal
        Unit vector across the plane, (3,).
    """
    return next((where for where, part in _parts_across(structure, normal) if part > FLAT), None)


def _parts_across(structure: StructureParts, normal: Floats) -> Iterator[tuple[str, float]]:
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
