"""Sub-models that a structure needs: each distinct section, material and load, and each joint."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from crumple.characterisation.bending import Bending
from crumple.characterisation.crush import Crush
from crumple.characterisation.out_of_plane import OutOfPlane, usual_resolution
from crumple.characterisation.rate import FASTER, rate_pair
from crumple.characterisation.resolution import SCALED_STEP
from crumple.characterisation.solving import FINER
from crumple.characterisation.sub_model import SubModel, is_mirrored
from crumple.characterisation.t_joint import TJoint
from crumple.characterisation.torsion import Torsion
from crumple.hinge.measured.place_hash import DIRECTIONS
from crumple.section import AXES, Axis
from crumple.structure import Structure, hinge_places, planar
from crumple.structure.bending import bending_axis
from crumple.structure.hinges.corner_laws import corner_name
from crumple.structure.hinges.corners import corners, untreated
from crumple.structure.hinges.places import has_clamped_law, member_hinge_places
from crumple.structure.hinges.runs.bars import is_closed
from crumple.structure.hinges.shares import about_axis
from crumple.structure.hinges.stored_loads import stored_loads
from crumple.structure.hinges.t_joints import t_places

PER_ELEMENT_STEP = 1.2e-7
"""Processor time of one element in one step [s]: 74 s for both senses of a corner of 4600 elements."""


@dataclass(frozen=True)
class Needed:
    """A place of a structure and its sub-model.

    Attributes
    ----------
    model
        What is solved.
    place
        Hash of the place.
    where
        Members, or nodes of corners and T-joints, that have it.
    """

    model: SubModel
    place: str
    where: tuple[str, ...]

    def seconds(self, *, converge: bool = False) -> float:
        """Estimated processor time [s]; sub-models that are solved again more slowly take longer.

        Elements times steps, both from the element size: a mesh r times finer takes r^3 as long.
        """
        model = self.model
        elements = model.section.area / model.section.thickness * model.length / model.size**2
        speed = math.sqrt(model.material.youngs_modulus / model.material.density)
        once = PER_ELEMENT_STEP * elements * model.duration * speed / (SCALED_STEP * model.size)
        runs = (1.0 if model.one_law else 2.0) + (sum(ratio**3 for ratio in FINER) if converge else 0.0)
        # at rest, with rate, and with rate three times as fast
        rate = 0.0 if rate_pair(model.material) is None or model.load == "crush" else 1.0 + 1.0 / FASTER
        return once * (runs + rate)


def needed(structure: Structure, largest: float) -> tuple[Needed, ...]:
    """Sub-models of a structure's members, corners and T-joints, each once.

    Parameters
    ----------
    structure
        Members that are rigid as a whole need none.
    largest
        Plastic rotation at which the laws end [rad].
    """
    found: dict[str, Needed] = {}

    def add(model: SubModel, where: str) -> None:
        place = model.place
        known = found[place].where if place in found else ()
        # a square tube bends about both axes in the same way
        if where not in known:
            found[place] = Needed(model, place, (*known, where))

    placed = dict.fromkeys(place.member for place in hinge_places(structure))
    for name in placed or structure.members:
        section, material = structure.section_of(name), structure.material_of(name)
        axes: tuple[Axis, ...] = (bending_axis(structure, name),) if planar(structure) else ("y", "z")
        for axis in axes:
            if not _beside_clamps(structure, name, axis):
                add(Bending(section, material, axis, largest=largest), name)
        if not planar(structure) and is_closed(section):
            add(Torsion(section, material, largest=largest), name)
        if any("crush" in stored_loads(place) for place in member_hinge_places(structure, name)):
            add(Crush(section, material), name)
    for node, corner in corners(structure).items():
        section, material = structure.section_of(corner.first), structure.material_of(corner.first)
        add(Bending(section, material, corner.axis, angle=corner.turn, largest=largest), node)
        # those of turned sections have no sub-model out of their plane
        if not planar(structure) and not corner.turned and is_mirrored(section, corner.across):
            for about in DIRECTIONS:
                place = section, material, corner.axis, corner.angle, about, largest
                add(OutOfPlane(*place, resolution=usual_resolution(section, about)), node)
    for node, joint in t_places(structure).items():
        axes = (bending_axis(structure, joint.branch),) if planar(structure) else AXES
        for plane in (joint.plane(axis) for axis in axes):
            add(TJoint(joint.section, joint.chord, structure.material_of(joint.branch), plane, largest), node)
    return tuple(found.values())


def _beside_clamps(structure: Structure, member: str, axis: Axis) -> bool:
    """Whether all hinges in a member itself have the law of tubes beside a clamp about an axis."""
    joints = {corner_name(node) for node in corners(structure)}
    places = [place for place in member_hinge_places(structure, member) if place.name not in joints]
    return bool(places) and all(has_clamped_law(structure, about_axis(place, axis)) for place in places)


def is_joint(model: SubModel) -> bool:
    """Whether a sub-model is a corner or a T-joint, not a straight member."""
    return isinstance(model, (OutOfPlane, TJoint)) or (isinstance(model, Bending) and model.angle is not None)


def left_out(structure: Structure) -> Mapping[str, str]:
    """Nodes at which members meet at an angle that have no sub-model, and why."""
    welded = t_places(structure)
    return {node: reason for node, reason in untreated(structure).items() if node not in welded}
