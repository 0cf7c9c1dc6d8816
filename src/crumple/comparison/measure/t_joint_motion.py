"""Rotation of a hinge at a T-joint: of the branch relative to the chord on both sides of it.

The face of the chord folds, in which no section of a member rotates: the sections are those of the branch one
side beyond the face, and of the chord one side beyond the branch's outline.  About the chord's own axis its
sections show no rotation: the chord's twist is part of the joint's rotation there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from crumple.comparison.measure.fold_moment import ELASTIC_WORK, Bent, moment_in
from crumple.comparison.measure.folds import OPENED, plastic_amount
from crumple.comparison.measure.motion import HingeMotion, Measured, bends_two_ways, rate_of
from crumple.numeric.arrays import Floats
from crumple.result import Result
from crumple.section import AXES, Axis
from crumple.structure import PlacedHinge, Structure
from crumple.structure.hinges.t_joints import TPlace, t_joint_name, t_laws


def with_t_joints(
    seen: Measured, result: Result, structure: Structure, hinges: Sequence[PlacedHinge]
) -> Measured:
    """The same with the hinges at T-joints measured between branch and chord.

    Parameters
    ----------
    seen
        Measured in shapes, member by member.
    result
        With these shapes.
    structure, hinges
        Hinges at T-joints are known by the structure's stored laws.
    """
    joints = {t_joint_name(node): joint for node, (joint, _) in t_laws(structure).items()}
    placed = {hinge.name: hinge for hinge in hinges}
    found, rest = [], list(seen.extra)
    for motion in seen.hinges:
        joint = joints.get(motion.name)
        if joint is None or not {joint.branch, joint.before, joint.after} <= set(seen.sections):
            found.append(motion)
            continue
        found.append(_measured(seen, result, structure, joint, motion, placed[motion.name]))
        rest = [fold for fold in rest if not _inside(structure, joint, fold)]
    return replace(seen, hinges=tuple(found), extra=tuple(rest))


def _reach(structure: Structure, joint: TPlace, member: str) -> float:
    """Distance from the node up to which the joint reaches along a member [m]: a side beyond the other's."""
    if member == joint.branch:
        return joint.face + max(joint.section.width, joint.section.depth)
    return joint.section.width / 2.0 + max(joint.chord.width, joint.chord.depth)


def _away(structure: Structure, joint: TPlace, member: str, station: float) -> float:
    """Distance of a station from the node [m]."""
    starts = structure.members[member].nodes[0] == joint.node
    return station if starts else structure.frame_of(member).length - station


def _inside(structure: Structure, joint: TPlace, fold: HingeMotion) -> bool:
    if fold.member not in (joint.branch, joint.before, joint.after):
        return False
    return _away(structure, joint, fold.member, fold.station) <= _reach(structure, joint, fold.member)


def _measured(
    seen: Measured,
    result: Result,
    structure: Structure,
    joint: TPlace,
    motion: HingeMotion,
    hinge: PlacedHinge,
) -> HingeMotion:
    starts = structure.members[joint.branch].nodes[0] == joint.node
    turns = {axis: _rotation(seen, structure, joint, axis) * (1.0 if starts else -1.0) for axis in AXES}
    axis = None if bends_two_ways(hinge) else hinge.axis
    rotation = np.hypot(*turns.values()) if axis is None else turns[axis]
    work = _work(seen, result, structure, joint)
    stiffness = _stiffness(structure, joint, hinge)
    moment, origin = moment_in(result, hinge.name, Bent(motion.time, rotation, work, stiffness, axis=axis))
    yielded = work >= ELASTIC_WORK * max(float(work.max(initial=0.0)), 1e-300)
    return replace(
        motion,
        rotation=rotation,
        rotation_rate=rate_of(rotation, motion.time),
        plastic_rotation=np.where(yielded, rotation - moment / stiffness, 0.0),
        moment=moment,
        plastic_work=work,
        how=f"Between the sections of {joint.branch} one side beyond the face, and of {joint.before} and "
        f"{joint.after} one side beyond the outline of the joint; {origin}.",
        extent=None,
        planes=None,
        crushed=0.0,
        fold=bool(np.abs(rotation).max(initial=0.0) > OPENED and work.any()),
    )


def _rotation(seen: Measured, structure: Structure, joint: TPlace, axis: Axis) -> Floats:
    """Rotation of the branch relative to the chord about an axis of the branch's section [rad]."""
    direction = structure.frame_of(joint.branch).axis(axis)
    members = [joint.branch]
    if joint.plane(axis) == "in":
        members += [joint.before, joint.after]
    turns = []
    for member in members:
        own, reach = seen.sections[member], _reach(structure, joint, member)
        starts = structure.members[member].nodes[0] == joint.node
        ring = own.nearest(reach if starts else structure.frame_of(member).length - reach)
        turns.append(own.rotation(direction)[:, ring])
    return turns[0] - (np.mean(turns[1:], axis=0) if turns[1:] else 0.0)


def _work(seen: Measured, result: Result, structure: Structure, joint: TPlace) -> Floats:
    """Energy dissipated in the joint [J] at the times of the shapes."""
    states = result.states
    if states is None or "energy.dissipated" not in result.channels:
        return np.zeros(0 if states is None else len(states.times))
    inside, total = np.zeros(len(states.times)), np.zeros(len(states.times))
    for member, own in seen.sections.items():
        amount = plastic_amount(states, own)
        total += amount.sum(axis=1)
        if member in (joint.branch, joint.before, joint.after):
            middles = (own.stations[1:] + own.stations[:-1]) / 2.0
            away = [_away(structure, joint, member, float(station)) for station in middles]
            inside += amount[:, np.array(away) <= _reach(structure, joint, member)].sum(axis=1)
    dissipated = np.interp(states.times, result.time, result["energy.dissipated"])
    share = inside / np.where(total > 0.0, total, np.inf)
    return np.asarray(np.maximum.accumulate(share * dissipated))


def _stiffness(structure: Structure, joint: TPlace, hinge: PlacedHinge) -> float:
    """Elastic stiffness of the branch between the sections, and of the joint's own walls [N m/rad]."""
    modulus = structure.material_of(joint.branch).youngs_modulus
    section = structure.section_of(joint.branch)
    length = max(joint.section.width, joint.section.depth)
    soft = length / (modulus * min(section.second_moment(axis) for axis in AXES))
    own = hinge.law.elastic_stiffness
    return 1.0 / (soft + (0.0 if own is None else 1.0 / own))
