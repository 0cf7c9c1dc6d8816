"""Filtered channels of an analysis: check of the request, and computation."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from crumple.errors import Problem
from crumple.result import Channel, Result, cfc
from crumple.result.channels import names_of
from crumple.result.filters import CUT_OFF, SAMPLES_PER_CUT_OFF, value_before
from crumple.structure import Filter, Outputs, hinge_places
from crumple.structure.parts import StructureParts
from crumple.structure.schema.problems import one_of, suggestion

LEAST_SAMPLES = 4
"""Samples that a filter needs."""


def filter_problems(
    structure: StructureParts, outputs: Outputs, duration: float, interval: float
) -> list[Problem]:
    """Filters of channels that the run will not have, or that are sampled too coarsely.

    Parameters
    ----------
    structure
        A valid structure, so that its hinges have names.
    outputs
        What is reported.
    duration, interval
        Of the histories [s].
    """
    if not outputs.filters:
        return []
    known = sorted(_channels(structure, outputs))
    return [
        problem
        for name, wanted in outputs.filters.items()
        for problem in _problems(f"outputs.filters.{name}", wanted, known, duration, interval)
    ]


def with_filters(result: Result, outputs: Outputs, interval: float) -> Result:
    """Result with the filtered channels added; those too short to filter are left out with a warning.

    Parameters
    ----------
    result
        As the solver gave it.
    outputs
        What is reported.
    interval
        Of the histories [s].
    """
    if not result.time.size or not outputs.filters:
        return result
    channels, warnings = dict(result.channels), list(result.warnings)
    # picture times may lie between the samples: filter only the regular samples
    regular = np.arange(math.floor(result.time[-1] / interval + 1e-9) + 1) * interval
    for name, wanted in outputs.filters.items():
        if regular.size < LEAST_SAMPLES or wanted.channel not in channels:
            warnings.append(f"{name} could not be filtered: the run ended too early")
            continue
        raw = channels[wanted.channel]
        even = np.interp(regular, result.time, raw.values)
        smooth = cfc(even, interval, wanted.cfc, before=value_before(wanted.channel))
        channels[name] = Channel(name, raw.unit, np.interp(result.time, regular, smooth))
    names = (*result.output_names, *(name for name in outputs.filters if name in channels))
    return replace(result, channels=channels, warnings=tuple(warnings), output_names=names)


def _channels(structure: StructureParts, outputs: Outputs) -> Iterator[str]:
    """Names of the channels that a run will have and that can be filtered."""
    for place in hinge_places(structure):
        yield from names_of("hinge", place.name)
    for node in outputs.nodes:
        yield from names_of("node", node)
    for obstacle in structure.obstacles:
        yield from names_of("obstacle", obstacle)
    yield from outputs.section_rotations
    yield from outputs.distances
    yield from outputs.clearances


def _problems(
    where: str, wanted: Filter, known: list[str], duration: float, interval: float
) -> Iterator[Problem]:
    if wanted.channel not in known:
        todo = suggestion(wanted.channel, known) or "name a channel of a hinge, or of a node in outputs.nodes"
        what = f"the run has no channel '{wanted.channel[:80]}'"
        yield Problem(what, wanted.channel[:80], one_of(known), todo, f"{where}.channel")
    longest = 1.0 / (SAMPLES_PER_CUT_OFF * CUT_OFF[wanted.cfc])
    if interval > longest:
        allowed = f"an interval of at most {1e3 * longest:.3g} ms for CFC {wanted.cfc}"
        what, todo = "the histories are too coarse for this filter", "give a shorter 'every' in outputs"
        yield Problem(what, f"{1e3 * interval:.3g} ms", allowed, todo, f"{where}.cfc")
    elif duration / interval < LEAST_SAMPLES:
        todo = "give a shorter 'every' in outputs"
        yield Problem("the histories are too short to filter", todo=todo, where=f"{where}.cfc")
