"""Energies of a whole run, used as the basis of shares, and where on members a multibody run dissipates.

A hinge stands for what shells do over a length.  The work of a joint of an elastic member is spread evenly up
to half way to its neighbours, and `DISTORTED` of what a mitred corner of rectangular tubes takes about its
bisector over the length l of both members that it distorts, falling to zero as the distortion does.  What a
hinge of a metal that hardens takes along its member before it folds or necks there is spread like the work of
a joint.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from crumple.hinge import Freedom
from crumple.hinge.corner.mitred_corner_across import distorted_length
from crumple.numeric.arrays import Floats
from crumple.result import Result
from crumple.section import RectangularTube
from crumple.structure import PlacedHinge, Structure, plastic_hinges
from crumple.structure.hinges.corner_laws import corner_of
from crumple.structure.hinges.corners import Corner
from crumple.structure.hinges.joint_reach import joint_reach
from crumple.structure.hinges.runs.straight_runs import StraightRun, straight_run

SHARED = 2.0
"""Power of the axial force over its capacity in the share of such work that is spread: the rest of the
interaction is a moment, which only the fold has."""
PIECES = 16
"""Pieces in which energy is spread over a length."""
DISTORTED = 0.4
"""Share of the work of rectangular corners about their bisectors that distorts their members: read off eight
members in four frames that shells solved, docs/theory/concordance.md."""

Work = tuple[str, float, float]
"""Member, station [m] and energy [J]."""


def energy_put_in(result: Result) -> float:
    """Energy at the start and the largest external work [J]."""
    start = sum(
        float(result[name][0]) for name in ("energy.kinetic", "energy.elastic") if name in result.channels
    )
    return start + (largest_of(result, "energy.external_work") or 0.0)


def largest_of(result: Result, channel: str) -> float | None:
    """Largest magnitude of a channel; None where the result has none."""
    if channel not in result.channels:
        return None
    return float(np.nanmax(np.abs(result[channel]), initial=0.0))


def hinge_work(result: Result, structure: Structure) -> list[Work]:
    """Work of hinges, dents, and what yielded between, in a multibody run."""
    hinges = plastic_hinges(structure)
    uniform = {one.name: work for one in hinges if (work := _before_folding(result, one)) > 0.0}
    at_hinges = [
        (one.member, one.station, float(result[f"hinge.{one.name}.energy"][-1]) - uniform.get(one.name, 0.0))
        for one in hinges
    ]
    dents = [(dent.member, dent.station, dent.energy) for dent in result.dents]
    along = _along_members(structure, hinges, uniform)
    return [*at_hinges, *dents, *along, *_of_joints(result, structure, hinges)]


def _before_folding(result: Result, hinge: PlacedHinge) -> float:
    """Work of the slip of a hinge that its member's length shares [J]."""
    parts = () if hinge.spatial is None else hinge.spatial.components
    spread = next((part.spread for part in parts if part.spread is not None), None)
    if spread is None:
        return 0.0
    slip, force, capacity = (
        result[f"hinge.{hinge.name}.slip.x.{one}"] for one in ("plastic_travel", "force", "capacity")
    )
    longest, shortest = (
        one[0][-1] if one[0].size else 0.0 for one in (spread.lengthening, spread.shortening)
    )
    shared = np.clip(slip, -shortest, longest)
    # where the slip comes back it yields anew, in the fold
    new = np.abs(slip) >= np.maximum.accumulate(np.abs(slip))
    # beside a moment only the walls that it loads too yield
    alone = (force / capacity) ** SHARED
    work = np.diff(shared) * (force[1:] + force[:-1]) / 2.0 * (alone[1:] + alone[:-1]) / 2.0
    return float(np.maximum(work, 0.0)[new[1:]].sum())


def _along_members(
    structure: Structure, hinges: tuple[PlacedHinge, ...], uniform: dict[str, float]
) -> Iterator[Work]:
    """Energy in pieces of the length up to half way to the next hinges of the straight run that slip."""
    for run in _runs(structure, (one.member for one in hinges if one.name in uniform)):
        own = sorted(
            (run.stretches[one.member].along(one.station), uniform.get(one.name, 0.0))
            for one in hinges
            if one.member in run.stretches and _slips(one)
        )
        yield from _spread(structure, run, np.array([place for place, _ in own]), own)


def _runs(structure: Structure, members: Iterable[str]) -> list[StraightRun]:
    """Straight runs of members: it does not matter to which of them a hinge at a node between belongs."""
    return list({run.first: run for run in (straight_run(structure, name) for name in members)}.values())


def _slips(hinge: PlacedHinge) -> bool:
    return hinge.spatial is not None and Freedom.AXIAL in hinge.spatial.freedoms


def _spread(
    structure: Structure, run: StraightRun, points: Floats, works: Iterable[tuple[float, float]]
) -> Iterator[Work]:
    """Works at points along a run [m, J], each evenly up to half way to the points beside it."""
    (member, node), (last_member, last_node) = run.ends
    first, last = joint_reach(structure, member, node), joint_reach(structure, last_member, last_node)
    ends = min(first, float(points[0])), max(run.length - last, float(points[-1]))
    borders = np.concatenate([ends[:1], (points[:-1] + points[1:]) / 2.0, ends[1:]])
    for place, energy in works:
        k = int(np.searchsorted(points, place))
        for at in borders[k] + (np.arange(PIECES) + 0.5) / PIECES * (borders[k + 1] - borders[k]):
            name = run.member_at(float(at))
            yield name, run.stretches[name].station(float(at)), energy / PIECES


def distortions(result: Result, structure: Structure) -> Iterator[tuple[str, Work]]:
    """Work of corners of a multibody run along their members: node whose hinge has it, and where it is."""
    for hinge in plastic_hinges(structure):
        corner = corner_of(structure, hinge.name)
        if corner is None:
            continue
        energy = DISTORTED * _about_bisector(result, structure, hinge, corner)
        for member in (corner.first, corner.second) if energy > 0.0 else ():
            yield from (
                (corner.node, one) for one in _distorting(structure, corner.node, member, energy / 2.0)
            )


def _about_bisector(result: Result, structure: Structure, hinge: PlacedHinge, corner: Corner) -> float:
    """Work of a corner about its bisector [J]; 0 of one that cannot turn so, and of round tubes."""
    if hinge.axes is None or not isinstance(structure.section_of(corner.first), RectangularTube):
        return 0.0
    works = {}
    for axis in "xyz":
        turned, moment = (f"hinge.{hinge.name}.{one}.{axis}" for one in ("plastic_rotation", "moment"))
        # a hinge that slips in its plane turns about one axis
        if turned in result.channels:
            means = result[moment][1:] + result[moment][:-1]
            works[axis] = max(0.0, float(np.diff(result[turned]) @ means))
    total = sum(works.values())
    share = works.get(corner.across, 0.0) / total if total > 0.0 else 0.0
    return share * float(result[f"hinge.{hinge.name}.energy"][-1])


def _distorting(structure: Structure, node: str, member: str, energy: float) -> Iterator[Work]:
    """Energy that falls linearly to zero over the distorted length from a node, or to the other end."""
    section, length = structure.section_of(member), structure.frame_of(member).length
    assert isinstance(section, RectangularTube)
    reach = distorted_length(section)
    away = (np.arange(PIECES) + 0.5) / PIECES * min(reach, length)
    share = (1.0 - away / reach) / np.sum(1.0 - away / reach)
    first = structure.members[member].nodes[0] == node
    for at, part in zip(away if first else length - away, share, strict=True):
        yield member, float(at), float(part) * energy


def _of_joints(result: Result, structure: Structure, hinges: tuple[PlacedHinge, ...]) -> Iterator[Work]:
    """Energy of the joints of elastic members, in pieces of the length up to half way to their neighbours."""
    for run in _runs(structure, result.yielded):
        joints = [
            (stretch.along(station), energy)
            for name, stretch in run.stretches.items()
            for station, energy in result.yielded.get(name, ())
        ]
        at_hinges = [
            run.stretches[one.member].along(one.station) for one in hinges if one.member in run.stretches
        ]
        yield from _spread(structure, run, np.unique([*(place for place, _ in joints), *at_hinges]), joints)
