"""Plastic hinges in the spatial kernel: closed forms, models M2 to M4, rotated models, momentum.

Constant moment: a rod stops after I w0^2/(2 M) at the time I w0/M.  M2 has the figures of the tests of the
planar kernel. M3, a portal that is a loop of one coordinate, stops when the curves of the hinges have
absorbed the energy; the angles follow from its closure, solved independently.  M4, a cube frame of four
loops with twelve ball hinges, has no outside figure: a coarse run must agree with an accurate one within
the requested accuracy, and symmetric hinges with each other.

Kind: closed form; independent calculation; invariant.  Source: derived here; derived here; derived here.
"""

import math

import numpy as np
import pytest
from scipy.optimize import brentq
from tests.support.multibody.chains import MASS_PER_LENGTH, REGULARISED, ROTATION, SET_VALUED
from tests.support.multibody.chains import m2 as planar_m2
from tests.support.multibody.space_models import (
    RX,
    RY,
    RZ,
    about,
    ball_hinge,
    bar,
    component,
    m2,
    m4,
    random_turn,
    revolute,
    softening_component,
    spherical,
    started,
    with_mass,
)
from tests.verification.planar.test_portal_loop import HEIGHTS, TOP, turns

from crumple._core.spatial.model import GROUND, Coupling, SpatialHinge, SpatialModel, SpatialSurface

END = np.array([0.1])


@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("ball", [False, True])
def test_constant_moment(ball, accuracy, record_figure):
    """A rod of 1 m on a pin, or on a ball with the same capacity about any axis, stopped from 15 rad/s."""
    turn = random_turn(1)
    axis, body = turn[2], bar((0, 0, 0), turn[0])
    components = tuple(component(freedom, 700.0) for freedom in ((RX, RY, RZ) if ball else (RX,)))
    surface = SpatialSurface(Coupling.BALL if ball else Coupling.NONE)
    joint = spherical(GROUND, 0, np.zeros(3)) if ball else revolute(GROUND, 0, np.zeros(3), axis)
    model = SpatialModel((body,), (joint,), (SpatialHinge(0, components, surface),))
    record = started(model, [about((0, 0, 0), 15.0 * axis, body)], accuracy).run(END)
    inertia = MASS_PER_LENGTH / 3
    name = f"{'ball' if ball else 'pin'}, accuracy {accuracy:g}"
    stop = inertia * 15.0**2 / (2 * 700.0)
    record_figure(f"rotation, {name}", record.summary.rotation_max[0], stop, accuracy, "rad", relative=True)
    rest = inertia * 15.0 / 700.0
    record_figure(f"time of rest, {name}", record.summary.rest_time[0], rest, accuracy, "s", relative=True)


@pytest.mark.parametrize("rate", [0.05, 5e-4])
def test_m2_is_the_planar_chain(rate, record_figure):
    figure = {0.05: 0.6656451692, 5e-4: 0.6621691528}[rate]
    tight = m2(10, 1e-5, REGULARISED, rate, error=1e-7, turn=random_turn(2)).run(END)
    total = tight.hinge.rotation[-1].sum()
    record_figure(
        f"sum of rotations of M2(10), ramp {rate:g} rad/s", total, figure, 1e-5, "rad", relative=True
    )
    assert tight.residual < 1e-5


@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-4])
def test_m2_set_valued(accuracy, record_figure):
    planar = planar_m2(10, 1e-6, SET_VALUED, error=1e-7)
    planar.run(END)
    record = m2(10, accuracy, SET_VALUED).run(END)
    error = np.abs(record.hinge.rotation[-1] - planar.q).max() / np.abs(planar.q).max()
    record_figure(f"error of the worst hinge of M2(10), accuracy {accuracy:g}", error, 0.0, accuracy)
    assert record.residual < accuracy


def area(turn, scale):
    """Work of the law of the models up to a turn below its stop."""
    plateau = min(turn, 0.05) * (0.576 + 0.5 / math.sqrt(0.05))
    return (
        scale
        * 1000.0
        * (plateau + (0.576 * (turn - 0.05) + math.sqrt(turn) - math.sqrt(0.05)) * (turn > 0.05))
    )


def m3(accuracy, turn):
    """Portal in the plane of x and z with 20 kg at the middle of its top, which starts at 10 m/s along x."""
    a, b, c, d = (np.array(p) for p in ((0, 0, 0), (0, 0, 0.5), (1, 0, 0.6), (1.0, 0, 0)))
    y = turn @ (0.0, 1.0, 0.0)
    a, b, c, d = (turn @ p for p in (a, b, c, d))
    bodies = (bar(a, b), with_mass(bar(b, c), (b + c) / 2, 20.0), bar(c, d))
    joints = (
        revolute(GROUND, 0, a, y),
        revolute(0, 1, b, y),
        revolute(1, 2, c, y),
        revolute(2, GROUND, d, y),
    )
    hinges = tuple(SpatialHinge(k, (softening_component(RX, 0.5),), softening=ROTATION) for k in range(4))
    velocity = [
        about(a, y * 10.0 / HEIGHTS[0], bodies[0]),
        np.concatenate([np.zeros(3), turn @ (10.0, 0.0, 0.0)]),
        about(d, y * 10.0 / HEIGHTS[1], bodies[2]),
    ]
    return started(SpatialModel(bodies, joints, hinges), velocity, accuracy)


@pytest.mark.parametrize("accuracy", [1e-3, 1e-5])
def test_m3(accuracy, record_figure):
    simulation = m3(accuracy, random_turn(3))
    assert simulation.freedoms == (1, 3)
    record = simulation.run(END)
    energy = sum(MASS_PER_LENGTH * h**3 / 6 * (10.0 / h) ** 2 for h in HEIGHTS)
    energy += (MASS_PER_LENGTH * TOP + 20.0) / 2 * 10.0**2
    stop = brentq(lambda a: energy - sum(area(t, 0.5) for t in turns(a)), 1e-3, 1.0, xtol=1e-12)
    for name, got, turn in zip("ABCD", record.summary.rotation_max, turns(stop), strict=True):
        text = f"M3, rotation of hinge {name}, accuracy {accuracy:g}"
        record_figure(text, got, turn, accuracy, "rad", relative=True)
    assert record.residual < accuracy


def lengths(record):
    return np.linalg.norm(record.hinge.rotation[-1].reshape(-1, 3), axis=1)


def test_m4(record_figure):
    """The frame stops with its eight lower and upper column hinges turned and the ring straight."""
    tight = m4(1e-6)
    assert tight.freedoms == (12, 0)
    tight = tight.run(END)
    reference = lengths(tight)
    assert tight.residual < 1e-6
    assert np.ptp(reference[:8]) < 1e-8
    assert reference[8:].max() < 1e-6
    record_figure("M4, rotation of a column's hinge", reference[0], 0.35841583, 1e-5, "rad", relative=True)
    for accuracy in (1e-2, 1e-3, 1e-4):
        record = m4(accuracy).run(END)
        error = np.abs(lengths(record) - reference).max() / reference.max()
        record_figure(f"M4, error of the worst hinge, accuracy {accuracy:g}", error, 0.0, accuracy)
        assert record.residual < accuracy


def test_m4_from_the_side():
    """A blow along the diagonal, and more on one side: columns turn alike no longer, and nothing breaks."""
    simulation = m4(1e-4)
    push = np.zeros((8, 6))
    push[4, 3:] = (0.0, 30.0, 0.0)
    lost = simulation.set_motion(np.zeros((8, 6)), push)
    record = simulation.run(END)
    assert record.outcome == 0
    assert lost > 0.0
    assert record.residual < 1e-4


@pytest.mark.parametrize(
    "model", [lambda turn: m2(10, 1e-3, SET_VALUED, turn=turn), lambda turn: m4(1e-3, turn=turn)]
)
def test_a_turned_model_moves_alike(model, record_figure):
    """All hinge rotations and energies; a model turned in space takes the same steps but for rounding."""
    straight, turned = model(np.eye(3)).run(END), model(random_turn(4)).run(END)
    plain, other = straight.summary.rotation_max, turned.summary.rotation_max
    record_figure("largest change of a rotation", float(np.abs(plain - other).max()), 0.0, 1e-9, "rad")
    assert straight.steps == turned.steps
    for name, energy in vars(turned.energy).items():
        np.testing.assert_allclose(energy, getattr(straight.energy, name), rtol=0, atol=1e-7)


def test_free_assembly_keeps_its_momentum(record_figure):
    """Three bars with ball hinges, thrown and spinning: the errors shrink at least with the step's square."""
    points = np.array([(0, 0, 0), (0.5, 0, 0), (0.8, 0.4, 0), (0.8, 0.5, 0.5)], float)
    bodies = tuple(bar(points[k], points[k + 1]) for k in range(3))
    joints = tuple(spherical(k, k + 1, points[k + 1]) for k in range(2))
    hinges = tuple(ball_hinge(k, 0.005) for k in range(2))
    model = SpatialModel(bodies, joints, hinges)
    velocity = np.array([[5, 0, 20, 1, 2, 3], [0, 10, -5, 1, 2, 3], [0, 0, 3, -2, 2, 3]], float)
    errors = []
    for number in (20, 40, 80):
        simulation = started(model, velocity)
        before = simulation.run(np.array([1e-9]))
        for _ in range(number):
            assert simulation.step(0.01 / number)
        after = simulation.run(np.array([simulation.time]))
        one, two = (momenta(bodies, record) for record in (before, after))
        assert np.abs(one[0] - two[0]).max() < 1e-10
        errors.append(np.linalg.norm(one[1] - two[1]) / np.linalg.norm(one[1]))
        assert after.energy.kinetic[-1] < 0.95 * before.energy.kinetic[-1]
    assert math.log2(errors[0] / errors[2]) / 2 > 1.8
    record_figure("angular momentum lost, 80 steps", errors[-1], 0.0, 1e-5)


def momenta(bodies, record):
    """Linear momentum, and angular momentum about the origin."""
    linear, angular = np.zeros(3), np.zeros(3)
    for k, body in enumerate(bodies):
        w, v = record.velocity[-1, k, :3], record.velocity[-1, k, 3:]
        q = record.rotation[-1, k]
        s, r = q[0], q[1:]
        cross = np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])
        turn = np.eye(3) + 2 * s * cross + 2 * cross @ cross
        linear += body.mass * v
        angular += turn @ body.inertia @ turn.T @ w + body.mass * np.cross(record.centre[-1, k], v)
    return linear, angular
