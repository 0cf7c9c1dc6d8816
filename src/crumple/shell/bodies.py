"""Rigid bodies at the nodes: end sections, lumps, and what a joint cut away from its members."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from crumple.shell.contour import Floats, Integers
from crumple.shell.joints import Joint
from crumple.shell.mesh import Mesh
from crumple.structure import FREEDOMS, Structure


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
    node
        Structure node that it belongs to.
    nodes
        Mesh nodes that move with it, the reference node last.
    lump
        Mass that is added to theirs.
    held
        Freedoms held at zero.
    pinned
        Whether its node stays where it is, and it can turn about it.
    """

    node: str
    nodes: Integers
    lump: Lump
    held: tuple[str, ...]
    pinned: bool = False


def bodies_of(structure: Structure, mesh: Mesh) -> tuple[Body, ...]:
    """Rigid bodies in the order of the mesh's reference nodes."""
    return tuple(_body(structure, mesh, mesh.joints[node], number) for node, number in mesh.reference.items())


def _body(structure: Structure, mesh: Mesh, joint: Joint, number: int) -> Body:
    rings = [mesh.end_ring(end.member, end.second) for end in joint.ends]
    lumps = [*_masses(structure, joint.node), *_cut_away(structure, joint)]
    place = np.asarray(structure.nodes[joint.node], float)
    driven = any(support.driven for support in structure.supports.values() if support.node == joint.node)
    held = {
        freedom
        for support in structure.supports.values()
        if support.node == joint.node
        for freedom in support.held
    }
    translations, rotations = set(FREEDOMS[:3]), set(FREEDOMS[3:])
    return Body(
        joint.node,
        np.append(np.unique(np.concatenate(rings)), number),
        combined(lumps, place),
        tuple(freedom for freedom in FREEDOMS if freedom in held),
        translations <= held and not rotations <= held and not driven,
    )


def moved(body: Body, before: Floats, now: Floats, row: Floats) -> Body:
    """Body where its rigid set is now: the lump moves and turns with it.

    Parameters
    ----------
    body
        As it was at the start.
    before, now
        Position of its reference node at the start and now [m], (3,).
    row
        Of the stepper's rigid sets: centre of mass [m], velocity, angular velocity, rotation by rows, (18,).
    """
    turn, lump = row[9:].reshape(3, 3), body.lump
    centre = now + turn @ (lump.centre - before)
    return replace(body, lump=Lump(lump.mass, centre, turn @ lump.inertia @ turn.T))


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
