"""What is left of a difference when the law, or the bars, are better: read off further models.

Three multibody models and a second mesh stand beside the candidate.  Elastic members have the input's laws
and bars that bend, vibrate and yield; the laws of the shells change the laws too.  So the difference splits
into that of the bars, that of the laws, and a rest that is the method's.  A second mesh says how well the
reference is known.
"""

from __future__ import annotations

from collections.abc import Iterator

from crumple.comparison.comparison import Comparison
from crumple.comparison.measure.metrics import HingeComparison, signed
from crumple.comparison.variant import ELASTIC_MEMBERS, SHELL_LAWS

CLOSE = 0.05
"""Relative error of rotation and plastic energy up to which a model with the right law counts as right."""
FOLLOWS = 0.9
"""Rating of rotation and velocity from which it does."""
SHARP = 0.05
"""Difference between two meshes above which the reference is not known well enough to judge by."""
GAIN = 0.1
"""Gain in the velocity's rating from which missing vibration is named as its reason."""


def shortfall(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Sentences on the hinge that absorbed most, and whether each is a caution."""
    hinge = _main(comparison.hinges)
    if hinge is None:
        return
    yield from _vibration(comparison, hinge)
    yield from _laws(comparison, hinge)
    yield from _meshes(comparison, hinge)


def _main(hinges: tuple[HingeComparison, ...]) -> HingeComparison | None:
    """Hinge that absorbed most in the reference, of those that both show."""
    both = [h for h in hinges if h.first is not None and h.second is not None and h.fold_station is not None]
    return max(both, key=lambda h: h.second.plastic_energy if h.second else 0.0, default=None)


def _vibration(comparison: Comparison, hinge: HingeComparison) -> Iterator[tuple[str, bool]]:
    channel = f"hinge.{hinge.name}.rotation_rate"
    own = _rating(comparison, comparison.candidate.name, channel)
    elastic = _rating(comparison, ELASTIC_MEMBERS, channel)
    if own is not None and elastic is not None and elastic > own + GAIN:
        yield (
            f"The angular velocity of hinge {hinge.name} is rated {own:.2f}, with elastic members and the "
            f"same laws {elastic:.2f}: the fold turns in the beat of the bars' bending vibration, and rigid "
            "bars have none.",
            False,
        )


def _laws(comparison: Comparison, hinge: HingeComparison) -> Iterator[tuple[str, bool]]:
    """What is left once bars bend and laws are those of the reference."""
    figures = _figures(comparison, SHELL_LAWS, hinge)
    if figures is None:
        return
    rotation, energy = figures
    rated = [
        _rating(comparison, SHELL_LAWS, f"hinge.{hinge.name}.{key}") for key in ("rotation", "rotation_rate")
    ]
    known = [value for value in rated if value is not None]
    text = (
        f"With elastic members and the moments measured in the {comparison.reference.name} folds, the "
        f"largest rotation of hinge {hinge.name} differs by {signed(rotation)}, plastic energy by up to "
        f"{100 * energy:.1f} %"
    )
    if len(known) == 2:
        text += f", ratings {known[0]:.2f} (rotation) and {known[1]:.2f} (velocity)"
    right = abs(rotation) <= CLOSE and energy <= CLOSE and min(known, default=1.0) >= FOLLOWS
    rest = (
        "the laws and the bending of the bars explain what the multibody answer lacks. (Moments of this very "
        "run: an explanation, no prediction.)"
        if right
        else "something besides the laws and the bending of the bars is missing too."
    )
    yield f"{text}: {rest}", False


def _meshes(comparison: Comparison, hinge: HingeComparison) -> Iterator[tuple[str, bool]]:
    """How much a second mesh changes the reference."""
    walls = _walls(comparison.reference.result.states)
    found = False
    for source in comparison.variants:
        figures = _figures(comparison, source.name, hinge)
        if source.result.fidelity != "shell" or figures is None:
            continue
        found = True
        rotation, energy = figures
        text = (
            f"On another mesh ({source.name}: {_walls(source.result.states)} walls in place of {walls}) the "
            f"largest rotation of hinge {hinge.name} differs by {signed(rotation)} and its plastic energy by "
            f"up to {100 * energy:.1f} %"
        )
        rated = _rating(comparison, source.name, f"hinge.{hinge.name}.rotation")
        if rated is not None:
            text += f", rating {rated:.2f}"
        doubtful = max(abs(rotation), energy) > SHARP
        yield f"{text}: the reference is known no better than that.", doubtful
    if not found and comparison.reference.result.fidelity == "shell":
        yield (
            "The shell run is one mesh: compare with a second one (--second-mesh) before trusting "
            "differences of a few per cent.",
            False,
        )


def _figures(comparison: Comparison, name: str, hinge: HingeComparison) -> tuple[float, float] | None:
    """Errors of largest rotation and plastic energy of one model's hinge; None where they are not known."""
    own = next((h for h in comparison.variant_hinges.get(name, ()) if h.name == hinge.name), None)
    rotation = None if own is None else own.error("rotation_max")
    if own is None or rotation is None:
        return None
    return rotation, max((abs(e) for e in own.energy_errors() if e is not None), default=0.0)


def _rating(comparison: Comparison, name: str, channel: str) -> float | None:
    wanted = (channel, name, comparison.reference.name)
    pairs = (p for p in comparison.pairs if (p.channel, p.candidate, p.reference) == wanted)
    pair = next(pairs, None)
    return None if pair is None or pair.rating is None else pair.rating.overall


def _walls(states: object) -> int:
    return len(getattr(states, "quads", ()))
