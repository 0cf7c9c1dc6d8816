"""The time in which something happens: curves over time are drawn there."""

from __future__ import annotations

import numpy as np

from crumple.result import Result

FIRST, LAST = 0.005, 0.995
"""Shares of the dissipated energy between which something happens."""
BEFORE, AFTER = 0.15, 0.3
"""What is shown before and after, over the time between."""
WHOLE = 0.7
"""Share of the run from which the whole of it is shown."""
LEAST = 24
"""Fewest output times that are shown."""


def happening(result: Result) -> slice:
    """Output times in which the structure absorbs its energy, with some before and after.

    Derived here: from 0.5 % to 99.5 % of the dissipated energy, widened by 15 % of that time before and
    30 % after it.  The whole run if that is most of it, or if nothing is dissipated.

    Parameters
    ----------
    result
        Its time and channel ``energy.dissipated``.
    """
    whole = slice(0, len(result.time))
    channel = result.channels.get("energy.dissipated")
    if channel is None or len(result.time) < LEAST or not np.isfinite(channel.values).all():
        return whole
    absorbed = np.maximum.accumulate(channel.values - channel.values[0])
    total = float(absorbed[-1])
    if not total > 0.0:
        return whole
    first = result.time[int(np.searchsorted(absorbed, FIRST * total))]
    last = result.time[int(np.searchsorted(absorbed, LAST * total))]
    start, end = first - BEFORE * (last - first), last + AFTER * (last - first)
    if end - start >= WHOLE * (result.time[-1] - result.time[0]):
        return whole
    low = int(np.searchsorted(result.time, start))
    high = int(np.searchsorted(result.time, end, side="right"))
    missing = max(LEAST - (high - low), 0)
    low = max(low - missing // 2, 0)
    return slice(low, min(max(high, low + LEAST), len(result.time)))


def window_sentence(result: Result) -> str:
    """What part of the run the curves over time show; empty if all of it."""
    from crumple.units import format_quantity  # noqa: PLC0415

    part = happening(result)
    if part == slice(0, len(result.time)):
        return ""
    start, end = (format_quantity(float(t), "s", 3) for t in result.time[part][[0, -1]])
    whole = format_quantity(float(result.time[-1]), "s", 3)
    return (
        f"Curves over time show {start} to {end} of {whole}, in which the structure absorbs its energy; "
        "histories.csv has all."
    )
