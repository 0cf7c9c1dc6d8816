"""Histories of hinges and the energy ledger, from the records of either kernel."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from crumple._core.records import ComponentRecord, EnergyRecord, HingeEnergyRecord, HingeSummary
from crumple.multibody.answer.solved import HingeHistory
from crumple.numeric.arrays import Floats
from crumple.structure import PlacedHinge

AXES = ("x", "y", "z")
TURNING = ("rotation", "rotation_rate", "plastic_rotation", "moment", "capacity")
"""Names of a component that is a rotation, in the order of `ComponentRecord`."""
AXIAL = ("travel", "rate", "plastic_travel", "force", "capacity")
"""The same of a component along an axis."""


class Rows(Protocol):
    """Records with a row for every output time, or for every run."""

    @property
    def hinge(self) -> ComponentRecord:
        """Components of hinges."""

    @property
    def hinge_energy(self) -> HingeEnergyRecord:
        """Energies of hinges."""

    @property
    def energy(self) -> EnergyRecord:
        """Energies of the whole model."""


@dataclass(frozen=True, eq=False)
class RecordedHinge:
    """A hinge and where its components are in a kernel's records.

    Attributes
    ----------
    hinge
        The plastic hinge.
    free
        Relative freedom of each component: 0 to 2 along, 3 to 5 about the hinge's axes.
    first
        Column of its first component.
    sign
        +1 where the kernel counts in the hinge's own sense, -1 where in the opposite.
    """

    hinge: PlacedHinge
    free: tuple[int, ...]
    first: int
    sign: float = 1.0

    def columns(self, record: ComponentRecord) -> list[Floats]:
        """Columns of this hinge in each record, (n, components), in the hinge's own sense."""
        span = slice(self.first, self.first + len(self.free))
        sign = self.sign
        signed = [record.rotation, record.rate, record.plastic, record.moment]
        return [*(sign * values[:, span] for values in signed), record.capacity[:, span]]


def hinge_columns(
    hinges: Sequence[RecordedHinge], rows: Rows
) -> Iterator[tuple[int, PlacedHinge, dict[str, Floats]]]:
    """Row, hinge and quantities, (n,) each by name, of every plastic hinge; see `HingeHistory`."""
    for k, recorded in enumerate(hinges):
        if not recorded.hinge.plastic:
            continue
        columns = _named(recorded.columns(rows.hinge), recorded.free)
        columns["energy"] = np.ascontiguousarray(rows.hinge_energy.dissipated[:, k])
        yield k, recorded.hinge, columns


def _named(parts: list[Floats], free: tuple[int, ...]) -> dict[str, Floats]:
    """Columns of one hinge: its only rotation, or the lengths of several; and components beside others."""
    of_turning = list(zip(TURNING, parts, strict=True))
    turning = [k for k, freedom in enumerate(free) if freedom >= 3]
    if len(turning) == 1:
        columns = {name: np.ascontiguousarray(values[:, turning[0]]) for name, values in of_turning}
    else:
        columns = {name: np.linalg.norm(values[:, turning], axis=1) for name, values in of_turning}
    if len(free) == 1 and turning:
        return columns
    for (name, values), axial in zip(of_turning, AXIAL, strict=True):
        for k, freedom in enumerate(free):
            one, axis = np.ascontiguousarray(values[:, k]), AXES[freedom % 3]
            if freedom >= 3:
                columns[f"{name}.{axis}"] = one
            else:
                columns[f"slip.{axis}.{axial}"] = one
    return columns


def hinge_histories(
    hinges: Sequence[RecordedHinge], rows: Rows, summary: HingeSummary
) -> Iterator[HingeHistory]:
    """Histories of all plastic hinges, in the kernel's order."""
    for k, hinge, columns in hinge_columns(hinges, rows):
        broke = float(summary.fracture_time[k])
        yield HingeHistory(
            hinge,
            columns,
            rotation_max=float(summary.rotation_max[k]),
            moment_max=float(summary.moment_max[k]),
            time_of_rest=None if summary.turning[k] else float(summary.rest_time[k]),
            energy=float(summary.energy[k]),
            fracture=None if math.isnan(broke) else (broke, float(summary.fracture_moment[k])),
        )


def spread_energy(hinges: Sequence[RecordedHinge], rows: Rows) -> dict[tuple[str, float], Floats]:
    """Energy dissipated in the joints of elastic members [J], (n,), by member and station [m]."""
    return {
        (recorded.hinge.member, recorded.hinge.station): rows.hinge_energy.dissipated[:, k]
        for k, recorded in enumerate(hinges)
        if not recorded.hinge.plastic
    }


def ledger(rows: Rows, *, touched: bool = False, slowed: bool = False) -> dict[str, Floats]:
    """Terms of the energy ledger [J], (n,) each; `touched`: with contact, friction; `slowed`: with damping.

    What hinges hold elastically is all that is stored or lost in them but what they dissipated.
    """
    energy, dissipated = rows.energy, rows.hinge_energy.dissipated.sum(axis=1)
    stored = energy.elastic + energy.dissipated + energy.damped + energy.stop + energy.spring
    found = {"kinetic": energy.kinetic, "elastic": stored - dissipated, "dissipated": dissipated}
    if touched:
        found |= {"contact": energy.contact, "friction": energy.friction}
    if slowed:
        found["damping"] = energy.slowed
    return found | {"external_work": energy.external_work}
