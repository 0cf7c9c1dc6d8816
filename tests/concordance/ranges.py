"""Whether shells lie in the range that the bands of the laws give a displacement."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from crumple.analysis import Analysis, with_law_range
from crumple.comparison.measure.decisive import TARGETS
from crumple.comparison.measure.measures import Measures
from crumple.result import Result

SMALL = 0.05
"""Share of the largest value of a structure below which errors are relative to this share."""


@dataclass(frozen=True)
class Ranged:
    """A displacement at the end of a run.

    Attributes
    ----------
    name
        Of the node, or of the distance.
    shell, model
        Magnitudes [m].
    low, high
        Least and largest of the runs with the laws at the edges of their bands, and of the run itself [m].
    error
        Of the model, relative [-].
    """

    name: str
    shell: float
    model: float
    low: float
    high: float
    error: float

    @property
    def near(self) -> bool:
        """Whether the model is within the target."""
        return self.error <= TARGETS["displacement"]

    @property
    def inside(self) -> bool:
        """Whether the shells are within the range."""
        return self.low <= self.shell <= self.high

    @property
    def width(self) -> float:
        """Of the range, over the shells' value [-]."""
        return (self.high - self.low) / self.shell if self.shell > 0.0 else math.inf


def ranged(analysis: Analysis, result: Result, shells: Measures) -> list[Ranged]:
    """Displacements that shells have stored, with their ranges; none for a result without a range."""
    found = with_law_range(result, analysis).law_range if result.status.ok else None
    if found is None:
        return []
    ends = {name: float(channel.values[-1]) for name, channel in result.channels.items()}
    at_end = {name: path[-1] for name, path in shells.paths.items()}
    least = SMALL * max(at_end.values(), default=0.0)
    rows = []
    for name, shell in at_end.items():
        runs = [
            value for run in (ends, *found.cases.values()) if (value := _magnitude(name, run)) is not None
        ]
        error = abs(runs[0] - shell) / max(shell, least)
        rows.append(Ranged(name, shell, runs[0], min(runs), max(runs), error))
    return rows


def _magnitude(name: str, ends: Mapping[str, float]) -> float | None:
    """Of a distance, or of the displacement of a node; None if it was not reported."""
    keys = (name,) if name in ends else tuple(f"node.{name}.displacement.{axis}" for axis in "xyz")
    return math.hypot(*(ends[key] for key in keys)) if all(key in ends for key in keys) else None
