"""Notes on every curve file: which columns were rated, and why others were not."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from crumple.result.format import former_names_note
from crumple.text.names import listed

if TYPE_CHECKING:
    from crumple.comparison import Comparison, CurveFile

MOST_COLUMNS = 8
"""Number of columns listed per file; the table of ratings contains all."""


def curve_notes(comparison: Comparison) -> list[tuple[str, bool]]:
    """One text per curve file, and whether all its columns with a unit could be rated."""
    found = []
    for curve in comparison.curves:
        notes = list(_columns(comparison, curve))
        texts = [listed((text for text, _ in notes), MOST_COLUMNS, "; ")] if notes else []
        if curve.left_out:
            texts.append(f"ignored because they have no unit: {', '.join(curve.left_out)}")
        text = f"{curve.name} ({Path(curve.file).name}): {'; '.join(texts)}."
        if note := former_names_note(curve.columns):
            text = f"{text} {note}"
        found.append((text, all(rated for _, rated in notes)))
    return found


def _columns(comparison: Comparison, curve: CurveFile) -> Iterator[tuple[str, bool]]:
    """Note on each column, and whether it was rated."""
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
            yield f"{name} is not the name of a history of the results", False
        elif signal.unit not in units:
            yield f"{name} is in {signal.unit}, but in {', '.join(sorted(units))} in the results", False
        else:
            else_ = (
                "the limit of rated histories is reached" if signal.values.any() else "it is zero throughout"
            )
            why = next((p.why_not for p in pairs if p.why_not), else_)
            yield f"{name} not rated: {why}", False
