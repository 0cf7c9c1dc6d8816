"""Initial motion: velocity fields on walls and lumps, impulses, and the resulting motion of rigid bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.shell.mesh.mesh import Mesh
from crumple.shell.mesh.quality import areas, wall_density, wall_metals, wall_thickness
from crumple.shell.model.bodies import Body
from crumple.structure import InitialVelocity, Structure
from crumple.structure.initial_fields import fields_of_mass, fields_of_member


@dataclass(frozen=True, eq=False)
class InitialMotion:
    """Motion at the start.

    Attributes
    ----------
    velocity, spin
        Of every node [m/s], [rad/s], (n, 3).
    given_energy
        Kinetic energy of the described fields [J], of everything that has mass.
    """

    velocity: Floats
    spin: Floats
    given_energy: float


def shell_initial_motion(structure: Structure, mesh: Mesh, bodies: tuple[Body, ...]) -> InitialMotion:
    """Velocities at the start.

    Parameters
    ----------
    structure, mesh
        What is computed.
    bodies
        Rigid bodies at the nodes; each takes the momentum of its parts and the impulses on its node.
    """
    mass, inertia = nodal_masses(structure, mesh)
    velocity, spin = np.zeros((len(mesh.position), 3)), np.zeros((len(mesh.position), 3))
    given = structure.initial_velocity
    # a node that two members share moves with the first
    for name, tube in reversed(mesh.tubes.items()):
        nodes = tube.nodes.reshape(-1)
        velocity[nodes], spin[nodes] = _motion(fields_of_member(given, name), mesh.position[nodes])
    energy = float((mass * (velocity**2).sum(axis=1) + inertia * (spin**2).sum(axis=1)).sum()) / 2
    for body in bodies:
        for node, lump in body.lumps.items():
            lump_velocity, lump_spin = _motion(fields_of_mass(structure, given, node), lump.centre[None])
            energy += lump.energy(lump_velocity[0], lump_spin[0])
        centre, v, w = _rigid_motion(structure, mesh, body, (mass, inertia), (velocity, spin))
        nodes = body.nodes
        velocity[nodes] = v + np.cross(w, mesh.position[nodes] - centre)
        spin[nodes] = w
    return InitialMotion(velocity, spin, energy)


def nodal_masses(structure: Structure, mesh: Mesh) -> tuple[Floats, Floats]:
    """Masses [kg] and isotropic rotary inertias [kg m^2] of the nodes, (n,) each, as the stepper lumps."""
    area, thickness = areas(mesh), wall_thickness(mesh)
    three = mesh.triangles
    share = np.where(three[:, None], [1 / 3, 1 / 3, 1 / 3, 0.0], 1 / 4)
    share = share * (area * thickness * wall_density(structure, mesh))[:, None]
    gyration = (thickness**2 + np.where(three, 2.0, 1.0) * _rotary_factor(structure, mesh) * area) / 12
    mass, inertia = np.zeros(len(mesh.position)), np.zeros(len(mesh.position))
    np.add.at(mass, mesh.quads, share)
    np.add.at(inertia, mesh.quads, share * gyration[:, None])
    return mass, inertia


def _rotary_factor(structure: Structure, mesh: Mesh) -> Floats:
    """Factor on the area in the rotary inertia of elements, (m,): docs/theory/explicit_stepper.md."""
    metals, number = wall_metals(structure, mesh)
    ratio = np.array([metal.poissons_ratio for metal in metals])
    shear, plane = 5 / 6 / (2 * (1 + ratio)), 1 / (1 - ratio**2)
    return np.asarray((3 * shear / (plane - shear))[number])


def _motion(fields: Sequence[InitialVelocity], points: Floats) -> tuple[Floats, Floats]:
    """Sum of fields: velocities [m/s] and angular velocities [rad/s] at points, (n, 3) each."""
    velocity, spin = np.zeros(points.shape), np.zeros(points.shape)
    for field in fields:
        rate = _rate(field)
        velocity += np.asarray(field.translation, float) + np.cross(rate, points - np.asarray(field.about))
        spin += rate
    return velocity, spin


def _rate(field: InitialVelocity) -> Floats:
    if field.axis is None:
        return np.zeros(3)
    axis = np.asarray(field.axis, float)
    return np.asarray(field.rotation * axis / np.linalg.norm(axis))


def _rigid_motion(
    structure: Structure,
    mesh: Mesh,
    body: Body,
    masses: tuple[Floats, Floats],
    motion: tuple[Floats, Floats],
) -> tuple[Floats, Floats, Floats]:
    """Centre, velocity and angular velocity of a body with the momentum of its parts and its impulses."""
    nodes = body.nodes
    mass, inertia = (values[nodes] for values in masses)
    velocity, spin = (values[nodes] for values in motion)
    position, lumps = mesh.position[nodes], tuple(body.lumps.items())
    total = mass.sum() + sum(lump.mass for _, lump in lumps)
    moment = np.sum([mass @ position, *(lump.mass * lump.centre for _, lump in lumps)], axis=0)
    centre = moment / total
    arm = position - centre
    momentum, tensor = mass @ velocity, inertia.sum() * np.eye(3) + _about(mass, arm)
    angular = np.cross(arm, mass[:, None] * velocity).sum(axis=0) + inertia @ spin
    for node, lump in lumps:
        fields = fields_of_mass(structure, structure.initial_velocity, node)
        ((v,), (w,)) = _motion(fields, lump.centre[None])
        arm = lump.centre - centre
        momentum = momentum + lump.mass * v
        angular = angular + np.cross(arm, lump.mass * v) + lump.inertia @ w
        tensor = tensor + lump.inertia + _about(np.array([lump.mass]), arm[None])
    for given in structure.impulses:
        if given.node in body.lumps:
            impulse = np.asarray(given.impulse, float)
            momentum = momentum + impulse
            angular = angular + np.asarray(given.angular_impulse, float)
            angular = angular + np.cross(mesh.position[mesh.reference[given.node]] - centre, impulse)
    return centre, momentum / total, np.linalg.solve(tensor, angular)


def _about(mass: Floats, arm: Floats) -> Floats:
    """Inertia tensor of points [kg m^2], (3, 3)."""
    squares = (mass * (arm**2).sum(axis=1)).sum() * np.eye(3)
    return np.asarray(squares - np.einsum("n,ni,nj->ij", mass, arm, arm))
