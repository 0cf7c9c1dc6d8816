"""Mitred corners: nodes at which two members of one section meet rigidly at an angle, and nothing else.

A corner has a law of its own (crumple characterise --angle): its walls may fold at a smaller moment than
those of a straight member.  The section must lie in the same way to the plane of the corner in both members,
as it does in the sub-model, where the second piece is the first one turned about the normal of the plane.
Where something acts on the node, what passes it on holds the section of the mitre in shape.  The corner is
then as strong as its members, and their folds form outside of it (joint_reach).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from enum import Enum, auto

import numpy as np

from crumple.hinge.corner.in_plane import LARGEST, SMALLEST
from crumple.hinge.measured.place_hash import Direction, place_hash
from crumple.numeric.arrays import Floats
from crumple.section import Axis, half_fold_length
from crumple.structure.parts import StructureParts

ALONG = 1e-4
"""Component of a unit vector below which it does not point along another."""
ALIKE = 5e-3
"""Distance of the points of two outlines, over the section's largest side, below which they are one: square
tubes turned by 0.4 degrees, far above rounded coordinates and far below a wall's thickness."""

BOTH_WAYS = ("closed_hat",)
"""Sections whose corners are known with either side inside."""


class Lacks(Enum):
    """What two members at an angle lack for a mitred corner."""

    ANGLE = auto()
    SECTION = auto()
    METAL = auto()
    POSITION = auto()
    """The section does not lie as in the sub-model."""
    INTENDED = auto()
    """The input makes the node something else: joined, held, loaded, rigid, or a joint of several members."""


@dataclass(frozen=True)
class Corner:
    """A mitred corner of two members.

    Attributes
    ----------
    node
        At which they meet.
    first, second
        The members, in the order of the structure.
    axis
        Axis of the section, in the first member, that is normal to the corner's plane.
    angle
        Angle between their axes, 0 in line [rad].
    sense
        +1 if a positive rotation of a hinge in the first member about that axis closes the corner, else -1.
    normal
        Unit vector across its plane: a positive rotation about it turns the first member's way on to that of
        the second, (3,).
    turned
        Whether the section lies the other way round than in the sub-model of a positive angle: the crown of
        a closed hat, not its plate, is on the inner side.
    """

    node: str
    first: str
    second: str
    axis: Axis
    angle: float
    sense: int
    normal: tuple[float, float, float]
    turned: bool = False

    @property
    def turn(self) -> float:
        """Angle of the second piece of its sub-model about the section's axis [rad]; negative if turned."""
        return -self.angle if self.turned else self.angle

    def place(self, structure: StructureParts) -> str:
        """Hash of the place, by which a store knows its law."""
        section, material = structure.section_of(self.first), structure.material_of(self.first)
        return place_hash(section, material, self.axis, self.turn)

    def place_out_of_plane(self, structure: StructureParts, about: Direction) -> str:
        """Hash of the place out of the corner's plane, about its bisector or its tangent."""
        section, material = structure.section_of(self.first), structure.material_of(self.first)
        return place_hash(section, material, self.axis, self.turn, load="out-of-plane", about=about)

    def is_round(self, structure: StructureParts) -> bool:
        """Whether its tubes are round: their sections have no axis of their own, so the plane gives it."""
        return structure.section_of(self.first).kind == "circular_tube"

    def is_about(self, structure: StructureParts) -> bool:
        """Whether the section's axis is normal to its plane; that of a round tube may be any."""
        along = structure.frame_of(self.first).axis(self.axis) @ np.array(self.normal)
        return abs(float(along)) > 1.0 - ALONG

    @property
    def across(self) -> Axis:
        """Axis of the section in the corner's plane."""
        return "z" if self.axis == "y" else "y"

    def axes(self, structure: StructureParts) -> Floats:
        """Principal axes of its hinge in the first member as rows, (3, 3): tangent, y and z.

        The first member's axes, turned about the normal of the corner's plane by half the angle: y or z then
        lies along the bisector.
        """
        along, normal = structure.frame_of(self.first).x, np.array(self.normal)
        tangent = math.cos(0.5 * self.angle) * along + math.sin(0.5 * self.angle) * np.cross(normal, along)
        ends_here = structure.members[self.first].nodes[1] == self.node
        own = normal if (self.sense > 0) == ends_here else -normal
        if self.axis == "y":
            return np.array([tangent, own, np.cross(tangent, own)])
        return np.array([tangent, np.cross(own, tangent), own])

    def zone(self, structure: StructureParts) -> float:
        """Distance from the node within which its law stands for all folds [m]: one side and half a fold."""
        section = structure.section_of(self.first)
        side = float(np.ptp(section.outer_outline(), axis=0).max())
        return side + half_fold_length(section, self.axis)


def corners(structure: StructureParts) -> Mapping[str, Corner]:
    """Corners that have a sub-model, by node."""
    return structure.kept.once("corners", "", lambda: _corners(structure)[0])


def untreated(structure: StructureParts) -> Mapping[str, str]:
    """Nodes at which members meet at an angle that have no sub-model, and why."""
    return {node: reason for node, (_, reason) in lacking(structure).items()}


def lacking(structure: StructureParts) -> Mapping[str, tuple[Lacks, str]]:
    """The same with the kind of the reason."""
    return structure.kept.once("untreated corners", "", lambda: _corners(structure)[1])


def _corners(structure: StructureParts) -> tuple[dict[str, Corner], dict[str, tuple[Lacks, str]]]:
    found: dict[str, Corner] = {}
    reasons: dict[str, tuple[Lacks, str]] = {}
    for node, members in structure.members_at.items():
        if len(members) < 2 or not all(structure.is_whole(name) for name in members):
            continue
        answer = _corner(structure, node, members)
        if isinstance(answer, Corner):
            found[node] = answer
        elif answer is not None:
            reasons[node] = answer
    return found, reasons


def continues(structure: StructureParts, node: str) -> bool:
    """Whether the members at a node are one tube in line: two of one section, placed alike, and no more."""
    members = structure.members_at.get(node, ())
    if len(members) != 2 or not all(structure.is_whole(name) for name in members):
        return False
    first, second = members
    arriving, onward = -leaving(structure, first, node), leaving(structure, second, node)
    angle = kink_at(structure, node)
    if angle >= SMALLEST or next(_reasons(structure, node, (first, second), angle), None) is not None:
        return False
    across = np.cross(arriving, onward)
    bent = float(np.linalg.norm(across))
    normal = across / bent if bent > ALONG else structure.frame_of(first).y
    return _lie_alike(structure, ((first, arriving), (second, onward)), normal)


def kink_at(structure: StructureParts, node: str) -> float:
    """Angle [rad] by which the second of two members at a node is off the line of the first."""
    first, second = structure.members_at[node]
    arriving, onward = -leaving(structure, first, node), leaving(structure, second, node)
    return math.atan2(float(np.linalg.norm(np.cross(arriving, onward))), float(arriving @ onward))


def _corner(structure: StructureParts, node: str, members: list[str]) -> Corner | tuple[Lacks, str] | None:
    """Corner at a node, or the reason why there is none; None where members only meet in line."""
    if len(members) > 2:
        return Lacks.INTENDED, f"{len(members)} members meet"
    first, second = sorted(members, key=list(structure.members).index)
    arriving, onward = -leaving(structure, first, node), leaving(structure, second, node)
    angle = math.acos(float(np.clip(arriving @ onward, -1.0, 1.0)))
    if angle < SMALLEST:
        return None
    reason = next(_reasons(structure, node, (first, second), angle), None)
    if reason is not None:
        return reason
    normal = np.cross(arriving, onward)
    normal /= np.linalg.norm(normal)
    axis = _axis_along(structure, first, normal)
    if axis is None:
        return Lacks.POSITION, "no axis of the section is normal to the corner's plane (out of plane)"
    ways = ((first, arriving), (second, onward))
    lies = _as_modelled(structure, ways, normal, axis)
    if lies is None or (lies < 0 and structure.section_of(first).kind not in BOTH_WAYS):
        return Lacks.POSITION, _position(structure, ways, normal, lies)
    ends_here = structure.members[first].nodes[1] == node
    along_normal = float(structure.frame_of(first).axis(axis) @ normal) > 0.0
    sense = 1 if along_normal == ends_here else -1
    return Corner(node, first, second, axis, angle, sense, tuple(normal.tolist()), lies < 0)


def _reasons(
    structure: StructureParts, node: str, members: tuple[str, str], angle: float
) -> Iterator[tuple[Lacks, str]]:
    """Why two members that meet at an angle are no mitred corner of one section."""
    one, other = (structure.members[name] for name in members)
    sections = [structure.section_of(name) for name in members]
    materials = [structure.material_of(name) for name in members]
    if any(joint.member in members for joint in structure.joints_at.get(node, ())):
        yield Lacks.INTENDED, "the members are joined by a joint"
    if _held(structure, node):
        yield Lacks.INTENDED, "a support holds its rotation"
    elif node in structure.loaded_nodes:
        yield Lacks.INTENDED, "its section is rigid where a mass, support, load or impulse acts"
    if any(_rigid_at(structure, name, node) for name in members):
        yield Lacks.INTENDED, "a member is rigid there"
    if angle > LARGEST:
        yield (
            Lacks.ANGLE,
            f"the angle is {math.degrees(angle):.0f} deg, above {math.degrees(LARGEST):.0f} deg",
        )
    if sections[0] != sections[1]:
        yield Lacks.SECTION, f"the sections {one.section} and {other.section} differ"
    if replace(materials[0], name="") != replace(materials[1], name=""):
        yield Lacks.METAL, f"the materials {one.material} and {other.material} differ"


def leaving(structure: StructureParts, member: str, node: str) -> Floats:
    """Unit vector of a member away from one of its nodes."""
    along = structure.frame_of(member).x
    return along if structure.members[member].nodes[0] == node else -along


def _held(structure: StructureParts, node: str) -> bool:
    """Whether a support holds or drives any rotation of the node."""
    return any(
        freedom[0] == "r"
        for _, support in structure.supports_at.get(node, ())
        for freedom in (*support.held, *support.driven)
    )


def _rigid_at(structure: StructureParts, member: str, node: str) -> bool:
    length = structure.frame_of(member).length
    station = 0.0 if structure.members[member].nodes[0] == node else length
    parts = structure.members[member].rigid_parts(length)
    return any(a <= station * (1.0 + 1e-12) and station <= b * (1.0 + 1e-12) for a, b in parts)


def _axis_along(structure: StructureParts, member: str, normal: Floats) -> Axis | None:
    frame = structure.frame_of(member)
    for axis in ("y", "z"):
        if abs(float(frame.axis(axis) @ normal)) > 1.0 - ALONG:
            return axis
    if structure.section_of(member).kind == "circular_tube":
        return "y"
    return None


def _lie_alike(structure: StructureParts, members: tuple[tuple[str, Floats], ...], normal: Floats) -> bool:
    """Whether one section lies in one way to a plane in members along given directions.

    Round sections lie alike however they are turned.
    """
    if structure.section_of(members[0][0]).kind == "circular_tube":
        return True
    one, other = (_outline(structure, *member, normal) for member in members)
    return _same_points(other, one)


def _as_modelled(
    structure: StructureParts, members: tuple[tuple[str, Floats], ...], normal: Floats, axis: Axis
) -> int | None:
    """How a section lies in members along given directions: 1 as in the sub-model of a corner, -1 turned.

    None: in neither way, or not alike in the members.
    """
    first = members[0][0]
    if structure.section_of(first).kind == "circular_tube":
        return 1
    reference = _modelled(structure, first, axis)
    outlines = [_outline(structure, *member, normal) for member in members]
    for way in (1, -1):
        if all(_same_points(outline, way * reference) for outline in outlines):
            return way
    return None


def _position(
    structure: StructureParts, members: tuple[tuple[str, Floats], ...], normal: Floats, lies: int | None
) -> str:
    """How a section lies in two members that meet at an angle, where it does not lie as in the sub-model."""
    if lies is not None:
        return (
            "the section lies alike in both members, but the other way round than in the sub-model (the "
            "corner would be recognised with 'roll' larger by 180 deg in both members: another structure)"
        )
    if not _lie_alike(structure, members, normal):
        return "the section does not lie in the same way to the corner's plane in both members"
    return "the section lies alike in both members, but as a mirror image of that of the sub-model"


def _outline(structure: StructureParts, member: str, along: Floats, normal: Floats) -> Floats:
    """Mid-line of a member's section seen along the corner: along its normal, and outwards in its plane."""
    frame, points = structure.frame_of(member), structure.section_of(member).outline()
    across = np.cross(normal, along)
    in_space = points[:, :1] * frame.y + points[:, 1:] * frame.z
    return np.stack([in_space @ normal, in_space @ across], axis=1)


def _modelled(structure: StructureParts, member: str, axis: Axis) -> Floats:
    """The same in the sub-model, whose first piece lies along x with the section's axes as y and z."""
    y, z = structure.section_of(member).outline().T
    return np.stack([y, -z] if axis == "y" else [z, y], axis=1)


def _same_points(one: Floats, other: Floats) -> bool:
    apart = np.linalg.norm(one[:, None] - other[None, :], axis=2)
    size = float(np.ptp(one, axis=0).max())
    return bool(max(apart.min(axis=0).max(), apart.min(axis=1).max()) < ALIKE * size)
