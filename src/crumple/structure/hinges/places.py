"""Where the hinges of a structure are, and which law each has.

A hinge at a node that is held against its rotation lies inside the member (`fold_distance`): a fold needs
room, and a clamp gives none.  Between the equal bars of a member lies one hinge each.
"""

from __future__ import annotations

from dataclasses import dataclass

from crumple.hinge import HingeLaw
from crumple.section import Axis, fold_distance
from crumple.structure.bending import bending_axis
from crumple.structure.hinges.asked import where_automatic
from crumple.structure.hinges.automatic import hinges_of, near_fold
from crumple.structure.hinges.law_choice import (
    CLAMPED,
    Surroundings,
    automatic_law,
    chosen_law,
    made_law,
    plain_law,
)
from crumple.structure.hinges.runs.ends import holds_rotation
from crumple.structure.hinges.struck_folds import with_dent
from crumple.structure.keys.hinge_axes import HingeAxes
from crumple.structure.keys.law import LawKeys, LawReference
from crumple.structure.keys.member import Hinge
from crumple.structure.parts import StructureParts
from crumple.structure.remembered import remembered

PLAIN = HingeAxes()
"""A hinge that bends about one axis, the one across the plane of bending."""
MADE = 1024
"""Laws, and records, that a process keeps: far more than any structure has."""


@dataclass(frozen=True)
class HingePlace:
    """One hinge before its law is built.

    Attributes
    ----------
    name
        Unique in the structure.
    member
        Member that it belongs to; the first side of the hinge is that of the member's first node.
    station
        Distance from the member's first node [m].
    axis
        Section axis of its moment vector.
    law
        Reference as the input gives it.
    where
        Path in the input, for messages.
    keys
        Keys of the input for its components and axes.
    """

    name: str
    member: str
    station: float
    axis: Axis
    law: LawReference | None
    where: str
    keys: HingeAxes = PLAIN


def hinge_places(structure: StructureParts) -> tuple[HingePlace, ...]:
    """Every hinge of a sound structure, member by member, along each member.

    The structure's members must have nodes that exist and are apart; nothing else is checked.
    """
    return tuple(place for member in structure.members for place in member_hinge_places(structure, member))


def member_hinge_places(structure: StructureParts, member: str) -> list[HingePlace]:
    """Hinges of one member by increasing station."""
    return structure.kept.once("hinges", member, lambda: _hinge_places(structure, member))


def _hinge_places(structure: StructureParts, member: str) -> list[HingePlace]:
    spec, length = structure.members[member], structure.frame_of(member).length
    bars, where, axis = spec.bars, f"members.{member}", bending_axis(structure, member)
    places = [
        _place(f"{member}-{i}", member, length * i / bars.number, bars, f"{where}.bars", axis)
        for i in range(1, bars.number)
    ]
    automatic = where_automatic(structure, member)
    for i, given in enumerate(hinges_of(structure, member)):
        station = hinge_station(structure, member, given)
        places.append(_place(given.name, member, station, given, automatic or f"{where}.hinges[{i}]", axis))
    return sorted(places, key=lambda place: place.station)


def _place(name: str, member: str, station: float, keys: HingeAxes, where: str, axis: Axis) -> HingePlace:
    first = first_axis(keys) or axis
    return HingePlace(name, member, station, first, keys.law_about(first), where, keys)


def first_axis(keys: HingeAxes) -> Axis | None:
    """Bending axis that a hinge names, the first of several."""
    return keys.bending[0] if keys.bending else keys.axis


def hinge_station(structure: StructureParts, member: str, given: Hinge) -> float:
    """Distance of a hinge from the member's first node [m]; may lie outside the member."""
    spec = structure.members[member]
    if not isinstance(given.at, str):
        return given.at + (given.offset or 0.0)
    offset = given.offset
    if offset is None:
        axis = first_axis(given) or bending_axis(structure, member)
        held = holds_rotation(structure, given.at, structure.frame_of(member).axis(axis))
        offset = fold_distance(structure.section_of(member), axis) if held else 0.0
    return offset if given.at == spec.nodes[0] else structure.frame_of(member).length - offset


def law_spec(structure: StructureParts, place: HingePlace) -> LawKeys:
    """Law that a hinge refers to: the one it names, else a stored one, a formula, or an estimate.

    A rigid hinge of an elastic member becomes an elastic one.
    """
    spec = _law_spec(structure, place)
    if structure.members[place.member].elastic and spec.form == "set-valued":
        return _elastic(spec)
    return spec


# the same for every hinge of a chain
@remembered(MADE)
def _elastic(spec: LawKeys) -> LawKeys:
    return spec.model_copy(update={"form": "elastic-plastic"})


def _law_spec(structure: StructureParts, place: HingePlace) -> LawKeys:
    asked = automatic_law(structure, place.law)
    if asked is not None:
        near = near_fold(structure, place.member, place.name)
        return chosen_law(structure, place.member, place.axis, asked, near)
    assert place.law is not None
    if not isinstance(place.law, str):
        return place.law
    named = structure.hinge_laws.get(place.law)
    return plain_law(place.law) if named is None else named


def has_clamped_law(structure: StructureParts, place: HingePlace) -> bool:
    """Whether the law of a hinge is that of tubes beside a clamp or joint, which no stored one replaces."""
    asked = automatic_law(structure, place.law)
    if asked is None:
        return False
    near = near_fold(structure, place.member, place.name)
    return chosen_law(structure, place.member, place.axis, asked, near).type == CLAMPED


def law_of(structure: StructureParts, place: HingePlace) -> HingeLaw:
    """Formula of a hinge.

    Raises
    ------
    InputError
        If the law does not fit the section.
    """

    def build() -> HingeLaw:
        section, material = structure.section_of(place.member), structure.material_of(place.member)
        return made_law(section, material, place.axis, law_spec(structure, place))

    alike = alike_law(structure, place)
    law = build() if alike is None else structure.kept.once("law", alike, build)
    return with_dent(structure, place.member, place.name, place.axis, place.law, law)


def alike_law(
    structure: StructureParts, place: HingePlace
) -> tuple[str, str, Axis, str, Surroundings] | None:
    """What all hinges with the same law have in common: section, material, axis, its name, what is beside.

    None without a name.
    """
    spec = structure.members[place.member]
    if not isinstance(place.law, str):
        return None
    near = near_fold(structure, place.member, place.name)
    return (spec.section, spec.material, place.axis, place.law, near)
