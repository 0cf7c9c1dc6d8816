"""Criteria of a result, and how the result scatters with its input."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

BANDS = "bands.csv"
"""File of the bands."""


@dataclass(frozen=True)
class Judged:
    """A criterion and the value of a run.

    Attributes
    ----------
    name, channel, take
        As in the input.
    unit
        SI unit of the numbers.
    at_least, at_most
        Limits; None without one.
    value
        Of the run, as far as it came; NaN if it has none.
    kept
        Whether the value is within the limits; None if there is no value, or the run ended early and does
        not decide it.
    """

    name: str
    channel: str
    take: str
    unit: str
    at_least: float | None
    at_most: float | None
    value: float
    kept: bool | None


@dataclass(frozen=True)
class Chance:
    """Share of variants that keep a criterion, within this model.

    Attributes
    ----------
    name
        Of the criterion.
    rows, kept
        Complete variants, and those of them that keep it.
    probability
        Their share.
    interval
        Of Clopper and Pearson, 95 %: for the number of variants alone, not for an error of the model.
    """

    name: str
    rows: int
    kept: int
    probability: float
    interval: tuple[float, float]


@dataclass(frozen=True)
class Swing:
    """A response with one variable at its 2.5 % and 97.5 % value, the others at their medians.

    Attributes
    ----------
    response, unit
        What is reported, and its SI unit.
    variable
        What is moved.
    low, middle, high
        Response at the lower value, with all at their medians, and at the higher value.
    """

    response: str
    unit: str
    variable: str
    low: float
    middle: float
    high: float


@dataclass(frozen=True)
class Scatter:
    """What variants of the input with scattering numbers gave; numbers are SI.

    Attributes
    ----------
    rows, complete
        Variants, and those that reached their end; the others are in no number below.
    sources
        Where the distribution of each variable is from, in words.
    times
        Of the bands [s].
    bands
        By channel: 2.5 %, 50 % and 97.5 % quantile at each time.
    chances
        Of each criterion.
    swings
        For a tornado: by response, the widest first.
    notes
        What was left out, in words.
    """

    rows: int
    complete: int
    sources: Mapping[str, str]
    times: tuple[float, ...]
    bands: Mapping[str, tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]]
    chances: tuple[Chance, ...] = ()
    swings: tuple[Swing, ...] = ()
    notes: tuple[str, ...] = ()


def judged_of(plain: Any) -> tuple[Judged, ...]:
    """Criteria as stored."""
    return tuple(Judged(**one) for one in plain or ())


def scatter_of(plain: Mapping[str, Any] | None) -> Scatter | None:
    """A scatter as stored."""
    if plain is None:
        return None
    bands = {name: (tuple(low), tuple(mid), tuple(high)) for name, (low, mid, high) in plain["bands"].items()}
    chances = tuple(Chance(**{**one, "interval": tuple(one["interval"])}) for one in plain["chances"])
    swings = tuple(Swing(**one) for one in plain["swings"])
    head = plain["rows"], plain["complete"], plain["sources"], tuple(plain["times"])
    return Scatter(*head, bands, chances, swings, tuple(plain["notes"]))


def bands_csv(scatter: Scatter) -> str:
    """Times and quantiles of every band as CSV, SI units."""
    names = [f"{name}.{share}" for name in scatter.bands for share in ("q2.5", "median", "q97.5")]
    columns = [scatter.times, *(column for band in scatter.bands.values() for column in band)]
    lines = [",".join(map(repr, row)) for row in zip(*columns, strict=True)]
    return "\n".join([",".join(["time", *names]), *lines]) + "\n"
