"""Checks between several parts: names that do not exist, members without length, unconnected masses.

A check takes a structure whose parts are valid one by one and returns every problem.  Names may be
passed that exist in the input but whose parts were refused, so that one mistake is not reported twice.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from itertools import combinations, product
from math import dist

import numpy as np

from crumple.errors import Problem
from crumple.hinge.registry import BENDING
from crumple.numeric.arrays import Floats
from crumple.structure.checks.hinge_checks import inertia_problems, place_problems
from crumple.structure.checks.joint_checks import bare_node_problems, joint_problems
from crumple.structure.checks.limit_checks import limit_problems, output_limit_problems, pitch_limit_problems
from crumple.structure.checks.obstacle_checks import obstacle_problems
from crumple.structure.checks.rigid_checks import rigid_problems
from crumple.structure.checks.start_checks import start_problems
from crumple.structure.checks.weld_checks import pitch_problems, spot_weld_problems
from crumple.structure.keys.hinge_axes import AxisLaws, HingeAxes
from crumple.structure.keys.member import AutomaticHinges, Member
from crumple.structure.keys.outputs import Outputs
from crumple.structure.parts import StructureParts
from crumple.structure.schema.problems import Names, one_of, outside, shown, suggestion, unknown
from crumple.structure.settings.shell_settings import ShellSettings
from crumple.units import format_quantity

COINCIDENT = 1e-6
"""Distance [m] below which two nodes are one place: a thousandth of a wall, far above rounding."""
ASKEW = np.array([0.26726, 0.53452, 0.80178])
"""Direction of about unit length."""
ROUNDING = 1e-12
"""Error of a coordinate along it, as a share of the coordinate."""
JUMP = 1e-12
"""Prescribed displacement [m] or rotation [rad] at the start that is still rounding."""
FLAT = 1e-9
"""Area over the square of the size below which a polygon has none."""
UNEVEN = 1e-3
"""Distance from its plane over the size up to which a polygon counts as plane."""
NO_LAWS = AxisLaws()
UNDIVIDED = Member.model_fields["bars"].default
KINDS = ("nodes", "members", "sections", "materials", "hinge_laws", "supports", "obstacles")

Defined = Mapping[str, Iterable[str]]
"""Names per kind of part that the input defines, including those of refused parts."""
Known = Mapping[str, Names]


def problems_in(
    structure: StructureParts, defined: Defined | None = None, *, complete: bool = True
) -> list[Problem]:
    """Every mistake of a structure.

    Parameters
    ----------
    structure
        Parts valid one by one.
    defined
        Names per kind (``nodes``, ``members``, ...) that exist even if their parts are missing here; None:
        those of the structure.
    complete
        False if parts were refused: a missing part is then not a mistake.
    """
    given = defined or {}
    known = {kind: Names([*getattr(structure, kind), *given.get(kind, ())]) for kind in KINDS}
    checks = (*_CHECKS, *(_CHECKS_OF_WHAT_IS_MISSING if complete else ()))
    # what is too large is refused before anything is made of it
    if problems := [*limit_problems(structure, known), *pitch_limit_problems(structure)]:
        return problems
    return list(dict.fromkeys(problem for check in checks for problem in check(structure, known)))


def output_problems(
    outputs: Outputs, structure: StructureParts, defined: Defined | None = None
) -> list[Problem]:
    """Every name in the outputs that does not exist, and every place outside its member."""
    nodes = Names([*structure.nodes, *(defined or {}).get("nodes", ())])
    members = Names([*structure.members, *(defined or {}).get("members", ())])
    if too_many := list(output_limit_problems(outputs)):
        return too_many
    problems = [
        problem
        for i, node in enumerate(outputs.nodes)
        for problem in unknown("node", node, nodes, f"outputs.nodes[{i}]")
    ]
    for name, clearance in outputs.clearances.items():
        where = f"outputs.clearances.{name}"
        problems += unknown("member", clearance.moves_with, members, f"{where}.moves_with")
        problems += _shape_problems(np.asarray(clearance.points, float), f"{where}.points")
        for i, member in enumerate(clearance.members or ()):
            problems += unknown("member", member, members, f"{where}.members[{i}]")
    for name, distance in outputs.distances.items():
        where = f"outputs.distances.{name}"
        problems += unknown("node", distance.start, nodes, f"{where}.from")
        problems += unknown("node", distance.end, nodes, f"{where}.to")
        if distance.start == distance.end:
            what, came = "a distance needs two nodes", f"{shown(distance.end)} twice"
            problems.append(Problem(what, came, "", "name another node", f"{where}.to"))
    for name, force in outputs.section_forces.items():
        where = f"outputs.section_forces.{name}"
        problems += unknown("member", force.member, members, f"{where}.member")
        if structure.has_line(force.member):
            length = structure.frame_of(force.member).length
            if force.at > length * (1.0 + 1e-9):
                problems.append(outside(f"{where}.at", force.at, length))
    for name, rotation in outputs.section_rotations.items():
        where = f"outputs.section_rotations.{name}"
        problems += unknown("member", rotation.member, members, f"{where}.member")
        if structure.has_line(rotation.member):
            length = structure.frame_of(rotation.member).length
            stations = (("from", rotation.start), ("to", rotation.end))
            problems += [
                outside(f"{where}.{key}", s, length) for key, s in stations if s > length * (1.0 + 1e-9)
            ]
    return problems


def _shape_problems(corners: Floats, where: str) -> Iterator[Problem]:
    """Corners that span no area or do not lie in one plane."""
    arms = corners[1:] - corners[0]
    normal = np.cross(arms[:-1], arms[1:]).sum(axis=0)
    size, area = float(np.abs(arms).max()), float(np.linalg.norm(normal))
    todo = "correct the points"
    if area <= FLAT * size**2 or not arms[0].any():
        what, came = "the space has no area", "corners in a line or at one place, or sides that cross"
        yield Problem(what, came, "corners in order around it", todo, where)
    elif float(np.abs(arms @ normal).max()) > UNEVEN * size * area:
        what, came = "the corners do not lie in one plane", f"{len(corners)} corners"
        yield Problem(what, came, "corners in one plane", todo, where)


def shell_problems(
    settings: ShellSettings, structure: StructureParts, defined: Defined | None = None
) -> list[Problem]:
    """Fine-mesh positions outside members or on unknown members; settings without effect."""
    members = Names([*structure.members, *(defined or {}).get("members", ())])
    problems: list[Problem] = []
    for i, place in enumerate(settings.fine_at):
        where = f"analysis.shell.fine_at[{i}]"
        problems += unknown("member", place.member, members, f"{where}.member")
        if structure.has_line(place.member):
            length = structure.frame_of(place.member).length
            if place.at > length * (1.0 + 1e-9):
                problems.append(outside(f"{where}.at", place.at, length))
    if settings.weld_pitch is not None:
        problems += pitch_problems(structure)
    if settings.contact_friction and settings.self_contact == "off" and structure.member_contact is None:
        what, todo = "'contact_friction' would have no effect: self-contact is off", "add 'self_contact: on'"
        where = "analysis.shell.contact_friction"
        problems.append(Problem(what, f"{settings.contact_friction:g}", "0 without contact", todo, where))
    return problems


def _names(structure: StructureParts, known: Known) -> Iterator[Problem]:
    """Names that members refer to."""
    laws = Names([*known["hinge_laws"], *BENDING])
    if structure.hinges is not None:
        yield from _unknown_laws(structure.hinges, laws, "hinges")
    for name, member in structure.members.items():
        where = f"members.{name}"
        if not known["nodes"].issuperset(member.nodes):
            for i, node in enumerate(member.nodes):
                yield from unknown("node", node, known["nodes"], f"{where}.nodes[{i}]")
        if member.section not in known["sections"]:
            yield from unknown("section", member.section, known["sections"], f"{where}.section")
        if member.material not in known["materials"]:
            yield from unknown("material", member.material, known["materials"], f"{where}.material")
        if member.bars is not UNDIVIDED:
            yield from _unknown_laws(member.bars, laws, f"{where}.bars")
        if isinstance(member.hinges, AutomaticHinges):
            yield from _unknown_laws(member.hinges, laws, f"{where}.hinges")
        for i, hinge in enumerate(member.given_hinges):
            yield from _unknown_laws(hinge, laws, f"{where}.hinges[{i}]")
            if isinstance(hinge.at, str) and hinge.at not in member.nodes:
                what, allowed = f"'{shown(hinge.at)}' is not a node of this member", one_of(member.nodes)
                todo = suggestion(hinge.at, member.nodes) or "give one of its nodes, or a distance: '300 mm'"
                yield Problem(
                    what, shown(hinge.at), f"{allowed}, or a distance", todo, f"{where}.hinges[{i}].at"
                )


def _metals(structure: StructureParts, known: Known) -> Iterator[Problem]:
    """Materials that sections name."""
    for name, section in structure.sections.items():
        for key, material in section.named_materials().items():
            yield from unknown("material", material, known["materials"], f"sections.{name}.{key}")


def _carried_names(structure: StructureParts, known: Known) -> Iterator[Problem]:
    """Names that supports, masses, loads and initial motion refer to."""
    for where, node, _ in _carriers(structure):
        yield from unknown("node", node, known["nodes"], where)
    for i, field in enumerate(structure.initial_velocity):
        for j, node in enumerate(field.nodes or ()):
            yield from unknown("node", node, known["nodes"], f"initial_velocity[{i}].nodes[{j}]")
        for j, name in enumerate(field.members or ()):
            yield from unknown("member", name, known["members"], f"initial_velocity[{i}].members[{j}]")


def _members(structure: StructureParts, known: Known) -> Iterator[Problem]:
    """Members without length or direction."""
    if not known["members"]:
        yield Problem("the structure has no members", where="members", todo="add at least one member")
    for name, member in structure.members.items():
        where = f"members.{name}"
        if not all(node in structure.nodes for node in member.nodes):
            continue
        if dist(*(structure.nodes[node] for node in member.nodes)) < COINCIDENT:
            todo = "move one of its nodes"
            yield Problem("the member has no length", ", ".join(member.nodes), "two nodes apart", todo, where)
        elif not structure.has_line(name):
            what, todo = "'up' lies along the member", "choose another direction"
            yield Problem(what, "", "a direction across it", todo, f"{where}.up")


def _coincident(structure: StructureParts, known: Known) -> Iterator[Problem]:
    """Nodes at one place."""
    cells: dict[tuple[int, ...], list[str]] = defaultdict(list)
    for name in _perhaps_coincident(structure):
        position = structure.nodes[name]
        # every cell that the node is near to: two close nodes share one whatever side of an edge they lie on
        around = ((int(x // COINCIDENT), int(x // COINCIDENT) + 1) for x in position)
        for cell in product(*around):
            cells[cell].append(name)
    # a member without length has its own message
    joined = {frozenset(member.nodes) for member in structure.members.values()}
    pairs = {pair for names in cells.values() for pair in combinations(names[:8], 2)}
    pairs = {pair for pair in pairs if frozenset(pair) not in joined}
    order = {name: i for i, name in enumerate(structure.nodes)}
    for first, second in sorted(pairs, key=lambda pair: (order[pair[1]], order[pair[0]])):
        if dist(structure.nodes[first], structure.nodes[second]) < COINCIDENT:
            todo = f"use one node, or move '{second}'"
            yield Problem(f"the nodes '{first}' and '{second}' coincide", where=f"nodes.{second}", todo=todo)


def _perhaps_coincident(structure: StructureParts) -> list[str]:
    """Nodes that are near to another one along some direction: all that coincide and few others, in order."""
    names = list(structure.nodes)
    # few nodes of a drawing lie in a plane across this direction
    along = np.array([structure.nodes[name] for name in names], float).reshape(-1, 3) @ ASKEW
    order = np.argsort(along)
    near = np.diff(along[order]) <= 2.0 * COINCIDENT + ROUNDING * np.abs(along).max(initial=0.0)
    found = np.zeros(len(names), bool)
    found[order[:-1][near]] = found[order[1:][near]] = True
    return [names[i] for i in np.flatnonzero(found)]


def _connections(structure: StructureParts, known: Known) -> Iterator[Problem]:
    """Masses, supports, loads and nodes that no member connects to the structure."""
    joined = {node for member in structure.members.values() for node in member.nodes}
    if not joined or not joined <= known["nodes"]:
        return  # a misspelt name may be the connection of a node; without members nothing is connected
    carriers, ends = list(_carriers(structure)), one_of(sorted(joined))
    for where, node, noun in carriers:
        if node in structure.nodes and node not in joined:
            what = f"{noun} is not connected: no member ends at node '{node}'"
            yield Problem(what, node, ends, "choose a node of a member", where)
    carried = {node for _, node, _ in carriers}
    for name in structure.nodes:
        if name not in joined and name not in carried:
            yield Problem(
                f"no member ends at node '{name}'", where=f"nodes.{name}", todo="remove it or connect it"
            )


def _supports(structure: StructureParts, known: Known) -> Iterator[Problem]:
    """Motions that start with a jump, and degrees of freedom with two supports."""
    claimed: dict[tuple[str, str], str] = {}
    for name, support in structure.supports.items():
        for freedom in (*support.held, *support.driven):
            other = claimed.setdefault((support.node, freedom), name)
            if other != name:
                what = f"the supports '{other}' and '{name}' both hold {freedom} of node '{support.node}'"
                yield Problem(what, where=f"supports.{name}", todo="keep one of them")
        for freedom, function in support.driven.items():
            start = float(function(0.0))
            if abs(start) > JUMP:
                where, todo = f"supports.{name}.motion.{freedom}", "let it start from 0"
                what = "the prescribed motion starts with a jump"
                came = format_quantity(start, "rad" if freedom.startswith("r") else "m")
                yield Problem(what, came, "0 at the start", todo, where)


_CHECKS: tuple[Callable[[StructureParts, Known], Iterator[Problem]], ...] = (
    _names,
    _metals,
    _carried_names,
    _members,
    _coincident,
    place_problems,
    rigid_problems,
    joint_problems,
    spot_weld_problems,
    _supports,
    start_problems,
    obstacle_problems,
)
_CHECKS_OF_WHAT_IS_MISSING = (_connections, inertia_problems, bare_node_problems)


def _carriers(structure: StructureParts) -> Iterator[tuple[str, str, str]]:
    """Path of the key, node and noun of everything that sits on a node."""
    for name, mass in structure.masses.items():
        yield f"masses.{name}.node", mass.node, "the mass"
    for name, support in structure.supports.items():
        yield f"supports.{name}.node", support.node, "the support"
    for i, load in enumerate(structure.loads):
        yield f"loads[{i}].node", load.node, "the load"
    for i, struck in enumerate(structure.impulses):
        yield f"impulses[{i}].node", struck.node, "the impulse"


def _unknown_laws(keys: HingeAxes, known: Names, where: str) -> Iterator[Problem]:
    own = keys.laws or NO_LAWS
    for key, law in (("law", keys.law), ("laws.y", own.y), ("laws.z", own.z)):
        if isinstance(law, str) and law not in known:
            yield from unknown("hinge law", law, known, f"{where}.{key}")
