"""Histories of the dents that obstacles press into walls, from the kernel's records."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from crumple._core.records import ComponentRecord, HingeEnergyRecord
from crumple.multibody.bodies.obstacles.bodies import Touching
from crumple.numeric.arrays import Floats
from crumple.result import Channel, DentedWall
from crumple.result.channels import channel
from crumple.structure import DentedTube

ROUNDING = 1e-6
"""Depth up to which a wall is not dented [m]."""


@dataclass(frozen=True, eq=False)
class DentHistory:
    """Dent of one tube.

    Attributes
    ----------
    tube
        What gives way.
    depth, rate, energy
        [m], [m/s], [J], (n,) each; the energy without that of the fold into which the obstacle sinks.
    """

    tube: DentedTube
    depth: Floats
    rate: Floats
    energy: Floats


WallMotion = tuple[Floats, Floats]
"""Mean displacement [m] and velocity [m/s] of the walls of a section relative to its member, (n, 3)."""


def dent_histories(
    touching: Touching, columns: tuple[int, ...], hinge: ComponentRecord, energy: HingeEnergyRecord
) -> Iterator[DentHistory]:
    """Dents of all tubes.

    Parameters
    ----------
    touching, columns
        Faces of obstacles and walls of folds, and the first column of every hinge of their model.
    hinge, energy
        Records of the hinges.
    """
    sunk = {}
    for wall in touching.walls:
        column = columns[wall.hinge] + wall.component
        turned, rate = (wall.law.sense * values[:, column] for values in (hinge.rotation, hinge.rate))
        slope = np.where(turned > 0.0, wall.law.slope(np.abs(turned)), 0.0)
        sunk[wall.tube.obstacle, wall.tube.member] = wall.tube, wall.law.depth(turned), slope * rate
    for face in touching.faces:
        depth, rate = (values[:, columns[face.hinge]] for values in (hinge.rotation, hinge.rate))
        absorbed = [tube.dent.absorbed(np.maximum.accumulate(depth)) for tube in face.tubes]
        total = np.sum(absorbed, axis=0)
        of_face = energy.dissipated[:, face.hinge]
        for tube, own in zip(face.tubes, absorbed, strict=True):
            share = np.divide(own, total, out=np.zeros_like(own), where=total > 0.0)
            _, deeper, faster = sunk.pop((face.obstacle, tube.member), (tube, 0.0, 0.0))
            yield DentHistory(tube, depth + deeper, rate + faster, share * of_face)
    yield from (DentHistory(tube, depth, rate, 0.0 * depth) for tube, depth, rate in sunk.values())


def dent_channels(dents: Iterable[DentHistory]) -> Iterator[Channel]:
    """Depth of the deepest dent of every obstacle."""
    depths: dict[str, Floats] = {}
    for dent in dents:
        name = dent.tube.obstacle
        depths[name] = np.maximum(depths.get(name, 0.0), dent.depth)
    yield from (channel(f"obstacle.{name}.dent", depth) for name, depth in depths.items())


def wall_motions(dents: Iterable[DentHistory]) -> Mapping[str, WallMotion]:
    """Motion of the walls at nodes that lie in a dent, by node."""
    found = {}
    for dent in dents:
        inwards, law = -dent.tube.outwards, dent.tube.dent
        slope = np.gradient(law.moves, law.depth)
        moved = np.interp(dent.depth, law.depth, law.moves)
        speed = np.interp(dent.depth, law.depth, slope) * dent.rate
        for node in dent.tube.nodes:
            found[node] = np.outer(moved, inwards), np.outer(speed, inwards)
    return found


def dented_walls(dents: Iterable[DentHistory]) -> tuple[DentedWall, ...]:
    """Dents as listed in results: those beyond `ROUNDING`."""
    return tuple(
        DentedWall(
            dent.tube.member,
            dent.tube.station,
            dent.tube.obstacle,
            float(dent.depth.max()),
            float(dent.energy[-1]),
        )
        for dent in dents
        if dent.depth.max(initial=0.0) > ROUNDING
    )
