"""Bars: what bends as one between joints, an elastic straight run or a member alone."""

from __future__ import annotations

from crumple.section import Section
from crumple.structure.hinges.joint_reach import unbent_parts
from crumple.structure.hinges.runs.straight_runs import StraightRun, Stretch, straight_run
from crumple.structure.parts import StructureParts

ALIKE = 0.9
"""Cosine between section axes of one name in two members from which these are the same axes: else a square
section lies a quarter turn further, or a round one anyhow."""


def bar_of(structure: StructureParts, member: str) -> StraightRun:
    """The bar that a member is part of; often its only member.

    Elastic members of a straight run whose sections have the same axes bend as one: nothing happens at the
    nodes between them, so that moments are linear along all of them, and neither a node nor which member a
    hinge at it belongs to may change how they bend.  Stiffness of rigid members is not used.
    """
    return structure.kept.once("bar", member, lambda: _bar(structure, member))


def _bar(structure: StructureParts, member: str) -> StraightRun:
    spec, frame = structure.members[member], structure.frame_of(member)
    if spec.elastic:
        run = straight_run(structure, member)
        if all(abs(float(structure.frame_of(name).y @ frame.y)) > ALIKE for name in run.stretches):
            return run
    alone = Stretch(0.0, frame.length, forward=True)
    return StraightRun({member: alone}, spec.nodes, {}, member, frame.length)


def rigid_along(structure: StructureParts, bar: StraightRun) -> tuple[tuple[float, float], ...]:
    """Stretches of a bar that do not deform [m], increasing: rigid parts, and what lies in rigid joints."""
    if not bar.between:
        return unbent_parts(structure, bar.first)
    found: list[tuple[float, float]] = []
    for name, stretch in bar.stretches.items():
        for part in unbent_parts(structure, name):
            first, second = sorted(stretch.along(at) for at in part)
            found.append((first, second))
    return tuple(sorted(found))


def welded_to_another(structure: StructureParts, member: str) -> bool:
    """Whether spot welds join a member to another one: both together may be closed where each is open."""
    welded = (welds.members for welds in structure.spot_welds.values())
    return any(member in members for members in welded if len(members) > 1)


def is_closed(section: Section) -> bool:
    """Whether the walls of a section have a cell."""
    from crumple.section.wall_section import walls_of  # noqa: PLC0415  (only structures in space need walls)

    return bool(walls_of(section).skeleton.cells)
