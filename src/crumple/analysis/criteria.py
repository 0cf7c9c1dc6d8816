"""Criteria of an input: limits of what a run reports, and how the run meets them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from crumple.analysis.distribution import Value, number
from crumple.errors import InputError, Problem, Status
from crumple.result import Result
from crumple.result.channels import unit_of
from crumple.result.scatter import Judged
from crumple.structure import Outputs, hinge_places
from crumple.structure.parts import StructureParts
from crumple.structure.schema.problems import one_of, suggestion
from crumple.structure.schema.spec import Spec

SUMMARISED = ("rotation", "moment")
"""Channels of hinges whose largest value the stepper keeps."""
SAME = 1e-9
"""Part of a time by which rounding may put it after the end of a run."""
EARLY = frozenset(Status) - {Status.COMPLETE, Status.RESIDUAL_EXCEEDED, Status.IMPOSSIBLE}
"""How runs end that did not reach their end."""


class Criterion(Spec):
    """A limit of a channel that the structure shall keep."""

    channel: str
    """Name of a channel of the result, such as hinge.root.rotation."""
    take: Literal["final", "max", "at"] = "max"
    """Its last value, that of largest magnitude (of hinges without, else with sign), or that at a time."""
    time: Value | None = None
    """For 'at'."""
    at_most: Value | None = None
    """Largest permitted value."""
    at_least: Value | None = None
    """Smallest permitted value."""


@dataclass(frozen=True)
class Measured:
    """A number that is read from a result.

    Attributes
    ----------
    name
        By which it is called.
    channel
        Of the result; empty for the mass of members.
    take, time
        As in a criterion; [s].
    """

    name: str
    channel: str
    take: str = "final"
    time: float = 0.0

    @property
    def quantity(self) -> str | None:
        """Name in a table of variants; None if it has only the history."""
        parts = self.channel.split(".")
        if self.take == "final":
            return self.channel
        if self.take == "max" and parts[0] == "hinge" and len(parts) == 3 and parts[2] in SUMMARISED:
            return f"{self.channel}_max"
        return None


def measure(result: Result, wanted: Measured) -> float:
    """The number of a result; NaN if it has no such channel."""
    quantity = wanted.quantity
    if wanted.take == "max" and quantity is not None:
        hinge, name = quantity.split(".")[1:]
        summary = result.hinges.get(hinge)
        return np.nan if summary is None else float(getattr(summary, name))
    channel = result.channels.get(wanted.channel)
    if channel is None or not channel.values.size:
        return np.nan
    if wanted.take == "final":
        return float(channel.values[-1])
    if wanted.take == "at":
        return float(np.interp(wanted.time, result.time, channel.values))
    return float(channel.values[np.argmax(np.abs(channel.values))])


def criteria_in_si(
    criteria: Mapping[str, Criterion], structure: StructureParts, outputs: Outputs, duration: float
) -> tuple[dict[str, Criterion], list[Problem]]:
    """Criteria with all quantities in SI, and mistakes: unknown channels, other dimensions, late times.

    Parameters
    ----------
    criteria
        As written, by name.
    structure, outputs
        Of the file; they name the channels.
    duration
        Of the run [s].
    """
    found, problems = {}, []
    for name, given in criteria.items():
        where = f"criteria.{name}"
        try:
            unit = _unit(given.channel, structure, outputs, where)
            found[name] = _in_si(given, unit, where)
            problems += late(float(found[name].time or 0.0), duration, f"{where}.time")
        except InputError as error:
            problems += error.problems
    return found, problems


def late(time: float, duration: float, where: str) -> list[Problem]:
    """The problem of a time at which a number is wanted and that is after the end of the run [s]."""
    if time <= duration * (1.0 + SAME):
        return []
    what, todo = "this time is after the end of the run", "correct the time or the duration"
    return [Problem(what, f"{time:g} s", f"at most {duration:g} s, the duration", todo, where)]


def limits_of(criteria: Mapping[str, Criterion], result: Result) -> list[tuple[Measured, float, float]]:
    """What criteria measure, with least and largest value [SI]; without those whose channel is not there.

    Parameters
    ----------
    criteria
        By name; a number without unit is SI.
    result
        Gives the channels and their units.
    """
    found = []
    for name, given in criteria.items():
        channel = result.channels.get(given.channel)
        if channel is not None:
            one = _in_si(given, channel.unit, f"criteria.{name}", bare=True)
            low, high = (math.nan if end is None else float(end) for end in (one.at_least, one.at_most))
            low, high = (-math.inf if math.isnan(low) else low), (math.inf if math.isnan(high) else high)
            found.append((Measured(name, one.channel, one.take, float(one.time or 0.0)), low, high))
    return found


def with_criteria(result: Result, criteria: Mapping[str, Criterion]) -> Result:
    """A result with its criteria judged; one whose channel this solver does not give is a warning.

    Of a run that ended early only violations of a largest value and values at a time that it reached count.
    """
    if not criteria or not result.time.size:
        return result
    judged = []
    for one, low, high in limits_of(criteria, result):
        value, unit = measure(result, one), result.channels[one.channel].unit
        if _after(result, one):
            value = math.nan
        kept = _kept(result, one, value, (low, high))
        ends = (low if math.isfinite(low) else None, high if math.isfinite(high) else None)
        judged.append(Judged(one.name, one.channel, one.take, unit, *ends, value, kept))
    missing = tuple(
        f"criterion {name} is not judged: this result has no channel {given.channel}"
        for name, given in criteria.items()
        if given.channel not in result.channels
    )
    return replace(result, criteria=tuple(judged), warnings=(*result.warnings, *missing))


def _after(result: Result, one: Measured) -> bool:
    """Whether a number is wanted at a time that the run did not reach."""
    return one.take == "at" and one.time > float(result.time[-1]) * (1.0 + SAME)


def _kept(result: Result, one: Measured, value: float, limits: tuple[float, float]) -> bool | None:
    """Whether a value is within its limits; None if it has none, or could still change in a run cut short.

    A largest value only grows: one that is beyond a limit stays beyond it.
    """
    low, high = limits
    if not math.isfinite(value):
        return None
    if result.status in EARLY and one.take != "at":
        beyond = one.take == "max" and (value > max(high, 0.0) or value < min(low, 0.0))
        return False if beyond else None
    return bool(low <= value <= high)


def _in_si(given: Criterion, unit: str, where: str, *, bare: bool = False) -> Criterion:
    """A criterion in SI; `bare`: numbers without unit are."""
    if (given.take == "at") != (given.time is not None):
        raise InputError(Problem("'take: at' and 'time' belong together", "", "", "give both or none", where))
    if given.at_most is None and given.at_least is None:
        raise InputError(Problem("the limit is missing", "", "at_most, at_least", "add one", where))
    numbers = {
        key: float(value) if bare and not isinstance(value, str) else number(value, own, f"{where}.{key}")
        for key, own in (("at_most", unit), ("at_least", unit), ("time", "s"))
        if (value := getattr(given, key)) is not None
    }
    low, high = numbers.get("at_least", -math.inf), numbers.get("at_most", math.inf)
    if low > high:
        what = "no value is within both limits"
        came, todo = f"at_least {low:g}, at_most {high:g} (SI)", "exchange them, or leave one out"
        raise InputError(Problem(what, came, "at_least <= at_most", todo, where))
    return given.model_copy(update=numbers)


def _unit(channel: str, structure: StructureParts, outputs: Outputs, where: str) -> str:
    """SI unit of a channel that a run of the structure has."""
    if channel in outputs.filters:
        channel = outputs.filters[channel].channel
    if channel in outputs.section_rotations:
        return "rad"
    if channel in outputs.distances or channel in outputs.clearances:
        return "m"
    unit, named = unit_of(channel), channel.split(".")
    known = {
        "hinge": [place.name for place in hinge_places(structure)],
        "node": list(outputs.nodes),
        "member": list(structure.members),
        "support": list(structure.supports),
        "obstacle": list(structure.obstacles),
    }
    if unit is not None and (len(named) < 3 or named[1] in known.get(named[0], [named[1]])):
        return unit
    names = [f"{family}.{name}" for family, all_of in known.items() for name in all_of]
    own = [*names, *outputs.section_rotations, *outputs.distances, *outputs.clearances, *outputs.filters]
    todo = suggestion(".".join(named[:2]), own) or "name a channel of a hinge, of a node in outputs, ..."
    allowed = "hinge.NAME.rotation, node.NAME.displacement.z, energy.dissipated, ...; " + one_of(own)
    what = "the run has no such channel"
    raise InputError(Problem(what, channel[:80], allowed, todo, f"{where}.channel"))
