"""What became of every curve file, column by column."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from crumple.comparison import Comparison, CurveFile
from crumple.result.format import former_names_note

MOST_COLUMNS = 8
"""Columns of a file that are told one by one; the table of ratings holds all."""


def curve_notes(comparison: Comparison) -> list[tuple[str, bool]]:
    """One text per curve file, and whether everything with a unit in it could be rated."""
    found = []
    for curve in comparison.curves:
        told = list(_columns(comparison, curve))
        texts = [text for text, _ in told[:MOST_COLUMNS]]
        if len(told) > MOST_COLUMNS:
            texts.append(f"{len(told) - MOST_COLUMNS} more")
        if curve.left_out:
            texts.append(f"without a unit, and so left out: {', '.join(curve.left_out)}")
        text = f"{curve.name} ({Path(curve.file).name}): {'; '.join(texts)}."
        if note := former_names_note(curve.columns):
            text = f"{text} {note}"
        found.append((text, all(rated for _, rated in told)))
    return found


def _columns(comparison: Comparison, curve: CurveFile) -> Iterator[tuple[str, bool]]:
    """What became of each column."""
    models = {model.name for model in comparison.variants}
    for name, signal in curve.signals.items():
        pairs = [p for p in comparison.pairs if (p.channel, p.reference) == (name, curve.name)]
        rated = [
            f"{p.rating.overall:.2f} ({p.candidate})" for p in pairs if p.rating if p.candidate not in models
        ]
        units = {s.signals[name].unit for s in comparison.sources if name in s.signals}
        if rated:
            yield f"{name} rated {', '.join(rated)}", True
        elif not units:
            yield f"no history of the results is called {name}", False
        elif signal.unit not in units:
            told = ", ".join(sorted(units))
            yield f"{name} is in {signal.unit}, in the results in {told}: not compared", False
        else:
            else_ = (
                "there are more histories than are rated" if signal.values.any() else "it is zero throughout"
            )
            why = next((p.why_not for p in pairs if p.why_not), else_)
            yield f"{name} not rated: {why}", False
