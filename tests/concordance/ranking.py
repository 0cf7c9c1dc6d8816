"""Ranking of layouts: Kendall's tau-b of the intrusions, over pairs that the shells can tell apart."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crumple.numeric.arrays import Floats

SAMPLES = 2000
"""Bootstrap samples of the layouts."""
SEED = 1
LEVEL = 0.95


@dataclass(frozen=True)
class Ranking:
    """tau-b [-], bounds of its bootstrap interval, and the number of pairs that count."""

    tau: float
    low: float
    high: float
    pairs: int


def ranking(shells: Floats, spreads: Floats, values: Floats) -> Ranking:
    """Agreement of two rankings.

    Parameters
    ----------
    shells, spreads
        Value of each layout by shells and its spread over meshes and imperfection, (n,).
    values
        By the model that is judged, (n,); what failed is infinite, and worse than all others.

    References
    ----------
    Kendall, M. G. (1945). The treatment of ties in ranking problems. Biometrika 33, 239-251.
    """
    rng = np.random.default_rng(SEED)
    samples = [
        _tau(shells, spreads, values, rng.integers(0, len(shells), len(shells)))[0] for _ in range(SAMPLES)
    ]
    low, high = np.nanquantile(samples, [(1.0 - LEVEL) / 2.0, (1.0 + LEVEL) / 2.0])
    tau, pairs = _tau(shells, spreads, values, np.arange(len(shells)))
    return Ranking(tau, float(low), float(high), pairs)


def _tau(shells: Floats, spreads: Floats, values: Floats, chosen: Floats) -> tuple[float, int]:
    i, j = np.triu_indices(len(chosen), 1)
    a, b = chosen[i], chosen[j]
    apart = np.abs(shells[a] - shells[b]) > np.maximum(spreads[a], spreads[b])
    first = np.sign(shells[a] - shells[b])[apart]
    with np.errstate(invalid="ignore"):
        second = np.nan_to_num(np.sign(values[a] - values[b]))[apart]
    tied = np.count_nonzero(second)
    pairs = len(first)
    return (float(first @ second) / float(np.sqrt(pairs * tied)) if tied else float("nan")), pairs
