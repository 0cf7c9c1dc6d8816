"""Cautions about the runs themselves: failed welds, crushing, hinges still rotating at the end, warnings."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

import numpy as np

from crumple.comparison.comparison import Comparison
from crumple.comparison.measure.energy import energy_put_in
from crumple.comparison.measure.metrics import OPENED_AT, percent
from crumple.shell.checks.folds import FEW
from crumple.text.names import listed

LEAST_WORK = 0.05
"""Plastic work over the energy input below which a run counts as elastic."""
OUTSIDE = 0.2
"""Share of plastic work outside folds from which there is a caution. In structures that bend, the ends of
folds and long ranges that just yield contain up to a tenth."""
AT_END = 0.01
"""Last part of the compared duration: a largest rotation within it counts as that of the end."""
STILL = 0.02
"""Rate of rotation over the largest one below which a hinge counts as at rest."""
LEAST_CRUSH = 1e-3
"""Shortening of a hinge [m] from which it is reported."""

_SLIP = re.compile(r"hinge\.(.+)\.slip\.x\.plastic_travel")
_FAILED = re.compile(r"weld\.(.+)\.failed")


def run_sentences(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Sentences, and whether each is a caution."""
    yield from _coarse(comparison)
    yield from _outside(comparison)
    yield from _welds(comparison)
    yield from _crushed(comparison)
    yield from _still_turning(comparison)
    yield from _warnings(comparison)


def coarse_mesh(comparison: Comparison) -> str:
    """What the reference's own warning says of a mesh that is too coarse to fold; empty without one."""
    found = [warning for warning in comparison.reference.result.warnings if warning.startswith(FEW)]
    return found[0].partition(". ")[0].removeprefix(FEW) if found else ""


def _coarse(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """The reference's own warning of its mesh."""
    for warning in comparison.reference.result.warnings:
        if warning.startswith(FEW):
            yield f"Of the {comparison.reference.name} run: {warning}", True


def outside_folds(comparison: Comparison) -> float:
    """Share of the reference's plastic work outside folds; 0 if it is nearly elastic or has no shapes."""
    source = comparison.reference
    if source.result.states is None or "energy.dissipated" not in source.result.channels:
        return 0.0
    until = min(comparison.until, float(source.result.time[-1]))
    work = float(np.interp(until, source.result.time, source.result["energy.dissipated"]))
    if not work > LEAST_WORK * energy_put_in(source.result):
        return 0.0
    own = [motion.until(until).plastic_work for motion in (*source.hinges, *source.extra)]
    return max(1.0 - sum(float(one[-1]) for one in own if one.size) / work, 0.0)


def _outside(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Plastic work where no section rotates, as in walls that are dented or crushed along a member."""
    share = outside_folds(comparison)
    if share > OUTSIDE:
        yield (
            f"{percent(share)} of the plastic work of the {comparison.reference.name} run is outside its "
            "folds: walls yield, are dented, or are crushed along their member where sections do not "
            f"rotate. Hinges of the {comparison.candidate.name} model that only bend cannot represent this.",
            True,
        )


def _welds(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Spot welds that failed in the reference; those of rigid bars cannot fail."""
    first, second = comparison.candidate.name, comparison.reference
    for name, channel in second.result.channels.items():
        match = _FAILED.fullmatch(name)
        share = float(channel.values[-1]) if match and channel.values.size else 0.0
        if match is None or not share > 0.0:
            continue
        begin = float(second.result.time[int(np.argmax(channel.values > 0.0))])
        yield (
            f"{percent(share)} of the spot welds {match[1]} failed in the {second.name} result, the first "
            f"by {1e3 * begin:.4g} ms. In the {first} model spot welds cannot fail.",
            True,
        )


def _crushed(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Hinges that are crushed along the member's axis: only rotations are measured in shapes."""
    first, second = comparison.candidate, comparison.reference.name
    for name, channel in first.result.channels.items():
        match = _SLIP.fullmatch(name)
        most = float(np.nanmax(np.abs(channel.values), initial=0.0))
        if match is None or most < LEAST_CRUSH:
            continue
        yield (
            f"Hinge {match[1]} is crushed by {1e3 * most:.3g} mm along its member in the {first.name} "
            f"result, and its plastic energy includes this; in the {second} result only rotations are "
            "measured. Compare the crushing through displacements of nodes or a curve from another code.",
            True,
        )


def _still_turning(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Hinges whose largest rotation is not a peak because the run ended first."""
    found = []
    for source in (comparison.candidate, comparison.reference):
        names = []
        for motion in source.hinges:
            own = motion.until(comparison.until)
            if own.time.size < 2 or not own.fold:
                continue
            turned, rate = own.sense * own.rotation, own.sense * own.rotation_rate
            peak = float(own.time[int(np.argmax(turned))])
            late = peak >= (1.0 - AT_END) * float(own.time[-1])
            opened = float(turned.max()) > OPENED_AT
            if opened and late and rate[-1] > STILL * float(np.abs(rate).max()):
                names.append(motion.name)
        if names:
            found.append(f"{listed(names)} ({source.name})")
    if found:
        end = math.nan if math.isinf(comparison.until) else 1e3 * comparison.until
        yield (
            f"Still rotating when the comparison ends at {end:.4g} ms: {'; '.join(found)}. The largest "
            "rotations of these hinges are end values, not peaks. Increase the duration.",
            True,
        )


def _warnings(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Reference to the warnings of both runs further down on the page."""
    counts = [
        f"{len(s.result.warnings)} of the {s.name} run"
        for s in (comparison.candidate, comparison.reference)
        if s.result.warnings
    ]
    if counts:
        yield (
            f"The warnings of the runs ({', '.join(counts)}) are at the end of the page.",
            False,
        )
