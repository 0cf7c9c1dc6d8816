"""Braced members: none of their hinges can open unless some member changes its length.

Bar k between the nodes i and j turns in a motion q of the pinned framework (framework) so that its direction
changes by d_k = (q_j - q_i)/L_k across it.  A member is braced if in every motion that keeps all lengths

- both of its nodes stand still: what loads them changes lengths; or
- nothing turns against it: one rotation w explains what it and all that it meets at both ends do,
  w x e_k = d_k, with no more of w that a support there holds than pivots a little out of line do.  A triangle
  that is thrown is a case, and a wishbone on its two pivots.

Limits: of first order, as the framework.  Members in line that can kink at a node between them are not
braced, even in a triangle: they begin to move without stretching, or are a held run (held_runs).
Only spherical joints are taken to let members turn, which can only make fewer members braced.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.structure.hinges.lengthening.framework import (
    MOTIONS,
    STILL,
    framework_motions,
    passes_on,
    supported,
)
from crumple.structure.parts import StructureParts

OUT_OF_LINE = math.sin(math.radians(15.0))
"""Part of a rotation that supports hold of members that turn as one, up to which their pivots are in line."""
LITTLE = 1e-4
"""Weight of what supports hold: of the rotations that members leave open, the one with the least of it."""


def braced(structure: StructureParts) -> frozenset[str]:
    """Members whose hinges cannot open unless some member changes its length."""
    return structure.kept.once("braced", "", lambda: _braced(structure))


def _braced(structure: StructureParts) -> frozenset[str]:
    lines = {name: structure.frame_of(name) for name in structure.members if structure.has_line(name)}
    moved = framework_motions(structure)
    turned = {}
    for name, line in lines.items():
        first, second = structure.members[name].nodes
        apart = moved[second] - moved[first]
        turned[name] = (apart - np.outer(line.x, line.x @ apart)) / line.length
    # turns are compared as displacements over a mean length
    mean = float(np.mean([line.length for line in lines.values()])) if lines else 0.0
    turned = {name: mean * turn for name, turn in turned.items()}
    standing = {node for node, motion in moved.items() if np.abs(motion).max() <= STILL}
    return frozenset(
        name
        for name in lines
        if all(passes_on(structure, name, node) for node in structure.members[name].nodes)
        and (standing.issuperset(structure.members[name].nodes) or _unturned(structure, name, turned))
    )


def _unturned(structure: StructureParts, member: str, turned: dict[str, Floats]) -> bool:
    """Whether a member meets anything, and one rotation explains what it and all of that does."""
    nodes = structure.members[member].nodes
    met = {name for node in nodes for name in _met(structure, member, node)} & turned.keys()
    held = {axis for node in nodes for axis in supported(structure, node, "r")}
    if not (met or held):
        return False
    turning = [member, *sorted(met)]
    # w x e = -e x w
    matrix = np.concatenate([-_cross(structure.frame_of(name).x) for name in turning])
    wanted = np.concatenate([turned[name] for name in turning])
    kept = LITTLE * np.eye(3)[sorted(held)]
    rotation = np.linalg.lstsq(
        np.concatenate([matrix, kept]),
        np.concatenate([wanted, np.zeros((len(held), MOTIONS))]),
        rcond=None,
    )[0]
    against = np.linalg.norm(rotation[sorted(held)], axis=0)
    most = OUT_OF_LINE * np.linalg.norm(rotation, axis=0) + STILL
    return bool(np.abs(matrix @ rotation - wanted).max() <= STILL and (against <= most).all())


def _met(structure: StructureParts, member: str, node: str) -> Iterator[str]:
    """Other members that a member cannot turn against at a node but by hinges."""
    pinned = {joint.member for joint in structure.joints_at.get(node, ()) if joint.type == "spherical"}
    if member not in pinned:
        yield from (name for name in structure.members_at[node] if name != member and name not in pinned)


def _cross(vector: Floats) -> Floats:
    """Matrix of the cross product vector x."""
    x, y, z = vector.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
