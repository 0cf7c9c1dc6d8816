"""Which hinges opened, in which order, and whether the mechanism is the only one.

A hinge counts as open from when its plastic rotation passes a threshold: a hundredth of the largest plastic
rotation of the run, at most half a degree.  Where the largest is next to nothing, no hinge opened: members
are crushed or stretched, and their mechanism is not one of rotations.

Softening makes a collapse ill-posed where several hinges are equally near to their capacity: rounding then
decides which one opens.  So the run is repeated with capacities changed by 1 %: alternately up and down along
the structure, at random (always the same pattern), and both with the signs reversed.  The mechanism is not
unique if a hinge rotates by more than a fifth of the largest rotation in one run and by less than a tenth in
another.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from crumple.hinge import Envelope, HingeRecord
from crumple.multibody.answer.solved import HingeHistory
from crumple.numeric.arrays import Floats
from crumple.numeric.crossing import first_above
from crumple.result import Opening
from crumple.structure import PlacedHinge
from crumple.text.names import listed

OPEN = math.radians(0.5)
"""Largest threshold [rad]: an angle that a test can just measure."""
OPEN_SHARE = 0.01
"""Threshold relative to the largest plastic rotation, if all rotations are small."""
CHANGE = 0.01
"""Change of the capacities: less than the uncertainty of any law or material."""
PART = 0.2
"""Share of the largest rotation from which a hinge is part of the mechanism; below half of it, it is not."""
NOTHING = 5e-4
"""Plastic rotation [rad] up to which all hinges count as closed: 0.03 deg, below what a test can measure, and
an error that is negligible.  A crash box that is only crushed turns by a thousandth of it, at either end."""


def collapse_log(hinges: Sequence[HingeHistory], time: np.ndarray) -> tuple[tuple[Opening, ...], float]:
    """Hinges that opened in the order of their times, and the threshold [rad].

    Parameters
    ----------
    hinges
        Histories of one run.
    time
        Output times [s], (n,).
    """
    turned = [np.abs(history.values("plastic_rotation")) for history in hinges]
    largest = max((float(values.max()) for values in turned), default=0.0)
    if largest <= NOTHING:
        return (), OPEN
    threshold = min(OPEN, OPEN_SHARE * largest)
    openings = []
    for history, values in zip(hinges, turned, strict=True):
        when = first_above(time, values, threshold)
        if when is None:
            continue
        final = float(history.values("plastic_rotation")[-1])
        broke = history.fracture[0] if history.fracture else None
        openings.append(Opening(history.hinge.name, when, final, history.energy, broke))
    return tuple(sorted(openings, key=lambda opening: opening.time)), threshold


def patterns(count: int) -> dict[str, Floats]:
    """Senses in which capacities are changed along a structure, (count,) of 1 and -1, by name."""
    alternate = np.resize([1.0, -1.0], count)
    at_random = np.random.default_rng(0).choice([1.0, -1.0], count)
    return {
        "alternating": alternate,
        "alternating, reversed": -alternate,
        "at random": at_random,
        "at random, reversed": -at_random,
    }


def changed_capacities(hinges: tuple[PlacedHinge, ...]) -> Iterator[tuple[PlacedHinge, ...]]:
    """Hinges with capacities 1 % up and down: alternately along the structure, at random, and both reversed.

    Parameters
    ----------
    hinges
        In the structure's order.
    """
    up, down = ([scaled_hinge(hinge, 1.0 + change) for hinge in hinges] for change in (CHANGE, -CHANGE))
    for signs in patterns(len(hinges)).values():
        yield tuple(one if sign > 0.0 else other for one, other, sign in zip(up, down, signs, strict=True))


def not_unique(runs: Sequence[Sequence[HingeHistory]]) -> str | None:
    """A warning if runs with changed capacities fold elsewhere; the first run is the unchanged one."""
    turned = [{h.hinge.name: float(np.abs(h.values("plastic_rotation")[-1])) for h in run} for run in runs]
    largest = max((value for run in turned for value in run.values()), default=0.0)
    if largest <= NOTHING:
        return None
    part = PART * largest
    base = turned[0]
    variants = []
    for run in turned[1:]:
        gained = [name for name, value in run.items() if value > part and base[name] < part / 2.0]
        lost = [name for name, value in run.items() if value < part / 2.0 and base[name] > part]
        if gained and lost:
            variants.append(f"{listed(gained)} open{_s(gained)} instead of {listed(lost)}")
        elif gained or lost:
            names, verb = (gained, "open") if gained else (lost, "stay")
            variants.append(f"{listed(names)} {verb}{_s(names)}{'' if gained else ' closed'}")
    if not variants:
        return None
    changes = "; or ".join(dict.fromkeys(variants))
    return f"The mechanism is not unique. With capacities changed by 1 %: {changes}."


def _s(names: list[str]) -> str:
    """Ending of the verb that follows one or several names."""
    return "s" if len(names) == 1 else ""


def scaled_hinge(hinge: PlacedHinge, factor: float) -> PlacedHinge:
    """The hinge with its capacities multiplied by a factor."""
    spatial = hinge.spatial
    if spatial is not None:
        parts = (replace(part, record=_stronger(part.record, factor)) for part in spatial.components)
        spatial = replace(spatial, components=tuple(parts))
    return replace(hinge, record=_stronger(hinge.record, factor), spatial=spatial)


def _stronger(record: HingeRecord, factor: float) -> HingeRecord:
    positive, negative = (
        Envelope(envelope.rotation, envelope.moment * factor)
        for envelope in (record.positive, record.negative)
    )
    return replace(record, positive=positive, negative=negative)
