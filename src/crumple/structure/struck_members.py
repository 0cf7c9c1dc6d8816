"""Places between the nodes of a member at which another member strikes it: a fold forms there.

Members are thrown by initial velocities, each as a whole.  The struck one is at rest in what follows, the
other moves by the difference of their velocities where they touch, like a pole of the outline of its section
(`struck_places`).  A field that turns gives other velocities at other places, so that place and velocity are
found in turns.  Members that share a node have no contact with each other, and a far stronger one does not
fold where a weaker one strikes it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.numeric.rotation import cross
from crumple.section import AXES
from crumple.structure.geometry import Frame
from crumple.structure.initial_fields import fields_of_member
from crumple.structure.parts import StructureParts
from crumple.structure.struck_places import LEAST, Core, StruckPlace, reach_of, touch

STRONGER = 3.0
"""Plastic moment over that of the other member from which on the other one folds alone."""
TURNS = 5
"""Times that place and velocity are found from each other."""


@dataclass(frozen=True)
class _Thrown:
    """A member with the velocity of its origin [m/s], and its angular velocity [rad/s]."""

    name: str
    frame: Frame
    outline: Floats
    velocity: Floats
    rate: Floats

    def velocity_at(self, point: Floats) -> Floats:
        return np.asarray(self.velocity + cross(self.rate, point - self.frame.origin))


def places_struck_by_members(structure: StructureParts, member: str) -> tuple[StruckPlace, ...]:
    """Places between the nodes of a member that other members strike; their names stand for the obstacle.

    Parameters
    ----------
    structure, member
        What is struck.
    """
    if structure.member_contact is None or not structure.initial_velocity:
        return ()
    return structure.kept.once("struck by members", "", lambda: _struck(structure)).get(member, ())


def _struck(structure: StructureParts) -> Mapping[str, tuple[StruckPlace, ...]]:
    thrown = [_thrown(structure, name) for name in structure.members if structure.is_whole(name)]
    found: dict[str, tuple[StruckPlace, ...]] = {}
    for one, other in _apart(structure, thrown):
        place = _place(one, other)
        if place is None:
            continue
        if _moment(structure, one.name) <= STRONGER * _moment(structure, other.name):
            found[one.name] = (*found.get(one.name, ()), place)
    return found


def _moment(structure: StructureParts, member: str) -> float:
    """Larger plastic moment of a section [N m]."""
    section = structure.section_of(member)
    most = max(section.plastic_section_modulus(axis) for axis in AXES)
    return structure.material_of(member).yield_stress * most


def _thrown(structure: StructureParts, member: str) -> _Thrown:
    frame = structure.frame_of(member)
    fields = fields_of_member(structure.initial_velocity, member)
    velocity = sum((np.asarray(field.at(frame.origin), float) for field in fields), np.zeros(3))
    rate = sum((np.asarray(field.rate, float) for field in fields), np.zeros(3))
    return _Thrown(member, frame, structure.section_of(member).outer_outline(), velocity, rate)


def _apart(structure: StructureParts, thrown: list[_Thrown]) -> Iterator[tuple[_Thrown, _Thrown]]:
    """Pairs of members without a common node whose velocities differ."""
    moved = np.array([np.concatenate([one.velocity_at(np.zeros(3)), one.rate]) for one in thrown])
    for i, one in enumerate(thrown):
        nodes = set(structure.members[one.name].nodes)
        for j in np.flatnonzero(np.any(moved != moved[i], axis=1)).tolist():
            if nodes.isdisjoint(structure.members[thrown[j].name].nodes):
                yield one, thrown[j]


def _place(one: _Thrown, other: _Thrown) -> StruckPlace | None:
    """Where another member strikes one between its ends, or None."""
    normal = cross(one.frame.x, other.frame.x)
    size = float(np.linalg.norm(normal))
    if size == 0.0:
        return None
    towards = normal / size
    towards = towards if float((other.frame.origin - one.frame.origin) @ towards) >= 0.0 else -towards
    radius = reach_of(other.frame, other.outline, -towards)
    core = Core(other.frame.origin, other.frame.x, radius, 0.0, other.frame.length)
    point, place = one.frame.position(0.5 * one.frame.length), None
    for _ in range(TURNS):
        velocity = other.velocity_at(point) - one.velocity_at(point)
        speed = float(np.linalg.norm(velocity))
        if speed == 0.0:
            return None
        place = touch(one.frame, one.outline, core, velocity / speed, other.name)
        if place is None or not LEAST < place.station < one.frame.length - LEAST:
            return None
        point = one.frame.position(place.station)
    return place
