"""Checks of hinges: positions outside the member, equal positions or names, unsuitable laws, free ends."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from itertools import pairwise, product

from crumple.errors import InputError, Problem
from crumple.hinge.record.sampling import TOO_STEEP
from crumple.hinge.registry import BENDING
from crumple.structure.hinges.automatic import near_fold
from crumple.structure.hinges.hinges import spatial_record_of, too_thin
from crumple.structure.hinges.law_choice import Surroundings
from crumple.structure.hinges.places import HingePlace, alike_law, law_of, member_hinge_places
from crumple.structure.hinges.runs.ends import holds_rotation
from crumple.structure.keys.member import AutomaticHinges, Hinge
from crumple.structure.parts import StructureParts
from crumple.structure.schema.problems import Names, outside

APART = 1e-6
"""Distance of two hinges, as a share of the member, below which the bar between has negligible inertia."""


def place_problems(structure: StructureParts, known: Mapping[str, Names]) -> Iterator[Problem]:
    """Places, names and laws of hinges."""
    where: dict[str, list[str]] = defaultdict(list)
    sound: set[tuple[str, str, str, str, Surroundings]] = set()
    reported: set[Problem | tuple[str, str]] = set()
    bounded = _asks_bound(structure)
    for name in sound_members(structure):
        places, length = member_hinge_places(structure, name), structure.frame_of(name).length
        for place in places:
            where[place.name].append(place.where)
            if not -APART * length <= place.station <= length * (1.0 + APART):
                yield _outside(place, length)
        # one message for the many hinges between equal bars, and for those that one `auto` puts into many
        # members
        kinds: dict[tuple[str | None, ...], HingePlace] = {(p.where, p.axis): p for p in places}
        if bounded:
            # what lies beside an automatic hinge decides its law, and whether that has a band
            kinds = {(p.where, p.axis, near_fold(structure, name, p.name).fold): p for p in places}
        for place in kinds.values():
            alike = alike_law(structure, place) if place.keys.plain else None
            if alike in sound:
                continue
            found = list(_law_problems(structure, place, known["hinge_laws"]))
            if alike is not None and not found:
                sound.add(alike)
            yield from (problem for problem in found if _alike(problem) not in reported)
            reported.update(_alike(problem) for problem in found)
        for first, second in pairwise(places):
            if second.station - first.station < APART * length:
                what = f"the hinges '{first.name}' and '{second.name}' are at the same position"
                yield Problem(what, where=second.where, todo="move one of them: no inertia lies between")
    for name, named in where.items():
        if len(named) > 1:
            what, todo = f"{len(named)} hinges have the name '{name}'", "rename all but one"
            yield Problem(what, name, "a name of its own", todo, f"{named[-1]}.name")


def _outside(place: HingePlace, length: float) -> Problem:
    """A hinge outside its member of a length [m]: by its offset, if this begins at a place that is inside."""
    keys = place.keys
    if isinstance(keys, Hinge) and keys.offset is not None:
        begin = 0.0 if isinstance(keys.at, str) else keys.at
        if 0.0 <= begin <= length:
            return outside(f"{place.where}.offset", keys.offset, length, begin)
    return outside(f"{place.where}.at", place.station, length)


def inertia_problems(structure: StructureParts, known: Mapping[str, Names]) -> Iterator[Problem]:
    """Hinges at a free end, with nothing to rotate beyond them."""
    joined = Counter(node for member in structure.members.values() for node in member.nodes)
    turning = {m.node for m in structure.masses.values() if any(m.rotary_inertia) or any(m.offset)}
    for name in sound_members(structure):
        frame = structure.frame_of(name)
        free = [
            (node, station)
            for node, station in zip(structure.members[name].nodes, (0.0, frame.length), strict=True)
            if joined[node] == 1 and node not in turning
        ]
        for place, (node, station) in product(member_hinge_places(structure, name), free):
            at_end = abs(place.station - station) < APART * frame.length
            if at_end and not holds_rotation(structure, node, frame.axis(place.axis)):
                what = f"zero inertia beyond the hinge '{place.name}': nothing else is joined to '{node}'"
                todo = "move the hinge into the member, or remove it"
                yield Problem(what, where=f"{place.where}.at", todo=todo)


def sound_members(structure: StructureParts) -> tuple[str, ...]:
    """Members whose nodes, section and materials are there, and whose hinges name no other node."""
    return structure.kept.once("sound members", "", lambda: tuple(_sound_members(structure)))


def _sound_members(structure: StructureParts) -> Iterator[str]:
    whole = {
        name
        for name, section in structure.sections.items()
        if set(section.named_materials().values()) <= set(structure.materials)
    }
    for name, member in structure.members.items():
        named = [hinge.at for hinge in member.given_hinges if isinstance(hinge.at, str)]
        if (
            structure.has_line(name)
            and member.section in whole
            and member.material in structure.materials
            and all(node in member.nodes for node in named)
        ):
            yield name


def _law_problems(structure: StructureParts, place: HingePlace, known: Names) -> Iterator[Problem]:
    """Reasons why laws and axes do not fit the section of their hinge; unknown names have another check.

    `known`: names of laws in the input, those with mistakes of their own included.
    """
    keys = place.keys
    places = [replace(place, axis=axis, law=keys.law_about(axis)) for axis in keys.bending] or [place]
    named = [about.law for about in places if isinstance(about.law, str)]
    if any(law not in structure.hinge_laws and (law in known or law not in BENDING) for law in named):
        return
    found = [problem for about in places for problem in _refusals(partial(law_of, structure, about))]
    where = f"{place.where}.law"
    if not found:
        found, where = _refusals(lambda: spatial_record_of(structure, place)), place.where
    for problem in found:
        if problem.what.endswith(TOO_STEEP):
            yield too_thin(structure, place)
            continue
        if problem.where == "bound":
            what = f"hinge '{place.name}' of member '{place.member}': {problem.what}"
            written = f"hinge_laws.{named[0]}" if named else where
            yield replace(problem, what=what, where=f"{written}.bound")
            continue
        key = f"{problem.where}: " if problem.where else ""
        yield Problem(key + problem.what, problem.came, problem.allowed, problem.todo, where)


def _asks_bound(structure: StructureParts) -> bool:
    """Whether automatic hinges are asked for a bound of their law."""
    asked = [structure.hinges, *[member.hinges for member in structure.members.values()]]
    laws = [
        law
        for keys in asked
        if isinstance(keys, AutomaticHinges)
        for law in (keys.law, *[keys.law_about(axis) for axis in keys.bending])
    ]
    named = [structure.hinge_laws.get(law) if isinstance(law, str) else law for law in laws]
    return any(law is not None and law.bound != "nominal" for law in named)


def _alike(problem: Problem) -> Problem | tuple[str, str]:
    """What problems have in common that are told once: those of a bound, which name a hinge, their law."""
    return (problem.where, problem.came) if problem.where.endswith(".bound") else problem


def _refusals(build: Callable[[], object]) -> list[Problem]:
    try:
        build()
    except InputError as error:
        return list(error.problems)
    return []
