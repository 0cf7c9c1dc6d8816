"""Which of the candidate's modes of collapse the reference follows."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from crumple.comparison.comparison import Comparison
from crumple.result.nearby import Mode


def mode_sentences(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Sentence on the mode that is nearest to the reference, and whether it is a caution.

    Nothing where there is one mode, or where no fold of the reference belongs to a hinge of a mode.
    """
    found = comparison.candidate.result.modes
    if found is None or found.unique:
        return
    folded = {h.name for mode in found.modes for h in comparison.hinges if h.name in mode.hinges}
    turned = {h.name: h.second.plastic_rotation for h in comparison.hinges if h.second and h.name in folded}
    if not turned:
        return
    apart = [_apart(mode, turned) for mode in found.modes]
    nearest = found.modes[apart.index(min(apart))]
    first, second = comparison.candidate.name, comparison.reference.name
    count = len(found.modes)
    if nearest is found.modes[0]:
        yield (
            f"Of {count} modes of collapse of the {first} model, the {second} run follows its result.",
            False,
        )
        return
    yield (
        f"Of {count} modes of collapse of the {first} model, the {second} run is nearest to one that is not "
        f"its result: {nearest.told}, which it has with {nearest.told_runs}. Small changes decide between "
        "them, so the figures below compare different modes.",
        True,
    )


def _apart(mode: Mode, turned: Mapping[str, float]) -> float:
    """Sum over the hinges of the differences of rotations [rad]."""
    own = dict(zip(mode.hinges, mode.rotations, strict=True))
    return sum(abs(own.get(name, 0.0) - rotation) for name, rotation in turned.items())
