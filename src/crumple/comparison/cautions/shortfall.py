"""Causes of a difference, from further models: bars, laws, or something else.

Three multibody models and a second mesh are solved besides the candidate.  The model with elastic members
has the laws of the input and bars that bend, vibrate and yield; the model with the laws of the shells has
other laws as well.  The difference is thereby divided into the part of the bars, the part of the laws, and
the rest, which is due to the method.  The second mesh shows how accurate the reference is.
"""

from __future__ import annotations

from collections.abc import Iterator

from crumple.comparison.comparison import Comparison
from crumple.comparison.measure.metrics import HingeComparison, signed
from crumple.comparison.variant import ELASTIC_MEMBERS, SHELL_LAWS
from crumple.numeric.ranking import largest_first

CLOSE = 0.05
"""Relative error of rotation and plastic energy up to which laws and bars explain the difference."""
FOLLOWS = 0.9
"""Rating of rotation and angular velocity from which they do."""
SHARP = 0.05
"""Relative difference between two meshes above which there is a caution about the reference."""
GAIN = 0.1
"""Gain in the rating of the angular velocity from which missing vibration is named as the cause."""


def shortfall(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Sentences on the hinge that absorbed the most energy, and whether each is a caution."""
    hinge = _main(comparison.hinges)
    if hinge is None:
        return
    yield from _vibration(comparison, hinge)
    yield from _laws(comparison, hinge)
    yield from _meshes(comparison, hinge)


def _main(hinges: tuple[HingeComparison, ...]) -> HingeComparison | None:
    """Hinge that absorbed the most energy in the reference, among those that both results contain."""
    both = [h for h in hinges if h.first is not None and h.second is not None and h.fold_station is not None]
    energies = {i: h.second.plastic_energy for i, h in enumerate(both) if h.second is not None}
    return both[largest_first(energies)[0]] if energies else None


def _vibration(comparison: Comparison, hinge: HingeComparison) -> Iterator[tuple[str, bool]]:
    channel = f"hinge.{hinge.name}.rotation_rate"
    own = _rating(comparison, comparison.candidate.name, channel)
    elastic = _rating(comparison, ELASTIC_MEMBERS, channel)
    if own is not None and elastic is not None and elastic > own + GAIN:
        yield (
            f"The rating of the angular velocity of hinge {hinge.name} is {own:.2f}; with elastic members "
            f"and the same laws it is {elastic:.2f}. The angular velocity of the fold contains the bending "
            "vibration of the members, which rigid bars do not have.",
            False,
        )


def _laws(comparison: Comparison, hinge: HingeComparison) -> Iterator[tuple[str, bool]]:
    """Difference that remains with elastic bars and the moments of the reference."""
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
        "hinge laws and bending of the bars explain the difference. (The moments are those of this run, so "
        "this is an explanation, not a prediction.)"
        if right
        else "hinge laws and bending of the bars do not explain the whole difference."
    )
    yield f"{text}; {rest}", False


def _meshes(comparison: Comparison, hinge: HingeComparison) -> Iterator[tuple[str, bool]]:
    """Change of the reference with a second mesh."""
    walls = _walls(comparison.reference.result.states)
    found = False
    for source in comparison.variants:
        figures = _figures(comparison, source.name, hinge)
        if source.result.fidelity != "shell" or figures is None:
            continue
        found = True
        rotation, energy = figures
        text = (
            f"On another mesh ({source.name}: {_walls(source.result.states)} elements, not {walls}) the "
            f"largest rotation of hinge {hinge.name} differs by {signed(rotation)} and its plastic energy by "
            f"up to {100 * energy:.1f} %"
        )
        rated = _rating(comparison, source.name, f"hinge.{hinge.name}.rotation")
        if rated is not None:
            text += f", rating {rated:.2f}"
        doubtful = max(abs(rotation), energy) > SHARP
        yield f"{text}. The reference is not more accurate than this.", doubtful
    if not found and comparison.reference.result.fidelity == "shell":
        yield (
            "The shell model was solved with one mesh only. Solve it with a second mesh (--second-mesh) "
            "before relying on differences of a few per cent.",
            False,
        )


def _figures(comparison: Comparison, name: str, hinge: HingeComparison) -> tuple[float, float] | None:
    """Errors of largest rotation and plastic energy of a hinge in one model; None if they are unknown."""
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
