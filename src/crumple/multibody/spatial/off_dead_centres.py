"""Departure from dead centres in the spatial kernel: further joints hold the motions that cannot go on."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace

import numpy as np

from crumple._core.spatial.model import SpatialModel
from crumple._core.spatial.simulation import SpatialRecord
from crumple.multibody.bodies.dead_centres import DeadCentres
from crumple.multibody.bodies.linkage import Linkage


def off_dead_centres(
    model: SpatialModel, linkage: Linkage, centres: DeadCentres, *, aside: bool = False
) -> tuple[SpatialModel, dict[int, int]]:
    """A model that begins to move only in ways in which it can go on.

    Parameters
    ----------
    model, linkage
        As `spatial_model` gives it, obstacles added.
    centres
        Freedoms that further joints hold, and connections from which several ways go on.
    aside
        Move these connections aside.

    Returns
    -------
    model
        With the further joints last.
    joint
        Index of the further joint by connection.
    """
    joints = list(model.joints)
    for i, (place, axes) in centres.aside.items() if aside else ():
        joints[i] = replace(joints[i], position=place, axes=axes)
    held = defaultdict(list)
    for connection, freedom in sorted(centres.held):
        held[connection].append(freedom)
    further = [
        replace(joints[i], held=tuple(k in own for k in range(6)), cross=False)  # type: ignore[arg-type]
        for i, own in held.items()
    ]
    return replace(model, joints=(*joints, *further)), {i: len(joints) + k for k, i in enumerate(held)}


def with_held_moments(
    record: SpatialRecord, linkage: Linkage, model: SpatialModel, holding: dict[int, int]
) -> SpatialRecord:
    """A record in which hinges at dead centres carry the moments that hold them, up to their capacity.

    The forces of their joints contain all that holds them, so that forces in sections balance.

    Parameters
    ----------
    record, linkage, model
        Of the kernel, and what it solved.
    holding
        Index of the further joint by connection.
    """
    if not holding:
        return record
    moment, largest = record.hinge.moment.copy(), record.summary.moment_max.copy()
    force = record.joint_force.copy()
    for i, further in holding.items():
        force[:, i] += force[:, further]
    connections = [i for i, c in enumerate(linkage.connections) if c.hinge is not None]
    offsets = model.component_offsets
    for k, i in enumerate(connections):
        if i not in holding:
            continue
        span, free = slice(offsets[k], offsets[k + 1]), list(linkage.connections[i].free)
        held = -record.joint_force[:, holding[i], free]
        capacity = record.hinge.capacity[:, span]
        moment[:, span] = np.clip(moment[:, span] + held, -capacity, capacity)
        turning = moment[:, span][:, np.array(free) >= 3]
        largest[k] = max(largest[k], np.linalg.norm(turning, axis=1).max(initial=0.0))
    hinge, summary = replace(record.hinge, moment=moment), replace(record.summary, moment_max=largest)
    return replace(record, hinge=hinge, summary=summary, joint_force=force)
