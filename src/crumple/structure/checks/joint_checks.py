"""Checks of joints: members and nodes that do not meet, ends with two joints, nodes without inertia."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from crumple.errors import Problem
from crumple.structure.parts import StructureParts
from crumple.structure.schema.problems import Names, one_of, shown, suggestion


def joint_problems(structure: StructureParts, known: Mapping[str, Names]) -> Iterator[Problem]:
    """Names that do not exist or do not meet, and ends with two joints."""
    ends: dict[tuple[str, str], str] = {}
    for name, joint in structure.joints.items():
        where = f"joints.{name}"
        if joint.member not in known["members"]:
            todo = known["members"].suggestion(joint.member) or "name a member"
            what = f"there is no member '{shown(joint.member)}'"
            yield Problem(what, shown(joint.member), known["members"].listed, todo, f"{where}.member")
            continue
        if joint.member not in structure.members:
            continue
        nodes = structure.members[joint.member].nodes
        if joint.node not in nodes:
            what = f"member '{joint.member}' does not end at node '{shown(joint.node)}'"
            todo = suggestion(joint.node, nodes) or "give one of its nodes"
            yield Problem(what, shown(joint.node), one_of(nodes), todo, f"{where}.node")
        other = ends.setdefault((joint.node, joint.member), name)
        if other != name:
            what = f"the joints '{other}' and '{name}' join the same end of member '{joint.member}'"
            yield Problem(what, where=where, todo="keep one of them")


def bare_node_problems(structure: StructureParts, known: Mapping[str, Names]) -> Iterator[Problem]:
    """Nodes at which every member hangs on a joint, and nothing has inertia or holds them."""
    ends: dict[str, list[str]] = defaultdict(list)
    for name, member in structure.members.items():
        for node in member.nodes:
            ends[node].append(name)
    jointed = {(joint.node, joint.member): name for name, joint in structure.joints.items()}
    carried = {mass.node for mass in structure.masses.values() if any(mass.rotary_inertia)}
    clamped = {support.node for support in structure.supports.values() if len(support.held) == 6}
    sound = carried | clamped
    for node, members in ends.items():
        if node in sound or not all((node, member) in jointed for member in members):
            continue
        what = f"every member at node '{node}' is connected by a joint, so the node itself has no inertia"
        todo = "connect one of the members rigidly, clamp the node, or give it a mass with rotary inertia"
        yield Problem(what, ", ".join(members), "", todo, f"joints.{jointed[node, members[-1]]}")
