"""Data of a comparison: two results of one structure, further models, and curves from files."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from crumple.comparison.measure.crush import CrushComparison
from crumple.comparison.measure.decisive import Figure
from crumple.comparison.measure.metrics import HingeComparison
from crumple.comparison.measure.motion import HingeMotion
from crumple.comparison.rating.curve_file import CurveFile
from crumple.comparison.rating.pairing import Pair
from crumple.comparison.rating.signal import Signal
from crumple.result import Result


@dataclass(frozen=True, eq=False)
class Source:
    """One result with what was read from it.

    Attributes
    ----------
    name
        Its name in the comparison.
    result
        As returned by the solver.
    hinges
        Motion of every hinge: from its channels, or measured in the shapes.
    extra
        Folds without a hinge.
    signals
        Histories by name.
    """

    name: str
    result: Result
    hinges: tuple[HingeMotion, ...]
    extra: tuple[HingeMotion, ...]
    signals: Mapping[str, Signal]

    @property
    def with_threads(self) -> str:
        """Its name, with the number of threads if there are several."""
        threads = self.result.provenance.threads
        return self.name if threads == 1 else f"{self.name}, {threads} threads"

    def hinge(self, name: str) -> HingeMotion | None:
        """Motion of a hinge or fold by name."""
        return next((motion for motion in (*self.hinges, *self.extra) if motion.name == name), None)


@dataclass(frozen=True, eq=False)
class Opening:
    """A hinge or fold that opened: name, member, place along it [m], time [s]."""

    name: str
    member: str
    station: float
    time: float


@dataclass(frozen=True)
class Timing:
    """Wall times of a model that was solved several times, the smallest of each [s].

    Attributes
    ----------
    again
        Of the whole solve, as ``Result.solve_seconds``, with laws sampled again. Unlike the first solve, it
        finds code and data in the processor's caches.
    stepping
        Of the stepper at the requested accuracy, histories included; None if it did not complete.
    """

    again: float
    stepping: float | None


@dataclass(frozen=True)
class Trust:
    """Verdict: level ``good``, ``caution`` or ``bad``, a headline, facts, and cautions."""

    level: str
    headline: str
    facts: tuple[str, ...]
    cautions: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Comparison:
    """Comparison of two results of one structure, as plain data.

    Attributes
    ----------
    title
        Of the analysis.
    candidate, reference
        The result that is assessed, and the result against which it is assessed.
    variants
        Further candidates, for example the same model with elastic-plastic hinges.
    curves
        From files.
    hinges
        For each hinge the candidate and the reference; folds without a hinge come last.
    variant_hinges
        The same for every variant, by its name.
    pairs
        Histories rated: candidate and variants against reference, every result against every curve.
    unpaired
        Columns of curve files that match no history, by file name.
    opened
        Hinges in order of opening, by source name.
    trust
        Verdict and sentences.
    until
        End of the compared duration [s]: the earlier end of the two runs.
    timings
        Of multibody models that were solved repeatedly for timing, by source name.
    busy_share
        Processor time of the reference's solve over the wall time of its threads [-], where it was measured:
        below 1 the threads waited for the processor or for each other.
    """

    title: str
    candidate: Source
    reference: Source
    variants: tuple[Source, ...]
    curves: tuple[CurveFile, ...]
    hinges: tuple[HingeComparison, ...]
    variant_hinges: Mapping[str, tuple[HingeComparison, ...]]
    pairs: tuple[Pair, ...]
    unpaired: Mapping[str, tuple[str, ...]]
    opened: Mapping[str, tuple[Opening, ...]]
    until: float = math.inf
    trust: Trust = field(default_factory=lambda: Trust("caution", "", (), ()))
    timings: Mapping[str, Timing] = field(default_factory=dict)
    busy_share: float | None = None
    crushes: tuple[CrushComparison, ...] = ()
    """Members that can shorten, candidate against reference."""
    figures: Mapping[str, Sequence[Figure]] = field(default_factory=dict)
    """What engineers decide on, by kind, candidate against reference; empty where a run did not complete."""
    in_ranges: Mapping[str, float] = field(default_factory=dict)
    """Values of the reference [SI] for quantities with a range from the bands of the candidate's laws."""

    @property
    def speed_ratio(self) -> float | None:
        """Solve time of the reference over that of the candidate; None if one is unknown."""
        return self.times_faster(self.candidate.result.solve_seconds)

    def times_faster(self, seconds: float | None) -> float | None:
        """Solve time of the reference over a time [s]; None if one is unknown."""
        own = self.reference.result.solve_seconds
        return own / seconds if seconds and own > 0.0 else None

    @property
    def sources(self) -> tuple[Source, ...]:
        """Candidate, variants, reference."""
        return (self.candidate, *self.variants, self.reference)
