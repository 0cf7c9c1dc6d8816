"""Joints and drives of obstacles that move."""

from __future__ import annotations

import numpy as np

from crumple._core.spatial.model import SpatialDrive, SpatialJoint, frame_of
from crumple.multibody.bodies.linkage import GROUND
from crumple.multibody.bodies.sampled_functions import sampled_motion
from crumple.numeric.arrays import Floats
from crumple.structure import Obstacle


def guided_or_driven(
    obstacle: Obstacle, body: int, joint: int, duration: float
) -> tuple[SpatialJoint, list[SpatialDrive]]:
    """Joint that guides or drives an obstacle, and its drives."""
    place = np.asarray(obstacle.point, float)
    guide = obstacle.guide_direction
    if guide is not None:
        held = (False, True, True, True, True, True)
        return SpatialJoint(GROUND, body, place, frame_of(guide), held), []
    axes = np.eye(3)
    if obstacle.turning is not None:
        place, axes = np.asarray(obstacle.turning.about, float), frame_of(obstacle.turning.axis)
    drives = []
    times, rates = _travel(obstacle, duration)
    for freedom, rate in enumerate(axes @ rates.T):
        if np.any(rate != 0.0):
            drives.append(SpatialDrive(joint, freedom, times, rate))
    if obstacle.turning is not None:
        turn_times, _, turn_rates = sampled_motion(obstacle.turning.angle, duration)
        drives.append(SpatialDrive(joint, 3, turn_times, turn_rates))
    return SpatialJoint(GROUND, body, place, axes, (True,) * 6), drives


def _travel(obstacle: Obstacle, duration: float) -> tuple[Floats, Floats]:
    """Times [s], (n,), and prescribed velocity in global axes [m/s], (n, 3)."""
    if any(obstacle.velocity):
        return np.array([0.0, duration]), np.tile(np.asarray(obstacle.velocity, float), (2, 1))
    parts = []
    for axis in "xyz":
        function = getattr(obstacle.motion, axis)
        times, _, rates = (
            (np.zeros(1), None, np.zeros(1)) if function is None else sampled_motion(function, duration)
        )
        parts.append((times, rates))
    union = np.unique(np.concatenate([times for times, _ in parts]))
    return union, np.stack([np.interp(union, times, rates) for times, rates in parts], axis=1)
