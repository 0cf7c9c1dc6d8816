"""Mistakes of hinges: places outside the member or taken, names taken, laws that do not fit, free ends."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import pairwise

from crumple.errors import InputError, Problem
from crumple.structure.hinges import HingePlace, holds_rotation, law_of, member_hinge_places
from crumple.structure.law import LAW_SPECS
from crumple.structure.problems import outside
from crumple.structure.structure import Structure

APART = 1e-6
"""Distance of two hinges, as a share of the member, below which the bar between has next to no inertia."""


def place_problems(structure: Structure, known: Mapping[str, set[str]]) -> Iterator[Problem]:
    """Places, names and laws of hinges."""
    places = _places(structure)
    where = {place.name: place.where for place in places}
    for name, times in Counter(place.name for place in places).items():
        if times > 1:
            what = f"{times} hinges have the name '{name}'"
            yield Problem(what, name, "a name of its own", "rename all but one", f"{where[name]}.name")
    seen: set[tuple[str, str]] = set()
    for place in places:
        length = structure.frame_of(place.member).length
        if not -APART * length <= place.station <= length * (1.0 + APART):
            yield outside(f"{place.where}.at", place.station, length)
        # one message for the many hinges between equal bars
        if (place.where, place.axis) not in seen:
            seen.add((place.where, place.axis))
            yield from _law_problems(structure, place)
    for first, second in pairwise(places):
        apart = APART * structure.frame_of(first.member).length
        if first.member == second.member and second.station - first.station < apart:
            what = f"the hinges '{first.name}' and '{second.name}' lie at one place: no inertia lies between"
            yield Problem(what, where=second.where, todo="move one of them")


def inertia_problems(structure: Structure, known: Mapping[str, set[str]]) -> Iterator[Problem]:
    """Hinges at a free end, beyond which there is nothing to turn."""
    joined = Counter(node for member in structure.members.values() for node in member.nodes)
    turning = {m.node for m in structure.masses.values() if any(m.rotary_inertia) or any(m.offset)}
    for place in _places(structure):
        frame = structure.frame_of(place.member)
        ends = zip(structure.members[place.member].nodes, (0.0, frame.length), strict=True)
        for node, station in ends:
            at_end = abs(place.station - station) < APART * frame.length
            free = joined[node] == 1 and node not in turning
            if at_end and free and not holds_rotation(structure, node, frame.axis(place.axis)):
                what = f"zero inertia beyond the hinge '{place.name}': nothing else is joined to '{node}'"
                todo = "move the hinge into the member, or remove it"
                yield Problem(what, where=f"{place.where}.at", todo=todo)


def _places(structure: Structure) -> list[HingePlace]:
    """Places of hinges in members whose nodes, section and material are there."""
    return [
        place
        for name, member in structure.members.items()
        if structure.has_line(name)
        and member.section in structure.sections
        and member.material in structure.materials
        and all(hinge.at in member.nodes for hinge in member.hinges if isinstance(hinge.at, str))
        for place in member_hinge_places(structure, name)
    ]


def _law_problems(structure: Structure, place: HingePlace) -> Iterator[Problem]:
    """Why a law does not fit the section of its hinge; an unknown name is another check's."""
    if isinstance(place.law, str) and place.law not in {*structure.hinge_laws, *LAW_SPECS}:
        return
    try:
        law_of(structure, place)
    except InputError as error:
        for problem in error.problems:
            key = f"{problem.where}: " if problem.where else ""
            yield Problem(
                key + problem.what, problem.came, problem.allowed, problem.todo, f"{place.where}.law"
            )
