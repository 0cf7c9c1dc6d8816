"""A plain statement of trust: what the candidate got right, what it could not see, if the check is sound."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from crumple.comparison.metrics import HingeComparison, signed
from crumple.comparison.motion import REACH, HingeMotion, largest_side
from crumple.comparison.shortfall import shortfall
from crumple.hinge import Form
from crumple.result import Result
from crumple.structure import PlacedHinge, Structure, placed_hinges

if TYPE_CHECKING:
    from crumple.comparison.comparison import Comparison, Source

AGREES = 0.12
"""Relative error of largest rotation and plastic energy up to which a concept-stage answer agrees."""
FAR_OFF = 0.25
"""The same from which it does not."""
ELASTIC = 0.05
"""Share of elastic energy from which rigid bars are worth a word."""
VIBRATES = 0.05
"""Bending of a bar over the hinge's rotation from which it is worth a word."""
HOURGLASS = 0.05
"""Hourglass energy over internal energy above which a shell run is no reference."""
TOUCHED = 0.005
"""Contact energy over the energy put in from which walls count as having touched."""
SMALL = 0.1
"""Share of the largest plastic energy, in either result, below which a hinge's own errors decide nothing."""


@dataclass(frozen=True)
class Trust:
    """Verdict: level ``good``, ``caution`` or ``bad``, a headline, facts, and cautions."""

    level: str
    headline: str
    facts: tuple[str, ...]
    cautions: tuple[str, ...]


def trust_of(comparison: Comparison, structure: Structure) -> Trust:
    """Statement on a comparison.

    Parameters
    ----------
    comparison
        Everything but its own statement is used.
    structure
        For the laws' ranges and the sections' sizes.
    """
    hinges = {hinge.name: hinge for hinge in placed_hinges(structure)}
    failed = [s for s in comparison.sources if not s.result.status.ok]
    errors = list(_agreement(comparison))
    facts = [text for text, _ in errors]
    cautions = [text for text, wrong in errors if wrong]
    facts = [text for text, wrong in errors if not wrong]
    for text, serious in (
        *_ranges(comparison, hinges),
        *_folds(comparison, structure, hinges),
        *_order(comparison),
        *_elastic(comparison, hinges),
        *_bending(comparison),
        *_contact(comparison),
        *_reference(comparison.reference),
        *shortfall(comparison),
    ):
        (cautions if serious else facts).append(text)
    level, headline = _verdict(comparison, structure, hinges, bool(cautions))
    if failed:
        ends = (f"The {s.name} run: {s.result.status.value}. {s.result.reason}".strip() for s in failed)
        cautions = [*ends, *cautions]
        level, headline = "bad", "A run did not end well: what was computed until then is compared."
    return Trust(level, headline, tuple(facts), tuple(cautions))


def _verdict(
    comparison: Comparison, structure: Structure, hinges: dict[str, PlacedHinge], doubtful: bool
) -> tuple[str, str]:
    """Level and headline of two runs that ended well."""
    first, second = comparison.candidate.name, comparison.reference.name
    missed = _missed(comparison, structure, hinges)
    if missed:
        return (
            "bad",
            f"The {first} answer is wrong: the {second} run folds where no hinge was put ({missed}).",
        )
    off = _worst(comparison)
    if off is None:
        return "bad", "No hinge turned in both results: nothing is compared."
    said = f"largest rotation off by {off[0]:.1%}, plastic energy by up to {off[1]:.1%}"
    if max(off) > FAR_OFF:
        return "bad", f"The {first} answer is not that of the {second} run: {said}."
    if max(off) > AGREES:
        return "caution", f"The {first} answer is only roughly that of the {second} run: {said}."
    if doubtful:
        return "caution", f"Both answers agree, with reservations: {said}."
    return "good", f"Both answers agree: {said}."


def _missed(comparison: Comparison, structure: Structure, hinges: dict[str, PlacedHinge]) -> str:
    """Members in which folds without a hinge took up much of the plastic work; empty without any."""
    motions = (*comparison.reference.hinges, *comparison.reference.extra)
    work = {m.name: float(m.plastic_work[-1]) if m.plastic_work.size else 0.0 for m in motions}
    most = max(work.values(), default=0.0)
    extra = [
        m
        for m in comparison.reference.extra
        if work[m.name] > SMALL * most and not _across_joint(structure, m, hinges)
    ]
    return ", ".join(dict.fromkeys(f"{m.member} at {_mm(m.station)}" for m in extra))


def _worst(comparison: Comparison) -> tuple[float, float] | None:
    """Largest relative errors of rotation and of plastic energy among the hinges that matter."""
    most = max(map(_absorbed, comparison.hinges), default=0.0)
    found = []
    for hinge in comparison.hinges:
        rotation = hinge.error("rotation_max")
        if rotation is not None and _absorbed(hinge) > SMALL * most:
            found.append((abs(rotation), abs(worst(hinge.energy_errors()) or 0.0)))
    return (max(r for r, _ in found), max(e for _, e in found)) if found else None


def _agreement(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Errors of rotation and energy of every hinge that matters."""
    first, second = comparison.candidate.name, comparison.reference.name
    most = max(map(_absorbed, comparison.hinges), default=0.0)
    for hinge in comparison.hinges:
        rotation, energy = hinge.error("rotation_max"), worst(hinge.energy_errors())
        if rotation is None or hinge.first is None or hinge.second is None:
            continue
        matters = _absorbed(hinge) > SMALL * most
        off = abs(rotation) > AGREES or (energy is not None and abs(energy) > AGREES)
        text = (
            f"Hinge {hinge.name}: largest rotation {_deg(hinge.first.rotation_max)} {first}, "
            f"{_deg(hinge.second.rotation_max)} {second} ({signed(rotation)})"
        )
        if energy is not None:
            text += f"; plastic energy at equal plastic rotation differs by at most {abs(energy):.1%}"
        yield text + ".", off and matters


def _absorbed(hinge: HingeComparison) -> float:
    """Plastic energy of a hinge in that result in which it is larger [J]."""
    return max((m.plastic_energy for m in (hinge.first, hinge.second) if m is not None), default=0.0)


def worst(errors: tuple[float | None, ...]) -> float | None:
    """Error of largest magnitude; None without any."""
    known = [error for error in errors if error is not None]
    return max(known, key=abs) if known else None


def _ranges(comparison: Comparison, hinges: dict[str, PlacedHinge]) -> Iterator[tuple[str, bool]]:
    """Laws inside or outside their ranges, in either result."""
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
                    f"Hinge {name} reaches {_deg(reached)} in the {source.name} result; the walls of its "
                    "law jam at "
                    f"{_deg(jams)}, and what the law says beyond is a guess.",
                    True,
                )
            elif reached > limit:
                yield (
                    f"Hinge {name} reaches {_deg(reached)} in the {source.name} result, outside the range "
                    "of its law "
                    f"({_deg(limit)}: {hinge.law.validity.basis}).",
                    True,
                )
            else:
                inside.append((name, source.name))
    both = [
        n for n in hinges if all((n, s.name) in inside for s in (comparison.candidate, comparison.reference))
    ]
    if both:
        which = f"Hinge {both[0]} stays" if len(both) == 1 else f"{len(both)} of {len(hinges)} hinges stay"
        yield f"{which} inside the range of the law in both results.", False


def _folds(
    comparison: Comparison, structure: Structure, hinges: dict[str, PlacedHinge]
) -> Iterator[tuple[str, bool]]:
    """Folds without hinges, hinges without folds, folds away from their hinges."""
    first, second = comparison.candidate.name, comparison.reference.name
    for motion in comparison.reference.extra:
        where = f"member {motion.member} at {_mm(motion.station)}"
        place = f"The {second} result folds in {where} (by {_deg(_most(motion))})"
        near = _across_joint(structure, motion, hinges)
        if near:
            turns = [s.hinge(near) for s in (comparison.candidate, comparison.reference)]
            alone, beside = (0.0 if turn is None else _most(turn) for turn in turns)
            yield (
                f"{place}, at the joint beside hinge {near} of another member: both members share the "
                f"rotation of this corner, {_deg(beside + _most(motion))} together against {_deg(alone)} "
                f"{first}, and figures of that hinge alone cannot be compared.",
                True,
            )
            continue
        yield (
            f"{place}, where no hinge was put: the {first} model cannot fold there, and its answer is wrong "
            "by what "
            "this fold takes up.",
            True,
        )
    opened = {source: {o.name for o in found} for source, found in comparison.opened.items()}
    for hinge in comparison.hinges:
        if hinge.name not in hinges:
            continue
        here, there = hinge.name in opened[first], hinge.name in opened[second]
        if here and not there:
            yield (
                f"Hinge {hinge.name} opens in the {first} result alone; the {second} result has no fold "
                "there.",
                True,
            )
        elif there and not here:
            yield f"Hinge {hinge.name} opens in the {second} result alone.", True
        if hinge.fold_station is not None:
            away = hinge.fold_station - hinge.station
            text = (
                f"The fold of hinge {hinge.name} lies at {_mm(hinge.fold_station)} of member {hinge.member}, "
                f"the hinge at {_mm(hinge.station)}."
            )
            yield text, abs(away) > largest_side(structure, hinge.member)


def _across_joint(structure: Structure, motion: HingeMotion, hinges: dict[str, PlacedHinge]) -> str:
    """Hinge of another member that lies beside a fold, as at a joint; empty where there is none."""
    place = structure.frame_of(motion.member).position(motion.station)
    reach = REACH * largest_side(structure, motion.member)
    near = [
        (float(np.linalg.norm(hinge.position - place)), name)
        for name, hinge in hinges.items()
        if hinge.member != motion.member
    ]
    distance, name = min(near, default=(np.inf, ""))
    return name if distance <= reach else ""


def _order(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Order of opening of hinges that both results opened."""
    orders = {name: [o.name for o in found] for name, found in comparison.opened.items()}
    a, b = orders[comparison.candidate.name], orders[comparison.reference.name]
    common = [[name for name in order if name in a and name in b] for order in (a, b)]
    if len(common[0]) > 1:
        if common[0] == common[1]:
            yield f"Hinges open in the same order in both: {', '.join(common[0])}.", False
        else:
            yield (
                f"Hinges open in another order: {', '.join(common[0])} in the {comparison.candidate.name} "
                "result, "
                f"{', '.join(common[1])} in the {comparison.reference.name} result.",
                True,
            )


def _elastic(comparison: Comparison, hinges: dict[str, PlacedHinge]) -> Iterator[tuple[str, bool]]:
    """Share of elastic energy, and whether the candidate can hold any."""
    stored, put_in = (
        _largest(comparison.reference.result, "energy.elastic"),
        energy_put_in(comparison.reference.result),
    )
    if stored is None or not put_in > 0.0:
        return
    share = stored / put_in
    text = f"At most {share:.1%} of the energy put in is elastic in the {comparison.reference.name} result"
    rigid = [name for name, hinge in hinges.items() if hinge.record.form is not Form.ELASTIC_PLASTIC]
    if rigid and share > ELASTIC:
        text += (
            f"; hinges that are rigid until their capacity is reached ({', '.join(rigid[:4])}) hold none of "
            "it, so the "
            f"{comparison.candidate.name} rotations lack the elastic part and peak early"
        )
    yield text + ".", bool(rigid) and share > ELASTIC


def _bending(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Bending and vibration of the bars between hinges, which rigid bars have none of."""
    for motion in comparison.reference.hinges:
        if motion.far is None or not motion.fold or motion.time.size < 5:
            continue
        bent = motion.sense * (motion.far - motion.rotation)
        most = _most(motion)
        drift = np.convolve(np.pad(bent, 2, mode="edge"), np.full(5, 0.2), mode="valid")
        wobble = float(np.std(bent - drift) * math.sqrt(2.0))
        reach = float(np.max(np.abs(bent)))
        if most > 0.0 and reach > VIBRATES * most:
            yield (
                f"Member {motion.member} bends between the fold of hinge {motion.name} and its far end by "
                "up to "
                f"{_deg(reach)} ({reach / most:.0%} of the rotation) and vibrates there with an amplitude of "
                f"{_deg(wobble)}: bars between hinges are rigid and cannot.",
                False,
            )


def _contact(comparison: Comparison) -> Iterator[tuple[str, bool]]:
    """Whether walls touched, which laws up to jamming know nothing of."""
    touched, put_in = (
        _largest(comparison.reference.result, "energy.contact"),
        energy_put_in(comparison.reference.result),
    )
    if touched is not None and put_in > 0.0 and touched > TOUCHED * put_in:
        yield (
            f"Walls touch in the {comparison.reference.name} result (contact energy up to "
            f"{touched / put_in:.1%} of the "
            "energy put in): from then on a fold is stiffer than a law without contact.",
            True,
        )


def _reference(source: Source) -> Iterator[tuple[str, bool]]:
    """Whether the reference itself can be believed."""
    if source.result.fidelity != "shell":
        return
    internal = sum(
        float(v)
        for v in (_largest(source.result, f"energy.{n}") for n in ("elastic", "dissipated"))
        if v is not None
    )
    hourglass = _largest(source.result, "energy.hourglass")
    if hourglass is not None and internal > 0.0 and hourglass > HOURGLASS * internal:
        yield (
            f"Hourglass energy is {hourglass / internal:.1%} of the internal energy: the mesh is no "
            "reference.",
            True,
        )


def energy_put_in(result: Result) -> float:
    """Energy at the start and the largest external work [J]."""
    start = sum(
        float(result[name][0]) for name in ("energy.kinetic", "energy.elastic") if name in result.channels
    )
    return start + (_largest(result, "energy.external_work") or 0.0)


def _largest(result: Result, channel: str) -> float | None:
    if channel not in result.channels:
        return None
    return float(np.nanmax(np.abs(result[channel]), initial=0.0))


def _most(motion: HingeMotion) -> float:
    return float(np.max(motion.sense * motion.rotation)) if motion.rotation.size else 0.0


def _deg(angle: float) -> str:
    return f"{math.degrees(angle):.1f}°"


def _mm(length: float) -> str:
    return f"{length * 1e3:.0f} mm"
