"""Criteria and scatter of a result in sentences."""

from __future__ import annotations

import math
from collections.abc import Iterator

from crumple.report.drawing.scales import display_unit
from crumple.result import Result
from crumple.result.scatter import Chance, Judged
from crumple.units import plain_number


def sentences(result: Result) -> list[str]:
    """Criteria of the run, share of variants that keep each within this model, and what was left out."""
    return [*criterion_sentences(result), *scatter_sentences(result)]


def criterion_sentences(result: Result) -> Iterator[str]:
    """Whether the run keeps each criterion."""
    for one in result.criteria:
        limits = [
            f"{word} {_quantity(limit, one.unit)}"
            for word, limit in (("at least", one.at_least), ("at most", one.at_most))
            if limit is not None
        ]
        wanted = " and ".join(limits)
        if one.kept is None:
            yield f"Criterion {one.name} {_undecided(one)}."
            continue
        kept = "kept" if one.kept else "violated"
        value = _quantity(one.value, one.unit)
        yield f"Criterion {one.name} {kept}: {_told(one)} is {value}, {wanted} allowed."


def scatter_sentences(result: Result) -> Iterator[str]:
    """Share of variants that keep each criterion."""
    scatter = result.scatter
    if scatter is None:
        return
    for chance in scatter.chances:
        yield _chance(chance)
    yield from (f"{note[:1].upper()}{note[1:]}." for note in scatter.notes)
    if scatter.chances:
        more = "The scatter is that of the input's numbers alone; it contains no error of the model"
        range_told = ", whose range from the bands of the laws is stated apart" if result.law_range else ""
        yield f"{more}{range_told}."


def _undecided(one: Judged) -> str:
    if math.isfinite(one.value):
        return (
            f"not decided: the run ended early, {_told(one)} is {_quantity(one.value, one.unit)} until then"
        )
    if one.take == "at":
        return f"not decided: {one.channel} has no value at its time, or the run ended before"
    return f"not decided: {one.channel} has no value"


def _told(one: Judged) -> str:
    return {"max": "largest ", "final": "final ", "at": ""}[one.take] + one.channel


def _chance(chance: Chance) -> str:
    low, high = chance.interval
    share = f"{100.0 * chance.probability:.3g} % of {chance.rows} variants keep criterion {chance.name}"
    return f"Within this model {share} (95 % interval {100.0 * low:.3g} to {100.0 * high:.3g} %)."


def _quantity(value: float, si: str) -> str:
    unit, factor = ("°", math.radians(1.0)) if si == "rad" else display_unit(si, value)
    text = plain_number(value / factor)
    return text + unit if unit == "°" else f"{text} {unit}".strip()
