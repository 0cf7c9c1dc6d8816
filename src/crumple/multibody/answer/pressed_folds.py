"""Moments of folds under poles, from the kernel's records."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from crumple._core.spatial.model import SpatialModel
from crumple._core.spatial.simulation import SpatialRecord
from crumple.multibody.bodies.obstacles.sunk_walls import SunkWall

FIRST_ROTATION = 3
"""First of the freedoms of a joint that are rotations."""


def with_fold_moments(
    record: SpatialRecord, walls: Sequence[SunkWall], model: SpatialModel, *, ends_only: bool
) -> SpatialRecord:
    """A record in which moment and capacity of a fold, and its cut, are without the part that the pole takes.

    The kernel's hinge carries all that the fold dissipates by its rotation; what its cams carry, the force on
    the walls times the slope of their depth, is the work of the pole.

    Parameters
    ----------
    record, walls, model
        Of the kernel, and the walls of its model.
    ends_only
        Whether the record has no outputs, from which the largest moment is taken; else it stays.
    """
    if not walls:
        return record
    columns = model.component_offsets
    moment, capacity = record.hinge.moment.copy(), record.hinge.capacity.copy()
    force = record.joint_force.copy()
    for wall in walls:
        column, sense = columns[wall.hinge] + wall.component, wall.law.sense
        turned = sense * record.hinge.rotation[:, column]
        slope = np.where(turned > 0.0, wall.law.slope(np.abs(turned)), 0.0)
        # a wall that is pushed in pushes the other piece away from the pole
        passed = record.joint_force[:, wall.joint, 0]
        taken = -passed * slope
        moment[:, column] -= sense * taken
        capacity[:, column] -= taken
        # what the cam passes between the pieces, besides the joint of the fold
        joint, part = model.hinges[wall.hinge].joint, model.hinges[wall.hinge].components[wall.component]
        force[:, joint, part.freedom] += sense * taken
        on_second = passed if wall.own == model.joints[joint].first else -passed
        force[:, joint, :FIRST_ROTATION] += np.outer(on_second, model.joints[joint].axes @ wall.outwards)
    largest = record.summary.moment_max.copy()
    for hinge in {wall.hinge for wall in walls} if not ends_only else ():
        turns = [part.freedom >= FIRST_ROTATION for part in model.hinges[hinge].components]
        of_hinge = moment[:, columns[hinge] : columns[hinge + 1]][:, turns]
        largest[hinge] = np.linalg.norm(of_hinge, axis=1).max(initial=0.0)
    return replace(
        record,
        hinge=replace(record.hinge, moment=moment, capacity=capacity),
        summary=replace(record.summary, moment_max=largest),
        joint_force=force,
    )
