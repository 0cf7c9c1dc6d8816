"""What the ends of members can carry."""

from __future__ import annotations

from crumple.numeric.arrays import Floats
from crumple.section import Axis
from crumple.structure.keys.motion import FREEDOMS
from crumple.structure.parts import StructureParts

SAME_DIRECTION = 1e-9
"""Component of a unit vector below which it does not point along an axis."""


def carries_moment(structure: StructureParts, member: str, node: str) -> bool:
    """Whether anything at a member's end can take a bending moment: another member, a support, an inertia."""
    if _is_free(structure, member, node):
        return False
    turned = any(
        freedom[0] == "r"
        for _, support in structure.supports_at.get(node, ())
        for freedom in (*support.held, *support.driven)
    )
    inertia = any(any(mass.rotary_inertia) or any(mass.offset) for mass in structure.masses_at.get(node, ()))
    return _meets_others(structure, member, node) or turned or inertia


def passes_moment(structure: StructureParts, member: str, node: str, axes: tuple[Axis, ...]) -> bool:
    """Whether others take over the bending moments of a member at its end about all of its axes."""
    if _is_free(structure, member, node):
        return False
    frame = structure.frame_of(member)
    held = all(holds_rotation(structure, node, frame.axis(axis)) for axis in axes)
    return held or _meets_others(structure, member, node)


def holds_rotation(structure: StructureParts, node: str, direction: Floats) -> bool:
    """Whether supports hold or drive the rotation of a node about a direction."""
    supports = structure.supports_at.get(node, ())
    held = {freedom for _, support in supports for freedom in (*support.held, *support.driven)}
    needed = (FREEDOMS[3 + i] for i in range(3) if abs(direction[i]) > SAME_DIRECTION)
    return all(freedom in held for freedom in needed)


def _is_free(structure: StructureParts, member: str, node: str) -> bool:
    """Whether a spherical joint lets a member turn at its end."""
    return any(
        joint.member == member and joint.type == "spherical" for joint in structure.joints_at.get(node, ())
    )


def _meets_others(structure: StructureParts, member: str, node: str) -> bool:
    """Whether another member is fixed to a node."""
    return any(
        name != member and not _is_free(structure, name, node) for name in structure.members_at.get(node, ())
    )
