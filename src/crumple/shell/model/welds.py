"""Spot welds: pairs of nodes of a section's lines as small rigid bodies, and described spots that can fail.

A described spot lies anywhere between the nodes of two sheets.  Each sheet takes part with the mean of the
nodes around, whose weights are the smallest (in the sum of squares) that add up to one and have the place as
their mean: on a rectangle's corners 1/4 (1 + x_i x)(1 + y_i y) without the product of x and y, which would
drive the hourglass.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from crumple.errors import InputError, Problem
from crumple.numeric.arrays import Floats, Integers
from crumple.shell.mesh.mesh import Mesh, Tube
from crumple.shell.mesh.quality import wall_thickness
from crumple.structure import SpotWelds, Structure
from crumple.text.names import listed

LEAST_PARALLEL = np.cos(np.radians(30.0))
"""Cosine of the angle between two walls from which they lie on each other."""
LEAST_GAP = 0.05
"""Distance of two walls' mid-lines over their mean thickness, below which they lie within each other."""
BESIDE = 0.1
"""Distance along the sheets between both feet of a spot, over that across, from which it is refused: sheets
could turn about a slanted tie, as nothing in a smooth sheet holds the spin about its normal."""
SAME_SHEET = 0.5
"""Share of the sheets' distance within which a node lies in a sheet."""
REACH = 1.45
"""Radius of the nodes around a spot over the size of the element there: four at its middle, nine at a node.
Five at a node would push it against its neighbours and drive the hourglass."""
WIDER = (1.0, 1.5, 2.2)
"""Factors on that radius, of which the first serves that gives enough nodes."""
LARGEST_WEIGHT = 1.2
"""Sum of the weights' magnitudes above which a place lies outside its nodes; for a place between them it is
1."""
MOST_REFUSED = 5
"""Spots whose refusals are given one by one."""


@dataclass(frozen=True, eq=False)
class Patch:
    """Nodes of a sheet around a spot, and their weights, (k,) each."""

    nodes: Integers
    weights: Floats


@dataclass(frozen=True, eq=False)
class Spot:
    """One described spot weld.

    Attributes
    ----------
    name
        Of the entry in the structure.
    first, second
        Patches of both sheets.
    place
        Half-way between the sheets [m], (3,).
    strength
        Across and along the sheets [N]; infinite: it does not fail.
    """

    name: str
    first: Patch
    second: Patch
    place: Floats
    strength: tuple[float, float]


def weld_pairs(structure: Structure, mesh: Mesh, pitch: float | None) -> Integers:
    """Pairs of nodes that are tied rigidly where a section has lines of spots without a description, (k, 2).

    Parameters
    ----------
    structure, mesh
        What is computed.
    pitch
        Distance of the spots along a member [m]; None: one at every ring.
    """
    described = {welds.members[0] for welds in structure.spot_welds.values() if len(welds.members) == 1}
    pairs = [np.zeros((0, 2), dtype=np.int64)]
    for name, tube in mesh.tubes.items():
        if len(tube.contour.welds) and name not in described:
            rings = _rings(tube.stations, pitch)
            pairs.append(tube.nodes[rings][:, tube.contour.welds].reshape(-1, 2))
    # members that share a mitre share its spots
    return np.unique(np.sort(np.concatenate(pairs), axis=1), axis=0)


def _rings(stations: Floats, pitch: float | None) -> Integers:
    """Rings nearest to the spots, of which as many as fit lie evenly between both ends."""
    if pitch is None:
        return np.arange(len(stations))
    number = max(1, round(float(stations[-1] - stations[0]) / pitch))
    spots = stations[0] + (np.arange(number) + 0.5) * float(stations[-1] - stations[0]) / number
    return np.unique(np.abs(stations[:, None] - spots).argmin(axis=0))


def spots_of(structure: Structure, mesh: Mesh, taken: Integers) -> tuple[Spot, ...]:
    """Spots of every entry of a structure.

    Parameters
    ----------
    structure, mesh
        What is computed.
    taken
        Nodes that a clamp or a rigid body holds: they cannot be tied.

    Raises
    ------
    InputError
        If walls do not lie on each other at a spot, or too few nodes around it are free.
    """
    spots, problems = [], []
    for name, welds in structure.spot_welds.items():
        for place, elements in _places(structure, mesh, welds):
            try:
                spots.append(_spot(mesh, _Asked(name, welds, place), elements, taken))
            except InputError as error:
                problems += error.problems
    if rest := problems[MOST_REFUSED:]:
        entries = listed(dict.fromkeys(problem.where for problem in rest))
        problems = [
            *problems[:MOST_REFUSED],
            Problem(f"and {len(rest)} more spots cannot be tied", where=entries),
        ]
    if problems:
        raise InputError(problems)
    return tuple(spots)


def in_words(place: Floats) -> str:
    """A place as (x, y, z) mm."""
    # one micrometre: zero with a sign or of round-off is zero
    return f"({', '.join(f'{round(1e3 * float(value), 3) + 0.0:.6g}' for value in place)}) mm"


@dataclass(frozen=True, eq=False)
class _Asked:
    """A spot as it is described: its entry, and its place [m]."""

    name: str
    welds: SpotWelds
    place: Floats

    def refusal(self, what: str, came: str, allowed: str) -> InputError:
        """What is wrong with it."""
        todo = "correct the places of the spots, or of the members"
        what = f"{what} at the spot {in_words(self.place)}"
        return InputError(Problem(what, came, allowed, todo, f"spot_welds.{self.name}"))


def _places(
    structure: Structure, mesh: Mesh, welds: SpotWelds
) -> Iterator[tuple[Floats, tuple[Integers, Integers]]]:
    """Place of each spot [m], (3,), and the numbers of the elements of both sheets."""
    tubes = [mesh.tubes[member] for member in welds.members]
    if len(tubes) == 2:
        first, second = (tube.elements_between(0, tube.last_ring) for tube in tubes)
        for place in welds.places(tubes[0].frame):
            yield place, (first, second)
        return
    frame, contour = tubes[0].frame, tubes[0].contour
    for pair in contour.welds:
        first, second = (_beside_point(mesh, tubes[0], int(point)) for point in pair)
        across = contour.points[pair].mean(axis=0) @ frame.axes[1:]
        for station in welds.stations(frame.length):
            yield frame.position(float(station)) + across, (first, second)


def _beside_point(mesh: Mesh, tube: Tube, point: int) -> Integers:
    """Elements of a member on the sides that meet at a point of its section."""
    elements = tube.elements_between(0, tube.last_ring)
    return elements[np.isin(mesh.quads[elements], tube.nodes[:, point]).any(axis=1)]


@dataclass(frozen=True, eq=False)
class _Foot:
    """Point of a sheet nearest to a place: it, normal, size and thickness of the facet [m]."""

    at: Floats
    normal: Floats
    size: float
    thickness: float


def _spot(mesh: Mesh, asked: _Asked, elements: tuple[Integers, Integers], taken: Integers) -> Spot:
    first = _foot(mesh, elements[0], asked.place)
    # seen from the first sheet, so that the tie lies across both
    second = _foot(mesh, elements[1], first.at)
    _refuse_apart(asked, first, second)
    gap, patches = float(np.linalg.norm(second.at - first.at)), []
    for foot, own in ((first, elements[0]), (second, elements[1])):
        nodes = np.setdiff1d(mesh.quads[own], taken)
        patch = _patch(mesh, nodes, foot, gap, asked.welds.diameter / 2)
        if patch is None:
            what, allowed = (
                "there are too few free nodes around the spot",
                "walls around it that are neither rigid nor clamped",
            )
            raise asked.refusal(what, "", allowed)
        patches.append(patch)
    strength = (asked.welds.normal_strength or np.inf, asked.welds.shear_strength or np.inf)
    return Spot(asked.name, patches[0], patches[1], (first.at + second.at) / 2, strength)


def _foot(mesh: Mesh, elements: Integers, place: Floats) -> _Foot:
    corner = mesh.position[mesh.quads[elements]]
    on = np.stack([_on_triangles(place, corner[:, [0, 1, 2]]), _on_triangles(place, corner[:, [0, 2, 3]])])
    half, which = divmod(int(np.linalg.norm(on - place, axis=2).argmin()), len(elements))
    a, b, c, d = corner[which]
    normal = np.cross(c - a, d - b)
    twice = float(np.linalg.norm(normal))
    thickness = float(wall_thickness(mesh)[elements[which]])
    return _Foot(on[half, which], normal / twice, float(np.sqrt(twice / 2)), thickness)


def _on_triangles(place: Floats, corner: Floats) -> Floats:
    """Feet of a place on triangles (m, 3, 3) [m], (m, 3); where it lies beside one a point of the border."""
    first, second = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    to = place - corner[:, 0]
    a, b, c = (first**2).sum(1), (first * second).sum(1), (second**2).sum(1)
    # a quadrilateral that is a triangle has a second half without area
    area = np.maximum(a * c - b * b, np.finfo(float).tiny)
    u, v = (first * to).sum(1), (second * to).sum(1)
    share = np.stack([np.zeros_like(a), (c * u - b * v) / area, (a * v - b * u) / area], axis=1)
    share[:, 0] = 1.0 - share[:, 1] - share[:, 2]
    share = np.clip(share, 0.0, 1e9)
    share /= share.sum(axis=1)[:, None]
    return np.asarray(np.einsum("mk,mki->mi", share, corner))


def _patch(mesh: Mesh, nodes: Integers, foot: _Foot, gap: float, radius: float) -> Patch | None:
    """Nodes around a foot, at least within a radius [m], with weights; None where too few are free."""
    arm = mesh.position[nodes] - foot.at
    across = arm @ foot.normal
    along = arm - across[:, None] * foot.normal
    distance = np.where(np.abs(across) <= SAME_SHEET * gap, np.linalg.norm(along, axis=1), np.inf)
    for factor in WIDER:
        near = distance <= max(radius, factor * REACH * foot.size)
        # rows: the sum of the weights, and the place along the sheet
        rows = np.vstack([np.ones(int(near.sum())), along[near].T / foot.size])
        weights = np.linalg.pinv(rows, rcond=1e-6)[:, 0]
        fits = np.allclose(rows @ weights, np.eye(4)[0], atol=1e-9)
        if fits and np.abs(weights).sum() <= LARGEST_WEIGHT:
            return Patch(nodes[near], weights / weights.sum())
    return None


def _refuse_apart(asked: _Asked, first: _Foot, second: _Foot) -> None:
    """Refuse a place at which the two walls do not lie on each other."""
    both, members = first.thickness + second.thickness, asked.welds.members
    allowed = f"at most {1e3 * both:.3g} mm, both thicknesses"
    distance = float(np.linalg.norm(first.at - asked.place))
    if distance > both:
        raise asked.refusal(
            f"there is no wall of member '{members[0]}'", f"nearest {1e3 * distance:.3g} mm away", allowed
        )
    apart = second.at - first.at
    gap = float(np.linalg.norm(apart))
    if gap > both:
        what = f"no wall of member '{members[-1]}' touches that of '{members[0]}'"
        raise asked.refusal(what, f"{1e3 * gap:.3g} mm apart", allowed)
    if gap < LEAST_GAP * both / 2:
        allowed = f"mid-lines {1e3 * both / 2:.3g} mm apart, half of both thicknesses"
        raise asked.refusal("the walls penetrate each other", "", allowed)
    if abs(float(first.normal @ second.normal)) < LEAST_PARALLEL:
        raise asked.refusal("the walls are not parallel", "", "at most 30 deg between them")
    across = (apart @ first.normal) * first.normal
    if float(np.linalg.norm(apart - across)) > BESIDE * gap:
        raise asked.refusal("one wall ends", "", "walls of both members across each other")
