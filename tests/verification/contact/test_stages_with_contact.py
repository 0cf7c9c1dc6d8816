"""Moving obstacles and stages: a rigid bar on a plastic hinge, pushed and struck.

The bar stands upright from the origin, with length L, a hinge of constant moment M at its foot (axis y) and
a ball at its tip.  A smooth vertical wall that has pushed the tip by u rotates it to sin a = u/L; then the
force is M/(L cos a) and the work M a.  A wall of mass m on a guide that strikes it at v loses m m' v^2/(2
(m + m')) in the impact, with m' = I/L^2, and the rest in the hinge.

Kind: closed form.  Source: derived here.
"""

import math

import numpy as np
import pytest
from tests.support.multibody.contact_models import MAX_RESIDUAL, ball_shape, plane
from tests.support.multibody.space_models import component

from crumple._core.spatial.model import (
    GROUND,
    SpatialBody,
    SpatialDrive,
    SpatialHinge,
    SpatialModel,
    prismatic,
    revolute,
)
from crumple._core.spatial.simulation import SpatialSimulation, SpatialUntil, Until

LENGTH, RADIUS, MOMENT = 1.2, 0.05, 900.0
BAR = SpatialBody(3.0, np.diag([0.4, 0.4, 0.01]), np.array([0.0, 0.0, 0.6]))
INERTIA = 0.4 + 3.0 * 0.6**2
TIP = (0.0, 0.0, LENGTH)
SPEED = 0.25


def bar_and_wall(mass, drives=(), gap=0.0, restitution=0.0, driven=True):
    """Wall at the tip's left, moving along x; joint 1 is its guide."""
    place = (-RADIUS - gap, 0.0, LENGTH)
    wall = SpatialBody(mass, np.eye(3), np.array(place))
    guide = prismatic(GROUND, 1, place, (1, 0, 0))
    if driven:
        guide = type(guide)(guide.first, guide.second, guide.position, guide.axes, (True,) * 6)
    return SpatialModel(
        (BAR, wall),
        joints=(revolute(GROUND, 0, (0, 0, 0), (0, 1, 0)), guide),
        hinges=(SpatialHinge(0, (component(3, MOMENT),)),),
        drives=tuple(drives),
        obstacles=(plane(place, (1, 0, 0), restitution=restitution, body=1),),
        capsules=(ball_shape(0, TIP, RADIUS),),
        length=LENGTH,
    )


def push():
    """Wall driven at a constant speed."""
    return SpatialSimulation(bar_and_wall(5.0, [SpatialDrive(1, 0, np.zeros(1), np.array([SPEED]))]))


def turned(record):
    """Angle of the bar at the end."""
    return float(record.hinge.rotation[-1, 0])


@pytest.mark.parametrize(("mass", "gap"), [(50.0, 0.0), (50.0, 0.1), (5.0, 0.1)])
def test_mass_on_a_guide_strikes_a_hinge(mass, gap, record_figure):
    model = bar_and_wall(mass, gap=gap, driven=False)
    run = SpatialSimulation(model)
    run.set_motion(np.array([[0] * 6, [0, 0, 0, 5.0, 0, 0]], float), np.zeros((2, 6)))
    record = run.run(np.linspace(0, 0.6, 61))
    kinetic, beside = mass * 25 / 2, INERTIA / LENGTH**2
    lost = mass * beside / (mass + beside) * 25 / 2
    name = f"mass {mass:g} kg, gap {gap:g} m"
    record_figure(
        f"energy lost in the impact, {name}", record.energy.contact[20], lost, 2e-3, "J", relative=True
    )
    stops = int(np.argmax(record.energy.dissipated))
    energy = record.energy
    total = energy.kinetic[stops] + energy.dissipated[stops] + energy.contact[stops]
    record_figure(f"energy accounted for, {name}", total, kinetic, 2e-3, "J", relative=True)
    if mass > 10:
        largest = float(record.summary.rotation_max[0])
        record_figure(
            f"largest rotation, {name}", largest, (kinetic - lost) / MOMENT, 5e-3, "rad", relative=True
        )
    assert record.residual < MAX_RESIDUAL


@pytest.mark.parametrize("quasi_static", [True, False])
def test_driven_wall_pushes_the_bar(quasi_static, record_figure):
    run = push()
    run.stage(quasi_static=quasi_static)
    record = run.run(np.array([1.0, 2.0, 3.0]))
    for k, time in enumerate(record.time):
        angle = math.asin(SPEED * time / LENGTH)
        tolerance = 1e-4 if quasi_static else 2e-2
        name = f"at {time:g} s, {'quasi-static' if quasi_static else 'dynamic'}"
        record_figure(f"rotation {name}", record.hinge.rotation[k, 0], angle, 1e-4, "rad", relative=True)
        record_figure(
            f"work {name}",
            record.energy.external_work[k],
            MOMENT * angle,
            max(tolerance, 1e-3),
            "J",
            relative=True,
        )
    assert record.residual < MAX_RESIDUAL


def test_force_of_a_quasi_static_push(record_figure):
    run = push()
    run.stage(quasi_static=True)
    record = run.run(np.linspace(0.0, 3.0, 301))
    for k in (100, 200, 300):
        force = MOMENT / (LENGTH * math.cos(math.asin(SPEED * (record.time[k] - 0.005) / LENGTH)))
        record_figure(
            f"force at {record.time[k]:g} s", record.obstacle_force[k, 0, 0], -force, 1e-3, "N", relative=True
        )


@pytest.mark.parametrize(
    ("condition", "angle"),
    [
        (SpatialUntil(Until.FORCE, 1.2 * MOMENT / LENGTH, index=0), math.acos(1 / 1.2)),
        (SpatialUntil(Until.WORK, 500.0), 500.0 / MOMENT),
        (SpatialUntil(Until.DISPLACEMENT, 0.4, index=1, freedom=0), math.asin(0.4 / LENGTH)),
        (
            SpatialUntil(
                Until.DISTANCE, -0.2, bodies=(0, GROUND), points=np.array([TIP, (1.0, 0.0, LENGTH)])
            ),
            None,
        ),
    ],
    ids=["force", "work", "displacement", "distance"],
)
def test_stage_ends_when_its_condition_is_met(condition, angle, record_figure):
    """The last step is shortened to the threshold."""
    run = push()
    run.stage(quasi_static=True, until=[SpatialUntil(Until.WORK, 1e9), condition])
    record = run.run(np.linspace(0.1, 4.0, 40))
    assert record.ended_by == 1
    found = turned(record)
    if angle is None:
        tip = LENGTH * np.array([math.sin(found), math.cos(found)])
        record_figure("distance at the end", math.hypot(1 - tip[0], LENGTH - tip[1]), 0.8, 1e-3, "m")
    else:
        record_figure(
            f"rotation at the end, {condition.kind.name.lower()}", found, angle, 1e-3, "rad", relative=True
        )
    assert record.time[-1] == pytest.approx(run.time)


def test_push_then_impact_on_the_deformed_bar(record_figure):
    """Pushed to 0.4 m, the wall taken away, then an impulse: it turns on by I w^2/(2M) from where it was."""
    run = push()
    run.stage(quasi_static=True, until=[SpatialUntil(Until.DISPLACEMENT, 0.4, index=1, freedom=0)])
    first = run.run(np.linspace(0.1, 4.0, 40))
    start, begin = turned(first), run.time
    run.stage(drives=[], obstacles=[])
    rate = 6.0
    axis = np.array([0, 1.0, 0])
    arm = 0.6 * np.array([math.sin(start), 0, math.cos(start)])
    run.set_motion(np.array([[*(rate * axis), *np.cross(rate * axis, arm)], [0] * 6]), np.zeros((2, 6)))
    second = run.run(begin + np.linspace(0.0, 0.1, 11))
    stop = INERTIA * rate**2 / (2 * MOMENT)
    # the accuracy, 1e-3, is that of the largest rotation
    record_figure("turned in the impact", turned(second) - start, stop, 1e-3 * turned(second), "rad")
    record_figure("wall's place", second.centre[-1, 1, 0], first.centre[-1, 1, 0], 1e-9, "m")
    assert not second.obstacle_force.any()
    assert second.residual < MAX_RESIDUAL


def test_obstacle_appears_with_its_stage(record_figure):
    """Absent in the first stage: the bar swings through its place; the second takes the overlap as it is."""
    model = bar_and_wall(5.0)
    run = SpatialSimulation(model)
    run.stage(obstacles=[])
    rate = 6.0
    run.set_motion(np.array([[0, -rate, 0, -rate * 0.6, 0, 0], [0] * 6]), np.zeros((2, 6)))
    first = run.run(np.array([0.05]))
    assert turned(first) < -0.005
    run.stage()
    second = run.run(np.array([0.05, 0.1]))
    record_figure("rotation stays", turned(second), turned(first), 1e-4, "rad")
    assert second.residual < MAX_RESIDUAL
