"""Histories of spot welds: forces, load over strength, and failures with time and position."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from crumple.numeric.arrays import Floats, Integers
from crumple.result import Channel
from crumple.result.channels import channel
from crumple.shell.answer.record import Record
from crumple.shell.model.model import ShellCase
from crumple.shell.model.welds import in_words
from crumple.structure import Structure
from crumple.text.names import listed
from crumple.units import format_quantity

BROKEN, TIME, NORMAL, SHEAR, USE = range(5)
"""Columns of the stepper's states of spot welds."""


def weld_channels(structure: Structure, case: ShellCase, record: Record) -> Iterator[Channel]:
    """Share of spots that failed, largest forces of the others, and largest use so far, of every entry."""
    for name, welds in structure.spot_welds.items():
        rows = record["weld"][:, _numbers(case, name)]
        whole = rows[..., BROKEN] < 0.5
        yield channel(f"weld.{name}.failed", (~whole).mean(axis=1))
        for key, column in (("normal_force", NORMAL), ("shear_force", SHEAR)):
            yield channel(f"weld.{name}.{key}", np.where(whole, rows[..., column], 0.0).max(axis=1))
        if welds.fails:
            yield channel(f"weld.{name}.use", rows[..., USE].max(axis=1))


def weld_assumptions(structure: Structure, case: ShellCase) -> Iterator[str]:
    """Sentences on how spots are tied."""
    if plain := sum(not body.lumps and not body.stretch for body in case.bodies):
        yield f"{plain} spot welds connect pairs of nodes rigidly and cannot fail."
    for name, welds in structure.spot_welds.items():
        across, along = _force(welds.normal_strength), _force(welds.shear_strength)
        fails = f"fail at {across} across and {along} along the sheets" if welds.fails else "cannot fail"
        yield f"{len(_numbers(case, name))} spot welds {name} connect the sheets rigidly and {fails}."


def weld_warnings(structure: Structure, case: ShellCase, record: Record) -> Iterator[str]:
    """Sentences on spots that failed: when, where, and under which forces."""
    for name in structure.spot_welds:
        numbers = _numbers(case, name)
        rows = record["weld"][-1][numbers]
        broken = np.flatnonzero(rows[:, BROKEN] > 0.5)
        if not broken.size:
            continue
        order = broken[np.argsort(rows[broken, TIME], kind="stable")]
        failures = listed([_failure(case, rows, numbers, int(i)) for i in order], separator="; ")
        yield f"{len(order)} of {len(numbers)} spot welds {name} failed: {failures}."


def _failure(case: ShellCase, rows: Floats, numbers: Integers, i: int) -> str:
    """When, where and under which forces one spot of an entry failed."""
    across, along = (_force(float(rows[i, column])) for column in (NORMAL, SHEAR))
    place = in_words(case.welds[numbers[i]].place)
    when = format_quantity(float(rows[i, TIME]), "s", 4)
    return f"at {when} the one at {place}, at {across} across and {along} along the sheets"


def _numbers(case: ShellCase, name: str) -> Integers:
    return np.array([i for i, spot in enumerate(case.welds) if spot.name == name], dtype=np.int64)


def _force(value: float | None) -> str:
    return "any force" if value is None else format_quantity(value, "N", 4)
