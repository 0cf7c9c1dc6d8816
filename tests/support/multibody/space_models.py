"""Models of the spatial kernel that several verification tests share."""

from __future__ import annotations

import math

import numpy as np
from tests.support.multibody.chains import MASS_PER_LENGTH, PAYLOAD, REGULARISED, ROTATION, softening_law

from crumple._core.spatial.model import (
    GROUND,
    Coupling,
    SpatialBody,
    SpatialComponent,
    SpatialHinge,
    SpatialModel,
    SpatialSurface,
    revolute,
    spherical,
)
from crumple._core.spatial.simulation import SpatialSimulation

GRAVITY = 9.81
RX, RY, RZ = 3, 4, 5


def bar(first, second, mass=None, about_axis=1e-4, payload=0.0):
    """Slender uniform bar between two points; `payload` sits at its centre."""
    first, second = np.asarray(first, float), np.asarray(second, float)
    length = float(np.linalg.norm(second - first))
    own = MASS_PER_LENGTH * length if mass is None else mass
    along = (second - first) / length
    inertia = own * length**2 / 12 * (np.eye(3) - np.outer(along, along)) + about_axis * np.outer(
        along, along
    )
    return SpatialBody(own + payload, inertia, (first + second) / 2)


def with_mass(body, point, mass):
    """The body with a point mass fixed to it."""
    point = np.asarray(point, float)
    total = body.mass + mass
    centre = (body.mass * body.centre + mass * point) / total
    inertia = np.array(body.inertia, float)
    for own, place in ((body.mass, body.centre), (mass, point)):
        d = place - centre
        inertia = inertia + own * (d @ d * np.eye(3) - np.outer(d, d))
    return SpatialBody(total, inertia, centre)


def component(freedom, envelope, stop=(), rate=0.05, **options):
    """A component alike in both senses; `envelope` is a moment or (places, moments)."""
    if not isinstance(envelope, tuple):
        envelope = (np.zeros(1), np.array([float(envelope)]))
    return SpatialComponent(
        freedom,
        positive=envelope,
        negative=envelope,
        regularisation_rate=rate,
        stop_positive=stop,
        stop_negative=stop,
        **options,
    )


def softening_component(freedom, scale, rate=0.05, error=1e-6):
    """Law and stop of the models M1 to M4."""
    return component(freedom, softening_law(scale, error), (1.2, 1e6 * scale, 1.0, 2e3 * scale, 0.0), rate)


def moving(bodies, velocity_of):
    """Velocities (omega, v) of the bodies' centres, (bodies, 6), from a function of the body's index."""
    return np.array([velocity_of(i) for i in range(len(bodies))], float)


def about(point, omega, body):
    """(omega, v) of a body that turns about a point."""
    omega = np.asarray(omega, float)
    return np.concatenate([omega, np.cross(omega, body.centre - np.asarray(point, float))])


def started(model, velocity, accuracy=1e-3, **settings):
    """Simulation of a model with velocities (bodies, 6) at the start."""
    simulation = SpatialSimulation(model, accuracy, **settings)
    velocity = np.asarray(velocity, float)
    simulation.set_motion(velocity, np.zeros_like(velocity))
    return simulation


def m2(number, accuracy=1e-3, form=REGULARISED, rate=0.05, error=1e-6, turn=None):
    """Model M2 in space: chain along x, hinges about z, all as one with 15 rad/s; `turn` turns it all."""
    turn = np.eye(3) if turn is None else np.asarray(turn, float)
    length = 0.1 * number
    whole = MASS_PER_LENGTH * length**3 / 3 + PAYLOAD * length**2
    root = whole / (MASS_PER_LENGTH / 3 + PAYLOAD)
    bodies, joints, hinges = [], [], []
    for i in range(number):
        ends = [turn @ (0.1 * i, 0.0, 0.0), turn @ (0.1 * (i + 1), 0.0, 0.0)]
        body = bar(*ends)
        if i == number - 1:
            body = with_mass(body, ends[1], PAYLOAD)
        bodies.append(body)
        joints.append(revolute(i - 1, i, ends[0], turn @ (0.0, 0.0, 1.0)))
        scale = root if i == 0 else 0.8 * root * (1 - 0.1 * i / length)
        hinges.append(
            SpatialHinge(i, (softening_component(RX, scale, rate, error),), form=form, softening=ROTATION)
        )
    model = SpatialModel(tuple(bodies), tuple(joints), tuple(hinges), length=length)
    omega = turn @ (0.0, 0.0, 15.0)
    return started(model, [about((0, 0, 0), omega, body) for body in bodies], accuracy)


def ball_hinge(joint, scale, form=0, rate=0.05, error=1e-6):
    """Ball hinge of model M4: capacity on the angle of the relative rotation."""
    components = tuple(softening_component(freedom, scale, rate, error) for freedom in (RX, RY, RZ))
    return SpatialHinge(joint, components, SpatialSurface(Coupling.BALL), form=form, softening=ROTATION)


def m4(accuracy=1e-3, form=0, rate=0.05, error=1e-6, turn=None):
    """Model M4: cube frame of 0.5 m on a fixed base, its top ring starting at 10 m/s along x."""
    return started(*m4_parts(form, rate, error, turn), accuracy)


def m4_parts(form=0, rate=0.05, error=1e-6, turn=None):
    """The model M4 and the velocities of its bodies at the start."""
    turn = np.eye(3) if turn is None else np.asarray(turn, float)
    corners = [np.array(c, float) * 0.5 for c in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0))]
    up = np.array([0.0, 0.0, 0.5])
    columns = [bar(turn @ c, turn @ (c + up)) for c in corners]
    ring = [bar(turn @ (corners[i] + up), turn @ (corners[(i + 1) % 4] + up), payload=5.0) for i in range(4)]
    joints = [spherical(GROUND, i, turn @ corners[i]) for i in range(4)]
    joints += [spherical(i, 4 + i, turn @ (corners[i] + up)) for i in range(4)]
    joints += [spherical(4 + i, 4 + (i + 1) % 4, turn @ (corners[(i + 1) % 4] + up)) for i in range(4)]
    hinges = tuple(ball_hinge(k, 0.25, form, rate, error) for k in range(12))
    model = SpatialModel((*columns, *ring), tuple(joints), hinges, length=0.5)
    speed, omega = turn @ (10.0, 0.0, 0.0), turn @ (0.0, 20.0, 0.0)
    velocity = [about(turn @ c, omega, body) for c, body in zip(corners, columns, strict=True)]
    velocity += [np.concatenate([np.zeros(3), speed])] * 4
    return model, np.array(velocity)


def tower(storeys, accuracy=1e-3, *, error=1e-6, velocity=(10.0, 0.0, 0.0), sway=(0.0, 0.0, 0.0)):
    """Portals of 0.5 m on top of each other, three bodies and one loop each, all joints ball hinges as in M4.

    Beams start with `velocity` plus the `sway` times sin(12 z), columns turn with their ends.
    """
    velocity, sway = np.asarray(velocity, float), np.asarray(sway, float)
    left, right, up = np.zeros(3), np.array([0.5, 0.0, 0.0]), np.array([0.0, 0.0, 0.5])

    def speed(storey):
        return velocity + sway * math.sin(6.0 * storey) if storey else np.zeros(3)

    bodies, joints, motion = [], [], []
    for k in range(storeys):
        below = 3 * k - 1 if k else GROUND
        for side, corner in enumerate((left, right)):
            foot, head = corner + k * up, corner + (k + 1) * up
            bodies.append(bar(foot, head))
            turning = np.cross(up, speed(k + 1) - speed(k)) / (up @ up)
            motion.append(np.concatenate([turning, (speed(k) + speed(k + 1)) / 2]))
            joints += [spherical(below, 3 * k + side, foot), spherical(3 * k + side, 3 * k + 2, head)]
        bodies.append(bar(left + (k + 1) * up, right + (k + 1) * up, payload=5.0))
        motion.append(np.concatenate([np.zeros(3), speed(k + 1)]))
    hinges = tuple(ball_hinge(k, 0.25, error=error) for k in range(len(joints)))
    model = SpatialModel(tuple(bodies), tuple(joints), hinges, length=0.5)
    return started(model, np.array(motion), accuracy)


def pendulum(accuracy=1e-6, joint=revolute):
    """Slender rod of 1.5 m on its end, from horizontal rest: swings like a point mass on 1 m."""
    body = bar((0, 0, 0), (1.5, 0, 0), mass=2.0, about_axis=0.01)
    joints = (
        (joint(GROUND, 0, np.zeros(3), (0, 1, 0)),)
        if joint is revolute
        else (spherical(GROUND, 0, np.zeros(3)),)
    )
    model = SpatialModel((body,), joints, gravity=(0.0, 0.0, -GRAVITY), length=1.5)
    return SpatialSimulation(model, accuracy)


def random_turn(seed=0):
    """Rotation matrix (3, 3)."""
    q = np.random.default_rng(seed).normal(size=4)
    w, x, y, z = q / math.sqrt(q @ q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
