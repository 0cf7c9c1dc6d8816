"""Motion at the start: velocity fields, as momentum of the rigid bodies, and impulses on them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from crumple.errors import InputError, Problem
from crumple.multibody.bodies.assembly import Piece
from crumple.multibody.bodies.linkage import GROUND, Linkage
from crumple.multibody.bodies.rigid import RigidMass, lump_mass, piece_mass
from crumple.numeric.arrays import Floats
from crumple.numeric.rotation import turned
from crumple.structure import InitialVelocity, NodalImpulse, Structure, member_hinge_places
from crumple.structure.geometry import cross
from crumple.structure.initial_fields import fields_of_mass, fields_of_member

ALONG = 0.05
"""Share of the largest given speed from which the ends of a member part along it."""
FASTEST = 1e5
"""Speed [m/s] up to which an impulse may accelerate a part before joints slow it down."""


class Parts(Protocol):
    """Bodies of a structure: the body of every piece of a member and of every node."""

    @property
    def pieces(self) -> Mapping[str, tuple[Piece, ...]]:
        """Pieces by member."""

    @property
    def node_body(self) -> Mapping[str, int]:
        """Bodies by node."""


@dataclass(frozen=True, eq=False)
class InitialMotion:
    """Motion at the start.

    Attributes
    ----------
    velocity
        Twists of the bodies at their centres: (rotation, x, y) in a plane, (bodies, 3), or (rotation,
        translation) in space, (bodies, 6).
    impulse
        Impulses on the bodies at their centres, of the same shape.
    given_energy
        Energy of the described velocity field [J], of every part that has mass, ground parts included.
    """

    velocity: Floats
    impulse: Floats
    given_energy: float


@dataclass(frozen=True, eq=False)
class Placed:
    """Positions of the bodies in space.

    Attributes
    ----------
    centre
        Centres of mass [m], (bodies, 3).
    quaternion
        Rotations since the start, (bodies, 4); None: none.
    """

    centre: Floats
    quaternion: Floats | None

    def turned(self, body: int, vector: Floats) -> Floats:
        """A vector, (3,), or the rows of a matrix, rotated with a body."""
        return vector if self.quaternion is None else turned(self.quaternion[body], vector)

    def tensor(self, body: int, tensor: Floats) -> Floats:
        """A symmetric tensor, (3, 3), rotated with a body."""
        return tensor if self.quaternion is None else self.turned(body, self.turned(body, tensor).T)


def spatial_initial_motion(
    structure: Structure,
    linkage: Linkage,
    fields: Sequence[InitialVelocity],
    impulses: Sequence[NodalImpulse],
    now: Placed | None = None,
) -> InitialMotion:
    """Velocities and impulses of bodies in space, gathered as momentum of every body.

    `now` is where the bodies have come to; None: where they start.
    """
    n = len(linkage.bodies)
    place = now or Placed(np.array([body.centre for body in linkage.bodies]).reshape(n, 3), None)
    spin, momentum, impulse = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 6))
    energy = 0.0
    for part, body, acting in moving_parts(structure, linkage, fields):
        if part.mass == 0.0:
            continue
        centre, inertia = part.centre, part.inertia
        if body != GROUND:
            arm = place.turned(body, part.centre - linkage.bodies[body].centre)
            centre, inertia = place.centre[body] + arm, place.tensor(body, part.inertia)
        velocity, rate = motion_of(acting, centre)
        energy += float(part.mass * velocity @ velocity + rate @ inertia @ rate) / 2
        if body != GROUND:
            momentum[body] += part.mass * velocity
            spin[body] += inertia @ rate + cross(arm, part.mass * velocity)
    for given in impulses:
        body = linkage.node_body[given.node]
        if body != GROUND:
            arm = place.turned(body, np.asarray(structure.nodes[given.node]) - linkage.bodies[body].centre)
            linear = np.asarray(given.impulse, float)
            impulse[body, :3] += np.asarray(given.angular_impulse, float) + cross(arm, linear)
            impulse[body, 3:] += linear
    twists = [
        np.concatenate([np.linalg.solve(place.tensor(i, body.inertia), spin[i]), momentum[i] / body.mass])
        for i, body in enumerate(linkage.bodies)
    ]
    velocity = np.array(twists).reshape(n, 6)
    masses = np.array([body.mass for body in linkage.bodies])
    refuse_speeding(velocity[:, 3:], impulse[:, 3:], masses)
    return InitialMotion(velocity, impulse, energy)


def stretched(structure: Structure, fields: Sequence[InitialVelocity]) -> dict[str, float]:
    """Members that keep their length although the given motion changes it, and its rates [m/s].

    Only between ends whose velocities are given: of masses, and of supports that hold all translations.
    """
    moved = {
        node: motion_of(fields_of_mass(structure, fields, node), np.asarray(place, float))[0]
        for node, place in structure.nodes.items()
        if structure.masses_at.get(node)
    }
    for support in structure.supports.values():
        if {"x", "y", "z"} <= set(support.held):
            moved[support.node] = np.zeros(3)
    fastest = max((float(np.linalg.norm(velocity)) for velocity in moved.values()), default=0.0)
    found = {}
    for name, spec in structure.members.items():
        first, second = (moved.get(node) for node in spec.nodes)
        lengthens = any(place.keys.axial is not None for place in member_hinge_places(structure, name))
        if first is None or second is None or lengthens:
            continue
        rate = float((second - first) @ structure.frame_of(name).x)
        if abs(rate) > ALONG * fastest:
            found[name] = rate
    return found


def refuse_speeding(velocity: Floats, impulse: Floats, mass: Floats) -> None:
    """Refuse impulses that accelerate a part so much that its motion could not be followed to the end."""
    speed = np.linalg.norm(velocity + impulse / mass[:, None], axis=1)
    if speed.size and float(speed.max()) > FASTEST:
        part = float(mass[speed.argmax()])
        what = f"the impulses accelerate a part of {part:.3g} kg to {float(speed.max()):.3g} m/s"
        todo = "use smaller impulses, or more mass at their nodes"
        raise InputError(Problem(what, "", f"at most {FASTEST:g} m/s", todo, "impulses"))


def moving_parts(
    structure: Structure, parts: Parts, given: Sequence[InitialVelocity]
) -> Iterator[tuple[RigidMass, int, list[InitialVelocity]]]:
    """Every part with mass, its body, and the velocity fields that act on it."""
    for name, pieces in parts.pieces.items():
        if found := fields_of_member(given, name):
            for piece in pieces:
                yield piece_mass(structure, name, piece.start, piece.end), piece.body, found
    for mass in structure.masses.values():
        if found := fields_of_mass(structure, given, mass.node):
            yield lump_mass(structure, mass), parts.node_body[mass.node], found


def motion_of(fields: Sequence[InitialVelocity], point: Floats) -> tuple[Floats, Floats]:
    """Velocity [m/s] at a point and angular velocity [rad/s] of the sum of several fields, (3,) each."""
    velocity, rate = np.zeros(3), np.zeros(3)
    for field in fields:
        velocity += field.at(point)
        rate += field.rate
    return velocity, rate
