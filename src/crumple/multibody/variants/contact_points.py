"""Obstacles shifted or tilted, so that they meet the structure half a section side away."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from crumple.multibody.run import Run
from crumple.numeric.arrays import Floats
from crumple.structure import CylinderObstacle, Obstacle, PlaneObstacle, Structure
from crumple.structure.bending import planar

TILT = math.radians(0.5)
"""Angle by which planes are tilted: then another edge of a flat end touches first."""


def contact_points(structure: Structure, run: Run) -> dict[str, dict[str, float]]:
    """Values by path of every run, by its name: in every direction across the approach, to either side.

    Cylinders, balls and planes that end are shifted by half of the largest side of a section; other planes
    are tilted by `TILT`, no nearer to the structure than they were.  Obstacles that turn stay.
    """
    half = (
        max(float(np.ptp(structure.section_of(m).outer_outline(), axis=0).max()) for m in structure.members)
        / 2.0
    )
    found: dict[str, dict[str, float]] = {}
    for name, obstacle in structure.obstacles.items():
        if obstacle.turning is not None:
            continue
        for k, across in enumerate(_across(structure, run, obstacle)):
            for sign in (1.0, -1.0):
                if isinstance(obstacle, PlaneObstacle) and obstacle.edge is None:
                    values = _tilted(structure, name, obstacle, sign * across)
                else:
                    values = _placed(name, "point", np.asarray(obstacle.point) + sign * half * across)
                side = "" if k == 0 else ", across"
                run_name = f"contact point {'one' if sign > 0.0 else 'other'} way{side}"
                found.setdefault(run_name, {}).update(values)
    return found


def _across(structure: Structure, run: Run, obstacle: Obstacle) -> Iterator[Floats]:
    """Unit vectors across the approach along which the contact point can move; none if it is not known."""
    if isinstance(obstacle, PlaneObstacle):
        towards: Floats | None = np.asarray(obstacle.normal, float)
        if obstacle.edge is not None:
            yield np.asarray(obstacle.edge, float) / np.linalg.norm(obstacle.edge)
            return
    else:
        towards = _approach(structure, run, obstacle)
    if towards is None:
        return
    towards = towards / np.linalg.norm(towards)
    if isinstance(obstacle, CylinderObstacle):
        directions = [np.cross(np.asarray(obstacle.axis, float), towards)]
    elif planar(structure):
        directions = [np.cross(np.asarray(structure.bending_normal, float), towards)]
    else:
        helper = np.eye(3)[int(np.argmin(np.abs(towards)))]
        directions = [np.cross(towards, helper), np.cross(towards, np.cross(towards, helper))]
    for direction in directions:
        if (size := float(np.linalg.norm(direction))) > 1e-6:
            yield direction / size


def _approach(structure: Structure, run: Run, obstacle: Obstacle) -> Floats | None:
    """Direction in which both meet, of any length and sense; None if the input does not say."""
    motion = [getattr(obstacle.motion, axis) is not None for axis in "xyz"]
    fields = (
        *structure.initial_velocity,
        *(field for stage in run.stages for field in stage.initial_velocity),
    )
    thrown = np.sum([field.translation for field in fields], axis=0) if fields else np.zeros(3)
    told = (obstacle.guide_direction, obstacle.velocity, motion, thrown, structure.gravity)
    vectors = (np.asarray(vector, float) for vector in told if vector is not None)
    return next((vector for vector in vectors if np.linalg.norm(vector) > 0.0), None)


def _tilted(structure: Structure, name: str, plane: PlaneObstacle, across: Floats) -> dict[str, float]:
    """Normal tilted towards a direction, and a point that keeps the least distance from the structure."""
    normal = np.asarray(plane.normal, float) / np.linalg.norm(plane.normal)
    tilted = math.cos(TILT) * normal + math.sin(TILT) * across
    corners = np.concatenate([_corners(structure, m) for m in plane.members or structure.members])
    gap = float((corners @ normal).min()) - float(normal @ np.asarray(plane.point))
    point = np.asarray(plane.point, float)
    moved = point + tilted * (float((corners @ tilted).min()) - gap - float(tilted @ point))
    return {**_placed(name, "normal", tilted), **_placed(name, "point", moved)}


def _corners(structure: Structure, member: str) -> Floats:
    """Outline points at both ends of a member [m], (n, 3)."""
    frame, outline = structure.frame_of(member), structure.section_of(member).outer_outline()
    ring = outline @ frame.axes[1:]
    return np.concatenate([frame.position(0.0) + ring, frame.position(frame.length) + ring])


def _placed(name: str, key: str, vector: Floats) -> dict[str, float]:
    return {f"obstacles.{name}.{key}.{i}": float(value) for i, value in enumerate(vector)}
