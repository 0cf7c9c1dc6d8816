"""Places where a result folded, found from the plastic work along each member.

Plastic work is summed between neighbouring sections and divided by their distance.  A fold is a range in
which this density exceeds a share of its largest value in the structure; ranges closer to each other than
half the section's depth are one fold.  Its position is the mean station weighted with the density.  The
planes between which its rotation is measured are half a depth outside, where the sections are plane again,
but no farther than half-way to a neighbouring fold.

If there is no field of plastic work, plastic strain times wall area is used instead; without that, the
change of section rotation between neighbours.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from crumple.comparison.measure.sections import Sections
from crumple.numeric.arrays import Floats
from crumple.result import States

WORK, STRAIN = "plastic_work", "plastic_strain"
"""Names of cell fields: plastic work of a piece of wall [J], its equivalent plastic strain [-]."""
EDGE = 0.05
"""Share of the largest density at which a fold ends; a fold contains some nine tenths of the plastic work."""
OPENED = np.radians(1.0)
"""Relative rotation [rad] from which a yielded range counts as a fold: above its elastic bending."""


@dataclass(frozen=True, eq=False)
class Fold:
    """One fold of one member.

    Attributes
    ----------
    member
        Its name.
    station
        Position along the member [m].
    start, end
        Yielded range [m].
    planes
        Indices of the sections on both sides between which its rotation is measured.
    share
        Part of the structure's plastic work that lies between the planes, in every state,
        (n_states,).
    """

    member: str
    station: float
    start: float
    end: float
    planes: tuple[int, int]
    share: Floats


def find_folds(states: States, sections: dict[str, Sections], depths: dict[str, float]) -> list[Fold]:
    """Folds of every member, along each member.

    Parameters
    ----------
    states
        With the cell field ``plastic_work`` or ``plastic_strain``, if available.
    sections
        Per member.
    depths
        Largest side of each member's section [m].
    """
    amounts = {name: plastic_amount(states, own) for name, own in sections.items()}
    totals = sum((amount.sum(axis=1) for amount in amounts.values()), np.zeros(len(states.times)))
    density = {name: amounts[name][-1] / np.diff(own.stations) for name, own in sections.items()}
    largest = max((float(d.max()) for d in density.values() if d.size), default=0.0)
    if not largest > 0.0:
        return []
    found: list[Fold] = []
    for name, own in sections.items():
        zones = _zones(density[name] > EDGE * largest, own.stations, depths[name] / 2)
        folds = [_fold(own, amounts[name][-1], zone) for zone in zones]
        placed = _with_planes(folds, own, depths[name] / 2)
        shares = [_share(fold, amounts[name], totals) for fold in placed]
        found += [fold for fold in shares if _turned(fold, own) > OPENED]
    return found


def plastic_amount(states: States, own: Sections) -> Floats:
    """Plastic work, or its substitute, between neighbouring sections, (n_states, n_rings - 1)."""
    bins = len(own.stations) - 1
    field = next((name for name in (WORK, STRAIN) if name in states.cell_data), None)
    if field is None:
        change = np.abs(np.diff(_bending(own), axis=1))
        return np.asarray(change)
    member = states.member_names.index(own.member)
    mine = np.flatnonzero((states.member[states.quads] == member).all(axis=1))
    amount = np.nan_to_num(states.cell_data[field].reshape(len(states.times), -1)[:, mine])
    if field == STRAIN:
        corners = states.points[states.quads[mine]]
        across = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
        amount = amount * np.linalg.norm(across, axis=1) / 2
    place = states.station[states.quads[mine]].mean(axis=1)
    index = np.clip(np.searchsorted(own.stations, place) - 1, 0, bins - 1)
    return np.stack([np.bincount(index, row, bins) for row in amount])


def _bending(own: Sections) -> Floats:
    """Largest rotation of the normals from the start [rad], whatever the axis, (n_states, n_rings)."""
    cosine = np.einsum("tri,ri->tr", own.normals, own.start_normals)
    return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))


def _zones(inside: np.ndarray, stations: Floats, gap: float) -> list[tuple[int, int]]:
    """Runs of intervals (first, last) that are inside; runs less than a gap [m] apart are joined."""
    zones: list[tuple[int, int]] = []
    for i in np.flatnonzero(inside).tolist():
        if zones and stations[i] - stations[zones[-1][1] + 1] < gap:
            zones[-1] = (zones[-1][0], i)
        else:
            zones.append((i, i))
    return zones


def _fold(own: Sections, amount: Floats, zone: tuple[int, int]) -> Fold:
    """Fold in a run of intervals, weighted with the last state's amounts, (n_rings - 1,)."""
    held = amount[zone[0] : zone[1] + 1]
    middles = (own.stations[1:] + own.stations[:-1])[zone[0] : zone[1] + 1] / 2
    station = float(held @ middles / held.sum())
    start, end = float(own.stations[zone[0]]), float(own.stations[zone[1] + 1])
    return Fold(own.member, station, start, end, (zone[0], zone[1] + 1), np.zeros(0))


def _share(fold: Fold, amount: Floats, totals: Floats) -> Fold:
    """The same fold with the part of the structure's plastic work between its planes."""
    held = amount[:, fold.planes[0] : fold.planes[1]].sum(axis=1)
    return replace(fold, share=held / np.where(totals > 0.0, totals, np.inf))


def _with_planes(folds: list[Fold], own: Sections, clear: float) -> list[Fold]:
    """The same folds with planes half a depth outside, at most half-way to the next fold."""
    ends, placed = own.stations, []
    for i, fold in enumerate(folds):
        low = (folds[i - 1].end + fold.start) / 2 if i else float(ends[0])
        high = (folds[i + 1].start + fold.end) / 2 if i + 1 < len(folds) else float(ends[-1])
        first = int(np.searchsorted(ends, max(fold.start - clear, low) + 1e-9, side="right")) - 1
        last = int(np.searchsorted(ends, min(fold.end + clear, high) - 1e-9))
        placed.append(replace(fold, planes=(max(first, 0), min(last, len(ends) - 1))))
    return placed


def _turned(fold: Fold, own: Sections) -> float:
    """Largest rotation of one plane relative to the other over time [rad]."""
    return float(own.bend(*fold.planes).max())
