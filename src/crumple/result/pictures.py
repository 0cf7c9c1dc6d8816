"""Warning about requested pictures after the end of a run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from crumple.units import format_quantity

MOST_NAMED = 6
"""Times that the warning names one by one."""


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
        named = ", ".join(format_quantity(time, "s", 4) for time in missing[:MOST_NAMED])
        more = f" and {len(missing) - MOST_NAMED} more" if len(missing) > MOST_NAMED else ""
        yield f"The run ended at {format_quantity(end, 's', 4)}: there are no pictures at {named}{more}."
