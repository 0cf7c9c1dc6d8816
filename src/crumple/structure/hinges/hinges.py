"""Where the hinges of a structure are and what each can carry.

A hinge at a node that is held against its rotation lies half a fold length inside the member: a fold needs
room, and a clamp gives none.  Between the equal bars of a member lies one hinge each.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal

import numpy as np

from crumple import hinge
from crumple.errors import InputError, Problem
from crumple.hinge import Form, HingeLaw, HingeRecord, SofteningVariable, SpatialHingeRecord, Stop
from crumple.hinge.registry import BENDING, DEFAULT_BENDING
from crumple.material import Material
from crumple.numeric.arrays import Floats
from crumple.section import Axis, Section, half_fold_length
from crumple.structure.bending import bending_axis
from crumple.structure.hinges.automatic import hinges_of, where_automatic
from crumple.structure.hinges.spatial_hinges import spatial_hinge_record
from crumple.structure.keys.hinge_axes import HingeAxes
from crumple.structure.keys.law import LawKeys, LawReference, Stops
from crumple.structure.keys.member import Hinge
from crumple.structure.keys.motion import FREEDOMS
from crumple.structure.parts import StructureParts
from crumple.structure.remembered import remembered

PLAIN = HingeAxes()
"""A hinge that bends about one axis, the one across the plane of bending."""
MADE = 1024
"""Laws, and records, that a process keeps: far more than any structure has."""
NEARER = np.sqrt(0.5)
"""Cosine of 45 degrees: of two axes across a member the nearer one is within it."""
SAME_DIRECTION = 1e-9
"""Component of a unit vector below which it does not point along an axis."""


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
        All that the input says of its axes.
    """

    name: str
    member: str
    station: float
    axis: Axis
    law: LawReference | None
    where: str
    keys: HingeAxes = PLAIN


@dataclass(frozen=True, eq=False)
class PlacedHinge:
    """One hinge as the solvers take it.

    Attributes
    ----------
    name, member, station, axis
        As in `HingePlace`.
    position
        Where it lies at the start, global [m], shape (3,).
    direction
        Unit vector of its axis at the start, global, shape (3,); rotation is right-handed about it,
        second side relative to first.
    tributary_length
        Length of member [m] whose elastic bending it stands for.
    law
        Formula with source and range.
    record
        The law as the stepper takes it.
    spatial
        Of a hinge with several components, or one that breaks: all of them as the spatial stepper takes them;
        `axis`, `law` and `record` are then those of its first bending axis.  None for all others.
    """

    name: str
    member: str
    station: float
    axis: Axis
    position: Floats
    direction: Floats
    tributary_length: float
    law: HingeLaw
    record: HingeRecord
    spatial: SpatialHingeRecord | None = None


def hinge_places(structure: StructureParts) -> tuple[HingePlace, ...]:
    """Every hinge of a sound structure, member by member, along each member.

    The structure's members must have nodes that exist and are apart; everything else is not looked at.
    """
    return tuple(place for member in structure.members for place in member_hinge_places(structure, member))


def member_hinge_places(structure: StructureParts, member: str) -> list[HingePlace]:
    """Hinges of one member by increasing station."""
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
        offset = half_fold_length(structure.section_of(member), axis) if held else 0.0
    return offset if given.at == spec.nodes[0] else structure.frame_of(member).length - offset


def holds_rotation(structure: StructureParts, node: str, direction: Floats) -> bool:
    """Whether supports hold or drive the rotation of a node about a direction."""
    supports = [support for support in structure.supports.values() if support.node == node]
    held = {freedom for support in supports for freedom in (*support.held, *support.driven)}
    needed = (FREEDOMS[3 + i] for i in range(3) if abs(direction[i]) > SAME_DIRECTION)
    return all(freedom in held for freedom in needed)


def placed_hinges(structure: StructureParts) -> tuple[PlacedHinge, ...]:
    """Every hinge with its law, ready for a solver.

    Raises
    ------
    InputError
        With every law that does not fit its section.
    """
    by_member: dict[str, list[HingePlace]] = defaultdict(list)
    problems: list[Problem] = []
    placed: list[PlacedHinge] = []
    for place in hinge_places(structure):
        by_member[place.member].append(place)
    for member, places in by_member.items():
        length = structure.frame_of(member).length
        stations = [place.station for place in places]
        parts = structure.members[member].rigid_parts(length)
        for place, share in zip(places, tributary_lengths(stations, length, parts), strict=True):
            try:
                placed.append(_placed(structure, place, share, length if len(places) == 1 else share))
            except InputError as error:
                problems += error.problems
    if problems:
        raise InputError(problems)
    return tuple(placed)


def tributary_lengths(
    stations: list[float], length: float, rigid: tuple[tuple[float, float], ...] = ()
) -> list[float]:
    """Length of a member [m] whose elastic bending each hinge stands for.

    Parameters
    ----------
    stations
        Hinges' distances from the first node [m], increasing.
    length
        Of the member [m].
    rigid
        Stretches that do not bend [m].

    Notes
    -----
    A single hinge stands for a third of the member, since the moment falls off linearly from it (3 EI/L at
    the clamp of a cantilever loaded at its tip).  Of several each stands for the stretch that is nearest to
    it, which converges to the beam as they become many.
    """

    def flexible(a: float, b: float) -> float:
        return b - a - sum(max(min(b, end) - max(a, start), 0.0) for start, end in rigid)

    if len(stations) == 1:
        return [flexible(0.0, length) / 3.0]
    middles = [(a + b) / 2.0 for a, b in pairwise(stations)]
    ends = [0.0, *middles, length]
    return [flexible(a, b) for a, b in pairwise(ends)]


def law_spec(structure: StructureParts, place: HingePlace) -> LawKeys:
    """Law that a hinge refers to.

    Raises
    ------
    InputError
        If it names none and its section has no default.
    """
    reference = place.law
    if reference is None:
        kind = structure.section_of(place.member).kind
        if kind not in DEFAULT_BENDING:
            what, todo = f"a hinge in a {kind} needs a law", "add 'law'"
            allowed = "a name in hinge_laws, or " + ", ".join(BENDING)
            raise InputError(Problem(what, "", allowed, todo))
        reference = DEFAULT_BENDING[kind]
    if not isinstance(reference, str):
        return reference
    return structure.hinge_laws[reference] if reference in structure.hinge_laws else LawKeys(type=reference)


def law_of(structure: StructureParts, place: HingePlace) -> HingeLaw:
    """Formula of a hinge.

    Raises
    ------
    InputError
        If the law does not fit the section.
    """
    section, material = structure.section_of(place.member), structure.material_of(place.member)
    return _law(section, material, place.axis, law_spec(structure, place))


# a law is a pure function of these four: the hinges of a chain and the runs of a study share it
@remembered(MADE)
def _law(section: Section, material: Material, axis: Axis, spec: LawKeys) -> HingeLaw:
    given = {name: value for name, value in spec.own.items() if value is not None}
    options = set(hinge.law_options(spec.type))
    if "elastic_stiffness" in options and not isinstance(spec.elastic_stiffness, str):
        given["elastic_stiffness"] = spec.elastic_stiffness
    return hinge.bounded(hinge.build_law(spec.type, section, material, axis, **given), spec.bound)


def _bending(structure: StructureParts, place: HingePlace, share: float) -> tuple[HingeLaw, HingeRecord]:
    """Law and record about one axis of a hinge that stands for a length of member [m]."""
    spec = law_spec(structure, place)
    rigidity = structure.flexural_rigidity(place.member, place.axis)
    law = law_of(structure, place)
    record = _record(law, spec, rigidity)
    # the length alone differs along a chain, and only the elastic form looks at it
    by_length = spec.elastic_stiffness == "auto" and law.elastic_stiffness is None
    if record.form is Form.ELASTIC_PLASTIC and by_length:
        record = replace(record, elastic_stiffness=hinge.tributary_stiffness(rigidity, share))
    return law, record


def spatial_record_of(
    structure: StructureParts, place: HingePlace, share: float = 1.0, stretch: float = 1.0
) -> SpatialHingeRecord | None:
    """All components of a hinge, None if it bends about one axis alone.

    Parameters
    ----------
    structure, place
        The hinge.
    share, stretch
        Length of member [m] that it stands for in bending, and in twist and along.

    Raises
    ------
    InputError
        If its laws and axes do not fit the section or each other.
    """
    if place.keys.plain:
        return None

    def record_about(axis: Axis) -> HingeRecord:
        about = replace(place, axis=axis, law=place.keys.law_about(axis))
        return _bending(structure, about, share)[1]

    section, material = structure.section_of(place.member), structure.material_of(place.member)
    return spatial_hinge_record(place.keys, record_about, place.axis, section, material, stretch)


def _placed(structure: StructureParts, place: HingePlace, share: float, stretch: float) -> PlacedHinge:
    law, record = _bending(structure, place, share)
    frame = structure.frame_of(place.member)
    return PlacedHinge(
        name=place.name,
        member=place.member,
        station=place.station,
        axis=place.axis,
        position=frame.position(place.station),
        direction=_direction(structure, place),
        tributary_length=share,
        law=law,
        record=record,
        spatial=spatial_record_of(structure, place, share, stretch),
    )


def _direction(structure: StructureParts, place: HingePlace) -> Floats:
    """Axis of a hinge at the start; a round section has none of its own and takes the plane of bending's."""
    axis = structure.frame_of(place.member).axis(place.axis)
    normal = structure.bending_normal
    if normal is None or structure.section_of(place.member).kind != "circular_tube":
        return axis
    along = float(np.asarray(normal) @ axis)
    # the given axis still says about which of the two it turns, and in which sense
    return np.sign(along) * np.asarray(normal) if abs(along) > NEARER else axis


@remembered(MADE)
def _record(law: HingeLaw, spec: LawKeys, rigidity: float) -> HingeRecord:
    """Record of a law; where its stiffness is that of a length of member, the length is one metre here."""
    stiffness = spec.elastic_stiffness
    return hinge.record_of(
        law,
        form=Form(spec.form),
        elastic_stiffness=None if isinstance(stiffness, str) else stiffness,
        flexural_rigidity=rigidity,
        tributary_length=1.0,
        softening=SofteningVariable(spec.softening),
        stops=_stop(spec.stops),
        regularisation_rate=spec.regularisation.rate,
        rate=spec.rate == "on",
        viscous_damping=spec.viscous_damping,
    )


def _stop(stops: Stops | Literal["law", "none"]) -> Stop | Literal["law"] | None:
    if not isinstance(stops, Stops):
        return "law" if stops == "law" else None
    damping = np.nan if isinstance(stops.damping, str) else stops.damping
    return Stop(stops.rotation, stops.stiffness, stops.exponent, damping, stops.penetration)
