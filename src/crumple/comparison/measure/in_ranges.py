"""Values of the reference for the quantities that have a range from the bands of the candidate's laws.

Each value has the definition of the range's own: a hinge whose figure in the comparison is not that of the
hinge alone (at a corner it contains both folds) has none.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from crumple.comparison.measure.metrics import HingeComparison
from crumple.result import Result

SAME = 0.01
"""Relative difference up to which the comparison's figure of a candidate is that of its hinge: work is
integrated over the output times there."""
FIGURES = {"rotation_max": "rotation_max", "energy": "plastic_energy"}
"""Figure of the comparison by quantity of a hinge."""


def values_in_ranges(
    candidate: Result, reference: Result, hinges: Sequence[HingeComparison]
) -> Mapping[str, float]:
    """Values of the reference by quantity [SI]; empty if the candidate has no ranges.

    Parameters
    ----------
    candidate, reference
        Both reached the same end.
    hinges
        Both results side by side.
    """
    if candidate.law_range is None:
        return {}
    found = {}
    for hinge in hinges:
        own = candidate.hinges.get(hinge.name)
        if own is None or hinge.first is None or hinge.second is None:
            continue
        for quantity, figure in FIGURES.items():
            nominal, compared = float(getattr(own, quantity)), float(getattr(hinge.first, figure))
            if abs(compared - nominal) <= SAME * abs(nominal):
                found[f"hinge.{hinge.name}.{quantity}"] = float(getattr(hinge.second, figure))
    whole = {name: float(channel.values[-1]) for name, channel in reference.channels.items()}
    return {name: value for name, value in {**whole, **found}.items() if name in candidate.law_range.ranges}
