"""Spaces that must stay free, measured on a mesh as the multibody engine measures them on bars."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats, Integers
from crumple.result.clearance import clearance
from crumple.shell.answer.sections import section_rotation
from crumple.shell.mesh.mesh import Mesh, Tube
from crumple.structure import Outputs, Structure
from crumple.structure.keys.outputs import Clearance


@dataclass(frozen=True, eq=False)
class Bar:
    """The axis of a member that must stay outside.

    Attributes
    ----------
    nodes
        Of its sections, (rings, points).
    axis
        Where the member's axis passes the sections at the start [m], (rings, 3).
    radius
        Half its section's depth or width, whichever is more [m].
    """

    nodes: Integers
    axis: Floats
    radius: float


@dataclass(frozen=True, eq=False)
class Space:
    """A plane space that a section carries along.

    Attributes
    ----------
    name
        Of the output.
    corners
        At the start [m], (n, 3).
    carrier
        Nodes of the section that carries it.
    bars
        What must stay outside.
    """

    name: str
    corners: Floats
    carrier: Integers
    bars: tuple[Bar, ...]


def spaces_of(structure: Structure, mesh: Mesh, outputs: Outputs | None) -> tuple[Space, ...]:
    """Every space whose clearance is requested."""
    asked = outputs.clearances if outputs is not None else {}
    return tuple(_space(structure, mesh, name, clearance) for name, clearance in asked.items())


def _space(structure: Structure, mesh: Mesh, name: str, asked: Clearance) -> Space:
    tube = mesh.tubes[asked.moves_with]
    others = asked.members or [member for member in structure.members if member != asked.moves_with]
    return Space(
        name=name,
        corners=np.array(asked.points, float),
        carrier=tube.nodes[tube.ring_at(tube.frame.length / 2.0)],
        bars=tuple(_bar(structure, member, mesh.tubes[member]) for member in others),
    )


def _bar(structure: Structure, member: str, tube: Tube) -> Bar:
    outline = structure.section_of(member).outer_outline()
    return Bar(
        nodes=tube.nodes,
        axis=tube.frame.position(tube.stations[:, None]),
        radius=float(np.ptp(outline, axis=0).max()) / 2.0,
    )


def clearance_now(space: Space, start: Floats, position: Floats) -> float:
    """Least distance between a space and its bars [m], negative inside; axes move with the sections' means.

    Parameters
    ----------
    space
        What is measured.
    start, position
        Nodes of the mesh at the start and now [m], (n, 3).
    """
    before, now = start[space.carrier], position[space.carrier]
    turn = section_rotation(before, now)
    corners = now.mean(axis=0) + (space.corners - before.mean(axis=0)) @ turn.T
    segments, radii = [], []
    for bar in space.bars:
        axis = bar.axis + (position[bar.nodes] - start[bar.nodes]).mean(axis=1)
        segments.append(np.stack([axis[:-1], axis[1:]], axis=1))
        radii.append(np.full(len(axis) - 1, bar.radius))
    return float(clearance(corners[None], np.concatenate(segments)[None], np.concatenate(radii))[0])
