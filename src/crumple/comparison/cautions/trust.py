"""Statement of trust: what agrees, what the candidate cannot represent, whether the reference is sound."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import combinations, pairwise

import numpy as np

from crumple.comparison.cautions.directions import direction_sentences
from crumple.comparison.cautions.fold_trust import across_joint, fold_sentences, largest_turn
from crumple.comparison.cautions.joints import joint_sentences
from crumple.comparison.cautions.metals import metal_sentences
from crumple.comparison.cautions.mode_followed import mode_sentences
from crumple.comparison.cautions.run_cautions import coarse_mesh, run_sentences
from crumple.comparison.cautions.shortfall import shortfall
from crumple.comparison.cautions.verdict import SMALL, agreement, verdict
from crumple.comparison.comparison import Comparison, Source, Trust
from crumple.comparison.measure.energy import energy_put_in, largest_of
from crumple.comparison.measure.metrics import deg, mm, percent
from crumple.hinge import Form
from crumple.numeric.arrays import Floats
from crumple.structure import PlacedHinge, Structure, plastic_hinges
from crumple.text.names import listed

ELASTIC = 0.05
"""Share of elastic energy from which rigid hinges are a caution."""
VIBRATES = 0.05
"""Bending of a bar over the rotation of the hinge from which it is reported."""
SWING = 0.1
"""Share of the largest bending below which a reversal is noise of planes fitted to few points."""
HOURGLASS = 0.05
"""Hourglass energy over internal energy above which a shell run is not suitable as reference."""
TOUCHED = 0.005
"""Contact energy over the energy input from which walls count as having touched."""
SAME_TIME = 0.02
"""Difference of two times of opening over the later one up to which they are one: mirrored hinges of shells
differ by 0.2 %, and hinges that open within 2 % of the time make no other collapse."""


def trust_of(comparison: Comparison, structure: Structure) -> Trust:
    """Statement on a comparison.

    Parameters
    ----------
    comparison
        Everything but its own statement is used.
    structure
        For the laws' ranges and the sections' sizes.
    """
    hinges = {hinge.name: hinge for hinge in plastic_hinges(structure)}
    failed = [s for s in comparison.sources if not s.result.status.ok]
    facts: list[str] = []
    cautions: list[str] = []
    for text, serious in (
        *mode_sentences(comparison),
        *agreement(comparison),
        *_ranges(comparison, hinges),
        *fold_sentences(comparison, structure, hinges),
        *_order(comparison),
        *_elastic(comparison, hinges),
        *bending_sentences(comparison, structure),
        *_contact(comparison, bool(structure.obstacles)),
        *direction_sentences(comparison),
        *joint_sentences(comparison.reference, structure),
        *metal_sentences(comparison.reference, structure),
        *_reference(comparison.reference),
        *shortfall(comparison),
        *run_sentences(comparison),
    ):
        (cautions if serious else facts).append(text)
    level, headline = verdict(comparison, _missed(comparison, structure, hinges), bool(cautions))
    if failed:
        cautions = [*(_ended(s) for s in failed), *cautions]
        if not all(s.result.status.ok for s in (comparison.candidate, comparison.reference)):
            level, headline = "bad", _unfinished(comparison)
    if coarse := coarse_mesh(comparison):
        headline += f" The mesh of the {comparison.reference.name} run is too coarse to judge: {coarse}."
    return Trust(level, headline, tuple(facts), tuple(cautions))


def _ended(source: Source) -> str:
    """Status and reason of a run that did not complete."""
    reason = f": {source.result.reason.rstrip('.')}" if source.result.reason else ""
    return f"The {source.name} run: {source.result.status.value}{reason}."


def _unfinished(comparison: Comparison) -> str:
    """Headline if one of the two runs did not complete."""
    ends = [s.result.time[-1] for s in (comparison.candidate, comparison.reference)]
    text = "A run did not complete"
    if comparison.until < max(ends):
        return f"{text}: only the first {1e3 * comparison.until:.4g} ms, which both contain, are compared."
    return f"{text}: the figures below are of limited value."


def _missed(comparison: Comparison, structure: Structure, hinges: dict[str, PlacedHinge]) -> str:
    """Places of folds without a hinge that absorbed much of the plastic work; empty without any."""
    motions = (*comparison.reference.hinges, *comparison.reference.extra)
    work = {m.name: float(m.plastic_work[-1]) if m.plastic_work.size else 0.0 for m in motions}
    most = max(work.values(), default=0.0)
    extra = [
        m
        for m in comparison.reference.extra
        if work[m.name] > SMALL * most and not across_joint(structure, m, hinges)
    ]
    return ", ".join(dict.fromkeys(f"{m.member} at {mm(m.station)}" for m in extra))


def _ranges(comparison: Comparison, hinges: dict[str, PlacedHinge]) -> Iterator[tuple[str, bool]]:
    """Whether hinges stay inside the ranges of their laws, in both results."""
    inside = []
    for name, hinge in hinges.items():
        limit, jams = hinge.law.validity.rotation_max, hinge.law.jamming_angle
        for source in (comparison.candidate, comparison.reference):
            motion = source.hinge(name)
            if motion is None or not motion.rotation.size:
                continue
            reached = float(np.max(motion.sense * motion.rotation))
            if jams is not None and reached > jams:
                yield (
                    f"Hinge {name} reaches {deg(reached)} in the {source.name} result, beyond the jamming "
                    f"angle of its law ({deg(jams)}). The moment beyond it is not supported by evidence.",
                    True,
                )
            elif hinge.law.validity.is_left_at(reached):
                yield (
                    f"Hinge {name} reaches {deg(reached)} in the {source.name} result, outside the range "
                    f"of its law (up to {deg(limit)}: {hinge.law.validity.basis}).",
                    True,
                )
            elif reached <= limit:
                inside.append((name, source.name))
    both = [
        n for n in hinges if all((n, s.name) in inside for s in (comparison.candidate, comparison.reference))
    ]
    if both:
        which = f"Hinge {both[0]} stays" if len(both) == 1 else f"{len(both)} of {len(hinges)} hinges stay"
        yield f"{which} inside the range of the law in both results.", False


def _order(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Order of opening of the hinges that opened in both results; of two at the same time it is chance."""
    first, second = comparison.candidate.name, comparison.reference.name
    a, b = ({o.name: o.time for o in comparison.opened[name]} for name in (first, second))
    common = [[name for name in order if name in a and name in b] for order in (a, b)]
    if len(common[0]) < 2:
        return
    apart = {
        name for pair in combinations(common[0], 2) if _way(a, pair) * _way(b, pair) < 0 for name in pair
    }
    if not apart:
        told = "" if common[0] == common[1] else ", but for those that open at the same time"
        yield f"Hinges open in the same order in both{told}: {listed(common[0])}.", False
        return
    # up to the first hinge whose order differs
    at = min(order.index(name) for order in common for name in apart)
    at = at if set(common[0][:at]) == set(common[1][:at]) else 0
    same = f"After the first {at}, which agree, the hinges" if at else "The hinges"
    yield (
        f"{same} open in different orders: {listed(common[0][at:])} in the {first} result, "
        f"{listed(common[1][at:])} in the {second} result.",
        True,
    )


def _way(opened: Mapping[str, float], pair: tuple[str, str]) -> int:
    """1 if the first of two hinges opens before the second, -1 if after; 0: at the same time."""
    before, after = (opened[name] for name in pair)
    if abs(after - before) <= SAME_TIME * max(before, after):
        return 0
    return 1 if before < after else -1


def _elastic(comparison: Comparison, hinges: dict[str, PlacedHinge]) -> Iterator[tuple[str, bool]]:
    """Share of elastic energy, and whether the hinges of the candidate can store any."""
    stored, put_in = (
        largest_of(comparison.reference.result, "energy.elastic"),
        energy_put_in(comparison.reference.result),
    )
    if stored is None or not put_in > 0.0:
        return
    share = stored / put_in
    text = (
        f"At most {percent(share)} of the energy input is elastic in the {comparison.reference.name} result"
    )
    rigid = [name for name, hinge in hinges.items() if hinge.record.form is not Form.ELASTIC_PLASTIC]
    if rigid and share > ELASTIC:
        text += (
            f". Hinges that are rigid until their capacity is reached ({listed(rigid)}) store none "
            f"of it, so the {comparison.candidate.name} rotations lack the elastic part and reach their "
            "peak early"
        )
    yield text + ".", bool(rigid) and share > ELASTIC


def bending_sentences(comparison: Comparison, structure: Structure) -> Iterator[tuple[str, bool]]:
    """Bending and vibration of the bars between hinges, which rigid bars do not have."""
    model = comparison.candidate.name
    rigid = f"The rigid bars of the {model} model do not contain this."
    elastic = f"The {model} model has it in the joints between the hinges of the elastic member."
    for motion in comparison.reference.hinges:
        if motion.far is None or not motion.fold or motion.time.size < 5:
            continue
        bent = motion.sense * (motion.far - motion.rotation)
        most, reach = largest_turn(motion), float(np.max(np.abs(bent)))
        if not (most > 0.0 and reach > VIBRATES * most):
            continue
        swings = swings_of(bent, SWING * reach)
        vibrates = f", with a vibration of up to ±{deg(max(swings))}" if len(swings) > 1 else ""
        yield (
            f"Member {motion.member} bends between the fold of hinge {motion.name} and its far end by up to "
            f"{deg(reach)} ({percent(reach / most)} of the rotation){vibrates}. "
            f"{elastic if structure.members[motion.member].elastic else rigid}",
            False,
        )


def swings_of(values: Floats, least: float) -> list[float]:
    """Amplitudes of the oscillation of a history: half the difference of successive turning points.

    The parts before the first turning point and after the last one are not counted.

    Parameters
    ----------
    values
        (n,).
    least
        A reversal smaller than this is not a turning point.
    """
    turns, side, best = [], 0.0, float(values[0])
    for value in map(float, values):
        if side == 0.0 and abs(value - best) > least:
            side, best = math.copysign(1.0, value - best), value
        elif side and side * (value - best) > 0.0:
            best = value
        elif side and side * (best - value) > least:
            turns.append(best)
            side, best = -side, value
    return [abs(b - a) / 2 for a, b in pairwise(turns)]


def _contact(comparison: Comparison, obstacles: bool) -> Iterator[tuple[str, bool]]:
    """Whether walls touched, which laws up to jamming do not represent."""
    touched, put_in = (
        largest_of(comparison.reference.result, "energy.contact"),
        energy_put_in(comparison.reference.result),
    )
    if touched is None or not put_in > 0.0 or not touched > TOUCHED * put_in:
        return
    energy = f"contact energy up to {percent(touched / put_in)} of the energy input"
    if obstacles:
        yield (
            f"In the {comparison.reference.name} result walls press on obstacles or on each other "
            f"({energy}; the energy does not distinguish them). A fold whose walls touch is stiffer than a "
            "law without contact.",
            False,
        )
        return
    yield (
        f"Walls touch in the {comparison.reference.name} result ({energy}). From then on the fold is "
        "stiffer than a law without contact.",
        True,
    )


def _reference(source: Source) -> Iterator[tuple[str, bool]]:
    """Whether the shell run is suitable as reference."""
    if source.result.fidelity != "shell":
        return
    internal = sum(
        float(v)
        for v in (largest_of(source.result, f"energy.{n}") for n in ("elastic", "dissipated"))
        if v is not None
    )
    hourglass = largest_of(source.result, "energy.hourglass")
    if hourglass is not None and internal > 0.0 and hourglass > HOURGLASS * internal:
        yield (
            f"Hourglass energy is {percent(hourglass / internal)} of the internal energy (acceptable: up to "
            f"{percent(HOURGLASS)}). The shell run is not suitable as reference; refine the mesh.",
            True,
        )
