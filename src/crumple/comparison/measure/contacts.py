"""What obstacles do to a structure: impulse, and the energy that is dissipated at their contacts.

- Impulse: the integral of the force over the run, as a vector's length.
- Places of contact: stations of members at which a wall point comes within `TOUCHES` of the section's largest
  side of the obstacle in any stored shape.
- Dissipation at the contact: plastic work of wall elements, or energy of hinges, whose place on the member's
  axis at the start lies within one side of a place of contact; and the energies of contact and friction.
- Struck joints: members that meet at a rigid joint fold outside of it, and shells have no walls in it.  Where
  its outline or a station within its reach touches, the places of contact are its faces: what lies within the
  reach and one side along each of its members counts.

Energies of contact and friction are those of the whole model: where several obstacles press, or members touch
members, they cannot be divided, and are left out.  The place of an obstacle that turns is not followed.  Of
what yields along elastic members only the sum is known: a dissipation is not known where the members that
touch have more than `LITTLE` of the energy put in outside hinges.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from crumple.comparison.measure.rings import carried
from crumple.numeric.arrays import Floats
from crumple.result import Result, States
from crumple.shell.mesh.cut_ends import outline_starts
from crumple.structure import Structure, gap, joint_reach
from crumple.structure.hinges.corners import leaving

TOUCHES = 0.1
"""Distance from an obstacle over the largest side of the section up to which a wall point touches it: shells
keep half a wall away, and capsules round the corners of a section off."""
LITTLE = 0.03
"""Share of the energy put in by which a dissipation at a contact may always differ, and up to which energy
may be without a place."""
SAMPLES = 4
"""Points along the lines of a joint's outline, which are about as long as the section is wide."""
TAKEN = ("energy.contact", "energy.friction")


def impulse(time: Floats, force: Floats) -> float:
    """Length of the impulse [N s] of a force (n_times, 3) [N], each the mean since the time before [s]."""
    return float(np.linalg.norm(np.diff(time) @ force[1:]))


def dissipated_at(
    result: Result, structure: Structure, impulses: dict[str, float], work: list[tuple[str, float, float]]
) -> dict[str, float]:
    """Energy dissipated at the contacts of every obstacle that pressed, where it is known [J].

    Parameters
    ----------
    result, structure
        With shapes.
    impulses
        Of every obstacle [N s].
    work
        Member, station [m] and energy [J] of all that dissipates: wall elements or hinges.
    """
    assert result.states is not None
    pressing = [name for name, size in impulses.items() if size > 0.0]
    alone = len(pressing) == 1 and structure.member_contact is None
    taken = sum(float(result[name][-1]) for name in TAKEN if name in result.channels) if alone else 0.0
    frames = {member: structure.frame_of(member) for member in structure.members}
    places = np.array([frames[member].position(station) for member, station, _ in work]).reshape(-1, 3)
    energies = np.array([energy for *_, energy in work])
    members = np.array([member for member, *_ in work])
    room = LITTLE * float(result["energy.kinetic"][0] + np.abs(result["energy.external_work"]).max())
    found = {}
    ends = _joint_ends(structure)
    for name in pressing:
        if structure.obstacles[name].turning is not None:
            continue
        near = np.zeros(len(work), dtype=bool)
        touching = list(_contacts(result, structure, name))
        faces = list(_struck_faces(result, structure, name, ends, touching))
        if _without_place(result, {member for member, *_ in (*touching, *faces)}, work) > room:
            continue
        for member, station, side in touching:
            near |= np.linalg.norm(places - frames[member].position(station), axis=1) <= side
        for member, node, reach in faces:
            from_node = np.linalg.norm(places - np.asarray(structure.nodes[node]), axis=1)
            near |= (members == member) & (from_node <= reach)
        found[name] = float(energies[near].sum()) + taken
    return found


def _without_place(result: Result, members: set[str], work: list[tuple[str, float, float]]) -> float:
    """Energy of elastic members outside hinges [J]."""
    totals = (result.channels.get(f"member.{member}.energy") for member in members)
    known = sum(energy for member, _, energy in work if member in members)
    found = [float(total.values[-1]) for total in totals if total is not None]
    return sum(found) - known if found and result.fidelity != "shell" else 0.0


def _contacts(result: Result, structure: Structure, obstacle: str) -> Iterator[tuple[str, float, float]]:
    """Members that touch an obstacle, station at which they do, side of their section [m]."""
    states = result.states
    assert states is not None
    only = structure.obstacles[obstacle].members
    least = _least_gaps(result, structure, obstacle, states.points + states.displacement)
    for m, member in enumerate(states.member_names):
        if only is not None and member not in only:
            continue
        side = _side(structure, member)
        touching = (states.member == m) & (least <= TOUCHES * side)
        for station in np.unique(states.station[touching].round(9)):
            yield member, float(station), side


def _struck_faces(
    result: Result,
    structure: Structure,
    obstacle: str,
    ends: dict[str, list[tuple[str, float]]],
    touching: list[tuple[str, float, float]],
) -> Iterator[tuple[str, str, float]]:
    """Member, node, and distance from it that counts [m], of all ends of the joints that an obstacle strikes.

    `ends`: members and their reach [m], by node; `touching`: stations of members that touch.
    """
    only = structure.obstacles[obstacle].members
    for node, joined in ends.items():
        own = [(member, reach) for member, reach in joined if only is None or member in only]
        struck = any(
            member == one and _from_node(structure, member, node, station) <= reach
            for member, station, _ in touching
            for one, reach in own
        ) or any(
            _least_gaps(result, structure, obstacle, _outline(result, structure, member, node, joined)).min()
            <= TOUCHES * _side(structure, member)
            for member, _ in own
        )
        if struck:
            yield from ((member, node, reach + _side(structure, member)) for member, reach in joined)


def _joint_ends(structure: Structure) -> dict[str, list[tuple[str, float]]]:
    """Members that meet at each rigid joint, and its reach along them [m].

    A joint may reach along one of its members alone: at an obtuse bend of unequal sections the walls of the
    deeper one end at the node.  Its walls bound the joint all the same.
    """
    found = {}
    for node, members in structure.members_at.items():
        reaches = [joint_reach(structure, member, node) for member in members]
        if max(reaches) > 0.0:
            found[node] = list(zip(members, reaches, strict=True))
    return found


def _outline(
    result: Result, structure: Structure, member: str, node: str, joined: list[tuple[str, float]]
) -> Floats:
    """Points of a member's outline between a joint's node and its first ring in all states [m], (n, m, 3)."""
    states = result.states
    assert states is not None
    own = np.flatnonzero(states.member == states.member_names.index(member))
    away = _from_node(structure, member, node, states.station[own])
    ring = own[away <= away.min() + 1e-9]
    axis = leaving(structure, member, node)
    others = [leaving(structure, other, node) for other, _ in joined if other != member]
    start, base = states.points[ring], np.asarray(structure.nodes[node])
    beside = start - base - np.outer((start - base) @ axis, axis)
    first = outline_starts(beside, axis, others)
    along = first + (float(away.min()) - first) * np.linspace(0.0, 1.0, SAMPLES)[:, None]
    points = (base + along[..., None] * axis + beside).reshape(-1, 3)
    return carried(start, start + states.displacement[:, ring], points)


def _from_node(structure: Structure, member: str, node: str, station: Floats | float) -> Floats:
    """Distance of stations of a member from one of its nodes [m]."""
    first = structure.members[member].nodes[0] == node
    return np.asarray(station if first else structure.frame_of(member).length - station)


def _side(structure: Structure, member: str) -> float:
    """Largest side of a member's section [m]."""
    return float(np.ptp(structure.section_of(member).outline(), axis=0).max())


def _least_gaps(result: Result, structure: Structure, obstacle: str, shapes: Floats) -> Floats:
    """Least distance of points from an obstacle over all states [m], (n,); shapes: (n_states, n, 3)."""
    assert result.states is not None
    moved = shapes - _travel(result, result.states, obstacle)[:, None]
    return np.asarray(gap(structure.obstacles[obstacle], moved).min(axis=0))


def _travel(result: Result, states: States, obstacle: str) -> Floats:
    """Displacement of an obstacle in every state [m], (n_states, 3)."""
    names = [f"obstacle.{obstacle}.displacement.{axis}" for axis in "xyz"]
    if any(name not in result.channels for name in names):
        return np.zeros((len(states.times), 3))
    return np.stack([np.interp(states.times, result.time, result[name]) for name in names], axis=1)
