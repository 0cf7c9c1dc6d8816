"""Final values of runs as named quantities: the channels of a history, with a row for each run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

from crumple._core.records import HingeSummary
from crumple.multibody.answer.dents import DentHistory, wall_motions
from crumple.multibody.answer.hinge_histories import RecordedHinge, Rows, hinge_columns, ledger
from crumple.multibody.answer.histories import (
    clearance_channels,
    distance_channels,
    node_motion,
    section_channels,
)
from crumple.multibody.answer.poses import Poses
from crumple.numeric.arrays import Floats
from crumple.structure import Outputs, Structure

OF_NODES = ("displacement", "rotation")
"""Motions of nodes among the quantities."""


class Ends(Rows, Protocol):
    """Final values of runs: the last row of the record of each."""

    @property
    def summary(self) -> HingeSummary:
        """Summaries of the hinges, (runs, hinges)."""


class Ended(Protocol):
    """A structure with its bodies and hinges, as needed to interpret final values."""

    @property
    def structure(self) -> Structure:
        """The structure."""

    @property
    def hinges(self) -> Sequence[RecordedHinge]:
        """Hinges in the kernel's order."""

    @property
    def touched(self) -> bool:
        """Whether members or obstacles can come into contact."""

    @property
    def slowed(self) -> bool:
        """Whether a stage is quasi-static."""

    def end_poses(self, ends: Any) -> Poses:
        """Final positions of the bodies; rows are independent runs."""

    def dents(self, rows: Rows) -> Sequence[DentHistory]:
        """Dents that obstacles pressed into walls."""


def end_quantities(case: Ended, ends: Ends, outputs: Outputs) -> dict[str, Floats]:
    """Named final quantities of runs that share a case, (n,) each."""
    return common_quantities(case, ends) | placed_quantities(case, ends, outputs)


def common_quantities(case: Ended, ends: Ends) -> dict[str, Floats]:
    """Those of hinges and energies: for runs of any cases of one topology, (n,) each."""
    found: dict[str, Floats] = {}
    for k, hinge, columns in hinge_columns(case.hinges, ends):
        found |= {
            f"hinge.{hinge.name}.{name}": values
            for name, values in columns.items()
            if not name.startswith("rotation_rate")
        }
        found[f"hinge.{hinge.name}.rotation_max"] = ends.summary.rotation_max[:, k]
        found[f"hinge.{hinge.name}.moment_max"] = ends.summary.moment_max[:, k]
    energy = ledger(ends, touched=case.touched, slowed=case.slowed)
    return found | {f"energy.{name}": values for name, values in energy.items()}


def placed_quantities(
    case: Ended, ends: Ends, outputs: Outputs, of_nodes: Sequence[str] = OF_NODES
) -> dict[str, Floats]:
    """Requested outputs of nodes, sections, distances and clearances of runs that share a case, (n,) each."""
    if not (outputs.nodes or outputs.section_rotations or outputs.distances or outputs.clearances):
        return {}
    structure, poses, walls = case.structure, case.end_poses(ends), wall_motions(case.dents(ends))
    found = {
        channel.name: channel.values
        for name in outputs.nodes
        for channel in node_motion(structure, poses, name, walls.get(name))
        if channel.name.split(".")[2] in of_nodes
    }
    further = (
        *section_channels(structure, poses, outputs),
        *distance_channels(structure, poses, outputs, walls),
        *clearance_channels(structure, poses, outputs),
    )
    return found | {channel.name: channel.values for channel in further}
