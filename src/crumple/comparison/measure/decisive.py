"""What engineers decide on: displacements, energy, force and rotations of joints, with errors and targets.

Errors are relative to the reference's value, or to `FLOOR` of the structure's largest value of the same kind
if that is more.  A rotation is a vector: that of a joint, however its folds share it, beside its direction.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from crumple.comparison.measure.contacts import LITTLE
from crumple.comparison.measure.measures import Measures

FLOOR = 0.05
"""Errors are relative to at least this share of the structure's largest value of the same kind."""
SMALL_ROTATION = math.radians(5.0)
"""Rotations that are below it in both are not judged."""
ROTATION_ROOM = math.radians(2.0)
"""Difference of rotations that is always allowed [rad]."""
TARGETS = {
    "displacement": 0.10,
    "rotations": 0.15,
    "energy by zone": 0.15,
    "peak force": 0.15,
    "mean force": 0.15,
    "time of rest": 0.15,
}
"""Relative errors; allowed is the larger of target and `SPREADS` times the spread of the reference."""
CONTACT_TARGETS = {"impulse": 0.05, "dissipation at contact": 0.20}
"""The same of the contacts of obstacles."""
SPREADS = 2.0


@dataclass(frozen=True)
class Figure:
    """One figure of one structure.

    Attributes
    ----------
    name
        Of the output, joint, zone or obstacle.
    shell, model
        Value of the reference, and of the result that is judged.
    error, allowed
        Relative [-]; an infinite error: the run failed.
    """

    name: str
    shell: float
    model: float
    error: float
    allowed: float

    @property
    def right(self) -> bool:
        """Whether it is within what is allowed."""
        return self.error <= self.allowed


def figures_of(
    model: Measures, reference: Measures, pairs: Sequence[tuple[Measures, Measures]] = ()
) -> dict[str, list[Figure]]:
    """Figures by kind; those of a run that failed have infinite errors.

    Parameters
    ----------
    model, reference
        What is judged, and by what.
    pairs
        Runs of the reference that differ in one thing (mesh, imperfection).  Their largest difference is its
        spread, which widens what is allowed.
    """
    whole = [pair for pair in pairs if pair[0].complete and pair[1].complete]
    kinds = {
        "displacement": _scalars(model, reference, whole, "extents", "displacement"),
        "rotations": _rotations(model, reference, whole),
        "energy by zone": _scalars(model, reference, whole, "zones", "energy by zone"),
        "peak force": _scalars(model, reference, whole, "peak_force", "peak force"),
        "mean force": _scalars(model, reference, whole, "mean_force", "mean force"),
        "time of rest": [
            _figure(
                "",
                (reference.rest, model.rest if model.complete else math.inf),
                (_spread(whole, lambda one: one.rest), reference.rest),
                TARGETS["time of rest"],
            )
        ]
        if reference.rest > 0.0
        else [],
    }
    kinds |= _contacts(model, reference, whole)
    return {kind: figures for kind, figures in kinds.items() if figures}


def _contacts(
    model: Measures, reference: Measures, pairs: Sequence[tuple[Measures, Measures]]
) -> dict[str, list[Figure]]:
    """Impulses and dissipations of the reference's contacts, where it has both; see contacts.py."""
    dissipation = "dissipation at contact"
    target = CONTACT_TARGETS[dissipation]
    # with this floor the target is the larger of 20 % and `LITTLE` of the energy put in
    floor = LITTLE / target * reference.energy.get("put_in", 0.0)
    most = max(reference.impulse.values(), default=0.0)
    kinds: dict[str, list[Figure]] = {}
    for kind, values, least in (("impulse", "impulse", FLOOR * most), (dissipation, "at_contact", floor)):
        wanted, own = getattr(reference, values), getattr(model, values)
        kinds[kind] = [
            _figure(
                name,
                (shell, own.get(name, 0.0) if model.complete else math.inf),
                (
                    _spread(pairs, lambda one, n=name, v=values: getattr(one, v).get(n, 0.0)),  # type: ignore[misc]
                    max(shell, least),
                ),
                CONTACT_TARGETS[kind],
            )
            for name, shell in wanted.items()
            # what a complete run does not know is not judged
            if max(shell, least) > 0.0 and (name in own or not model.complete)
        ]
    return kinds


def _scalars(
    model: Measures, reference: Measures, pairs: Sequence[tuple[Measures, Measures]], values: str, kind: str
) -> list[Figure]:
    own, wanted = getattr(model, values), getattr(reference, values)
    largest = max((abs(value) for value in wanted.values()), default=0.0)
    names = [*wanted, *(name for name in own if name not in wanted)]
    figures = []
    for name in names:
        shell = wanted.get(name, 0.0)
        came = own.get(name, 0.0) if model.complete else math.inf
        if max(shell, came) < FLOOR * largest or max(abs(shell), FLOOR * largest) == 0.0:
            continue
        spread = _spread(pairs, lambda one, name=name: getattr(one, values).get(name, 0.0))  # type: ignore[misc]
        scale = (spread, max(abs(shell), FLOOR * largest))
        figures.append(_figure(name, (shell, came), scale, TARGETS[kind]))
    return figures


def _figure(name: str, pair: tuple[float, float], scale: tuple[float, float], target: float) -> Figure:
    """`pair`: reference and model; `scale`: spread of the reference, and what errors are relative to."""
    shell, model = pair
    spread, relative_to = scale
    error = abs(model - shell) / relative_to
    return Figure(name, shell, model, error, max(target, SPREADS * spread / relative_to))


def _rotations(
    model: Measures, reference: Measures, pairs: Sequence[tuple[Measures, Measures]]
) -> list[Figure]:
    figures = []
    for name, wanted in reference.rotations.items():
        shell = np.array(wanted)
        own = np.array(model.rotations.get(name, (math.inf,) * 3)) if model.complete else np.full(3, math.inf)
        size, came = float(np.linalg.norm(shell)), float(np.linalg.norm(own))
        if max(size, came) < SMALL_ROTATION:
            continue
        apart = (
            float(np.linalg.norm(np.subtract(one.rotations[name], other.rotations[name])))
            for one, other in pairs
        )
        allowed = max(TARGETS["rotations"] * size, ROTATION_ROOM, SPREADS * max(apart, default=0.0))
        relative_to = max(size, SMALL_ROTATION)
        error = float(np.linalg.norm(own - shell)) / relative_to
        figures.append(Figure(name, size, came, error, allowed / relative_to))
    return figures


def _spread(pairs: Sequence[tuple[Measures, Measures]], value: Callable[[Measures], float]) -> float:
    """Largest difference within the pairs."""
    return max((abs(value(one) - value(other)) for one, other in pairs), default=0.0)
