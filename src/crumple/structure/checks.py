"""Mistakes that no part shows alone: names that do not exist, members without length, masses in the air.

A check looks at a structure whose parts are valid one by one and gives every problem it finds.  Names may be
passed that exist in the input but whose parts were refused, so that one mistake is not reported twice.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import combinations, pairwise

import numpy as np

from crumple.errors import InputError, Problem
from crumple.structure.hinges import HingePlace, holds_rotation, law_of, member_hinge_places
from crumple.structure.law import LAW_SPECS, LawReference
from crumple.structure.outputs import Outputs
from crumple.structure.problems import one_of, shown, suggestion
from crumple.structure.structure import Structure

COINCIDENT = 1e-6
"""Distance [m] below which two nodes are one place: a thousandth of a wall, far above rounding."""
HINGES_APART = 1e-6
"""Distance of two hinges, as a share of the member, below which the bar between them has no inertia to speak of."""

Names = Mapping[str, Iterable[str]]
"""Names per kind of part that the input defines, including those of refused parts."""


def problems_in(structure: Structure, defined: Names | None = None) -> list[Problem]:
    """Every mistake of a structure.

    Parameters
    ----------
    structure
        Parts valid one by one.
    defined
        Names per kind (``nodes``, ``members``, ``sections``, ``materials``, ``hinge_laws``) that exist even if
        their parts are missing here; None: those of the structure.
    """
    known = {
        kind: set(getattr(structure, kind))
        for kind in ("nodes", "members", "sections", "materials", "hinge_laws")
    }
    for kind, names in (defined or {}).items():
        known[kind] = known.get(kind, set()) | set(names)
    problems = [problem for check in _CHECKS for problem in check(structure, known)]
    return list(dict.fromkeys(problems))


def output_problems(outputs: Outputs, structure: Structure, defined: Names | None = None) -> list[Problem]:
    """Every name in the outputs that does not exist, and every place outside its member."""
    nodes = {*structure.nodes, *(defined or {}).get("nodes", ())}
    members = {*structure.members, *(defined or {}).get("members", ())}
    problems = [
        problem
        for i, node in enumerate(outputs.nodes)
        for problem in _unknown("node", node, nodes, f"outputs.nodes[{i}]")
    ]
    for name, rotation in outputs.section_rotations.items():
        where = f"outputs.section_rotations.{name}"
        problems += _unknown("member", rotation.member, members, f"{where}.member")
        length = _length(structure, rotation.member)
        for key, station in (("from", rotation.start), ("to", rotation.end)):
            if length is not None and station > length * (1.0 + 1e-9):
                problems.append(_outside(f"{where}.{key}", station, length))
    return problems


def _names(structure: Structure, known: Mapping[str, set[str]]) -> Iterator[Problem]:
    """Names that parts refer to."""
    for name, member in structure.members.items():
        where = f"members.{name}"
        for i, node in enumerate(member.nodes):
            yield from _unknown("node", node, known["nodes"], f"{where}.nodes[{i}]")
        yield from _unknown("section", member.section, known["sections"], f"{where}.section")
        yield from _unknown("material", member.material, known["materials"], f"{where}.material")
        laws = {*known["hinge_laws"], *LAW_SPECS}
        yield from _unknown_law(member.bars.law, laws, f"{where}.bars.law")
        for i, hinge in enumerate(member.hinges):
            yield from _unknown_law(hinge.law, laws, f"{where}.hinges[{i}].law")
            if isinstance(hinge.at, str) and hinge.at not in member.nodes:
                what, allowed = f"'{shown(hinge.at)}' is no node of this member", one_of(member.nodes)
                todo = (
                    suggestion(hinge.at, member.nodes)
                    or "name one of its nodes, or a distance such as '300 mm'"
                )
                yield Problem(
                    what, shown(hinge.at), f"{allowed}, or a distance", todo, f"{where}.hinges[{i}].at"
                )
    for kind, parts in (("supports", structure.supports), ("masses", structure.masses)):
        for name, part in parts.items():
            yield from _unknown("node", part.node, known["nodes"], f"{kind}.{name}.node")
    for kind, listed in (("impulses", structure.impulses), ("loads", structure.loads)):
        for i, item in enumerate(listed):
            yield from _unknown("node", item.node, known["nodes"], f"{kind}[{i}].node")
    for i, field in enumerate(structure.initial_velocity):
        for j, node in enumerate(field.nodes or ()):
            yield from _unknown("node", node, known["nodes"], f"initial_velocity[{i}].nodes[{j}]")
        for j, name in enumerate(field.members or ()):
            yield from _unknown("member", name, known["members"], f"initial_velocity[{i}].members[{j}]")


def _members(structure: Structure, known: Mapping[str, set[str]]) -> Iterator[Problem]:
    """Members without length or direction."""
    if not known["members"]:
        yield Problem("the structure has no members", where="members", todo="add at least one member")
    for name, member in structure.members.items():
        where = f"members.{name}"
        if not all(node in structure.nodes for node in member.nodes):
            continue
        first, second = (np.array(structure.nodes[node]) for node in member.nodes)
        if float(np.linalg.norm(second - first)) < COINCIDENT:
            todo = "move one of its nodes"
            yield Problem("the member has no length", ", ".join(member.nodes), "two nodes apart", todo, where)
            continue
        try:
            structure.frame_of(name)
        except ValueError:
            what = "'up' lies along the member"
            yield Problem(what, "", "a direction across it", "choose another direction", f"{where}.up")


def _nodes(structure: Structure, known: Mapping[str, set[str]]) -> Iterator[Problem]:
    """Nodes at one place, and nodes that nothing is joined to."""
    cells: dict[tuple[int, ...], list[str]] = defaultdict(list)
    for name, position in structure.nodes.items():
        cells[tuple(round(x / (4.0 * COINCIDENT)) for x in position)].append(name)
    for names in cells.values():
        for first, second in combinations(names[:8], 2):
            gap = np.subtract(structure.nodes[first], structure.nodes[second])
            if float(np.linalg.norm(gap)) < COINCIDENT:
                todo = f"use one node, or move '{second}'"
                yield Problem(
                    f"the nodes '{first}' and '{second}' coincide", where=f"nodes.{second}", todo=todo
                )
    joined = {node for member in structure.members.values() for node in member.nodes}
    if len(structure.members) < len(known["members"]) or not joined <= known["nodes"]:
        return  # a refused or misspelt part may be what joins a node
    carriers = [(f"masses.{name}", mass.node, "the mass") for name, mass in structure.masses.items()]
    carriers += [
        (f"supports.{name}", support.node, "the support") for name, support in structure.supports.items()
    ]
    carriers += [(f"loads[{i}]", load.node, "the load") for i, load in enumerate(structure.loads)]
    carriers += [
        (f"impulses[{i}]", struck.node, "the impulse") for i, struck in enumerate(structure.impulses)
    ]
    for where, node, noun in carriers:
        if node in structure.nodes and node not in joined:
            what = f"{noun} is not connected: no member ends at node '{node}'"
            yield Problem(what, node, one_of(sorted(joined)), "choose a node of a member", f"{where}.node")
    carried = {node for _, node, _ in carriers}
    for name in structure.nodes:
        if name not in joined and name not in carried:
            yield Problem(
                f"no member ends at node '{name}'", where=f"nodes.{name}", todo="remove it or join it"
            )


def _hinges(structure: Structure, known: Mapping[str, set[str]]) -> Iterator[Problem]:
    """Hinges outside their member, on one place, of one name, or with a law that does not fit."""
    places = [
        place
        for name in structure.members
        if _is_whole(structure, name)
        for place in _sound_places(structure, name)
    ]
    for name, times in Counter(place.name for place in places).items():
        if times > 1:
            where = next(place.where for place in reversed(places) if place.name == name)
            yield Problem(
                f"{times} hinges have the name '{name}'", name, "a name of its own", "rename", f"{where}.name"
            )
    seen: set[object] = set()
    for place in places:
        length = structure.frame_of(place.member).length
        if not -HINGES_APART * length <= place.station <= length * (1.0 + HINGES_APART):
            yield _outside(f"{place.where}.at", place.station, length)
        # one message for the many hinges of a chain
        key = (place.where, place.axis)
        if key not in seen and _has_law(place.law, structure):
            seen.add(key)
            yield from _law_problems(structure, place)
    for first, second in pairwise(places):
        if first.member == second.member:
            length = structure.frame_of(first.member).length
            if second.station - first.station < HINGES_APART * length:
                what = f"the hinges '{first.name}' and '{second.name}' lie at one place: the bar between has no inertia"
                yield Problem(what, where=second.where, todo="move one of them")


def _inertia(structure: Structure, known: Mapping[str, set[str]]) -> Iterator[Problem]:
    """Hinges at a free end, beyond which there is nothing to turn."""
    ends = Counter(node for member in structure.members.values() for node in member.nodes)
    for name, member in structure.members.items():
        if not _is_whole(structure, name):
            continue
        frame = structure.frame_of(name)
        for place in _sound_places(structure, name):
            for node, station in zip(member.nodes, (0.0, frame.length), strict=True):
                alone = abs(place.station - station) < HINGES_APART * frame.length and ends[node] == 1
                turning = any(
                    mass.node == node and (any(mass.rotary_inertia) or any(mass.offset))
                    for mass in structure.masses.values()
                )
                if alone and not turning and not holds_rotation(structure, node, frame.axis(place.axis)):
                    what = f"beyond the hinge '{place.name}' there is no inertia: nothing else is joined to '{node}'"
                    todo = "move the hinge into the member, or remove it"
                    yield Problem(what, where=f"{place.where}.at", todo=todo)


def _supports(structure: Structure, known: Mapping[str, set[str]]) -> Iterator[Problem]:
    """Motions that start with a jump, and freedoms that two supports claim."""
    claimed: dict[tuple[str, str], str] = {}
    for name, support in structure.supports.items():
        for freedom in (*support.held, *sorted(support.motion.model_fields_set)):
            other = claimed.setdefault((support.node, freedom), name)
            if other != name:
                what = f"the supports '{other}' and '{name}' both hold {freedom} of node '{support.node}'"
                yield Problem(what, where=f"supports.{name}", todo="keep one of them")
        for freedom in sorted(support.motion.model_fields_set):
            function = getattr(support.motion, freedom)
            start = 0.0 if function is None else float(function(0.0))
            if abs(start) > 1e-12:
                where, todo = f"supports.{name}.motion.{freedom}", "let it start from 0"
                yield Problem(
                    "the prescribed motion starts with a jump", f"{start:g}", "0 at the start", todo, where
                )


_CHECKS: tuple[Callable[[Structure, Mapping[str, set[str]]], Iterator[Problem]], ...] = (
    _names,
    _members,
    _nodes,
    _hinges,
    _inertia,
    _supports,
)


def _unknown(kind: str, name: str, known: Iterable[str], where: str) -> Iterator[Problem]:
    names = sorted(known)
    if name not in names:
        todo = suggestion(name, names) or f"define the {kind} '{shown(name)}' or correct the name"
        yield Problem(f"there is no {kind} '{shown(name)}'", shown(name), one_of(names), todo, where)


def _unknown_law(law: LawReference | None, known: Iterable[str], where: str) -> Iterator[Problem]:
    if isinstance(law, str):
        yield from _unknown("hinge law", law, known, where)


def _has_law(law: LawReference | None, structure: Structure) -> bool:
    return not isinstance(law, str) or law in structure.hinge_laws or law in LAW_SPECS


def _law_problems(structure: Structure, place: HingePlace) -> Iterator[Problem]:
    try:
        law_of(structure, place)
    except InputError as error:
        for problem in error.problems:
            where = place.where if problem.where == place.where else f"{place.where}.law"
            key = f"{problem.where}: " if problem.where and problem.where != place.where else ""
            yield Problem(key + problem.what, problem.came, problem.allowed, problem.todo, where)


def _is_whole(structure: Structure, name: str) -> bool:
    """Whether a member's nodes, section and material are there and it has a length and a direction."""
    member = structure.members[name]
    if not all(node in structure.nodes for node in member.nodes):
        return False
    if member.section not in structure.sections or member.material not in structure.materials:
        return False
    return not list(
        _members(
            structure.model_construct(nodes=structure.nodes, members={name: member}), {"members": {name}}
        )
    )


def _sound_places(structure: Structure, name: str) -> list[HingePlace]:
    """Places of a member's hinges, unless one names a node that is not the member's."""
    member = structure.members[name]
    if any(isinstance(hinge.at, str) and hinge.at not in member.nodes for hinge in member.hinges):
        return []
    return member_hinge_places(structure, name)


def _length(structure: Structure, name: str) -> float | None:
    return (
        structure.frame_of(name).length if name in structure.members and _is_whole(structure, name) else None
    )


def _outside(where: str, station: float, length: float) -> Problem:
    came, allowed = f"{1e3 * station:.6g} mm", f"0 mm to {1e3 * length:.6g} mm"
    return Problem("this place is outside the member", came, allowed, "choose a place on the member", where)
