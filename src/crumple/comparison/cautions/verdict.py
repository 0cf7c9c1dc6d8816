"""Level and headline of a comparison, and the errors of each hinge."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

from crumple.comparison.cautions.run_cautions import outside_folds
from crumple.comparison.comparison import Comparison
from crumple.comparison.measure.decisive import TARGETS, Figure
from crumple.comparison.measure.metrics import HingeComparison, deg, percent, signed
from crumple.numeric.ranking import largest_first
from crumple.units import format_quantity

AGREES = 0.12
"""Relative error of largest rotation and plastic energy up to which a concept-stage result agrees."""
FAR_OFF = 0.25
"""Relative error above which it does not agree."""
SMALL = 0.1
"""Share of the largest plastic energy, in either result, below which a hinge does not affect the verdict."""
MOSTLY = 0.5
"""Share of plastic work outside folds from which it is the headline of a comparison without folds."""
ZONES = "energy by zone"
TITLES = {
    "displacement": "largest displacements",
    "rotations": "rotations of joints",
    "peak force": "peak forces",
    ZONES: "energies of zones (of the whole)",
}
"""Kinds of figures that decide, in the order in which they are told."""
WHAT = {
    "displacement": "largest displacement of",
    "rotations": "rotation of",
    ZONES: "energy at",
    "peak force": "peak force (CFC 60) of",
}
FAR = 2.0
"""Error over what is allowed from which a figure is wrong."""
MOST_NAMED = 3
"""Number of figures that the headline names, the worst first."""
MOST_LISTED = 8
"""Number of hinges whose errors are listed one by one, the largest errors first."""


def verdict(comparison: Comparison, missed: str, doubtful: bool) -> tuple[str, str]:
    """Level and headline of two runs that completed.

    Parameters
    ----------
    comparison
        Everything but its own statement is used.
    missed
        Where the reference folds without a hinge; empty if nowhere.
    doubtful
        Whether there are cautions.
    """
    first, second = comparison.candidate.name, comparison.reference.name
    elsewhere = ""
    if missed:
        elsewhere = f"the {second} run folds where there is no hinge ({missed})"
    elif alone := _alone(comparison):
        elsewhere = f"it folds where the {second} run does not ({', '.join(alone)})"
    if any(kind in comparison.figures for kind in TITLES):
        return _by_figures(comparison, elsewhere, doubtful)
    if missed:
        return "bad", f"The {first} result is wrong: {elsewhere}."
    if elsewhere:
        return "bad", f"The {first} result disagrees with the {second} run: {elsewhere}."
    return _by_errors(comparison, doubtful)


def _by_figures(comparison: Comparison, elsewhere: str, doubtful: bool) -> tuple[str, str]:
    """Level and headline by what engineers decide on; `elsewhere`: folds that only one of the results has."""
    first, second = comparison.candidate.name, comparison.reference.name
    judged = _decisive(comparison)
    excess = {id(f): f.error / f.allowed for _, f in judged}
    order = largest_first({i: excess[id(f)] for i, (_, f) in enumerate(judged) if not f.right})
    wrong = [judged[i] for i in order]
    named = "; ".join(_figure_text(kind, f, comparison) for kind, f in wrong[:MOST_NAMED])
    further = f"; {len(wrong) - MOST_NAMED} further figures" if len(wrong) > MOST_NAMED else ""
    if wrong and excess[id(wrong[0][1])] > FAR:
        start = "is wrong" if elsewhere else f"disagrees with the {second} run"
        reason = f"{elsewhere}; " if elsewhere else ""
        return "bad", f"The {first} result {start}: {reason}{named}{further}."
    if wrong:
        return "caution", f"The {first} result agrees only roughly with the {second} run: {named}{further}."
    within = ", ".join(
        f"{title} within {percent(max(f.error for own, f in judged if own == kind))}"
        for kind, title in TITLES.items()
        if any(own == kind for own, _ in judged)
    )
    if elsewhere:
        return "caution", f"Both results agree, with reservations ({elsewhere}): {within}."
    if doubtful:
        return "caution", f"Both results agree, with reservations: {within}."
    return "good", f"Both results agree: {within}."


def _decisive(comparison: Comparison) -> list[tuple[str, Figure]]:
    """Figures that decide, with their kind; energies of zones are relative to that of the whole."""
    found = [(kind, f) for kind in TITLES for f in comparison.figures.get(kind, ()) if kind != ZONES]
    zones = comparison.figures.get(ZONES, ())
    whole = sum(abs(zone.shell) for zone in zones)
    for zone in zones:
        error = abs(zone.model - zone.shell) / whole if whole else math.inf
        found.append((ZONES, replace(zone, error=error, allowed=TARGETS[ZONES])))
    return found


def _figure_text(kind: str, figure: Figure, comparison: Comparison) -> str:
    """What differs: both values with their unit."""
    turned = kind == "rotations"
    unit = {"displacement": "m", ZONES: "J", "peak force": "N"}.get(kind, "")
    values = [
        deg(value) if turned else format_quantity(value, unit, 3) for value in (figure.model, figure.shell)
    ]
    return (
        f"{WHAT[kind]} {figure.name} {values[0]} {comparison.candidate.name}, "
        f"{values[1]} {comparison.reference.name}"
    )


def _by_errors(comparison: Comparison, doubtful: bool) -> tuple[str, str]:
    """Level and headline if both fold at the same hinges."""
    first, second = comparison.candidate.name, comparison.reference.name
    off = _worst(comparison)
    outside = outside_folds(comparison)
    if off is None and outside > MOSTLY:
        return (
            "bad",
            f"The {second} run absorbs its energy where nothing bends: {percent(outside)} of its plastic "
            "work is outside folds.",
        )
    if off is None:
        return "caution", f"Nothing folds in the {second} run: there is no plastic rotation to compare."
    errors = (
        f"the largest rotation differs by {percent(off[0])}, the plastic energy at equal plastic rotation by "
        f"up to {percent(off[1])}"
    )
    if max(off) > FAR_OFF:
        return "bad", f"The {first} result disagrees with the {second} run: {errors}."
    if max(off) > AGREES:
        return "caution", f"The {first} result agrees only roughly with the {second} run: {errors}."
    if doubtful:
        return "caution", f"Both results agree, with reservations: {errors}."
    return "good", f"Both results agree: {errors}."


def _alone(comparison: Comparison) -> list[str]:
    """Hinges that absorbed much of the candidate's plastic work where the reference has no fold."""
    own = [h for h in comparison.hinges if h.first is not None and h.second is not None]
    most = max((h.first.plastic_energy for h in own if h.first), default=0.0)
    opened = {o.name for o in comparison.opened[comparison.candidate.name]}
    return [
        h.name
        for h in own
        if h.name in opened and h.fold_station is None and h.first and h.first.plastic_energy > SMALL * most
    ]


def _worst(comparison: Comparison) -> tuple[float, float] | None:
    """Largest relative errors of rotation and of plastic energy among the hinges that matter."""
    most = max(map(absorbed, comparison.hinges), default=0.0)
    found = []
    for hinge in comparison.hinges:
        rotation = hinge.error("rotation_max")
        if rotation is not None and absorbed(hinge) > SMALL * most:
            found.append((abs(rotation), abs(worst(hinge.energy_errors()) or 0.0)))
    return (max(r for r, _ in found), max(e for _, e in found)) if found else None


def agreement(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Errors of rotation and energy of the hinges that matter most, and whether each is a caution."""
    most = max(map(absorbed, comparison.hinges), default=0.0)
    rows = []
    for hinge in comparison.hinges:
        off = _errors(hinge)
        if off:
            matters = absorbed(hinge) > SMALL * most
            rows.append((max(map(abs, off)) > AGREES and matters, matters, max(map(abs, off)), hinge))
    # largest errors first, and hinges that absorbed little last
    rows.sort(key=lambda one: one[:3], reverse=True)
    for wrong, _, _, hinge in rows[:MOST_LISTED]:
        yield _agreement(comparison, hinge), wrong
    if len(rows) > MOST_LISTED:
        count = sum(one[0] for one in rows[MOST_LISTED:])
        yield (
            f"{len(rows) - MOST_LISTED} further hinges have smaller errors or absorbed little energy; "
            f"{count} of them differ by more than {percent(AGREES)}.",
            count > 0,
        )


def _errors(hinge: HingeComparison) -> list[float]:
    """Errors of the largest rotations and of the plastic energy at equal plastic rotation."""
    found = [hinge.error("rotation_max"), hinge.error("plastic_rotation"), worst(hinge.energy_errors())]
    return [] if found[0] is None else [error for error in found if error is not None]


def _agreement(comparison: Comparison, hinge: HingeComparison) -> str:
    first, second = comparison.candidate.name, comparison.reference.name
    rotation, plastic = hinge.error("rotation_max"), hinge.error("plastic_rotation")
    assert hinge.first is not None
    assert hinge.second is not None
    assert rotation is not None
    text = (
        f"Hinge {hinge.name}: largest rotation {deg(hinge.first.rotation_max)} {first}, "
        f"{deg(hinge.second.rotation_max)} {second} ({signed(rotation)})"
    )
    if plastic is not None:
        text += (
            f", of which plastic {deg(hinge.first.plastic_rotation)} and "
            f"{deg(hinge.second.plastic_rotation)} ({signed(plastic)})"
        )
    energy = worst(hinge.energy_errors())
    if energy is not None:
        text += f"; plastic energy at equal plastic rotation differs by at most {percent(abs(energy))}"
    return text + "."


def absorbed(hinge: HingeComparison) -> float:
    """Plastic energy of a hinge in that result in which it is larger [J]."""
    return max((m.plastic_energy for m in (hinge.first, hinge.second) if m is not None), default=0.0)


def worst(errors: tuple[float | None, ...]) -> float | None:
    """Error of largest magnitude; None without any."""
    known = [error for error in errors if error is not None]
    return max(known, key=abs) if known else None
