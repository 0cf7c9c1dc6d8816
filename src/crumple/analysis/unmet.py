"""Stages that ended by their duration although the input has conditions that were to end them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from crumple.numeric.arrays import Floats
from crumple.result import Result, StageSummary
from crumple.structure import Stage, Until
from crumple.units import format_quantity

UNITS = {"force": "N", "energy": "J", "displacement": "m", "distance": "m"}
"""Of the quantities of conditions."""


def with_unmet(result: Result, stages: Sequence[Stage]) -> Result:
    """A result with a warning for each stage none of whose conditions was met."""
    found = []
    for stage, summary in zip(stages, result.stages, strict=False):
        stopped = not result.status.ok and summary is result.stages[-1]
        if stage.until and not stopped and summary.by_duration:
            missed = " and ".join(_missed(until, result, summary) for until in stage.until)
            found.append(f"Stage {stage.name} ended by its duration: {missed}.")
    return replace(result, warnings=(*result.warnings, *found)) if found else result


def _missed(until: Until, result: Result, stage: StageSummary) -> str:
    unit = UNITS[until.quantity]
    of = f" of {until.of}" if until.of else ""
    between = f" between {until.between[0]} and {until.between[1]}" if until.between else ""
    wanted = format_quantity(until.value, unit, 3)
    reached = [float(values.max()) for values in _histories(until, result, stage)]
    # shells average forces over a while, their histories do not
    below = reached and reached[0] < until.value
    came = f" ({format_quantity(reached[0], unit, 3)} at most)" if below else ""
    return f"{until.quantity}{of}{between} {wanted} was not reached{came}"


def _histories(until: Until, result: Result, stage: StageSummary) -> Iterator[Floats]:
    """The quantity of a condition in its stage, (n,); nothing where the result has no channel of it."""
    inside = (result.time >= stage.start) & (result.time <= stage.end)
    if not inside.any():
        return
    if until.quantity == "energy":
        names = ["energy.external_work"]
    else:
        kinds = ("obstacle", "support")
        all_of = [[f"{kind}.{until.of}.{until.quantity}.{axis}" for axis in "xyz"] for kind in kinds]
        names = next((one for one in all_of if all(name in result.channels for name in one)), [])
    if not names or not all(name in result.channels for name in names):
        return
    values = np.array([result.channels[name].values[inside] for name in names])
    if until.quantity == "force":
        yield np.linalg.norm(values, axis=0)
    else:
        since = values - values[:, :1]
        yield since[0] if until.quantity == "energy" else np.linalg.norm(since, axis=0)
