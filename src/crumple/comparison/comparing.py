"""Compare two results of one structure, and curves from files: hinges, histories, order of opening, trust."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from crumple.comparison.cautions.trust import trust_of
from crumple.comparison.comparison import Comparison, Opening, Source
from crumple.comparison.measure.corner_motion import with_corners
from crumple.comparison.measure.crush import CrushComparison, crush_figures, crushable
from crumple.comparison.measure.crushed_zones import with_joined_zones
from crumple.comparison.measure.decisive import Figure, figures_of
from crumple.comparison.measure.in_ranges import values_in_ranges
from crumple.comparison.measure.measures import measurable, measure
from crumple.comparison.measure.metrics import HingeComparison, compared, metrics_of
from crumple.comparison.measure.motion import Measured, channel_motions, measured, member_sections
from crumple.comparison.measure.t_joint_motion import with_t_joints
from crumple.comparison.rating.curve_file import CurveFile
from crumple.comparison.rating.pairing import RELEVANT, pairs_of
from crumple.comparison.rating.signal import member_signals, signals_of
from crumple.errors import InputError, Problem
from crumple.result import Result
from crumple.structure import PlacedHinge, Structure, plastic_hinges
from crumple.structure.hinges.automatic import lengthens

SAME_TIME = 1e-9
"""Share of the run below which the times of two shapes are equal but for rounding."""


def compare(
    candidate: Result,
    reference: Result,
    structure: Structure,
    *,
    variants: Mapping[str, Result] | None = None,
    curves: Sequence[CurveFile] = (),
) -> Comparison:
    """Compare two results of one structure, and any curves, with each other.

    Parameters
    ----------
    candidate
        The result that is assessed, as a rule multibody.
    reference
        The result against which it is assessed, as a rule shell; its hinges are measured in its shapes, so
        it needs states.
    structure
        Of both results.
    variants
        Further candidates by name.
    curves
        Measured curves or curves of other codes; columns are paired with histories of the same name.

    Returns
    -------
    Comparison
        Pure data.

    Raises
    ------
    InputError
        If a result contains no histories.

    References
    ----------
    Definitions in docs/theory/comparison.md.
    """
    hinges = plastic_hinges(structure)
    names = _names(candidate, reference, variants or {})
    results = (candidate, *(variants or {}).values(), reference)
    sources = [_source(name, result, structure, hinges) for name, result in zip(names, results, strict=True)]
    first, others, last = sources[0], tuple(sources[1:-1]), sources[-1]
    until = min(float(source.result.time[-1]) for source in (first, last))
    short = {source.name: _until(source, until) for source in sources}
    tables = {name: _hinges(short[name], short[last.name]) for name in (s.name for s in (first, *others))}
    pairs = pairs_of((first.name, first.signals), (last.name, last.signals))
    for s in others:
        pairs += pairs_of((s.name, s.signals), (last.name, last.signals), ranks=RELEVANT)
    unpaired = {}
    for curve in curves:
        known = {c for source in sources for c in source.signals}
        unpaired[curve.name] = tuple(c for c in curve.signals if c not in known)
        pairs += [p for s in sources for p in pairs_of((s.name, s.signals), (curve.name, curve.signals))]
    opened = {name: openings(source) for name, source in short.items()}
    found = Comparison(
        title=candidate.title or reference.title,
        candidate=first,
        reference=last,
        variants=others,
        curves=tuple(curves),
        hinges=tables[first.name],
        variant_hinges={s.name: tables[s.name] for s in others},
        pairs=tuple(pairs),
        unpaired=unpaired,
        opened=opened,
        until=until,
        crushes=_crushes(candidate, reference, structure, hinges, until),
        figures=_figures(candidate, reference, structure),
        in_ranges=values_in_ranges(candidate, reference, tables[first.name])
        if _alike(candidate, reference)
        else {},
    )
    return replace(found, trust=trust_of(found, structure))


def _figures(candidate: Result, reference: Result, structure: Structure) -> Mapping[str, Sequence[Figure]]:
    """What engineers decide on, if both runs are whole and long alike and their shapes are known."""
    if not _alike(candidate, reference) or not all(measurable(result) for result in (candidate, reference)):
        return {}
    own, wanted = (measure(one, structure) for one in (candidate, reference))
    return figures_of(with_joined_zones(own, structure, wanted), with_joined_zones(wanted, structure, wanted))


def _alike(candidate: Result, reference: Result) -> bool:
    """Whether both results have the same end."""
    ends = [float(result.time[-1]) for result in (candidate, reference)]
    return abs(ends[0] - ends[1]) <= SAME_TIME * max(ends)


def _crushes(
    candidate: Result, reference: Result, structure: Structure, hinges: Sequence[PlacedHinge], until: float
) -> tuple[CrushComparison, ...]:
    """Every member that can shorten, in both results; not those that lengthen unasked, as in a held run."""
    members = [name for name in crushable(hinges) if not lengthens(structure, name)]
    if not members:
        return ()
    seen = [(result, member_sections(result, structure)) for result in (candidate, reference)]
    return tuple(
        CrushComparison(member, *(crush_figures(result, own, member, until) for result, own in seen))
        for member in members
    )


def _names(candidate: Result, reference: Result, variants: Mapping[str, Result]) -> list[str]:
    """Names of the sources: the fidelities if they differ."""
    first, last = candidate.fidelity, reference.fidelity
    if first == last:
        first, last = f"{first} (candidate)", f"{last} (reference)"
    return [first, *variants, last]


def _source(name: str, result: Result, structure: Structure, hinges: Sequence[PlacedHinge]) -> Source:
    result = _distinct(result)
    if not result.time.size:
        what = f"the {name} result contains no histories"
        raise InputError(Problem(what, result.status.value, "a run that passed its start", result.reason))
    if result.fidelity == "multibody":
        sections = member_sections(result, structure)
        seen = Measured(sections, (), tuple(channel_motions(result, hinges, sections)), ())
    else:
        seen = with_corners(measured(result, structure, hinges), structure, hinges)
        seen = with_t_joints(seen, result, structure, hinges)
    members = member_signals(structure, seen.sections)
    signals = signals_of(result, seen.hinges, members)
    return Source(name, result, seen.hinges, seen.extra, signals)


def _distinct(result: Result) -> Result:
    """The same result with one shape for each time: times that differ by rounding give no rate."""
    times = np.zeros(0) if result.states is None else result.states.times
    if result.states is None or times.size < 2:
        return result
    apart = np.diff(times, prepend=-np.inf) > SAME_TIME * float(times[-1] - times[0])
    return result if apart.all() else replace(result, states=result.states.at_times(times[apart]))


def _until(source: Source, end: float) -> Source:
    """The same source with the motion of its hinges up to a time [s]."""
    return replace(
        source,
        hinges=tuple(motion.until(end) for motion in source.hinges),
        extra=tuple(motion.until(end) for motion in source.extra),
    )


def _hinges(first: Source, second: Source) -> tuple[HingeComparison, ...]:
    """Hinges of both results side by side, then folds without a hinge."""
    names = list(dict.fromkeys(m.name for s in (first, second) for m in (*s.hinges, *s.extra)))
    found = []
    for name in names:
        a, b = first.hinge(name), second.hinge(name)
        place = a or b
        if place is not None:
            found.append(compared(place, a, b))
    return tuple(found)


def openings(source: Source) -> tuple[Opening, ...]:
    """Hinges and folds of one source that opened, in order of opening."""
    found = []
    for motion in (*source.hinges, *source.extra):
        time = metrics_of(motion, ()).opened if motion.time.size else None
        if time is not None and motion.fold:
            found.append(Opening(motion.name, motion.member, motion.station, time))
    return tuple(sorted(found, key=lambda opening: opening.time))
