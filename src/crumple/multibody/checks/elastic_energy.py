"""Energy that members between rigid hinges could store elastically, which the rigid form neglects.

With the lengths l_i that its hinges stand for, and those of the elastic joints that its elastic form would
have beside them, a member stores

    sum M_i^2 l_i / (2 E I)

exactly for moments that are linear along it: M^2 L/(2 E I) under a uniform moment, M^2 L/(6 E I) in a column
whose ends are guided.  At a place without a hinge M is interpolated between the hinges.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from crumple.multibody.answer.solved import HingeHistory
from crumple.numeric.arrays import Floats
from crumple.section import Axis
from crumple.structure import Structure, shares_left_out


def energy_left_out(structure: Structure, histories: Sequence[HingeHistory]) -> float:
    """Energy [J] that members with rigid hinges could store: the largest of each at an output time, summed.

    Parameters
    ----------
    structure, histories
        The structure, and the histories of its plastic hinges.

    References
    ----------
    docs/theory/member_stiffness.md.  Verified in tests/verification/hinge/test_member_stiffness.py.
    """
    by_member: dict[str, list[HingeHistory]] = defaultdict(list)
    for history in histories:
        by_member[history.hinge.member].append(history)
    total = 0.0
    for member, about in shares_left_out(structure).items():
        energy = np.zeros(1)
        for axis, shares in about.items():
            own = {h.hinge.name: (h.hinge.station, _moment(h, axis)) for h in by_member[member]}
            points = [(own[name], length) for name, length in shares.lengths.items()]
            stations = np.array([station for (station, _), _ in points])
            moments = np.array([moment for (_, moment), _ in points])
            square = sum(length * moment**2 for (_, moment), length in points)
            for station, length in shares.joints:
                square = square + length * _between(stations, moments, station) ** 2
            energy = energy + square / (2.0 * structure.flexural_rigidity(member, axis))
        # the first moments are those of an impact, within one shortest step, which no elastic member follows
        total += float(energy[1:].max() if energy.size > 1 else energy.max())
    return total


def _between(stations: Floats, moments: Floats, station: float) -> Floats:
    """Moment at a station, (n,), interpolated between those of hinges, (k, n), at increasing stations."""
    at = float(np.interp(station, stations, np.arange(len(stations))))
    before = int(at)
    after = min(before + 1, len(stations) - 1)
    return np.asarray(moments[before] + (at - before) * (moments[after] - moments[before]))


def _moment(history: HingeHistory, axis: Axis) -> Floats:
    """Moment of a hinge about one of its axes [N m], (n,), at most its capacity about the first."""
    name = f"moment.{axis}" if f"moment.{axis}" in history.columns else "moment"
    record = history.hinge.record
    capacity = max(float(record.positive.moment.max()), float(record.negative.moment.max()))
    return np.clip(history.values(name), -capacity, capacity)
