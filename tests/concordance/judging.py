"""Errors of the multibody models against the shells, and whether they are within the targets."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from tests.concordance.models import ELASTIC, MODELS
from tests.concordance.ranges import Ranged, ranged
from tests.concordance.stored import ShellResults, read
from tests.concordance.suite import RANKED, Case

from crumple.analysis import solve
from crumple.comparison import with_frames
from crumple.comparison.measure.crushed_zones import with_joined_zones
from crumple.comparison.measure.decisive import Figure, figures_of
from crumple.comparison.measure.measures import Measures, measure
from crumple.errors import InputError
from crumple.structure import with_elastic_members


@dataclass(frozen=True)
class Verdict:
    """One structure and model.

    Attributes
    ----------
    case, model
        Which.
    measures
        Of the model; None where the input was refused.
    shells
        Stored results.
    figures
        By kind of figure; every kind that the shells have is there.
    order
        Share of pairs of joints that open in the same order [-]; NaN without pairs.
    reason
        Why there is no result.
    ranges
        Displacements with the range from the bands of the laws; of elastic members, and not of layouts.
    """

    case: Case
    model: str
    measures: Measures | None
    shells: ShellResults
    figures: dict[str, list[Figure]] = field(default_factory=dict)
    order: float = math.nan
    reason: str = ""
    ranges: list[Ranged] = field(default_factory=list)

    def worst(self, kind: str) -> float:
        """Largest error of a kind; NaN without one."""
        return max((figure.error for figure in self.figures.get(kind, [])), default=math.nan)

    def right(self, kind: str) -> bool:
        """Whether all figures of a kind are within what is allowed."""
        return all(figure.right for figure in self.figures.get(kind, []))


def judged(cases: Sequence[Case], models: Sequence[str], say: Callable[[str], object]) -> list[Verdict]:
    """Solve and judge; a structure without shell results, or whose shells failed, is left out by name."""
    found = []
    for case in cases:
        shells = read(case)
        if shells is None or not shells.reference.complete:
            say(
                f"{case.name}: no shell results for this input; "
                f"run: python -m tests.concordance shells {case.name}"
            )
            continue
        for model in models:
            verdict = _judged(case, model, shells)
            found.append(verdict)
            errors = ", ".join(
                f"{kind} {100 * verdict.worst(kind):.0f} %{'' if verdict.right(kind) else ' !'}"
                for kind in verdict.figures
            )
            say(f"{case.name}, {model}: {errors} {verdict.reason}")
    return found


def _judged(case: Case, model: str, shells: ShellResults) -> Verdict:
    begin = time.process_time()
    try:
        analysis = MODELS[model](case.analysis())
        result = solve(analysis)
        seconds = time.process_time() - begin
        bending = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
        measures = measure(solve(with_frames(analysis)), bending, seconds)
        reason = "" if measures.complete else f"{result.status.value}: {result.reason}"
        has_range = model == ELASTIC and case not in RANKED
        ranges = ranged(analysis, result, shells.reference) if has_range else []
    except InputError as error:
        measures, reason, ranges = Measures(status="refused"), error.problems[0].what, []
    # the shells' names: a model with other joints or hinges is measured at the same places
    own = case.analysis()
    structure = with_elastic_members(own.structure, own.multibody, own.time_in_motion)
    reference, *runs = (
        with_joined_zones(one, structure, shells.reference)
        for one in (shells.reference, *(one for pair in shells.pairs for one in pair))
    )
    joined = with_joined_zones(measures, structure, shells.reference)
    figures = figures_of(joined, reference, tuple(zip(runs[::2], runs[1::2], strict=True)))
    return Verdict(case, model, measures, shells, figures, _order(measures, shells.reference), reason, ranges)


def _order(model: Measures, shell: Measures) -> float:
    both = [name for name in shell.opened if name in model.opened]
    pairs = [
        (shell.opened[a] - shell.opened[b]) * (model.opened[a] - model.opened[b]) > 0.0
        for i, a in enumerate(both)
        for b in both[:i]
        if shell.opened[a] != shell.opened[b] and model.opened[a] != model.opened[b]
    ]
    return sum(pairs) / len(pairs) if pairs else math.nan
