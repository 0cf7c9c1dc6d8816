"""Where runs ended, as named quantities: the channels of a history whose rows are runs in place of times."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from crumple._core.planar.batch import TreeFinals
from crumple._core.planar.simulation import Outcome, TreeRecord
from crumple._core.spatial.batch import SpaceFinals
from crumple.multibody.answer.histories import (
    clearance_channels,
    distance_channels,
    node_channels,
    section_channels,
)
from crumple.multibody.answer.poses import Poses, TreePoses
from crumple.multibody.planar.case import Lowered
from crumple.multibody.planar.solver import energy_of, hinge_columns
from crumple.numeric.arrays import Floats
from crumple.structure import Outputs, Structure

OF_HINGES = ("rotation", "plastic_rotation", "moment", "capacity", "energy")
OF_NODES = ("displacement", "rotation")


Finals = TypeVar("Finals", TreeFinals, SpaceFinals)


def part_of(finals: Finals, rows: NDArray[np.int64]) -> Finals:
    """Some of the rows."""
    return replace(finals, **{field.name: getattr(finals, field.name)[rows] for field in fields(finals)})


def final_quantities(model: Lowered, finals: TreeFinals, outputs: Outputs) -> dict[str, Floats]:
    """Named quantities of runs that share a model, (n,) each."""
    record = TreeRecord(
        time=np.arange(finals.time.size, dtype=float),  # no row follows from the one before
        q=finals.q,
        w=finals.w,
        pose=finals.pose,
        velocity=finals.velocity,
        hinge=finals.hinge,
        energy=finals.energy,
        drive=np.zeros((finals.time.size, 0)),
        summary=finals.summary,
        outcome=Outcome.COMPLETE,
        reason="",
        residual=0.0,
        steps=0,
        rejected=0,
        forced=0,
        solves=0,
    )
    found: dict[str, Floats] = {}
    poses = TreePoses(model.mechanism, record)
    for hinge, columns in hinge_columns(model.mechanism, record):
        found |= {f"hinge.{hinge.name}.{name}": columns[name][1] for name in OF_HINGES}
    for k, (name, _) in enumerate(model.hinges):
        found[f"hinge.{name}.rotation_max"] = finals.summary[:, k, 0]
        found[f"hinge.{name}.moment_max"] = finals.summary[:, k, 1]
    found |= {f"energy.{name}": values for name, values in energy_of(record).items()}
    found |= place_quantities(model.structure, poses, outputs)
    found["energy_residual"] = finals.residual
    return found


def place_quantities(structure: Structure, poses: Poses, outputs: Outputs) -> dict[str, Floats]:
    """What outputs ask of nodes, sections, distances and clearances, (n,) each."""
    found = {
        channel.name: channel.values
        for channel in node_channels(structure, poses, outputs.nodes)
        if channel.name.split(".")[2] in OF_NODES
    }
    for channels in (section_channels, distance_channels, clearance_channels):
        found |= {channel.name: channel.values for channel in channels(structure, poses, outputs)}
    return found
