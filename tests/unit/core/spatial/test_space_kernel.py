"""The spatial kernel: freedoms of every joint, supports, drives, stages, bad models, and random frames."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.support.multibody.records import same
from tests.support.multibody.space_models import (
    RX,
    RY,
    RZ,
    about,
    ball_hinge,
    bar,
    component,
    m4,
    random_turn,
    started,
)

from crumple._core.outcome import Outcome
from crumple._core.spatial.model import (
    GROUND,
    ObstacleKind,
    SpatialBody,
    SpatialCapsule,
    SpatialDrive,
    SpatialHinge,
    SpatialJoint,
    SpatialLoad,
    SpatialModel,
    SpatialObstacle,
    cylindrical,
    fixed,
    planar,
    prismatic,
    revolute,
    spherical,
    universal,
)
from crumple._core.spatial.simulation import SpatialSimulation, SpatialUntil, Until

X, Y = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
JOINTS = {
    "fixed": (fixed(0, 1, (1, 0, 0)), 0),
    "revolute": (revolute(0, 1, (1, 0, 0), (1, 1, 0)), 1),
    "universal": (universal(0, 1, (1, 0, 0), X, Y), 2),
    "constant velocity": (SpatialJoint(0, 1, np.array(X), np.eye(3), (True,) * 4 + (False,) * 2), 2),
    "spherical": (spherical(0, 1, (1, 0, 0)), 3),
    "prismatic": (prismatic(0, 1, (1, 0, 0), (1, 2, 0)), 1),
    "cylindrical": (cylindrical(0, 1, (1, 0, 0), (1, 2, 0)), 2),
    "planar": (planar(0, 1, (1, 0, 0), (1, 2, 0)), 3),
    "point on a line": (SpatialJoint(0, 1, np.array(X), np.eye(3), (False, True, True) + (False,) * 3), 4),
    "parallel": (SpatialJoint(0, 1, np.array(X), np.eye(3), (False,) * 3 + (True,) * 3), 3),
}


def two_bodies(joint):
    bodies = (
        SpatialBody(2.0, np.diag([0.2, 0.3, 0.4]), np.array([0.5, 0.1, 0.0])),
        SpatialBody(3.0, np.diag([0.3, 0.5, 0.6]), np.array([1.6, 0.0, 0.2])),
    )
    return SpatialModel(bodies, (joint,))


@pytest.mark.parametrize("name", JOINTS)
def test_free_pairs_keep_energy_momentum_and_joint(name):
    """Two bodies with one joint, thrown: what the joint leaves free moves, what it holds does not part."""
    joint, free = JOINTS[name]
    model = two_bodies(joint)
    velocity = np.array([[1, 2, -1, 0.5, 0, 0.2], [-2, 1, 3, 0, 0.7, -0.4]], float)
    ledger = []
    for h in (4e-3, 2e-3):
        simulation = started(model, velocity)
        assert simulation.freedoms == (6 + free, 0)
        start = simulation.run(np.array([1e-9]))
        for _ in range(round(0.8 / h)):
            assert simulation.step(h)
        end = simulation.run(np.array([simulation.time]))
        masses = np.array([2.0, 3.0])
        before, after = masses @ start.velocity[-1, :, 3:], masses @ end.velocity[-1, :, 3:]
        np.testing.assert_allclose(after, before, atol=1e-11)
        ledger.append(abs(end.energy.kinetic[-1] - start.energy.kinetic[-1]) / start.energy.kinetic[-1])
    assert ledger[1] < 1e-4
    assert ledger[1] < 0.4 * ledger[0] + 1e-12
    if name in ("fixed", "parallel"):
        np.testing.assert_allclose(end.rotation[-1, 0], end.rotation[-1, 1], atol=1e-12)


def test_what_does_not_fit_the_joints_is_lost():
    simulation = SpatialSimulation(SpatialModel((bar((0, 0, 0), X),), (fixed(GROUND, 0, np.zeros(3)),)))
    lost = simulation.set_motion(np.array([[0, 0, 0, 0, 2.0, 0]]), np.zeros((1, 6)))
    assert lost == pytest.approx(bar((0, 0, 0), X).mass * 2.0)
    record = simulation.run(np.array([0.01]))
    assert record.energy.kinetic[-1] < 1e-20


def test_an_impulse_is_taken_up_by_its_mass():
    body = bar((0, 0, 0), X)
    simulation = SpatialSimulation(SpatialModel((body,), (spherical(GROUND, 0, np.zeros(3)),)))
    # a blow across the free end of a rod on a ball joint
    simulation.set_motion(np.zeros((1, 6)), np.array([[0.0, 0, 0.5 * 3.0, 0, 3.0, 0]]))
    record = simulation.run(np.array([1e-9]))
    assert record.velocity[-1, 0, 2] == pytest.approx(3.0 / (body.mass / 3), rel=1e-9)


def test_reaction_of_a_clamp_in_gravity():
    """A bar held at one end: force and moment in the joint's frame."""
    model = SpatialModel((bar((0, 0, 0), X),), (fixed(GROUND, 0, np.zeros(3)),), gravity=(0, 0, -9.81))
    record = SpatialSimulation(model).run(np.array([0.01]))
    weight = model.bodies[0].mass * 9.81
    np.testing.assert_allclose(record.joint_force[-1, 0], [0, 0, weight, 0, -weight / 2, 0], atol=1e-9)


def push(moment, force, **options):
    """A bar clamped by a hinge of constant moment and pushed at its tip."""
    hinge = SpatialHinge(0, (component(RX, moment),))
    load = SpatialLoad(0, np.array(X), np.array([0, force, 0.0]), np.zeros(3), np.zeros(1), np.ones(1))
    body = bar((0, 0, 0), X)
    return SpatialModel((body,), (revolute(GROUND, 0, np.zeros(3), (0, 0, 1)),), (hinge,), (load,), **options)


def test_a_locked_hinge_carries_what_equilibrium_asks():
    record = SpatialSimulation(push(1000.0, 900.0)).run(np.array([0.05]))
    assert abs(record.hinge.moment[-1, 0]) == pytest.approx(900.0, rel=1e-6)
    # it creeps at less than 1e-5 rad/s at this accuracy
    assert abs(record.hinge.rotation[-1, 0]) < 5e-7
    assert np.isnan(record.summary.opening_time[0])


def test_quasi_static_push_by_a_drive():
    """A bar's end is led across it at 0.2 m/s: work, moment and rotation of its hinge without inertia."""
    pin = revolute(GROUND, 0, np.zeros(3), (0, 0, 1))
    driven = SpatialJoint(GROUND, 0, pin.position, pin.axes, (True,) * 6)
    joints = (driven, revolute(0, 1, X, (0, 0, 1)), fixed(1, GROUND, (2, 0, 0)))
    bodies = (bar((0, 0, 0), X), bar(X, (2, 0, 0)))
    model = SpatialModel(bodies, joints, (SpatialHinge(1, (component(RX, 50.0),)),))
    assert SpatialSimulation(model).freedoms[0] == 0
    # let the first bar turn about the hinge: its foot slides
    slot = SpatialJoint(GROUND, 0, pin.position, np.eye(3), (False, False, True, True, True, False))
    lead = SpatialJoint(
        GROUND, 0, np.array([0.0, 0.0, 0.0]), np.eye(3), (False, True, False, False, False, False)
    )
    drive = SpatialDrive(1, 1, np.zeros(1), np.array([0.2]))
    model = SpatialModel(
        bodies, (slot, lead, *joints[1:]), (SpatialHinge(2, (component(RX, 50.0),)),), drives=(drive,)
    )
    simulation = SpatialSimulation(model, 1e-4)
    assert simulation.freedoms[0] == 0
    simulation.stage(quasi_static=True, until=(SpatialUntil(Until.WORK, 5.0),))
    record = simulation.run(np.linspace(0, 2.0, 21)[1:])
    assert record.ended_by == 0
    assert record.energy.external_work[-1] == pytest.approx(5.0, rel=2e-4)
    assert abs(record.hinge.rotation[-1, 0]) == pytest.approx(0.1, rel=1e-3)
    assert record.energy.dissipated[-1] == pytest.approx(5.0, rel=1e-3)
    assert record.residual < 1e-3
    # then everything stands still
    simulation.stage(drives=())
    still = simulation.run(np.array([simulation.time + 0.1]))
    assert still.energy.kinetic[-1] < 1e-12


def test_stages_add_up_and_drives_go_on_from_where_they_are():
    slide = SpatialJoint(GROUND, 0, np.zeros(3), np.eye(3), (True,) * 6)
    drive = SpatialDrive(0, 0, np.array([0.0, 1.0]), np.array([0.0, 2.0]))
    simulation = SpatialSimulation(SpatialModel((bar((0, 0, 0), X),), (slide,), drives=(drive,)))
    until = SpatialUntil(Until.DISPLACEMENT, 0.25, index=0, freedom=0)
    simulation.stage(until=(until,))
    first = simulation.run(np.linspace(0, 2, 5)[1:])
    assert first.ended_by == 0
    assert first.time[-1] == pytest.approx(0.5, rel=1e-4)
    assert first.centre[-1, 0, 0] == pytest.approx(0.75, rel=1e-4)
    simulation.stage()
    second = simulation.run(simulation.time + np.array([0.5]))
    assert second.centre[-1, 0, 0] == pytest.approx(1.0, rel=2e-4)
    simulation.stage(drives=())
    third = simulation.run(simulation.time + np.array([0.5]))
    assert third.centre[-1, 0, 0] == pytest.approx(1.0, rel=2e-4)


def test_poll_cancels_and_keeps_what_it_had():
    simulation = m4(1e-6)
    record = simulation.run(np.linspace(0, 0.1, 101)[1:], lambda time: time < 0.01)
    assert record.outcome is Outcome.CANCELLED
    assert 0 < len(record.time) < 100


def test_numbers_too_small_to_be_normal_are_zero_in_a_run_alone():
    kept = []
    simulation = SpatialSimulation(SpatialModel((SpatialBody(1.0, np.eye(3), np.zeros(3)),)))
    simulation.set_motion(np.array([[0, 0, 0, 1, 1e-310, 0]]), np.zeros((1, 6)))
    record = simulation.run(np.array([1.0]))
    assert record.velocity[-1, 0].tolist() == [0, 0, 0, 1, 0, 0]
    m4(1e-6).run(np.array([0.1]), lambda time: bool(kept.append(np.float64(1e-310) * 0.5) or True))
    assert kept
    assert {*kept, np.float64(1e-310) * 0.5} == {5e-311}


def test_an_impact_at_the_start_has_no_force_at_the_start():
    ball = SpatialModel(
        (SpatialBody(2.0, np.eye(3), np.zeros(3)),),
        capsules=(SpatialCapsule(0, np.zeros(3), np.zeros(3), 0.1),),
        obstacles=(SpatialObstacle(ObstacleKind.PLANE, GROUND, -0.1 * np.array(X), np.array(X)),),
    )
    simulation = SpatialSimulation(ball)
    simulation.set_motion(np.array([[0, 0, 0, -3.0, 0, 0]]), np.zeros((1, 6)))
    record = simulation.run(np.array([0.0, 0.01]))
    force = record.obstacle_force[:, 0, 0]
    assert force[0] == 0.0
    # on the plane, mean over the interval
    assert force[1] * 0.01 == pytest.approx(-2.0 * 3.0)


def test_same_bits_twice():
    first, second = (m4(1e-3).run(np.array([0.1])) for _ in range(2))
    assert np.array_equal(first.rotation, second.rotation)
    assert same(first, second)


BODY = bar((0, 0, 0), X)


@pytest.mark.parametrize(
    ("model", "expected"),
    [
        (SpatialModel((SpatialBody(0.0, np.eye(3), np.zeros(3)),)), "mass"),
        (SpatialModel((SpatialBody(1.0, np.zeros((3, 3)), np.zeros(3)),)), "inertia"),
        (SpatialModel((BODY,), (spherical(0, 1, X),)), "unknown"),
        (SpatialModel((BODY,), (spherical(0, 0, X),)), "two bodies"),
        (SpatialModel((BODY,), (spherical(GROUND, 0, X, 2 * np.eye(3)),)), "axes"),
        (
            SpatialModel((BODY,), (fixed(GROUND, 0, X),), (SpatialHinge(0, (component(RX, 1.0),)),)),
            "not held",
        ),
        (SpatialModel((BODY,), (), (SpatialHinge(0, (component(RX, 1.0),)),)), "unknown joint"),
        (
            SpatialModel(
                (BODY,), (spherical(GROUND, 0, X),), drives=(SpatialDrive(0, 4, np.zeros(1), np.zeros(1)),)
            ),
            "held",
        ),
        (
            SpatialModel(
                (BODY,),
                capsules=(SpatialCapsule(0, np.zeros(3), np.array(X), 0.1),),
                obstacles=(
                    SpatialObstacle(
                        ObstacleKind.PLANE, GROUND, -np.array(X), np.array(X), capsules=(0,), ends=(1, 2)
                    ),
                ),
            ),
            "ends for each of its capsules",
        ),
    ],
)
def test_bad_models_are_refused(model, expected):
    with pytest.raises(ValueError, match=expected):
        SpatialSimulation(model)


KINDS = ("ball", "creeping ball", "pin", "free ball", "fixed")


def frame(seed, kinds, loop, gravity, speed):
    """A tree of bars in random directions, perhaps a loop, hinges of every kind, a spin about its foot."""
    rng = np.random.default_rng(seed)
    points, ends, bodies, joints, hinges = [np.zeros(3)], [], [], [], []
    for k in range(len(kinds)):
        parent = int(rng.integers(0, len(points)))
        step = rng.normal(size=3)
        points.append(points[parent] + 0.3 * step / np.linalg.norm(step))
        ends.append((parent, k + 1))
    if loop and len(kinds) > 2:
        ends.append((len(kinds), 1))
    for k, (a, b) in enumerate(ends):
        bodies.append(bar(points[a], points[b], payload=float(rng.uniform(0, 3))))
        other = next((i for i, (_, end) in enumerate(ends[:k]) if end == a), GROUND)
        kind = kinds[k % len(kinds)]
        axes = random_turn(int(rng.integers(0, 1000)))
        if kind == "pin":
            joints.append(revolute(other, k, points[a], axes[0]))
            hinges.append(SpatialHinge(k, (component(RX, float(rng.uniform(10, 300))),)))
        elif kind in ("ball", "creeping ball"):
            joints.append(spherical(other, k, points[a], axes))
            hinges.append(ball_hinge(k, 0.1, form=2 if kind == "creeping ball" else 0))
        else:
            joints.append((spherical if kind == "free ball" else fixed)(other, k, points[a]))
    if len(ends) > len(kinds):
        joints.append(spherical(0, len(kinds), points[1]))
        limits = tuple(component(freedom, 50.0) for freedom in (RX, RY, RZ))
        hinges.append(SpatialHinge(len(joints) - 1, limits))
    model = SpatialModel(tuple(bodies), tuple(joints), tuple(hinges), gravity=(0.0, 0.0, gravity))
    omega = speed * rng.normal(size=3)
    return model, np.array([about((0, 0, 0), omega, body) for body in bodies])


@given(
    st.integers(0, 2**32 - 1),
    st.lists(st.sampled_from(KINDS), min_size=1, max_size=6),
    st.booleans(),
    st.sampled_from([0.0, -9.81]),
    st.sampled_from([0.0, 5.0, 30.0]),
)
@settings(max_examples=60)
def test_random_frames_run_or_report_why_not(seed, kinds, loop, gravity, speed):
    model, velocity = frame(seed, kinds, loop, gravity, speed)
    record = started(model, velocity, 1e-3).run(np.linspace(0, 0.05, 6)[1:])
    assert record.outcome is Outcome.COMPLETE or record.reason
    for values in (
        record.centre,
        record.rotation,
        record.velocity,
        record.energy.kinetic,
        record.hinge.rotation,
    ):
        assert np.isfinite(values).all()
    assert record.outcome is not Outcome.COMPLETE or record.residual < 5e-3


def test_outputs_do_not_change_the_steps():
    end = np.array([0.1])
    alone = m4(1e-3).run(end)
    dense = m4(1e-3).run(np.linspace(0.0, 0.1, 401))
    assert (dense.steps, dense.rejected) == (alone.steps, alone.rejected)
    np.testing.assert_array_equal(dense.centre[-1], alone.centre[-1])
    np.testing.assert_array_equal(dense.time, np.linspace(0.0, 0.1, 401))


def test_steps_of_a_smooth_motion_need_one_solve_for_each_step_and_half():
    joint, _ = JOINTS["revolute"]
    velocity = np.array([[1, 2, -1, 0.5, 0, 0.2], [-2, 1, 3, 0, 0.7, -0.4]], float)
    record = started(two_bodies(joint), velocity).run(np.array([0.5]))
    # the first step predicts its middle by a pass, and so does the trial step that shows the first forces;
    # one step shows the last ones
    assert record.solves == 3 * (record.steps + record.rejected) + 1 + 2 + 1


def test_a_state_between_steps_is_as_accurate_as_their_ends():
    # a step takes up to ten outputs; the last step of an output is a quarter of their interval
    times = np.linspace(0.0, 0.1, 401)
    found, exact = m4(1e-3).run(times), m4(1e-5).run(times)
    assert found.steps < 40
    largest = np.abs(exact.hinge.rotation).max()
    assert np.abs(found.hinge.rotation - exact.hinge.rotation).max() < 1e-3 * largest
    assert found.step[1:].max() <= 0.1 / 400 / 4 * (1 + 1e-9)
    sums = sum(getattr(found.energy, name) for name in ("kinetic", "dissipated", "stop"))
    assert np.abs(sums - sums[0]).max() < 1e-3 * sums[0]
