"""Structures that come to a stop at the start if their members keep their lengths.

Take the pinned framework (framework) with the masses of its nodes, and of obstacles that move along a guide.
What moves at the start, and what obstacles meet, is a plastic impact: of all motions q that keep the lengths
and do not enter the obstacles, the bodies take that which is nearest in energy to the given one, v,

    (q - v)' M (q - v) -> min,      R q = 0,   n . q_node = n . q_obstacle,

and lose the energy (q - v)' M (q - v)/2.  If that is more than `LOST` of all there is, members must shorten:
in shells they fold, while members of fixed length would pass any force on in no time.
A plane meets the nodes from which no member leads towards it by more than `FLAT`; other obstacles, and the
edge of a plane, meet the nodes that are nearest to them.  Limits: a node that is met stays in contact; hinges
have no moment; a mass that is met itself is lost in any case.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.hinges.corners import is_whole, leaving
from crumple.structure.hinges.lengthening.framework import BED, Framework, Row, framework, on_a_bed
from crumple.structure.keys.motion import InitialVelocity
from crumple.structure.keys.obstacles import Obstacle, PlaneObstacle, gap
from crumple.structure.parts import StructureParts
from crumple.structure.struck_places import LEAST, PLACES, axis_gaps, first_displacement

FLAT = math.radians(25.0)
"""Angle by which members at a node may lead towards a plane that meets it."""
ALONG = math.radians(60.0)
"""Angle of a member to the normal of what meets its end within which it is pressed along its axis."""
LOST = 0.25
"""Share of the energy that shows that lengths cannot stay."""
HEAVY = 1e3
"""Mass of an obstacle whose motion is prescribed, over that of the structure."""


def stopped(structure: StructureParts) -> bool:
    """Whether an impact at the start takes more than `LOST` of the energy if members keep their lengths."""
    return structure.kept.once("stopped", "", lambda: lost_share(structure) > LOST)


def presses(structure: StructureParts) -> bool:
    """Whether an obstacle meets a node from which a member leads away within `ALONG` of the blow."""
    return structure.kept.once("presses", "", lambda: _presses(structure))


def _presses(structure: StructureParts) -> bool:
    moving = _start(structure)
    for obstacle in structure.obstacles.values():
        motion, _ = _motion(obstacle, 1.0)
        for node in nodes_met(structure, obstacle):
            outwards = _outwards(obstacle, np.asarray(structure.nodes[node], float))
            members = (name for name in structure.members_at[node] if is_whole(structure, name))
            along = max(float(leaving(structure, name, node) @ outwards) for name in members)
            if along > math.cos(ALONG) and (moving[node][1] - motion) @ outwards < 0.0:
                return True
    return False


def lost_share(structure: StructureParts) -> float:
    """Share of the energy at the start that is lost if all members keep their lengths [-]; 0 without any.

    Also 0 for a structure with mistakes, of which no mass is known at some node.
    """
    pinned, moving = framework(structure), _start(structure)
    if not moving or not pinned.free.keys() <= moving.keys():
        return 0.0
    total = sum(mass for mass, _ in moving.values())
    weights = [math.sqrt(moving[node][0]) for node, free in pinned.free.items() for _ in free]
    speeds = [part for node, free in pinned.free.items() for part in free @ moving[node][1]]
    rows = list(pinned.rows)
    for obstacle in structure.obstacles.values():
        motion, mass = _motion(obstacle, HEAVY * total)
        speed = float(np.linalg.norm(motion))
        carrier = (len(weights), motion / speed if speed > 0.0 else motion) if mass > 0.0 else None
        if carrier is not None:
            weights, speeds = [*weights, math.sqrt(mass)], [*speeds, speed]
        for node in nodes_met(structure, obstacle):
            outwards = _outwards(obstacle, np.asarray(structure.nodes[node], float))
            if (moving[node][1] - motion) @ outwards < 0.0:
                rows.append(_contact(pinned, node, outwards, carrier))
    # unknowns are displacements times the root of their mass
    roots = np.array(weights)
    before = roots * np.array(speeds)
    energy = float(before @ before)
    if energy == 0.0:
        return 0.0
    typical = math.sqrt(total / len(moving))
    scaled = [(row * typical / roots[places], places) for row, places in rows]
    lost = before - BED * on_a_bed(scaled, before)
    return float(lost @ lost) / energy


def nodes_met(structure: StructureParts, obstacle: Obstacle) -> Iterator[str]:
    """Nodes that an obstacle meets first, without those that supports hold or drive."""
    wanted = obstacle.members or structure.members
    names = [name for name in wanted if name in structure.members and is_whole(structure, name)]
    if isinstance(obstacle, PlaneObstacle) and obstacle.edge is None:
        normal = np.asarray(obstacle.normal, float) / np.linalg.norm(obstacle.normal)
        for node, members in structure.members_at.items():
            away = [float(leaving(structure, name, node) @ normal) for name in members if name in names]
            if away and min(away) >= -math.sin(FLAT) and not structure.supports_at.get(node):
                yield node
        return
    if not names:
        return
    gaps = axis_gaps(structure, obstacle, names)
    nearest = np.argwhere(gaps <= gaps.min() + LEAST)
    ends = [(names[which], PLACES[place]) for which, place in nearest if PLACES[place] in (0.0, 1.0)]
    found = dict.fromkeys(structure.members[name].nodes[int(end)] for name, end in ends)
    yield from (node for node in found if not structure.supports_at.get(node))


def _contact(pinned: Framework, node: str, outwards: Floats, obstacle: tuple[int, Floats] | None) -> Row:
    """Row of a node and an obstacle that touch: they move alike along the normal."""
    row, places = pinned.free[node] @ outwards, pinned.places(node)
    if obstacle is None:
        return row, places
    place, guide = obstacle
    return np.append(row, -float(guide @ outwards)), [*places, place]


def _motion(obstacle: Obstacle, heavy: float) -> tuple[Floats, float]:
    """Velocity of an obstacle at the start [m/s], (3,), and its mass [kg]; 0: it stands still."""
    guide = obstacle.guide_direction
    if guide is not None:
        return guide * float(np.asarray(obstacle.velocity, float) @ guide), float(obstacle.mass or 0.0)
    if not obstacle.driven:
        return np.zeros(3), 0.0
    velocity = np.asarray(obstacle.velocity, float)
    return (velocity if velocity.any() else first_displacement(obstacle)), heavy


def _outwards(obstacle: Obstacle, point: Floats) -> Floats:
    """Unit vector from an obstacle to a point: the gradient of its distance."""
    ahead = gap(obstacle, point + LEAST * np.eye(3)) - gap(obstacle, point - LEAST * np.eye(3))
    size = float(np.linalg.norm(ahead))
    return ahead / size if size > 0.0 else np.zeros(3)


def _start(structure: StructureParts) -> dict[str, tuple[float, Floats]]:
    """Mass [kg] and velocity [m/s] of every node, with half of its members."""
    parts: dict[str, list[tuple[float, Floats]]] = {}

    def add(node: str, mass: float, kind: str, name: str) -> None:
        point = np.asarray(structure.nodes[node], float)
        acting = (field.at(point) for field in structure.initial_velocity if _acts(field, kind, name))
        parts.setdefault(node, []).append((mass, sum(acting, np.zeros(3))))

    for name, spec in structure.members.items():
        if is_whole(structure, name):
            density = structure.material_of(name).density
            half = structure.section_of(name).mass_per_length(density) * structure.frame_of(name).length / 2.0
            for node in spec.nodes:
                add(node, half, "members", name)
    for lump in structure.masses.values():
        if lump.node in parts:
            add(lump.node, float(lump.mass), "nodes", lump.node)
    found = {}
    for node, moving in parts.items():
        mass = sum(own for own, _ in moving)
        found[node] = (mass, sum((own * velocity for own, velocity in moving), np.zeros(3)) / mass)
    return found


def _acts(field: InitialVelocity, kind: str, name: str) -> bool:
    """Whether a velocity field is that of a part."""
    everywhere = field.nodes is None and field.members is None
    return everywhere or name in (getattr(field, kind) or ())
