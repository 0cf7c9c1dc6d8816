"""Members whose length must change, found by the forces of a run.

A hinge that only turns carries any force along its member.  Where the largest compression in a run exceeds
what folds the walls, or the largest tension the squash force, the member would fold, kink as a strut, or
yield; the forces are those that the kernel follows without vibration that it does not resolve.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from crumple.hinge import Freedom
from crumple.multibody.answer.poses import SpatialPoses
from crumple.multibody.answer.solved import Solved
from crumple.multibody.checks.crushing import folding
from crumple.multibody.checks.names import named
from crumple.multibody.run import Run
from crumple.result import Result
from crumple.structure import PlacedHinge, Structure
from crumple.structure.checks.doubtful import double_members
from crumple.structure.hinges.asked import automatic_of
from crumple.structure.hinges.lengthening.found import lengthening_members
from crumple.structure.hinges.runs.straight_runs import straight_run
from crumple.structure.hinges.spatial_hinges import interaction_of
from crumple.structure.keys.member import AutomaticHinges
from crumple.units import format_quantity


def members_to_lengthen(structure: Structure, solved: Solved) -> frozenset[str]:
    """Elastic members with candidates of fixed length, and forces along them beyond what their walls carry.

    Members in line that are one tube are found together.  Those of which the input says how their hinges
    change their length are left as they are, and so are two in one place, whose forces are not unique.
    """
    poses = solved.poses
    if not isinstance(poses, SpatialPoses):
        return frozenset()
    hinges, found = poses.linkage.hinges, set[str]()
    kept = double_members(structure) | _changing(structure, hinges)
    # behind them are the hinges of crushed walls
    for hinge, (pressed, pulled) in zip(hinges, poses.record.axial_most[: len(hinges)].tolist(), strict=True):
        member, asked = hinge.member, automatic_of(structure, hinge.member)
        given = asked is None or asked.axial is not None or "axial" in asked.model_fields_set
        if given or member in kept or member in found or not structure.members[member].elastic:
            continue
        squash = interaction_of(structure.section_of(member), structure.material_of(member)).squash_force
        if pressed > folding(structure, member)[1] or pulled > squash:
            found |= set(straight_run(structure, member).stretches)
    return frozenset(found)


def _changing(structure: Structure, hinges: Iterable[PlacedHinge]) -> set[str]:
    """Members that change their length, at a hinge of any member in line with them."""
    slipping = {
        hinge.member
        for hinge in hinges
        if hinge.spatial is not None and Freedom.AXIAL in hinge.spatial.freedoms
    }
    return {name for member in slipping for name in straight_run(structure, member).stretches}


def with_lengthening_told(result: Result, run: Run, given: Structure, solved: Structure) -> Result:
    """A result that names the members of the input whose length the run has shown to change.

    `solved`: the structure with these members as they are solved.
    """
    noted = lengthening_members(given, run.settings, run.time_in_motion)
    members = [name for name in given.members if name in noted]
    if not members:
        return result
    one, keys = len(members) == 1, automatic_of(solved, members[0]) or AutomaticHinges()
    law = f"{{law: {keys.axial.law}}}" if keys.axial is not None and keys.axial.law else "true"
    text = (
        f"{named('Member', members)} {'carries' if one else 'carry'} more along "
        f"{'its axis' if one else 'their axes'} than folds or yields the walls if "
        f"{'its length stays' if one else 'their lengths stay'}: solved again with hinges there that change "
        f"{'it' if one else 'them'}, and a candidate between the ends, as with members.{members[0]}.hinges: "
        f"{{axial: {law}, spacing: {format_quantity(keys.spacing or 0.0, 'm', 3)}}}."
    )
    return replace(result, warnings=(*result.warnings, text))
