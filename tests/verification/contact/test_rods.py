"""Rods that hit planes, poles, edges and each other follow closed forms of impact and statics.

Kind: closed form.  Source: derived here.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from tests.support.multibody.contact_models import (
    GRAVITY,
    MAX_RESIDUAL,
    all_pairs,
    ball_shape,
    plane,
    pole,
    rod,
    rod_shape,
    simulation,
    sphere,
)

from crumple._core.spatial.model import GROUND, SpatialBody, SpatialModel, prismatic
from crumple._core.spatial.simulation import SpatialSimulation

NO_GRAVITY = (0.0, 0.0, 0.0)


def inclined_rod(slope, gap, radius=0.05):
    """Rod of 1 m whose lower end is above the plane by a gap; ends."""
    low = np.array([0.0, 0.0, radius + gap])
    return low, low + np.array([math.cos(slope), 0.0, math.sin(slope)])


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("degrees", [20.0, 60.0])
def test_oblique_impact_of_a_rod(degrees, restitution, record_figure):
    """Impulse (1+e) v/(1/m + x^2/I), x the arm along the plane from centre to contact; no friction."""
    slope, speed, mass = math.radians(degrees), 3.0, 4.0
    first, second = inclined_rod(slope, 0.03)
    body = rod(first, second, mass=mass)
    run = simulation(
        [body],
        [rod_shape(0, first, second)],
        [plane(restitution=restitution)],
        [[0, 0, 0, 0, 0, -speed]],
        NO_GRAVITY,
    )
    record = run.run(np.array([0.0, 0.012]))
    x, inertia = -math.cos(slope) / 2, body.inertia[1, 1]
    impulse = (1 + restitution) * speed / (1 / mass + x * x / inertia)
    name = f"{degrees:g} deg, e = {restitution}"
    record_figure(f"velocity after, {name}", record.velocity[1, 0, 5], impulse / mass - speed, 1e-4, "m/s")
    record_figure(f"spin after, {name}", record.velocity[1, 0, 1], -x * impulse / inertia, 1e-3, "rad/s")
    assert record.residual < MAX_RESIDUAL


@pytest.mark.parametrize(("end", "sign"), [(1, 1.0), (2, -1.0)])
def test_an_end_that_another_capsule_stands_for_meets_nothing(end, sign, record_figure):
    """A flat rod that a plane meets at one end alone: impulse v/(1/m + (l/2)^2/I) there."""
    speed, mass, radius = 3.0, 4.0, 0.05
    first, second = np.array([0.0, 0.0, radius + 0.03]), np.array([1.0, 0.0, radius + 0.03])
    body = rod(first, second, mass=mass)
    floor = replace(plane(), capsules=(0,), ends=(end,))
    motion = [[0, 0, 0, 0, 0, -speed]]
    record = simulation([body], [rod_shape(0, first, second)], [floor], motion, NO_GRAVITY).run(
        np.array([0.0, 0.012])
    )
    inertia = body.inertia[1, 1]
    impulse = speed / (1 / mass + 0.25 / inertia)
    name = f"end {end}"
    record_figure(f"velocity after, {name}", record.velocity[1, 0, 5], impulse / mass - speed, 1e-4, "m/s")
    record_figure(
        f"spin after, {name}", record.velocity[1, 0, 1], sign * 0.5 * impulse / inertia, 1e-3, "rad/s"
    )


def test_impact_that_reverses_the_slip(record_figure):
    """The end of the rod slides forward, and backward after the impact; friction acts against the later slip.

    With the arm (x, z) from centre to contact, impulses N and F = mu N, and end of approach:
    N (1/m + x^2/I) - x z F/I = v, slip after: s + F (1/m + z^2/I) - x z N/I < 0.
    """
    slope, speed, slip, mass, friction, radius = math.radians(45.0), 3.0, 1.5, 4.0, 0.1, 0.05
    first, second = inclined_rod(slope, 0.03, radius)
    body = rod(first, second, mass=mass)
    run = simulation(
        [body],
        [rod_shape(0, first, second)],
        [plane(friction=friction)],
        [[0, 0, 0, slip, 0, -speed]],
        NO_GRAVITY,
    )
    record = run.run(np.array([0.0, 0.012]))
    x, z, inertia = -math.cos(slope) / 2, -math.sin(slope) / 2 - radius, body.inertia[1, 1]
    normal = speed / (1 / mass + x * x / inertia - x * z * friction / inertia)
    after = slip + friction * normal * (1 / mass + z * z / inertia) - x * z * normal / inertia
    assert -slip < after < 0.0
    record_figure(
        "slip reversed, normal impulse", mass * (record.velocity[1, 0, 5] + speed), normal, 1e-3, "N s"
    )
    lost = normal * speed / 2 - friction * normal * (slip + after) / 2
    together = record.energy.contact[-1] + record.energy.friction[-1]
    record_figure("slip reversed, energy lost", together, lost, 1e-3, "J", relative=True)
    assert record.energy.friction[-1] >= 0.0


@pytest.mark.parametrize("friction", [1.0, 1.3, 2.0, 10.0])
def test_impact_that_jams(friction, record_figure):
    """Above a friction of 1.21 the friction of the slip would press the rod on the plane more than the plane
    pushes it back (Painleve's paradox): both impulses are those that stop the end, at any friction.

    (1/m + z^2/I) F - x z N/I = s and (1/m + x^2/I) N - x z F/I = v; (x, z) from centre to contact.
    """
    slope, speed, slip, mass, radius = math.radians(60.0), 3.0, 1.5, 4.0, 0.05
    first, second = inclined_rod(slope, 0.03, radius)
    body = rod(first, second, mass=mass)
    velocity = [[0, 0, 0, -slip, 0, -speed]]
    run = simulation([body], [rod_shape(0, first, second)], [plane(friction=friction)], velocity, NO_GRAVITY)
    record = run.run(np.array([0.0, 0.012]))
    x, z, inertia = -math.cos(slope) / 2, -math.sin(slope) / 2 - radius, body.inertia[1, 1]
    mobility = np.eye(2) / mass + np.array([[z * z, -x * z], [-x * z, x * x]]) / inertia
    along, normal = np.linalg.solve(mobility, [slip, speed])
    assert along < friction * normal
    found = mass * (record.velocity[1, 0, [3, 5]] + [slip, speed])
    record_figure(f"jam, friction {friction:g}, along", found[0], along, 1e-3, "N s")
    record_figure(f"jam, friction {friction:g}, normal", found[1], normal, 1e-3, "N s")
    assert record.residual < MAX_RESIDUAL


def test_rod_falls_over_on_a_smooth_plane(record_figure):
    """Its centre falls straight down: energy gives the spin at every angle.

    At the slope a with half the length l: m g l (sin a0 - sin a) = (m l^2 cos^2 a + I) w^2/2.
    """
    start, radius, half, mass = math.radians(70), 0.05, 0.5, 4.0
    first, second = inclined_rod(start, 0.0, radius)
    body = rod(first, second, radius, mass)
    run = simulation([body], [rod_shape(0, first, second, radius)], [plane()])
    record = run.run(np.linspace(0, 0.4, 41))
    height = record.centre[:, 0, 2] - radius
    slope = np.arcsin(height / half)
    spin = np.sqrt(
        2
        * mass
        * GRAVITY
        * half
        * (math.sin(start) - np.sin(slope))
        / (mass * (half * np.cos(slope)) ** 2 + body.inertia[1, 1])
    )
    assert slope[-1] < 0.9 * start
    for k in (10, 20, 40):
        record_figure(
            f"spin at {record.time[k]:g} s", record.velocity[k, 0, 1], spin[k], 1e-3, "rad/s", relative=True
        )
    record_figure("drift of the centre", record.centre[-1, 0, 0] - record.centre[0, 0, 0], 0.0, 1e-9, "m")
    assert record.residual < MAX_RESIDUAL


def test_rod_comes_to_lie_flat(record_figure):
    """Thrown on a rough floor it ends on its two ends' contacts, each with half its weight."""
    first, second = inclined_rod(math.radians(30), 0.4)
    run = simulation([rod(first, second)], [rod_shape(0, first, second)], [plane(friction=0.5)])
    record = run.run(np.linspace(0, 3, 31))
    turned = record.rotation[-1, 0]
    slope = 2 * math.atan2(turned[2], turned[0])
    record_figure("slope at the end", slope, math.radians(30), 1e-5, "rad")
    record_figure("height at the end", record.centre[-1, 0, 2], 0.05, 5e-6, "m")
    record_figure("force at the end", record.obstacle_force[-1, 0, 2], -4 * GRAVITY, 1e-4, "N", relative=True)
    assert record.residual < MAX_RESIDUAL


@pytest.mark.parametrize("restitution", [0.0, 0.6, 1.0])
def test_central_collision(restitution, record_figure):
    """Parallel capsules meet side by side: momentum stays, v2 - v1 turns into -e times itself, none spins."""
    ends = [((0, -0.5, 0), (0, 0.5, 0)), ((0.5, -0.3, 0), (0.5, 0.3, 0))]
    masses = (4.0, 1.5)
    run = simulation(
        [rod(*e, mass=m) for e, m in zip(ends, masses, strict=True)],
        [rod_shape(k, *e) for k, e in enumerate(ends)],
        velocity=[[0, 0, 0, 5, 0, 0], [0, 0, 0, -1, 0, 0]],
        gravity=NO_GRAVITY,
        contact=all_pairs(2, restitution=restitution),
    )
    record = run.run(np.array([0.0, 0.2]))
    common = (4.0 * 5 - 1.5) / 5.5
    v = record.velocity[1]
    record_figure(
        f"velocity of the first, e = {restitution}",
        v[0, 3],
        common - restitution * 1.5 / 5.5 * 6,
        1e-5,
        "m/s",
    )
    record_figure(
        f"velocity of the second, e = {restitution}",
        v[1, 3],
        common + restitution * 4.0 / 5.5 * 6,
        1e-5,
        "m/s",
    )
    record_figure(f"spin, e = {restitution}", float(np.abs(v[:, :3]).max()), 0.0, 1e-4, "rad/s")
    lost = (1 - restitution**2) * 4.0 * 1.5 / 5.5 * 36 / 2
    record_figure(f"energy lost, e = {restitution}", record.energy.contact[1], lost, 1e-4 * 20, "J")


def test_crossing_rods_keep_momentum_and_moment_of_momentum(record_figure):
    """Two rods strike each other off centre with friction; forces act at one point, so both momenta stay."""
    first, second = ((-0.5, 0, 0), (0.5, 0, 0)), ((0.2, -0.4, 0.3), (0.2, 0.5, 0.35))
    bodies = [rod(*first), rod(*second, mass=2.0)]
    run = simulation(
        bodies,
        [rod_shape(0, *first), rod_shape(1, *second)],
        velocity=[[0, 0, 0, 0, 0, 3], [0.5, 0, 1, 0.5, 0.2, -2]],
        gravity=NO_GRAVITY,
        contact=all_pairs(2, friction=0.3, restitution=0.4),
        accuracy=1e-4,
    )
    record = run.run(np.array([0.0, 0.2]))
    assert record.energy.contact[1] > 1

    def momenta(k):
        linear, angular = np.zeros(3), np.zeros(3)
        for i, body in enumerate(bodies):
            w, x, y, z = record.rotation[k, i]
            turn = np.array(
                [
                    [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
                ]
            )
            spin, velocity = record.velocity[k, i, :3], record.velocity[k, i, 3:]
            linear += body.mass * velocity
            angular += turn @ body.inertia @ turn.T @ spin + np.cross(
                record.centre[k, i], body.mass * velocity
            )
        return linear, angular

    (p0, l0), (p1, l1) = momenta(0), momenta(1)
    record_figure("change of momentum", float(np.abs(p1 - p0).max()), 0.0, 1e-9, "N s")
    record_figure(
        "change of moment of momentum", float(np.abs(l1 - l0).max()), 0.0, 1e-4 * np.abs(l0).max(), "N m s"
    )
    assert record.residual < MAX_RESIDUAL


def test_rod_rests_across_two_poles(record_figure):
    """Statics: a rod of 1 m with its centre at 0.5 on poles at 0.2 and 0.9 loads them 4 to 3."""
    ends = ((0, 0, 0.25), (1, 0, 0.25))
    obstacles = [pole((x, 0, 0), (0, 1, 0), 0.2, friction=0.2) for x in (0.2, 0.9)]
    run = simulation([rod(*ends)], [rod_shape(0, *ends)], obstacles)
    record = run.run(np.array([0.0, 0.5, 1.0]))
    weight = 4 * GRAVITY
    record_figure(
        "load of the near pole", record.obstacle_force[2, 0, 2], -weight * 4 / 7, 1e-3, "N", relative=True
    )
    record_figure(
        "load of the far pole", record.obstacle_force[2, 1, 2], -weight * 3 / 7, 1e-3, "N", relative=True
    )
    record_figure("movement", float(np.abs(record.centre[2] - record.centre[0]).max()), 0.0, 1e-5, "m")


def test_ball_rolls_down_a_pole_and_leaves_it(record_figure):
    """Without friction a mass leaves a cylinder at 2/3 of its height at the start, with v^2 = 2 g R/3."""
    radius, reach, start = 0.1, 0.6, 0.02
    centre = reach * np.array([math.sin(start), 0.0, math.cos(start)])
    run = simulation(
        [sphere(centre, radius)], [ball_shape(0, centre, radius)], [pole((0, 0, 0), (0, 1, 0), 0.5)]
    )
    record = run.run(np.linspace(0, 1.6, 1601))
    carried = record.obstacle_force[:, 0, 2] < -1e-9
    leaves = int(np.argmax(~carried[1:])) + 1
    height = record.centre[leaves, 0, 2] / reach
    record_figure("height where it leaves", height, 2 / 3 * math.cos(start), 5e-3, "")
    speed = float(np.hypot(*record.velocity[leaves, 0, [3, 5]]))
    expected = math.sqrt(2 * GRAVITY * reach * math.cos(start) / 3)
    record_figure("speed there", speed, expected, 5e-3, "m/s", relative=True)
    distance = np.hypot(record.centre[:leaves, 0, 0], record.centre[:leaves, 0, 2])
    record_figure("distance from the axis until then", float(np.abs(distance - reach).max()), 0.0, 1e-5, "m")
    assert record.residual < MAX_RESIDUAL


@pytest.mark.parametrize(("over", "falls"), [(0.45, False), (0.55, True)])
def test_rod_on_an_edge_tips_when_its_centre_is_beyond(over, falls):
    """The plane ends at x = 0; the rod reaches `over` of its length beyond."""
    ends = ((over - 1, 0, 0.05), (over, 0, 0.05))
    run = simulation([rod(*ends)], [rod_shape(0, *ends)], [plane(friction=0.5, edge=(1, 0, 0))])
    record = run.run(np.array([0.0, 1.5]))
    dropped = record.centre[0, 0, 2] - record.centre[1, 0, 2]
    assert dropped > 1 if falls else abs(dropped) < 1e-5
    assert record.residual < MAX_RESIDUAL


def test_obstacle_with_a_mass_on_a_guide(record_figure):
    """A wall of 10 kg on a guide and a ball: they part with e times their approach along the normal."""
    wall = SpatialBody(10.0, np.eye(3), np.array([1.0, 0, 0]))
    model = SpatialModel(
        (wall, sphere((0, 0, 0), mass=2.0)),
        joints=(prismatic(GROUND, 0, (1.0, 0, 0), (1, 0, 0)),),
        obstacles=(plane((1.0, 0, 0), (-1, 0, 0.3), restitution=0.5, body=0),),
        capsules=(ball_shape(1, (0, 0, 0)),),
    )
    run = SpatialSimulation(model)
    run.set_motion(np.array([[0, 0, 0, -1.0, 0, 0], [0, 0, 0, 4.0, 0, 0]]), np.zeros((2, 6)))
    record = run.run(np.array([0.0, 0.3]))
    n = np.array([-1, 0, 0.3]) / math.hypot(1, 0.3)
    approach = 5.0 * -n[0]
    impulse = 1.5 * approach / (1 / 2.0 + n[0] ** 2 / 10.0)
    record_figure("velocity of the wall", record.velocity[1, 0, 3], -1 - impulse * n[0] / 10, 1e-5, "m/s")
    for k, name in ((0, "x"), (2, "z")):
        start = 4.0 if k == 0 else 0.0
        record_figure(
            f"velocity of the ball, {name}",
            record.velocity[1, 1, 3 + k],
            start + impulse * n[k] / 2,
            1e-5,
            "m/s",
        )
    assert record.residual < MAX_RESIDUAL


def test_bodies_that_overlap_at_the_start_stay_as_they_are(record_figure):
    """A rod that begins 10 mm deep in the floor rests there; nothing is thrown out."""
    ends = ((0, 0, 0.04), (1, 0, 0.04))
    run = simulation([rod(*ends)], [rod_shape(0, *ends)], [plane()])
    record = run.run(np.array([0.0, 0.5]))
    record_figure("movement", record.centre[1, 0, 2] - record.centre[0, 0, 2], 0.0, 2e-6, "m")
