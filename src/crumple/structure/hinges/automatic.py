"""Positions of candidate hinges of `hinges: auto`: wherever a fold can form.

Bending moments are largest where something holds, joins or loads a member, and masses, supports and joints
all sit on nodes: so a candidate lies near each end of a member (`distance_of_fold`), unless nothing there
can carry a moment.  Members in line that are one tube (straight_runs) count as one: at a node between them
is a candidate only if it is a kink, or an obstacle strikes there.  Obstacles also strike members between
their nodes: a candidate lies there (struck_places) unless another is near.  Braced members carry
forces along their axis and buckle with a hinge between those at their ends: a candidate lies in their middle.
Members of metal that hardens which an impact presses along their axes (pressed) may kink: two candidates lie
between those at their ends.
Distributed inertia and long spans bend members in between: `spacing` puts further candidates there.  A
candidate that is never loaded to its capacity stays rigid, and changes nothing.

Members of a straight run between supports (held_runs), braced members (braced), and elastic members of
structures that an impact presses along members (pressed), also change their length at their hinges,
unless the input says otherwise.  Tubes of the last two kinds, and of runs of which a support drives an end,
fold by the crushing law of their section; all others yield.

A corner whose law is stored has one hinge at its node in place of the candidates in its zone, and the
branch of a T-joint one in the face on which it ends.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from crumple.section import Axis, half_fold_length
from crumple.structure.bending import bending_axis, planar
from crumple.structure.hinges.asked import FOLDS, automatic_of, folds_at_ends
from crumple.structure.hinges.corner_laws import corner_hinges, corner_zones
from crumple.structure.hinges.law_choice import UNKNOWN, Surroundings, folding_slip
from crumple.structure.hinges.lengthening.braced import braced
from crumple.structure.hinges.lengthening.held_runs import held_runs, pushed_runs
from crumple.structure.hinges.lengthening.pressed import struck_along
from crumple.structure.hinges.runs.bars import is_closed, welded_to_another
from crumple.structure.hinges.runs.candidates import Candidate, Strike, candidates_on
from crumple.structure.hinges.runs.straight_runs import straight_run
from crumple.structure.hinges.t_joints import t_joint_hinges, t_joint_zones
from crumple.structure.keys.hinge_axes import AxialSlip, HingeAxes
from crumple.structure.keys.member import AutomaticHinges, Hinge
from crumple.structure.parts import StructureParts


def hinges_of(structure: StructureParts, member: str) -> tuple[Hinge, ...]:
    """Hinges of a member besides those between its bars: given one by one, or put where folds can form."""
    asked = automatic_of(structure, member)
    if asked is None:
        given = structure.members[member].given_hinges
        return (*given, *_further(structure, member, given)) if folds_at_ends(structure, member) else given
    keys, axes = _keys(structure, member, asked)
    stations = automatic_stations(structure, member, axes, asked.spacing)
    parts = structure.members[member].rigid_parts(structure.frame_of(member).length)
    parts = (*parts, *corner_zones(structure, member), *t_joint_zones(structure, member))
    stations = {name: at for name, at in stations.items() if not any(a <= at <= b for a, b in parts)}
    # names of members and nodes were checked; two of them together may be longer than a name that is given
    found = [Hinge.model_construct(name=name, at=station, **keys) for name, station in stations.items()]
    found += [*corner_hinges(structure, member, keys), *t_joint_hinges(structure, member, keys)]
    return tuple(sorted(found, key=lambda hinge: float(hinge.at)))


def _further(structure: StructureParts, member: str, given: tuple[Hinge, ...]) -> list[Hinge]:
    """Candidates of an elastic member besides its list of hinges, where none of these is near.

    A hinge within one fold, two half lengths, of a candidate's place stands for the fold there.  A member
    that shortens at a hinge of its list also shortens wherever else it folds: bending takes away the peak of
    the axial force.
    """
    keys, axes = _keys(structure, member, FOLDS)
    keys["axial"] = next((hinge.axial for hinge in given if hinge.axial is not None), keys["axial"])
    length, section = structure.frame_of(member).length, structure.section_of(member)
    fold = 2.0 * max(half_fold_length(section, axis) for axis in axes)
    own = [_about_at(structure, member, hinge) for hinge in given]
    taken = {hinge.name for hinge in given}
    parts = structure.members[member].rigid_parts(length)
    return [
        Hinge.model_construct(name=f"{name}-fold" if name in taken else name, at=at, **keys)
        for name, at in automatic_stations(structure, member, axes, None).items()
        if not any(a <= at <= b for a, b in parts) and not any(abs(at - place) <= fold for place in own)
    ]


def _about_at(structure: StructureParts, member: str, hinge: Hinge) -> float:
    """Distance of a given hinge from the member's first node [m], but for `fold_distance` at a clamp."""
    offset = hinge.offset or 0.0
    if not isinstance(hinge.at, str):
        return hinge.at + offset
    return (
        offset
        if hinge.at == structure.members[member].nodes[0]
        else structure.frame_of(member).length - offset
    )


def _keys(
    structure: StructureParts, member: str, asked: AutomaticHinges
) -> tuple[dict[str, Any], tuple[Axis, ...]]:
    """Keys of a member's candidates, and their bending axes."""
    keys = {name: getattr(asked, name) for name in HingeAxes.model_fields}
    if asked.axis is None and asked.axes is None:
        flat = planar(structure)
        keys |= (
            {"axis": bending_axis(structure, member)}
            if flat
            else {"axes": ("y", "z", "x") if twists(structure, member) else ("y", "z")}
        )
    elif asked.axes and "x" not in asked.axes and _twists_besides(structure, member, asked):
        keys["axes"] = (*asked.axes, "x")
    if lengthens(structure, member):
        keys["axial"] = _slip(structure, member)
    axes = (keys["axis"],) if keys["axis"] else tuple(axis for axis in keys["axes"] if axis != "x")
    return keys, axes


def _slip(structure: StructureParts, member: str) -> AxialSlip:
    """How a member that lengthens unasked shortens: compressed tubes fold, as columns, others yield.

    Held runs that nothing drives mostly stretch, and yield.  A stored law of folding is used in any case.
    """
    pressed = braced(structure) | pushed_runs(structure)
    folds = struck_along(structure, member) or member in pressed
    return folding_slip(structure, member) if folds else AxialSlip()


def lengthens(structure: StructureParts, member: str) -> bool:
    """Whether the automatic hinges of a member lengthen although the input does not say so."""
    asked = automatic_of(structure, member)
    unsaid = asked is not None and "axial" not in asked.model_fields_set
    if not unsaid:
        return False
    if struck_along(structure, member):
        return True
    return member in held_runs(structure) or member in braced(structure)


def twists(structure: StructureParts, member: str) -> bool:
    """Whether the automatic hinges of a member in space twist besides bending about both axes.

    A closed section mostly yields in torsion before it bends about its strong axis.  An open one twists all
    along its member: elastic members have a joint for this, rigid ones their hinges.
    """
    closed = is_closed(structure.section_of(member))
    return closed or not (structure.members[member].elastic or welded_to_another(structure, member))


def _twists_besides(structure: StructureParts, member: str, asked: AutomaticHinges) -> bool:
    """Whether a member twists although its folds were asked for about bending axes alone.

    A fold about its tension flange has no twist.
    """
    elastic = bool(structure.members[member].elastic)
    return elastic and asked.coupling != "tension-flange" and twists(structure, member)


def automatic_stations(
    structure: StructureParts, member: str, axes: tuple[Axis, ...], spacing: float | None
) -> dict[str, float]:
    """Distances of a member's candidates from its first node [m], increasing, by name.

    Parameters
    ----------
    structure, member
        The member must have nodes that exist and are apart.
    axes
        Bending axes of the candidates: the longest of their folds counts.
    spacing
        Largest distance between candidates [m]; None: only at the ends, in the middle of braced members, and
        where obstacles strike.
    """
    run = straight_run(structure, member)
    found = candidates_on(structure, run, axes, spacing).get(member, [])
    own = {one.name: one.station for one in found}
    return dict(sorted(own.items(), key=lambda item: item[1]))


def strikes_on(structure: StructureParts, member: str) -> Mapping[str, Strike]:
    """What strikes a member's straight run at its candidates, by their names."""
    found = _candidates(structure, member) if structure.obstacles else []
    return {one.name: one.strike for one in found if one.strike is not None}


def near_fold(structure: StructureParts, member: str, hinge: str) -> Surroundings:
    """What lies beside a hinge if it is a candidate: that decides its law."""
    return next((one.near for one in _candidates(structure, member) if one.name == hinge), UNKNOWN)


def _candidates(structure: StructureParts, member: str) -> list[Candidate]:
    """Candidates on a member, if its hinges are automatic."""

    def find() -> list[Candidate]:
        asked = automatic_of(structure, member)
        if asked is None:
            return []
        run, (_, axes) = straight_run(structure, member), _keys(structure, member, asked)
        return candidates_on(structure, run, axes, asked.spacing).get(member, [])

    return structure.kept.once("candidates", member, find)
