"""Energies of a whole run, used as the basis of shares."""

from __future__ import annotations

import numpy as np

from crumple.result import Result


def energy_put_in(result: Result) -> float:
    """Energy at the start and the largest external work [J]."""
    start = sum(
        float(result[name][0]) for name in ("energy.kinetic", "energy.elastic") if name in result.channels
    )
    return start + (largest_of(result, "energy.external_work") or 0.0)


def largest_of(result: Result, channel: str) -> float | None:
    """Largest magnitude of a channel; None where the result has none."""
    if channel not in result.channels:
        return None
    return float(np.nanmax(np.abs(result[channel]), initial=0.0))
