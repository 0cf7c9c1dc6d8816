"""Warning about requested pictures after the end of a run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from crumple.text.names import listed
from crumple.units import format_quantity


def missing_pictures(asked: Sequence[float], end: float) -> Iterator[str]:
    """A warning where a run ended before some of its pictures.

    Parameters
    ----------
    asked
        Times of the pictures [s].
    end
        Last output [s].
    """
    missing = [time for time in sorted(asked) if time > end * (1.0 + 1e-9)]
    if missing:
        named = listed(missing, spell=lambda time: format_quantity(time, "s", 4))
        yield f"The run ended at {format_quantity(end, 's', 4)}: there are no pictures at {named}."
