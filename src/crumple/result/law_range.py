"""Range of a result that follows from the bands of its hinge laws."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class LawRange:
    """Least and largest values of runs with the laws at the edges of their bands; a range, not a bound.

    Attributes
    ----------
    ranges
        Least and largest value by quantity, in SI: ``hinge.NAME.rotation_max``, ``hinge.NAME.energy``,
        ``node.NAME.displacement.x`` at the end, ``energy.dissipated``.
    bands
        Relative half-width of the band by hinge [-].
    without
        Hinges whose law has no known band; they keep their law in all runs.
    failed
        Runs that did not reach the end, in words; they are not in the ranges.
    """

    ranges: Mapping[str, tuple[float, float]]
    bands: Mapping[str, float]
    without: tuple[str, ...] = ()
    failed: tuple[str, ...] = ()

    def of(self, quantity: str) -> tuple[float, float] | None:
        """Range of a quantity; None if it has none."""
        return self.ranges.get(quantity)
