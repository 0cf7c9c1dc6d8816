"""Energies of a whole run, used as the basis of shares, and where on members a multibody run dissipates.

A hinge stands for what shells do over a length.  The work of a joint of an elastic member is spread evenly up
to half way to its neighbours, and `DISTORTED` of what a mitred corner of rectangular tubes takes about its
bisector over the length l of both members that it distorts, falling to zero as the distortion does.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from crumple.hinge.corner.mitred_corner_across import distorted_length
from crumple.result import Result
from crumple.section import RectangularTube
from crumple.structure import PlacedHinge, Structure, plastic_hinges
from crumple.structure.hinges.corner_laws import corner_of
from crumple.structure.hinges.corners import Corner

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
    at_hinges = [(one.member, one.station, float(result[f"hinge.{one.name}.energy"][-1])) for one in hinges]
    dents = [(dent.member, dent.station, dent.energy) for dent in result.dents]
    return [*at_hinges, *dents, *_of_joints(result, structure, hinges)]


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
    for member, joints in result.yielded.items():
        own = {hinge.station for hinge in hinges if hinge.member == member} | {
            station for station, _ in joints
        }
        points = np.array(sorted(own))
        length = structure.frame_of(member).length
        borders = np.concatenate([[0.0], (points[:-1] + points[1:]) / 2.0, [length]])
        for station, energy in joints:
            k = int(np.searchsorted(points, station))
            middles = borders[k] + (np.arange(PIECES) + 0.5) / PIECES * (borders[k + 1] - borders[k])
            yield from ((member, float(at), energy / PIECES) for at in middles)
