"""What moves at the start: nodes with the masses of their members, and obstacles."""

from __future__ import annotations

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.initial_fields import fields_of_mass, fields_of_member
from crumple.structure.keys.motion import InitialVelocity
from crumple.structure.keys.obstacles import Obstacle
from crumple.structure.parts import StructureParts
from crumple.structure.struck_places import first_displacement


def nodes_at_start(structure: StructureParts, share: float = 1.0) -> dict[str, tuple[float, Floats]]:
    """Mass [kg] and velocity [m/s] of every node, with half of its members, times `share`."""
    parts: dict[str, list[tuple[float, Floats]]] = {}

    def add(node: str, mass: float, fields: list[InitialVelocity]) -> None:
        point = np.asarray(structure.nodes[node], float)
        acting = (field.at(point) for field in fields)
        parts.setdefault(node, []).append((mass, sum(acting, np.zeros(3))))

    for name, spec in structure.members.items():
        if structure.is_whole(name):
            density = structure.material_of(name).density
            mass = structure.section_of(name).mass_per_length(density) * structure.frame_of(name).length
            half = share * mass / 2.0
            fields = fields_of_member(structure.initial_velocity, name)
            for node in spec.nodes:
                add(node, half, fields)
    for lump in structure.masses.values():
        if lump.node in parts:
            fields = fields_of_mass(structure, structure.initial_velocity, lump.node)
            add(lump.node, float(lump.mass), fields)
    found = {}
    for node, moving in parts.items():
        mass = sum(own for own, _ in moving)
        found[node] = (mass, sum((own * velocity for own, velocity in moving), np.zeros(3)) / mass)
    return found


def obstacle_at_start(obstacle: Obstacle, heavy: float) -> tuple[Floats, float]:
    """Velocity of an obstacle at the start [m/s], (3,), and its mass [kg]; 0: it stands still."""
    guide = obstacle.guide_direction
    if guide is not None:
        return guide * float(np.asarray(obstacle.velocity, float) @ guide), float(obstacle.mass or 0.0)
    if not obstacle.driven:
        return np.zeros(3), 0.0
    velocity = np.asarray(obstacle.velocity, float)
    return (velocity if velocity.any() else first_displacement(obstacle)), heavy


def momentum_at_start(structure: StructureParts) -> Floats:
    """Momentum of the nodes relative to the fastest obstacle [kg m/s], (3,)."""
    moving = nodes_at_start(structure)
    struck = [obstacle_at_start(obstacle, 1.0)[0] for obstacle in structure.obstacles.values()]
    fastest = max(struck, key=lambda motion: float(motion @ motion), default=np.zeros(3))
    return sum((mass * (velocity - fastest) for mass, velocity in moving.values()), np.zeros(3))


def approaches(structure: StructureParts, obstacle: Obstacle, node: str, outwards: Floats) -> bool:
    """Whether a node and an obstacle approach each other at the start, along the unit vector between them.

    A node that has no velocity of its own is moved by the others.
    """
    motion, _ = obstacle_at_start(obstacle, 1.0)
    velocity = nodes_at_start(structure)[node][1] - motion
    return float((velocity if velocity.any() else momentum_at_start(structure)) @ outwards) < 0.0
