"""What a hinge that shortens or lengthens along its member did: figures of a crush zone, and of a stretch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats

BENT = 1e-3
"""Rotation [rad] below which a crush zone did not bend: what it shows then is rounding."""


MOVED = 1e-3
"""Lengthening over the length of the member up to which a hinge is not reported as stretched."""


@dataclass(frozen=True)
class StretchSummary:
    """Stretching of one hinge.

    Attributes
    ----------
    length, length_final
        Largest lengthening, and that at the end [m].
    peak_force
        Largest tension [N].
    energy
        Dissipated in tension [J], at least 0.
    """

    length: float
    length_final: float
    peak_force: float
    energy: float


@dataclass(frozen=True)
class CrumpledEnd:
    """Free end of a member that crumpled on a plane that it met obliquely.

    Attributes
    ----------
    member, node, obstacle
        Names.
    depth
        Largest depth [m].
    energy
        Dissipated by the crumpling; part of the energy of contact [J].
    """

    member: str
    node: str
    obstacle: str
    depth: float
    energy: float


@dataclass(frozen=True)
class DentedWall:
    """Dent that an obstacle pressed into the wall of a tube.

    Attributes
    ----------
    member, station
        Where: distance from the member's first node [m].
    obstacle
        What pressed it.
    depth
        Largest depth [m], with what a pole sinks into a fold.
    energy
        Dissipated by it without the fold; part of the energy of its member [J].
    """

    member: str
    station: float
    obstacle: str
    depth: float
    energy: float


@dataclass(frozen=True)
class CrushSummary:
    """Crushing of one hinge.

    Attributes
    ----------
    length, length_final
        Largest shortening, and that at the end [m].
    peak_force, mean_force
        Largest compression [N], and the energy over the largest shortening [N]; 0 without any.
    energy
        Dissipated in compression [J], at least 0; of a hinge that is crushed several times that of all.
    stroke
        Shortening at which the folds are closed [m]; None where the law has none.
    efficiency
        Largest shortening over the length of the member [-].
    bottomed_out
        Whether the folds were closed, so that the force is that of a stop.
    law
        What its force is, with source and band, in words; empty in results of earlier versions.
    """

    length: float
    length_final: float
    peak_force: float
    mean_force: float
    energy: float
    stroke: float | None
    efficiency: float
    bottomed_out: bool
    law: str = ""


def crush_summary(
    travel: Floats, force: Floats, member_length: float, stroke: float | None, energy: float | None = None
) -> CrushSummary:
    """Figures of a crush zone.

    Parameters
    ----------
    travel
        Slip along the member [m], (n,); negative: shorter.
    force
        Positive in tension [N], (n,).
    member_length
        [m].
    stroke
        Shortening at which the folds are closed [m], or None.
    energy
        Dissipated in compression [J] where it is known; else `slip_work` of both histories.
    """
    shortening = np.maximum(-travel, 0.0)
    length = float(shortening.max(initial=0.0))
    if energy is None:
        energy = slip_work(travel, force)[0]
    return CrushSummary(
        length=length,
        length_final=float(shortening[-1]) if shortening.size else 0.0,
        peak_force=float(np.maximum(-force, 0.0).max(initial=0.0)),
        mean_force=energy / length if length > 0.0 else 0.0,
        energy=energy,
        stroke=stroke,
        efficiency=length / member_length,
        bottomed_out=stroke is not None and length > stroke,
    )


def stretch_summary(
    travel: Floats, force: Floats, member_length: float, energy: float | None = None
) -> StretchSummary | None:
    """Figures of a hinge that lengthens along its member; None up to `MOVED`.  See `crush_summary`."""
    lengthening = np.maximum(travel, 0.0)
    length = float(lengthening.max(initial=0.0))
    if length <= MOVED * member_length:
        return None
    tension = np.maximum(force, 0.0)
    if energy is None:
        energy = slip_work(travel, force)[1]
    return StretchSummary(length, float(lengthening[-1]), float(tension.max(initial=0.0)), energy)


def slip_work(travel: Floats, force: Floats) -> tuple[float, float]:
    """Energy dissipated by a slip in compression and in tension [J], both at least 0.

    Parameters
    ----------
    travel
        Plastic slip [m], (n,); negative: shorter.
    force
        Positive in tension [N], (n,).

    Notes
    -----
    A slip follows its force.  Between two outputs acts the mean of the forces at both that have the sense of
    the slip between them, one alone where the other has the opposite sense: there the slip began, or turned
    about, and the product of means would give energy back.
    """
    slip = np.diff(travel)
    works = []
    for sense in (-1.0, 1.0):
        with_it = np.maximum(sense * force, 0.0)
        first, last = with_it[:-1], with_it[1:]
        acting = (first + last) / np.maximum((first > 0.0).astype(float) + (last > 0.0), 1.0)
        works.append(float((acting * np.maximum(sense * slip, 0.0)).sum()))
    return works[0], works[1]
