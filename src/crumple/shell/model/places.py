"""Where hinges are measured on a mesh: the sections on both sides, the stretch between, the cut in it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from crumple.numeric.arrays import Floats, Integers
from crumple.section import AXES, half_fold_length
from crumple.shell.mesh.mesh import Mesh
from crumple.shell.model.bodies import Body
from crumple.structure import Frame, HingePlace, Structure, hinge_places
from crumple.structure.hinges.corner_laws import corner_of, turned_corner
from crumple.structure.hinges.corners import Corner

SIDE = 3.0
"""Distance of the measured sections from a hinge over half the fold's length: the fold reaches 1 to both
sides, and the walls need as much again to be plane sections."""


Stations = Mapping[str, Mapping[str, float]]
"""Of hinges by name [m], by the members whose walls represent them."""


class Span(NamedTuple):
    """Rings between which a part of one member represents a hinge."""

    member: str
    first: int
    last: int


@dataclass(frozen=True, eq=False)
class HingeZone:
    """The walls that represent a hinge: a range of its member, at a corner also one of the other member.

    Attributes
    ----------
    place
        The hinge as described.
    direction
        Unit vector of its axis at the start, (3,); of one with several axes, of the first that bends.
    position
        Where it lies at the start [m], (3,).
    spans
        Ranges of members: one, or at a corner two, the hinge's own member first.
    first, last
        Member and ring of its two measured sections.
    elements
        Elements between them.
    stiffness
        Bending stiffness of the ranges in series about `direction`, E I / length of each [N m/rad].
    axes
        Its x, y and z at the start as rows, (3, 3).
    turns
        Rows of the axes that it turns about, in their order.
    flexibility
        Elastic rotation about each axis over the moment about each, of all its ranges [rad/(N m)], (3, 3);
        zeros of a hinge about one axis.
    cut_elements, cut_nodes
        The cut at the hinge: the section nearest to it, and the elements on its second side.
    """

    place: HingePlace
    direction: Floats
    position: Floats
    spans: tuple[Span, ...]
    first: tuple[str, int]
    last: tuple[str, int]
    elements: Integers
    stiffness: float
    axes: Floats
    turns: tuple[int, ...]
    flexibility: Floats
    cut_elements: Integers
    cut_nodes: Integers


def hinge_zones(structure: Structure, mesh: Mesh) -> tuple[HingeZone, ...]:
    """Zone of every hinge of the structure; neighbouring zones meet halfway."""
    places = hinge_places(structure)
    # the hinge of a corner stands for both of its members
    corners = {
        place.name: corner for place in places if (corner := corner_of(structure, place.name)) is not None
    }
    stations: dict[str, dict[str, float]] = defaultdict(dict)
    for place in places:
        stations[place.member][place.name] = place.station
    for name, corner in corners.items():
        stations[corner.second][name] = _end_of(structure, corner)
    return tuple(
        _zone(structure, mesh, place, corners.get(place.name), stations)
        for member in structure.members
        for place in places
        if place.member == member
    )


def _end_of(structure: Structure, corner: Corner) -> float:
    """Station of a corner in its second member [m]."""
    starts = structure.members[corner.second].nodes[0] == corner.node
    return 0.0 if starts else structure.frame_of(corner.second).length


def _zone(
    structure: Structure, mesh: Mesh, place: HingePlace, corner: Corner | None, stations: Stations
) -> HingeZone:
    """Zone of one hinge; `corner`: the one that it stands for."""
    member, tube = place.member, mesh.tubes[place.member]
    reach = SIDE * half_fold_length(structure.section_of(member), place.axis)
    reach = reach if corner is None else corner.zone(structure)
    members = (member,) if corner is None else (member, corner.second)
    spans = tuple(_span(mesh, name, place.name, reach, stations[name]) for name in members)
    own = spans[0]
    first, last = (member, own.first), (member, own.last)
    if corner is not None:
        other = spans[1]
        far = (corner.second, other.last if _end_of(structure, corner) == 0.0 else other.first)
        # the first side is the one towards the first node of the hinge's member
        first, last = (far, last) if structure.members[member].nodes[0] == corner.node else (first, far)
    cut = min(max(tube.ring_at(place.station), own.first), own.last - 1)
    axes = _axes(structure, place, tube.frame)
    turns = tuple(sorted("xyz".index(axis) for axis in place.keys.axes or (place.axis,)))
    direction = tube.frame.axis(place.axis)
    return HingeZone(
        place=place,
        direction=direction,
        position=tube.frame.position(place.station),
        spans=spans,
        first=first,
        last=last,
        elements=np.concatenate([mesh.tubes[s.member].elements_between(s.first, s.last) for s in spans]),
        stiffness=1.0 / float(direction @ _flexibility(structure, mesh, spans, np.eye(3)) @ direction),
        axes=axes,
        turns=turns,
        flexibility=_flexibility(structure, mesh, spans, axes) if len(turns) > 1 else np.zeros((3, 3)),
        cut_elements=tube.bay(cut),
        cut_nodes=np.asarray(tube.nodes[cut]),
    )


def _length(mesh: Mesh, span: Span) -> float:
    at = mesh.tubes[span.member].stations
    return float(at[span.last] - at[span.first])


def _span(mesh: Mesh, member: str, hinge: str, reach: float, stations: Mapping[str, float]) -> Span:
    """Rings on both sides of a hinge in one member, no farther than halfway to its other hinges."""
    tube, station = mesh.tubes[member], stations[hinge]
    others = [at for name, at in stations.items() if name != hinge]
    low = max([station - reach, *((station + s) / 2 for s in others if s < station)])
    high = min([station + reach, *((station + s) / 2 for s in others if s > station)])
    first, last = tube.ring_at(low), tube.ring_at(high)
    # at least one bay
    if last == first:
        first, last = (first, last + 1) if last + 1 < len(tube.stations) else (first - 1, last)
    return Span(member, first, last)


def _axes(structure: Structure, place: HingePlace, frame: Frame) -> Floats:
    """Axes of a hinge at the start as rows, (3, 3): those of its member, or of its corner."""
    corner = turned_corner(structure, place.name, place.keys.axes)
    return frame.axes if corner is None else corner.axes(structure)


def _flexibility(structure: Structure, mesh: Mesh, spans: Sequence[Span], axes: Floats) -> Floats:
    """Elastic rotation of the ranges of a hinge over its moment, about its axes [rad/(N m)], (3, 3)."""
    total = np.zeros((3, 3))
    for span in spans:
        tube, section = mesh.tubes[span.member], structure.section_of(span.member)
        torsion = structure.material_of(span.member).shear_modulus * section.torsion_constant
        stiff = [torsion, *(structure.flexural_rigidity(span.member, axis) for axis in AXES)]
        own = axes @ tube.frame.axes.T
        total += (own * (_length(mesh, span) / np.array(stiff))) @ own.T
    return total


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
