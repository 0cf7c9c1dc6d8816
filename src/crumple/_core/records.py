"""Records of runs of both multibody kernels, by name; the columns of native/common/records.hpp.

A column has one row for every output time, or, where many runs are solved together, for every run.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any, TypeVar

import numpy as np

from crumple._core._kernels import record_columns
from crumple.numeric.arrays import Floats

Record = TypeVar("Record")


@dataclass(frozen=True, eq=False)
class EnergyRecord:
    """Energies of the whole model [J], (n,) each; zero in columns that do not apply to a kernel.

    Attributes
    ----------
    kinetic, elastic, dissipated, damped, spring, contact, friction, external_work
        As they are called.
    stop
        Stored and dissipated in stops.
    slowed
        Taken out of the motion by quasi-static stages.
    """

    kinetic: Floats
    elastic: Floats
    dissipated: Floats
    damped: Floats
    stop: Floats
    spring: Floats
    contact: Floats
    friction: Floats
    external_work: Floats
    slowed: Floats


@dataclass(frozen=True, eq=False)
class HingeEnergyRecord:
    """Energies of every hinge [J], (n, hinges) each; `dissipated` includes dampers and stops."""

    dissipated: Floats
    elastic: Floats
    stop: Floats


@dataclass(frozen=True, eq=False)
class ComponentRecord:
    """Components of all hinges in their order, (n, components) each.

    Attributes
    ----------
    rotation, rate, plastic
        Rotation [rad], its rate, and its plastic part; of an axial component the travel [m].
    moment, capacity
        Moment [N m], and the capacity in the sense in which the component moves; of an axial one forces [N].
    """

    rotation: Floats
    rate: Floats
    plastic: Floats
    moment: Floats
    capacity: Floats


@dataclass(frozen=True, eq=False)
class HingeSummary:
    """Summary of every hinge at the end of a run, (hinges,) each; of many runs (runs, hinges).

    Attributes
    ----------
    rotation_max, moment_max
        Largest magnitudes; of several rotations the lengths of the vectors of rotation and of moment.
    opening_time
        Of first flow [s]; NaN where it never flowed, or the kernel does not watch it.
    rest_time
        Since when it no longer turns [s].
    turning
        1 if it still turns, else 0.
    energy
        Dissipated, with dampers and stops [J].
    fracture_time, fracture_moment
        When it broke, and the moment carried until then; NaN: it is whole.
    """

    rotation_max: Floats
    moment_max: Floats
    opening_time: Floats
    rest_time: Floats
    turning: Floats
    energy: Floats
    fracture_time: Floats
    fracture_moment: Floats


RECORDS: dict[str, type] = {
    "energy": EnergyRecord,
    "hinge": ComponentRecord,
    "hinge_energy": HingeEnergyRecord,
    "summary": HingeSummary,
}
"""Classes of the records in a kernel's answer, by their names there."""
if {name: [field.name for field in fields(kind)] for name, kind in RECORDS.items()} != record_columns:
    raise ImportError("the compiled kernels are of another version: build them again")


def named(kernel_record: dict[str, Any]) -> dict[str, Any]:
    """A kernel's answer with its records, arrays (columns, ...) there, as the classes of this module."""
    return {key: RECORDS[key](*value) if key in RECORDS else value for key, value in kernel_record.items()}


def each_array(record: Record, change: Callable[[Any], Any]) -> Record:
    """A record with every array changed, including those of the records in it."""
    changed = {}
    for field in fields(record):  # type: ignore[arg-type]
        value = getattr(record, field.name)
        if isinstance(value, np.ndarray):
            changed[field.name] = change(value)
        elif is_dataclass(value):
            changed[field.name] = each_array(value, change)
    return replace(record, **changed)  # type: ignore[type-var]


def arrays_of(record: Any) -> list[Any]:
    """The arrays of a record and of the records and mappings in it, in their order."""
    if isinstance(record, np.ndarray):
        return [record]
    if isinstance(record, dict):
        parts = list(record.values())
    else:
        parts = [getattr(record, field.name) for field in fields(record)] if is_dataclass(record) else []
    return [array for part in parts for array in arrays_of(part)]


def joined(parts: Sequence[Any]) -> Any:
    """Concatenation of arrays, or of records that contain arrays only."""
    if isinstance(parts[0], np.ndarray):
        return np.concatenate(parts)
    columns = {
        field.name: joined([getattr(part, field.name) for part in parts]) for field in fields(parts[0])
    }
    return replace(parts[0], **columns)
