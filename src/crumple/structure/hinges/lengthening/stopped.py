"""Structures that come to a stop at the start if their members keep their lengths.

Take the pinned framework (framework) with the masses of its nodes, and of obstacles that move along a guide.
What moves at the start, and what obstacles meet, is a plastic impact: of all motions q that keep the lengths
and do not enter the obstacles, the bodies take that which is nearest in energy to the given one, v,

    (q - v)' M (q - v) -> min,      R q = 0,   n . q_node = n . q_obstacle,

and lose the energy (q - v)' M (q - v)/2.  If that is more than `LOST` of all there is, members must shorten:
in shells they fold, while members of fixed length would pass any force on in no time.
Limits: a node that is met stays in contact; hinges have no moment; a mass that is met itself is lost in any
case.
"""

from __future__ import annotations

import math

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.hinges.corners import leaving
from crumple.structure.hinges.lengthening.at_start import approaches, nodes_at_start, obstacle_at_start
from crumple.structure.hinges.lengthening.framework import BED, Framework, Row, framework, on_a_bed
from crumple.structure.hinges.lengthening.nodes_met import nodes_met
from crumple.structure.parts import StructureParts

ALONG = math.radians(60.0)
"""Angle of a member to the normal of what meets its end within which it is pressed along its axis."""
LOST = 0.25
"""Share of the energy that shows that lengths cannot stay."""
THROWN = 0.015
"""The same of what is lost because masses are thrown along members that lead to the ground or to others."""
LIGHT = 1e-2
"""Share of the masses of members that counts there: what they take, they take without being pressed."""
HEAVY = 1e3
"""Mass of an obstacle whose motion is prescribed, over that of the structure."""


def stopped(structure: StructureParts) -> bool:
    """Whether an impact at the start takes more than `LOST` of the energy if members keep their lengths.

    Or more than `THROWN`, without what obstacles and the masses of members take.
    """
    return structure.kept.once("stopped", "", lambda: _stopped(structure))


def _stopped(structure: StructureParts) -> bool:
    return lost_share(structure) > LOST or lost_share(structure, met=False) > THROWN


def presses(structure: StructureParts) -> bool:
    """Whether an obstacle meets a node from which a member leads away within `ALONG` of the blow."""
    return structure.kept.once("presses", "", lambda: _presses(structure))


def _presses(structure: StructureParts) -> bool:
    for obstacle in structure.obstacles.values():
        for node, outwards in nodes_met(structure, obstacle):
            members = (name for name in structure.members_at[node] if structure.is_whole(name))
            along = max(float(leaving(structure, name, node) @ outwards) for name in members)
            if along > math.cos(ALONG) and approaches(structure, obstacle, node, outwards):
                return True
    return False


def lost_share(structure: StructureParts, *, met: bool = True) -> float:
    """Share of the energy at the start that is lost if all members keep their lengths [-]; 0 without any.

    `met`: with what obstacles meet at the start; else without the masses of members, too. Also 0 for a
    structure with mistakes, of which no mass is known at some node.
    """
    pinned, moving = framework(structure), nodes_at_start(structure, 1.0 if met else LIGHT)
    if not moving or not pinned.free.keys() <= moving.keys():
        return 0.0
    total = sum(mass for mass, _ in moving.values())
    weights = [math.sqrt(moving[node][0]) for node, free in pinned.free.items() for _ in free]
    speeds = [part for node, free in pinned.free.items() for part in free @ moving[node][1]]
    rows = list(pinned.rows)
    for obstacle in structure.obstacles.values() if met else ():
        motion, mass = obstacle_at_start(obstacle, HEAVY * total)
        speed = float(np.linalg.norm(motion))
        carrier = (len(weights), motion / speed if speed > 0.0 else motion) if mass > 0.0 else None
        if carrier is not None:
            weights, speeds = [*weights, math.sqrt(mass)], [*speeds, speed]
        for node, outwards in nodes_met(structure, obstacle):
            if (moving[node][1] - motion) @ outwards < 0.0:
                rows.append(_contact(pinned, node, outwards, carrier))
    # unknowns are displacements times the root of their mass
    roots = np.array(weights)
    before = roots * np.array(speeds)
    energy = float(before @ before)
    if energy == 0.0:
        return 0.0
    # what a row holds does not depend on its length
    scaled = [(row / roots[places], places) for row, places in rows]
    scaled = [(row / np.linalg.norm(row), places) for row, places in scaled if row.any()]
    lost = before - BED * on_a_bed(scaled, before)
    return float(lost @ lost) / energy


def _contact(pinned: Framework, node: str, outwards: Floats, obstacle: tuple[int, Floats] | None) -> Row:
    """Row of a node and an obstacle that touch: they move alike along the normal."""
    row, places = pinned.free[node] @ outwards, pinned.places(node)
    if obstacle is None:
        return row, places
    place, guide = obstacle
    return np.append(row, -float(guide @ outwards)), [*places, place]
