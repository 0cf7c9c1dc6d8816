"""Axial crushing of members in both results: crush length, energy and mean force, measured alike.

The crush length is the loss of distance between the centres of a member's first and last section, seen in the
shapes of either result; the energy is what the member's hinges, or its elements, have dissipated; the mean
force is that energy over the crush length.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from crumple.comparison.measure.sections import Sections
from crumple.hinge import Freedom
from crumple.result import Result
from crumple.structure import PlacedHinge

NOT_CRUSHED = 1e-3
"""Crush length over the member's length below which energy over length is no force."""


@dataclass(frozen=True)
class CrushFigures:
    """Crushing of one member in one result.

    Attributes
    ----------
    length
        Largest loss of distance between its ends [m].
    efficiency
        The same over its length [-].
    energy
        Dissipated in it at the end [J].
    mean_force
        Energy over crush length [N]; None where it was not crushed.
    """

    length: float
    efficiency: float
    energy: float
    mean_force: float | None


@dataclass(frozen=True)
class CrushComparison:
    """One member in the candidate and in the reference; None where a result has no shapes of it."""

    member: str
    first: CrushFigures | None
    second: CrushFigures | None

    def error(self, quantity: str) -> float | None:
        """Relative error of a figure of the candidate; None where either is missing."""
        a, b = (None if side is None else getattr(side, quantity) for side in (self.first, self.second))
        return None if a is None or not b else float(a / b - 1.0)


def crushable(hinges: Sequence[PlacedHinge]) -> tuple[str, ...]:
    """Members with a hinge that can shorten, in the order of the hinges."""
    able = (h for h in hinges if h.spatial is not None and Freedom.AXIAL in h.spatial.freedoms)
    return tuple(dict.fromkeys(hinge.member for hinge in able))


def crush_figures(
    result: Result, sections: Mapping[str, Sections], member: str, until: float
) -> CrushFigures | None:
    """Figures of one member up to a time [s]; None without shapes of it."""
    own = sections.get(member)
    if own is None:
        return None
    chord = np.linalg.norm(own.centres[:, -1] - own.centres[:, 0], axis=1)
    start = float(np.linalg.norm(own.start_centres[-1] - own.start_centres[0]))
    within = own.times <= until * (1.0 + 1e-9)
    length = max(float((start - chord[within]).max(initial=0.0)), 0.0)
    energy = _dissipated(result, member, until)
    crushed = length > NOT_CRUSHED * start
    return CrushFigures(length, length / start, energy, energy / length if crushed else None)


def _dissipated(result: Result, member: str, until: float) -> float:
    """Energy [J] dissipated in a member up to a time, in its elements or else in its hinges."""
    states = result.states
    if states is not None and "plastic_work" in states.cell_data:
        of_member = states.member[states.quads[:, 0]] == states.member_names.index(member)
        last = max(int(np.searchsorted(states.times, until * (1.0 + 1e-9), side="right")) - 1, 0)
        work = states.cell_data["plastic_work"].reshape(len(states.times), -1)[last]
        return float(np.nansum(work[of_member]))
    name = f"member.{member}.energy"
    if name not in result.channels:
        return 0.0
    return float(np.interp(until, result.time, result[name]))
