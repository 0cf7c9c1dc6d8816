"""What both runs say of themselves that a comparison must not hide: failed welds, open ends, own warnings."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

import numpy as np

from crumple.comparison.comparison import Comparison
from crumple.comparison.measure.energy import energy_put_in
from crumple.comparison.measure.metrics import OPENED_AT, percent

LEAST_WORK = 0.05
"""Plastic work over the energy put in below which a run is as good as elastic."""
OUTSIDE = 0.2
"""Share of plastic work outside folds that is worth a caution: a fold's ends, and long stretches that just
yield, hold up to a tenth in structures that bend."""
AT_END = 0.01
"""Share of what is compared within whose last part a largest rotation is that of the end."""
STILL = 0.02
"""Rate of rotation over the largest one up to which a hinge has come to rest."""
MOST_NAMED = 4
"""Hinges that one sentence names."""

LEAST_CRUSH = 1e-3
"""Shortening of a hinge [m] that is worth a word: a millimetre, a share of any fold."""

_SLIP = re.compile(r"hinge\.(.+)\.slip\.x\.plastic_travel")
_FAILED = re.compile(r"weld\.(.+)\.failed")


def said_of_runs(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Sentences, and whether each is a caution."""
    yield from _outside(comparison)
    yield from _welds(comparison)
    yield from _crushed(comparison)
    yield from _still_turning(comparison)
    yield from _warnings(comparison)


def outside_folds(comparison: Comparison) -> float:
    """Share of the reference's plastic work in no fold; 0 where it did next to none, or has no shapes."""
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
    """Plastic work where no section turns, as in walls that are crushed along a member or dented."""
    share = outside_folds(comparison)
    if share > OUTSIDE:
        yield (
            f"{percent(share)} of the plastic work of the {comparison.reference.name} run lies outside its "
            "folds: walls yield, are dented, or are crushed along their member where sections do not turn, "
            f"and hinges of the {comparison.candidate.name} model that only bend cannot stand for that.",
            True,
        )


def _welds(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Spot welds that failed in the reference: those of rigid bars hold."""
    first, second = comparison.candidate.name, comparison.reference
    for name, channel in second.result.channels.items():
        match = _FAILED.fullmatch(name)
        share = float(channel.values[-1]) if match and channel.values.size else 0.0
        if match is None or not share > 0.0:
            continue
        begin = float(second.result.time[int(np.argmax(channel.values > 0.0))])
        yield (
            f"{percent(share)} of the spot welds {match[1]} failed in the {second.name} result, by "
            f"{1e3 * begin:.4g} ms the first: in the {first} model welds hold and sections stay whole.",
            True,
        )


def _crushed(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Hinges that fold along the member's axis: only rotations are measured in shapes."""
    first, second = comparison.candidate, comparison.reference.name
    for name, channel in first.result.channels.items():
        match = _SLIP.fullmatch(name)
        most = float(np.nanmax(np.abs(channel.values), initial=0.0))
        if match is None or most < LEAST_CRUSH:
            continue
        yield (
            f"Hinge {match[1]} is crushed by {1e3 * most:.3g} mm along its member in the {first.name} "
            f"result, which its plastic energy holds; of the {second} result rotations alone are "
            "measured. Compare the crushing by displacements of nodes, or another code's curve.",
            True,
        )


def _still_turning(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Hinges whose largest rotation is no peak, because the run ended first."""
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
            more = " and others" if len(names) > MOST_NAMED else ""
            found.append(f"{', '.join(names[:MOST_NAMED])}{more} ({source.name})")
    if found:
        end = math.nan if math.isinf(comparison.until) else 1e3 * comparison.until
        yield (
            f"Still turning when the comparison ends at {end:.4g} ms: {'; '.join(found)}. Largest rotations "
            "there are those of the end, no peaks: give the run a longer duration.",
            True,
        )


def _warnings(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """That the runs warn of something themselves, further down on the page."""
    counts = [
        f"{len(s.result.warnings)} of the {s.name} run"
        for s in (comparison.candidate, comparison.reference)
        if s.result.warnings
    ]
    if counts:
        yield (
            f"Warnings that the runs give themselves ({', '.join(counts)}) stand at the end of the page.",
            False,
        )
