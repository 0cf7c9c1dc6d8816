"""Whether nodes move in the same direction in both results: their displacements are compared by length."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crumple.comparison.comparison import Comparison
from crumple.comparison.measure.metrics import deg, mm
from crumple.numeric.arrays import Floats
from crumple.result import Result
from crumple.text.names import listed

APART = math.radians(20.0)
"""Angle between displacements from which they are different motions: they differ by a third of either."""
ALIKE = 0.75
"""Smaller length over the larger one from which two displacements count as alike; others differ by length."""
MATTERS = 0.05
"""Displacement over the largest one of all nodes below which its direction is not looked at."""
MOST_NAMED = 4
"""Nodes that the sentence names."""


def direction_sentences(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """A caution for nodes that move equally far in different directions; one sentence for all.

    Parameters
    ----------
    comparison
        Its candidate and reference are looked at up to where both go.
    """
    first, second = comparison.candidate, comparison.reference
    ours, theirs = (_largest(source.result, comparison.until) for source in (first, second))
    most = max((float(np.linalg.norm(vector)) for vector in theirs.values()), default=0.0)
    found: dict[str, float] = {}
    for node, vector in ours.items():
        other = theirs.get(node)
        if other is None:
            continue
        lengths = sorted(float(np.linalg.norm(each)) for each in (vector, other))
        if lengths[0] <= MATTERS * most or lengths[0] < ALIKE * lengths[1]:
            continue
        angle = math.acos(min(1.0, max(-1.0, float(vector @ other) / (lengths[0] * lengths[1]))))
        if angle > APART:
            found[node] = angle
    if not found:
        return
    cases = (
        f"{node} ({mm(float(np.linalg.norm(ours[node])))} in the {first.name}, "
        f"{mm(float(np.linalg.norm(theirs[node])))} in the {second.name} result, {deg(angle)} apart)"
        for node, angle in found.items()
    )
    what = "Node" if len(found) == 1 else "Nodes"
    yield (
        f"{what} {listed(cases, MOST_NAMED, '; ')} move{'s' if len(found) == 1 else ''} equally far in "
        "different directions: these are not the same motion, although the displacements agree in length.",
        True,
    )


def _largest(result: Result, until: float) -> dict[str, Floats]:
    """Largest displacement of each requested node up to a time, (3,) [m]."""
    nodes = [name.split(".")[1] for name in result.channels if name.endswith(".displacement.x")]
    within = result.time <= until * (1.0 + 1e-9)
    found = {}
    for node in nodes:
        parts = [result.channels.get(f"node.{node}.displacement.{axis}") for axis in "xyz"]
        if any(part is None for part in parts) or not within.any():
            continue
        path = np.stack([part.values[within] for part in parts if part is not None], axis=1)
        found[node] = path[int(np.argmax(np.linalg.norm(path, axis=1)))]
    return found
