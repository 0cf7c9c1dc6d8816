"""Bodies, obstacles and runs that the verification tests of contact share."""

from __future__ import annotations

import numpy as np

from crumple._core.spatial.model import (
    GROUND,
    ObstacleKind,
    SpatialBody,
    SpatialCapsule,
    SpatialContact,
    SpatialModel,
    SpatialObstacle,
)
from crumple._core.spatial.simulation import SpatialSimulation

GRAVITY = 9.81
DOWN = (0.0, 0.0, -GRAVITY)
MAX_RESIDUAL = 5e-3
"""Largest share of energy that a run may fail to account for."""


def sphere(centre, radius=0.1, mass=2.0):
    """Solid sphere."""
    return SpatialBody(mass, 0.4 * mass * radius**2 * np.eye(3), np.array(centre, float))


def rod(first, second, radius=0.05, mass=4.0):
    """Solid rod of a radius between two points; its capsule's caps have no mass."""
    first, second = np.array(first, float), np.array(second, float)
    length = float(np.linalg.norm(second - first))
    along = (second - first) / length
    across = np.eye(3) - np.outer(along, along)
    inertia = mass * (length**2 / 12 + radius**2 / 4) * across + mass * radius**2 / 2 * np.outer(along, along)
    return SpatialBody(mass, inertia, (first + second) / 2)


def ball_shape(body, centre, radius=0.1):
    """Capsule of a sphere."""
    centre = np.array(centre, float)
    return SpatialCapsule(body, centre, centre, radius)


def rod_shape(body, first, second, radius=0.05):
    """Capsule of a rod."""
    return SpatialCapsule(body, np.array(first, float), np.array(second, float), radius)


def plane(
    point=(0.0, 0.0, 0.0),
    normal=(0.0, 0.0, 1.0),
    friction=0.0,
    restitution=0.0,
    body=GROUND,
    edge=(0.0, 0.0, 0.0),
):
    """Plane; its normal need not be a unit vector."""
    normal = np.array(normal, float) / np.linalg.norm(normal)
    return SpatialObstacle(
        ObstacleKind.PLANE,
        body,
        np.array(point, float),
        normal,
        np.array(edge, float),
        friction=friction,
        restitution=restitution,
    )


def pole(point, axis, radius, friction=0.0, restitution=0.0, body=GROUND):
    """Cylinder without end."""
    point, axis = np.array(point, float), np.array(axis, float)
    return SpatialObstacle(
        ObstacleKind.CYLINDER, body, point, axis, radius=radius, friction=friction, restitution=restitution
    )


def simulation(bodies, capsules, obstacles=(), velocity=None, gravity=DOWN, accuracy=1e-3, **model):
    """A run of free bodies with velocities (omega, v), (bodies, 6)."""
    model = SpatialModel(
        tuple(bodies), obstacles=tuple(obstacles), capsules=tuple(capsules), gravity=gravity, **model
    )
    run = SpatialSimulation(model, accuracy)
    motion = np.zeros((len(model.bodies), 6)) if velocity is None else np.array(velocity, float)
    run.set_motion(motion, np.zeros_like(motion))
    return run


def all_pairs(count, friction=0.0, restitution=0.0):
    """Contact between every two of the first capsules."""
    pairs = tuple((i, j) for i in range(count) for j in range(i))
    return SpatialContact(pairs, friction, restitution)
