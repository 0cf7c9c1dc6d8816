"""What hinges did and where the energy went, from the records of either kernel."""

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
TURNING = {
    "rotation": "rad",
    "rotation_rate": "rad/s",
    "plastic_rotation": "rad",
    "moment": "N*m",
    "capacity": "N*m",
}
"""Names and units of a component that is a rotation, in the order of `ComponentRecord`."""
AXIAL = {"travel": "m", "rate": "m/s", "plastic_travel": "m", "force": "N", "capacity": "N"}
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
        Which it is.
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

    def columns(self, record: ComponentRecord) -> dict[str, tuple[str, Floats]]:
        """Unit and values, (n,), of its quantities: plain for one rotation; else lengths, and components."""
        turning = [k for k, freedom in enumerate(self.free) if freedom >= 3]
        parts = [self._component(record, k) for k in range(len(self.free))]
        if turning == [0] and len(parts) == 1:
            return {name: (unit, one) for (name, unit), one in zip(TURNING.items(), parts[0], strict=True)}
        columns = {}
        for of, (name, unit) in enumerate(TURNING.items()):
            turned = np.reshape([parts[k][of] for k in turning], (len(turning), len(record.rotation)))
            columns[name] = unit, np.linalg.norm(turned.T, axis=1)
        for of, ((name, unit), (axial, axial_unit)) in enumerate(
            zip(TURNING.items(), AXIAL.items(), strict=True)
        ):
            for one, freedom in zip(parts, self.free, strict=True):
                axis = AXES[freedom % 3]
                if freedom >= 3:
                    columns[f"{name}.{axis}"] = unit, one[of]
                else:
                    columns[f"slip.{axis}.{axial}"] = axial_unit, one[of]
        return columns

    def _component(self, record: ComponentRecord, k: int) -> list[Floats]:
        """Quantities of one component in the hinge's own sense, (n,) each; a capacity has none."""
        column, sign = self.first + k, self.sign
        signed = record.rotation, record.rate, record.plastic, record.moment
        return [*(sign * values[:, column] for values in signed), record.capacity[:, column].copy()]


def hinge_columns(
    hinges: Sequence[RecordedHinge], rows: Rows
) -> Iterator[tuple[PlacedHinge, dict[str, tuple[str, Floats]]]]:
    """Every hinge, and unit and values, (n,), of its quantities; see `HingeHistory`."""
    for k, recorded in enumerate(hinges):
        columns = recorded.columns(rows.hinge)
        columns["energy"] = "J", rows.hinge_energy.dissipated[:, k].copy()
        yield recorded.hinge, columns


def hinge_histories(
    hinges: Sequence[RecordedHinge], rows: Rows, summary: HingeSummary
) -> Iterator[HingeHistory]:
    """What every hinge did, in the kernel's order."""
    for k, (hinge, columns) in enumerate(hinge_columns(hinges, rows)):
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
