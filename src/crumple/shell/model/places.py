"""Where hinges are measured on a mesh: the sections on both sides, the stretch between, the cut in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from crumple.numeric.arrays import Floats, Integers
from crumple.section import half_fold_length
from crumple.shell.mesh.mesh import Mesh
from crumple.shell.model.bodies import Body
from crumple.structure import HingePlace, Structure, hinge_places

SIDE = 3.0
"""Distance of the measured sections from a hinge over half the fold's length: the fold reaches 1 to both
sides, and the walls need as much again to be plane sections."""


@dataclass(frozen=True, eq=False)
class HingeZone:
    """The range of a member that represents a hinge.

    Attributes
    ----------
    place
        The hinge as described.
    direction
        Unit vector of its axis at the start, (3,).
    position
        Where it lies at the start [m], (3,).
    first, last
        Rings of its two measured sections.
    length
        Distance of the two along the member [m].
    elements
        Elements between them.
    stiffness
        Bending stiffness of the stretch, E I / length [N m/rad].
    cut_elements, cut_nodes
        The cut at the hinge: the section nearest to it, and the elements on its second side.
    """

    place: HingePlace
    direction: Floats
    position: Floats
    first: int
    last: int
    length: float
    elements: Integers
    stiffness: float
    cut_elements: Integers
    cut_nodes: Integers


def hinge_zones(structure: Structure, mesh: Mesh) -> tuple[HingeZone, ...]:
    """Zone of every hinge of the structure; neighbouring zones meet halfway."""
    return tuple(
        _zone(structure, mesh, place, [other.station for other in places if other is not place])
        for places in (
            [place for place in hinge_places(structure) if place.member == member]
            for member in structure.members
        )
        for place in places
    )


def _zone(structure: Structure, mesh: Mesh, place: HingePlace, others: list[float]) -> HingeZone:
    tube = mesh.tubes[place.member]
    reach = SIDE * half_fold_length(structure.section_of(place.member), place.axis)
    low = max([place.station - reach, *((place.station + s) / 2 for s in others if s < place.station)])
    high = min([place.station + reach, *((place.station + s) / 2 for s in others if s > place.station)])
    first, last = tube.ring_at(low), tube.ring_at(high)
    # at least one bay
    if last == first:
        first, last = (first, last + 1) if last + 1 < len(tube.stations) else (first - 1, last)
    length = float(tube.stations[last] - tube.stations[first])
    at = min(max(tube.ring_at(place.station), first), last - 1)
    return HingeZone(
        place=place,
        direction=tube.frame.axis(place.axis),
        position=tube.frame.position(place.station),
        first=first,
        last=last,
        length=length,
        elements=tube.elements_between(first, last),
        stiffness=structure.flexural_rigidity(place.member, place.axis) / length,
        cut_elements=tube.bay(at),
        cut_nodes=np.asarray(tube.nodes[at]),
    )


@dataclass(frozen=True, eq=False)
class SupportCut:
    """What acts on the sections at a supported node, or on the rigid part that they belong to.

    Attributes
    ----------
    elements, nodes
        The cut: elements, and the nodes on which they act.
    about
        Of a rigid part: the node [m], (3,), for the moments; None: about the cut's middle.
    stays
        Whether that place is held.
    """

    elements: Integers
    nodes: Integers
    about: Floats | None = None
    stays: bool = False


def support_cut(
    structure: Structure, mesh: Mesh, bodies: tuple[Body, ...], rigid: NDArray[np.bool_], node: str
) -> SupportCut:
    """Cut of a support's node; `rigid`: for every element whether it is in a rigid part."""
    ends = mesh.joints[node].ends
    nodes = np.unique(np.concatenate([mesh.end_ring(end.member, end.second) for end in ends]))
    part = next((body for body in bodies if body.stretch and np.isin(nodes, body.nodes).any()), None)
    if part is not None:
        nodes = np.union1d(nodes, part.nodes[np.isin(part.nodes, mesh.quads)])
        acting = np.flatnonzero(np.isin(mesh.quads, nodes).any(axis=1) & ~rigid)
        stays = {"x", "y", "z"} <= set(part.held)
        return SupportCut(acting, nodes, np.asarray(structure.nodes[node], float), stays)
    bays = [
        mesh.tubes[end.member].bay(mesh.tubes[end.member].last_ring - 1 if end.second else 0) for end in ends
    ]
    return SupportCut(np.concatenate(bays), nodes)
