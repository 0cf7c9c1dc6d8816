"""What obstacles do to a structure: impulse, and the energy that is dissipated at their contacts.

- Impulse: the integral of the force over the run, as a vector's length.
- Places of contact: stations of members at which a wall point comes within `TOUCHES` of the section's largest
  side of the obstacle in any stored shape.
- Dissipation at the contact: plastic work of wall elements, or energy of hinges, whose place on the member's
  axis at the start lies within one side of a place of contact; and the energies of contact and friction.

Energies of contact and friction are those of the whole model: where several obstacles press, or members touch
members, they cannot be divided, and are left out.  The place of an obstacle that turns is not followed.  Of
what yields along elastic members only the sum is known: a dissipation is not known where the members that
touch have more than `LITTLE` of the energy put in outside hinges.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.result import Result, States
from crumple.structure import Structure, gap, plastic_hinges

TOUCHES = 0.1
"""Distance from an obstacle over the largest side of the section up to which a wall point touches it: shells
keep half a wall away, and capsules round the corners of a section off."""
LITTLE = 0.03
"""Share of the energy put in by which a dissipation at a contact may always differ, and up to which energy
may be without a place."""
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
    room = LITTLE * float(result["energy.kinetic"][0] + np.abs(result["energy.external_work"]).max())
    found = {}
    for name in pressing:
        if structure.obstacles[name].turning is not None:
            continue
        near = np.zeros(len(work), dtype=bool)
        touching = list(_contacts(result, structure, name))
        if _without_place(result, {member for member, *_ in touching}, work) > room:
            continue
        for _, place, side in touching:
            near |= np.linalg.norm(places - place, axis=1) <= side
        found[name] = float(energies[near].sum()) + taken
    return found


def _without_place(result: Result, members: set[str], work: list[tuple[str, float, float]]) -> float:
    """Energy of elastic members outside hinges [J]."""
    totals = (result.channels.get(f"member.{member}.energy") for member in members)
    known = sum(energy for member, _, energy in work if member in members)
    found = [float(total.values[-1]) for total in totals if total is not None]
    return sum(found) - known if found and result.fidelity != "shell" else 0.0


def _contacts(result: Result, structure: Structure, obstacle: str) -> Iterator[tuple[str, Floats, float]]:
    """Members that touch an obstacle, the place on their axis at the start, side of their section [m]."""
    states = result.states
    assert states is not None
    solid = structure.obstacles[obstacle]
    only, shapes = solid.members, zip(states.displacement, _travel(result, states, obstacle), strict=True)
    least = np.min([gap(solid, states.points + moved - by) for moved, by in shapes], axis=0)
    for m, member in enumerate(states.member_names):
        if only is not None and member not in only:
            continue
        side = float(np.ptp(structure.section_of(member).outline(), axis=0).max())
        touching = (states.member == m) & (least <= TOUCHES * side)
        frame = structure.frame_of(member)
        for station in np.unique(states.station[touching].round(9)):
            yield member, frame.position(float(station)), side


def _travel(result: Result, states: States, obstacle: str) -> Floats:
    """Displacement of an obstacle in every state [m], (n_states, 3)."""
    names = [f"obstacle.{obstacle}.displacement.{axis}" for axis in "xyz"]
    if any(name not in result.channels for name in names):
        return np.zeros((len(states.times), 3))
    return np.stack([np.interp(states.times, result.time, result[name]) for name in names], axis=1)


def hinge_work(result: Result, structure: Structure) -> list[tuple[str, float, float]]:
    """Member, station [m] and energy [J] of every hinge of a multibody run, and of what yielded between."""
    hinges = [
        (hinge.member, hinge.station, float(result[f"hinge.{hinge.name}.energy"][-1]))
        for hinge in plastic_hinges(structure)
    ]
    return hinges + [(member, *place) for member, own in result.yielded.items() for place in own]
