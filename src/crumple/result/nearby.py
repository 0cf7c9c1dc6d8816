"""What nearby inputs give: the range from the bands of the hinge laws, and the modes of an impact."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from crumple.units import format_quantity

MOST_HINGES = 3
"""Hinges that a sentence names of a mode."""
MOST_RUNS = 3
"""Runs that a sentence names of a mode."""


@dataclass(frozen=True)
class LawRange:
    """Least and largest values of runs with the laws at the edges of their bands; a range, not a bound.

    Attributes
    ----------
    ranges
        Least and largest value by quantity, in SI: ``hinge.NAME.rotation_max``, ``hinge.NAME.energy``,
        ``node.NAME.displacement.x``, distances and clearances at the end, ``energy.dissipated``.
    bands
        Relative half-width of the band by hinge [-].
    without
        Hinges whose law has no known band; they keep their law in all runs.
    failed
        Runs that did not reach the end, in words; they are not in the ranges.
    cases
        Values by quantity, for each run that reached the end by its name.  They are not stored.
    """

    ranges: Mapping[str, tuple[float, float]]
    bands: Mapping[str, float]
    without: tuple[str, ...] = ()
    failed: tuple[str, ...] = ()
    cases: Mapping[str, Mapping[str, float]] = field(default_factory=dict, compare=False, repr=False)

    @property
    def stored(self) -> dict[str, Any]:
        """What is written with a result."""
        return {key: getattr(self, key) for key in ("ranges", "bands", "without", "failed")}

    def of(self, quantity: str) -> tuple[float, float] | None:
        """Range of a quantity; None if it has none."""
        return self.ranges.get(quantity)


@dataclass(frozen=True)
class Mode:
    """Runs in which the same hinges turn.

    Attributes
    ----------
    hinges
        Those that turn by more than a fifth of the largest rotation of all runs, the largest first; where
        none does, by more than a fifth of the largest in its own first run.
    rotations
        Their plastic rotations at the end of that run [rad], without sign.
    runs
        Names of the runs.
    slips
        Hinges that shorten (less than 0) or lengthen along their members, and by how much at the end of that
        run [m], the largest first; where no hinge turns by a fifth of the largest rotation of all runs.
    between
        Energy that members took in that run without hinges [J]; where no hinge turns or slips, else 0.
    """

    hinges: tuple[str, ...]
    rotations: tuple[float, ...]
    runs: tuple[str, ...]
    slips: tuple[tuple[str, float], ...] = ()
    between: float = 0.0

    @property
    def told(self) -> str:
        """Its largest rotations, and what is crushed where these are small."""
        said = (self._turns, self._slips)
        return ", and ".join(filter(None, said)) or f"no hinge turns{self._yields}"

    @property
    def _yields(self) -> str:
        return (
            f", members yield between hinges ({format_quantity(self.between, 'J')})" if self.between else ""
        )

    @property
    def _slips(self) -> str:
        return ", ".join(
            f"{name} {'shortens' if slip < 0.0 else 'lengthens'} by {format_quantity(abs(slip), 'm', 2)}"
            for name, slip in self.slips[:MOST_HINGES]
        )

    @property
    def _turns(self) -> str:
        if not self.hinges:
            return ""
        angles = (f"{math.degrees(angle):.2g}°" for angle in self.rotations[:MOST_HINGES])
        shown = ", ".join(map(" ".join, zip(self.hinges[:MOST_HINGES], angles, strict=True)))
        return shown + (
            f" and {len(self.hinges) - MOST_HINGES} more" if len(self.hinges) > MOST_HINGES else ""
        )

    @property
    def told_runs(self) -> str:
        """Its runs, the first by their names."""
        more = f" or {len(self.runs) - MOST_RUNS} more" if len(self.runs) > MOST_RUNS else ""
        return " or ".join(f"'{name}'" for name in self.runs[:MOST_RUNS]) + more


@dataclass(frozen=True)
class Modes:
    """Modes of collapse of an impact.

    Attributes
    ----------
    modes
        The first is that of the result itself.
    failed
        Runs that did not reach the end; they have no mode.
    """

    modes: tuple[Mode, ...]
    failed: tuple[str, ...] = ()

    @property
    def unique(self) -> bool:
        """Whether all runs that reached the end fold as the result does."""
        return len(self.modes) == 1

    @property
    def sentence(self) -> str:
        """What was found, for people."""
        count = sum(len(mode.runs) for mode in self.modes)
        lost = f" {len(self.failed)} more did not reach their end." if self.failed else ""
        what = "changed capacities, friction, contact points and stiffness"
        if self.unique:
            return f"All {count} runs with {what} fold alike.{lost}"
        first, *others = self.modes
        told = "; ".join(f"{mode.told} with {mode.told_runs}" for mode in others)
        return (
            f"{len(self.modes)} modes of collapse appear in {count} runs with {what}. "
            f"As given: {first.told}. Also: {told}.{lost}"
        )


def modes_of(text: Mapping[str, Any] | None) -> Modes | None:
    """Modes from their entries as they are stored; None without."""
    if text is None:
        return None
    return Modes(tuple(map(_mode_of, text["modes"])), tuple(text["failed"]))


def _mode_of(text: Mapping[str, Any]) -> Mode:
    # files of earlier versions have neither slips nor the energy between hinges
    slips = tuple((name, float(slip)) for name, slip in text.get("slips", ()))
    hinges, rotations, runs = (tuple(text[key]) for key in ("hinges", "rotations", "runs"))
    return Mode(hinges, rotations, runs, slips, float(text.get("between", 0.0)))
