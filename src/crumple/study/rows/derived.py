"""Channels that are made of the histories of a batch: mean accelerations of nodes, and filtered channels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from crumple.analysis.criteria import Measured
from crumple.analysis.filters import LEAST_SAMPLES
from crumple.numeric.arrays import Floats
from crumple.result import ChannelClass, cfc
from crumple.result.filters import value_before
from crumple.structure import Outputs

if TYPE_CHECKING:
    from crumple.multibody import Run


@dataclass(frozen=True)
class Source:
    """What a channel is made of.

    Attributes
    ----------
    raw
        Channel of the histories of a batch.
    slope
        Whether it is its slope over time: mean accelerations between outputs are that of velocities.
    channel_class
        Of the filter; None without one.
    before
        Value before the run, for the filter.
    """

    raw: str
    slope: bool = False
    channel_class: ChannelClass | None = None
    before: float | None = None

    @classmethod
    def of(cls, channel: str, outputs: Outputs) -> Source:
        """The source of a channel of results."""
        asked = outputs.filters.get(channel)
        channel, wanted = (channel, None) if asked is None else (asked.channel, asked.cfc)
        parts = channel.split(".")
        slope = parts[0] == "node" and parts[2:3] == ["acceleration"]
        raw = ".".join([*parts[:2], "velocity", *parts[3:]]) if slope else channel
        return cls(raw, slope, wanted, value_before(channel))

    @property
    def derived(self) -> bool:
        """Whether it is another history than that of the batch."""
        return self.slope or self.channel_class is not None

    def values(self, history: Floats, times: Floats, run: Run, wanted: Measured) -> Floats:
        """A number of each row, (n,), as `crumple.analysis.criteria.measure` reads it of a single run.

        Parameters
        ----------
        history, times
            Of `raw`, (n, times), at times that contain the outputs of the run [s].
        run
            Its output times and interval are those of the filter.
        wanted
            What to take of it.
        """
        from crumple.multibody.run import output_times  # noqa: PLC0415  (needs the kernels)

        outputs = output_times(run)
        rows = history[:, np.searchsorted(times, outputs)]
        found = np.full(len(rows), np.nan)
        for i in np.flatnonzero(np.isfinite(rows).all(axis=1)).tolist():
            found[i] = _taken(self._made(rows[i], outputs, run.every), outputs, wanted)
        return found

    def _made(self, row: Floats, outputs: Floats, every: float) -> Floats:
        values = np.gradient(row, outputs) if self.slope else row
        if self.channel_class is None:
            return np.asarray(values)
        regular = np.arange(math.floor(outputs[-1] / every + 1e-9) + 1) * every
        if regular.size < LEAST_SAMPLES:
            return np.full(outputs.size, np.nan)
        even = np.interp(regular, outputs, values)
        smooth = cfc(even, every, self.channel_class, before=self.before)
        return np.asarray(np.interp(outputs, regular, smooth))


def _taken(values: Floats, times: Floats, wanted: Measured) -> float:
    if wanted.take == "final":
        return float(values[-1])
    if wanted.take == "at":
        return float(np.interp(wanted.time, times, values))
    return float(values[np.argmax(np.abs(values))])
