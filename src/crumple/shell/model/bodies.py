"""Rigid bodies: end sections and rigid parts, lumps, and the ends cut away from members at joints."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats, Integers
from crumple.shell.mesh.joints import Joint
from crumple.shell.mesh.mesh import Mesh, clamped_nodes
from crumple.shell.model.rigid_parts import Group, groups_of
from crumple.shell.model.welds import weld_pairs
from crumple.structure import FREEDOMS, Structure

TRANSLATIONS, ROTATIONS = set(FREEDOMS[:3]), set(FREEDOMS[3:])


@dataclass(frozen=True, eq=False)
class Lump:
    """Rigid mass: mass [kg], centre [m] (3,), inertia tensor about the centre [kg m^2] (3, 3), world axes."""

    mass: float
    centre: Floats
    inertia: Floats

    def energy(self, velocity: Floats, spin: Floats) -> float:
        """Kinetic energy at a velocity of its centre [m/s] and an angular velocity [rad/s], in [J]."""
        return float(self.mass * velocity @ velocity + spin @ self.inertia @ spin) / 2


@dataclass(frozen=True, eq=False)
class Body:
    """One rigid body of nodes.

    Attributes
    ----------
    lumps
        Mass that is added to that of its nodes, by structure node; those nodes are part of it.
    nodes
        Mesh nodes that move with it, reference nodes last.
    place
        Where the last of them is [m], (3,).
    held
        Freedoms held at zero.
    pin
        Where it is held at a point that it can turn about [m], (3,); None: at its centre of mass.
    stretch
        Whether a rigid part of a member belongs to it.
    """

    lumps: dict[str, Lump]
    nodes: Integers
    place: Floats
    held: tuple[str, ...]
    pin: Floats | None
    stretch: bool

    @property
    def lump(self) -> Lump:
        """All of its lumps as one."""
        parts = tuple(self.lumps.values())
        return parts[0] if len(parts) == 1 else combined(parts, self.place)


def bodies_of(structure: Structure, mesh: Mesh, weld_pitch: float | None = None) -> tuple[Body, ...]:
    """Rigid bodies: those of sections and rigid parts, then pairs of nodes of spot welds, one each.

    Raises
    ------
    InputError
        If a rigid part is too short, or its supports cannot be represented in shells.
    """
    bodies = [_body(structure, mesh, group) for group in groups_of(structure, mesh)]
    spots = weld_pairs(structure, mesh, weld_pitch)
    free = spots[~np.isin(spots, taken_nodes(mesh, bodies)).any(axis=1)]
    return (*bodies, *(Body({}, spot, mesh.position[spot[-1]], (), None, False) for spot in free))


def taken_nodes(mesh: Mesh, bodies: Iterable[Body]) -> Integers:
    """Nodes that a clamp or a rigid body holds."""
    return np.unique(np.concatenate([clamped_nodes(mesh), *(body.nodes for body in bodies)]))


def body_numbers(bodies: Iterable[Body]) -> dict[str, int]:
    """Number of the body that a structure node with a reference node belongs to."""
    return {node: i for i, body in enumerate(bodies) for node in body.lumps}


def _body(structure: Structure, mesh: Mesh, group: Group) -> Body:
    nodes = [node for node in group.joints if node in mesh.reference]
    lumps = {
        node: combined(
            [*_masses(structure, node), *_cut_away(structure, mesh.joints[node])],
            np.asarray(structure.nodes[node], float),
        )
        for node in nodes
    }
    held, pinned = _hold(structure, group)
    solid = [end.nodes for end in mesh.cut_ends if end.node in group.joints]
    references = [mesh.reference[node] for node in nodes]
    numbers = np.concatenate([group.walls, *solid, references]).astype(np.int64)
    pin = None if pinned is None else np.asarray(structure.nodes[pinned], float)
    return Body(lumps, numbers, mesh.position[numbers[-1]], held, pin, group.stretch)


def _hold(structure: Structure, group: Group) -> tuple[tuple[str, ...], str | None]:
    """Freedoms of a body that are held, and the node that is pinned."""
    held: dict[str, set[str]] = {}
    driven: dict[str, set[str]] = {}
    for support in structure.supports.values():
        if support.node in group.joints:
            held.setdefault(support.node, set()).update(support.held)
            driven.setdefault(support.node, set()).update(support.driven)
    if not held:
        return (), None
    if group.stretch:
        if any(freedoms == set(FREEDOMS) for freedoms in held.values()) and not any(driven.values()):
            return FREEDOMS, None
        _refuse_hold(structure, group, held, driven)
    node = next(iter(held))
    kept = tuple(freedom for freedom in FREEDOMS if freedom in held[node])
    pinned = held[node] >= TRANSLATIONS and not held[node] >= ROTATIONS and not driven[node]
    return kept, node if pinned else None


def _refuse_hold(
    structure: Structure, group: Group, held: dict[str, set[str]], driven: dict[str, set[str]]
) -> None:
    """Refuse supports that hold a rigid part elsewhere than at its centre of mass or one pin."""
    what, came = "", ""
    if len(held) > 1:
        what, came = "a rigid part is held at several nodes", ", ".join(held)
    else:
        ((node, fixed),) = held.items()
        moving = TRANSLATIONS & (fixed | driven[node])
        pinned = moving <= fixed and moving == TRANSLATIONS and not driven[node]
        if moving and not fixed >= ROTATIONS and not pinned:
            what, came = "a rigid part is held or driven at a node in some directions only", node
    if what:
        name = next(name for name, support in structure.supports.items() if support.node in held)
        allowed = "one node: all, pin, rotations only, or directions together with all rotations"
        todo = "use one of these supports, or let the part next to the support deform"
        raise InputError(
            Problem(
                f"{what}, which the shell solver cannot represent", came, allowed, todo, f"supports.{name}"
            )
        )


def moved(body: Body, before: Floats, now: Floats, row: Floats) -> Body:
    """Body where its rigid set is now: its lumps move and turn with it.

    Parameters
    ----------
    body
        As it was at the start.
    before, now
        Position of its last node at the start and now [m], (3,).
    row
        Of the stepper's rigid sets: centre of mass [m], velocity, angular velocity, rotation by rows, (18,).
    """
    turn = row[9:].reshape(3, 3)
    lumps = {
        node: Lump(lump.mass, now + turn @ (lump.centre - before), turn @ lump.inertia @ turn.T)
        for node, lump in body.lumps.items()
    }
    return replace(body, lumps=lumps, place=now)


def combined(lumps: Iterable[Lump], place: Floats) -> Lump:
    """One lump of several (parallel axes); where there is no mass its centre is the given place."""
    parts = list(lumps)
    mass = sum(part.mass for part in parts)
    moment = np.sum([part.mass * part.centre for part in parts], axis=0) if parts else np.zeros(3)
    centre = moment / mass if mass > 0.0 else place
    inertia = np.zeros((3, 3))
    for part in parts:
        arm = part.centre - centre
        inertia = inertia + part.inertia + part.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return Lump(mass, centre, inertia)


def _masses(structure: Structure, node: str) -> Iterable[Lump]:
    for mass in structure.masses.values():
        if mass.node == node:
            centre = np.asarray(structure.nodes[node], float) + np.asarray(mass.offset)
            yield Lump(mass.mass, centre, np.diag(mass.rotary_inertia).astype(float))


def _cut_away(structure: Structure, joint: Joint) -> Iterable[Lump]:
    """Pieces of members between a joint's node and their first ring: uniform bars."""
    for end, length in zip(joint.ends, joint.cut, strict=True):
        if length <= 0.0:
            continue
        frame, section = structure.frame_of(end.member), structure.section_of(end.member)
        density = structure.material_of(end.member).density
        mass = section.mass_per_length(density) * length
        about_y, about_z = (density * length * section.second_moment(axis) for axis in ("y", "z"))
        bar = mass * length**2 / 12
        local = np.diag([about_y + about_z, bar + about_y, bar + about_z])
        station = frame.length - length / 2 if end.second else length / 2
        yield Lump(mass, frame.position(station), frame.axes.T @ local @ frame.axes)
