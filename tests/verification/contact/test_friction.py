"""Coulomb friction on a plane: sliding to rest, sticking on a slope, and a sphere that begins to roll.

Closed forms: a block thrown at v stops after v^2/(2 mu g).  On a slope of angle a it sticks below tan a =
mu and otherwise accelerates with g (sin a - mu cos a).  A solid sphere that starts sliding rolls at 5/7 v
after 2v/(7 mu g), a solid rod at 2/3 v after v/(3 mu g).  Friction uses the normal impulse of its own
step; a test measures the error of frozen limits.

A ball of mass M that is guided vertically falls at the speed v on a bar of inertia I about a hinge on its
axis, at a distance s from the hinge.  The fold there is 2 H long.  Along the bar, the wall slides past the
ball with the share min(s/H, 1) of its turning about the axis at the radius r, and friction takes hold by the
same lever.  With w the rate of the bar after the blow, the impulse P follows from

    v - P/M = s w,  I w = P (s - mu r min(s/H, 1))   =>   P = v/(1/M + s (s - mu r min(s/H, 1))/I).

Kind: closed form.  Source: derived here.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from tests.support.multibody.contact_models import (
    GRAVITY,
    MAX_RESIDUAL,
    ball_shape,
    plane,
    rod,
    rod_shape,
    simulation,
    sphere,
)

from crumple._core.spatial.model import (
    GROUND,
    ObstacleKind,
    SpatialBody,
    SpatialCapsule,
    SpatialFold,
    SpatialJoint,
    SpatialModel,
    SpatialObstacle,
)
from crumple._core.spatial.simulation import SpatialSimulation

FRICTION = 0.4


def block(normal=(0.0, 0.0, 1.0), velocity=(0.0, 0.0, 0.0), friction=FRICTION, accuracy=1e-3):
    """Flat block on four spheres of no mass, its centre 0.1 m above the plane through the origin."""
    normal = np.array(normal, float) / np.linalg.norm(normal)
    along = np.cross((0.0, 1.0, 0.0), normal)
    across = np.cross(normal, along)
    feet = [0.05 * normal + a * 0.3 * along + b * 0.2 * across for a in (-1, 1) for b in (-1, 1)]
    body = SpatialBody(6.0, np.diag([0.1, 0.2, 0.25]), 0.1 * normal)
    capsules = [SpatialCapsule(0, foot, foot, 0.05) for foot in feet]
    obstacle = plane(normal=normal, friction=friction)
    return simulation([body], capsules, [obstacle], [[0, 0, 0, *velocity]], accuracy=accuracy)


@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("direction", [0.0, 37.0, 90.0])
def test_stopping_distance(direction, accuracy, record_figure):
    """The feet's load shifts forward while it brakes; the sum, and so the distance, stays."""
    angle = math.radians(direction)
    run = block(velocity=(3 * math.cos(angle), 3 * math.sin(angle), 0), accuracy=accuracy)
    record = run.run(np.array([0.5, 1.5]))
    distance = float(np.linalg.norm(record.centre[-1, 0, :2]))
    expected = 3.0**2 / (2 * FRICTION * GRAVITY)
    name = f"stopping distance at {direction:g} deg, accuracy {accuracy:g}"
    record_figure(name, distance, expected, accuracy, "m", relative=True)
    record_figure(f"friction's work, {name}", record.energy.friction[-1], 27.0, 1e-3, "J", relative=True)
    assert record.residual < MAX_RESIDUAL


@pytest.mark.parametrize("degrees", [15.0, 21.7])
def test_sticks_on_a_slope_below_the_angle_of_friction(degrees, record_figure):
    """atan 0.4 = 21.80 deg; what is left is creep, 1e-6 m/s at most."""
    slope = math.radians(degrees)
    run = block((-math.sin(slope), 0.0, math.cos(slope)))
    record = run.run(np.array([0.0, 1.0]))
    moved = float(np.linalg.norm(record.centre[1, 0] - record.centre[0, 0]))
    record_figure(f"creep in 1 s at {degrees} deg", moved, 0.0, 2e-6, "m")


@pytest.mark.parametrize("degrees", [22.0, 30.0, 45.0])
def test_slides_on_a_steeper_slope(degrees, record_figure):
    slope = math.radians(degrees)
    run = block((-math.sin(slope), 0.0, math.cos(slope)))
    record = run.run(np.array([0.0, 1.0]))
    moved = float(np.linalg.norm(record.centre[1, 0] - record.centre[0, 0]))
    expected = GRAVITY * (math.sin(slope) - FRICTION * math.cos(slope)) / 2
    record_figure(f"way in 1 s at {degrees} deg", moved, expected, 1e-3, "m", relative=True)
    assert record.residual < MAX_RESIDUAL


@pytest.mark.parametrize(("shape", "share", "time_share"), [("sphere", 5 / 7, 2 / 7), ("rod", 2 / 3, 1 / 3)])
def test_rolling_start(shape, share, time_share, record_figure):
    """Slides with deceleration mu g up to time_share v/(mu g), then rolls at share v and keeps on."""
    speed, mu, radius = 3.0, 0.3, 0.1
    if shape == "sphere":
        bodies, capsules = [sphere((0, 0, radius), radius)], [ball_shape(0, (0, 0, radius), radius)]
    else:
        ends = ((0, -0.5, radius), (0, 0.5, radius))
        bodies, capsules = [rod(*ends, radius)], [rod_shape(0, *ends, radius)]
    run = simulation(bodies, capsules, [plane(friction=mu)], [[0, 0, 0, speed, 0, 0]])
    begin = time_share * speed / (mu * GRAVITY)
    times = np.array([0.0, 0.5 * begin, 0.999 * begin, 1.001 * begin, 2.0])
    record = run.run(times)
    velocity, spin = record.velocity[:, 0, 3], record.velocity[:, 0, 1]
    sliding = speed - mu * GRAVITY * times[1]
    record_figure(f"velocity while sliding, {shape}", velocity[1], sliding, 1e-6, "m/s", relative=True)
    record_figure(
        f"slip just before rolling, {shape}", velocity[2] - radius * spin[2], 1e-3 * speed, 1e-3, "m/s"
    )
    for k in (3, 4):
        record_figure(
            f"rolling velocity at {times[k]:.3g} s, {shape}",
            velocity[k],
            share * speed,
            1e-4,
            "m/s",
            relative=True,
        )
        record_figure(f"slip at {times[k]:.3g} s, {shape}", velocity[k] - radius * spin[k], 0.0, 2e-6, "m/s")
    assert record.residual < MAX_RESIDUAL


def test_friction_uses_the_normal_force_of_its_own_step(record_figure):
    """A rod's end struck obliquely: friction changes the normal impulse, and this friction.

    Rigid rod of mass m, half length l, at the angle a to the plane, falling at v without spin.  Its end
    slides     towards -x, so friction mu N acts along +x, and N = v/(1/m + x^2/I - mu x z/I) for the arm
    (x, z) from centre     to contact.  With the normal impulse of a frictionless impact, N and friction
    would err by more than 10 %.
    """
    slope, half, mass, speed, slip, mu, radius = math.radians(35), 0.5, 4.0, 2.0, 3.0, 0.3, 0.05
    across = mass * ((2 * half) ** 2 / 12 + radius**2 / 4)
    end = np.array([0.0, 0.0, radius + 1e-7])
    other = end + 2 * half * np.array([math.cos(slope), 0.0, math.sin(slope)])
    run = simulation(
        [rod(end, other, radius, mass)],
        [rod_shape(0, end, other, radius)],
        [plane(friction=mu)],
        [[0, 0, 0, -slip, 0, -speed]],
        gravity=(0.0, 0.0, 0.0),
    )
    record = run.run(np.array([1e-5]))
    x, z = -half * math.cos(slope), -half * math.sin(slope) - radius
    # impulse (P, N) at (x, z) from the centre gives v_n = N/m - x w, w = (z P - x N)/I about y; P = mu N
    normal = speed / (1 / mass + x * x / across - mu * x * z / across)
    lagged = speed / (1 / mass + x * x / across)
    impulse = mass * (record.velocity[-1, 0, 5] + speed)
    record_figure("normal impulse with friction", impulse, normal, 1e-4, "N s", relative=True)
    friction = mass * (record.velocity[-1, 0, 3] + slip)
    record_figure("friction's impulse", friction, mu * normal, 1e-4, "N s", relative=True)
    assert abs(lagged / normal - 1) > 0.1


def test_few_passes_find_the_limits_of_friction():
    """A rod that falls over slides on its end; its friction and its normal force depend on each other.

    With plain repetition, and the secant of the normal force from the fourth pass on, it took 29 solutions of
    the equations per step tried, and 8 since the limits follow within Newton's method.  The number counts
    work, not time.
    """
    slope, half, radius = math.radians(60), 0.5, 0.05
    end = np.array([0.0, 0.0, radius + 1e-7])
    other = end + 2 * half * np.array([math.cos(slope), 0.0, math.sin(slope)])
    run = simulation(
        [rod(end, other, radius, 4.0)],
        [rod_shape(0, end, other, radius)],
        [plane(friction=0.3)],
        [[0, 0, 0, -1.0, 0.2, 0]],
    )
    record = run.run(np.array([0.2]))
    assert record.residual < MAX_RESIDUAL
    assert record.solves <= 10 * (record.steps + record.rejected)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("distance", [0.01, 0.03, 0.08])
@pytest.mark.parametrize("half", [None, 0.04])
def test_a_fold_takes_the_lever_from_friction_along_it(half, distance, turned, record_figure):
    """`turned`: the bar leads to the other side of the hinge."""
    side, mass, speed, radius, friction, above = -1.0 if turned else 1.0, 3.0, 2.0, 0.05, 0.15, 1e-5
    # a light bar, to which the lever of friction makes a difference
    far = (0.2 * side, 0.0, 0.0)
    bar, start = rod((0.0, 0.0, 0.0), far, radius, 1.0), (side * distance, 0.0, 2 * radius + above)
    inertia = float(bar.inertia[1, 1]) + bar.mass * 0.01
    folds = () if half is None else (SpatialFold(np.zeros(3), half),)
    model = SpatialModel(
        (bar, sphere(start, radius, mass)),
        (
            SpatialJoint(GROUND, 0, np.zeros(3), np.eye(3), (True, True, True, True, False, True)),
            SpatialJoint(GROUND, 1, np.array(start), np.eye(3), (True, True, False, True, True, True)),
        ),
        obstacles=(
            SpatialObstacle(
                ObstacleKind.SPHERE, 1, np.array(start), radius=radius, friction=friction, capsules=(0,)
            ),
        ),
        capsules=(replace(rod_shape(0, (0.0, 0.0, 0.0), far, radius), folds=folds),),
        gravity=(0.0, 0.0, 0.0),
    )
    run = SpatialSimulation(model, 1e-3)
    run.set_motion(np.array([[0.0] * 6, [0.0] * 5 + [-speed]]), np.zeros((2, 6)))
    record = run.run(np.array([0.0, 2 * above / speed]))
    lever = distance - friction * radius * (1.0 if half is None else min(distance / half, 1.0))
    impulse = speed / (1 / mass + distance * lever / inertia)
    name = f"impulse at {distance} m, H = {half}" + (", other side" if turned else "")
    record_figure(name, mass * (speed + record.velocity[-1, 1, 5]), impulse, 1e-4, "N s", relative=True)
    assert record.residual < MAX_RESIDUAL
