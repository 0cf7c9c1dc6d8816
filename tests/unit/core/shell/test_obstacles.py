"""Rigid obstacles against free sheets: momentum, friction, masses on guides, drives, shapes, same bits."""

from dataclasses import replace

import numpy as np
import pytest
from tests.support.shell.sheets import ELASTIC, STEEL, grid, model

from crumple._core.shell.simulation import RigidObstacle, RigidSet, Shape, ShellState

T = 2e-3


def block(obstacle, velocity, gravity=(0.0, 0.0, 0.0), n=3, side=0.03, height=T / 2, **settings):
    """A sheet above z = 0 whose nodes are one rigid set: nothing but its contact can store energy."""
    x, quads = grid(n, n, side, side)
    x[:, 2] = height
    return model(
        x,
        quads,
        T,
        velocity=np.broadcast_to(np.array(velocity), x.shape),
        rigid_sets=[RigidSet(np.arange(len(x)))],
        obstacles=[obstacle],
        settings={"gravity": gravity, "contact_damping": 0.1, **settings},
    )


def mass_of(m):
    return ShellState(m).mass


def test_sliding_block_stops_where_friction_has_taken_its_energy():
    """v^2 / (2 mu g); then it sticks."""
    speed, mu, g = 1.0, 0.3, 2000.0
    state = ShellState(block(RigidObstacle(Shape.PLANE, (0, 0, 0), friction=mu), (speed, 0, 0), (0, 0, -g)))
    state.advance(3e-3)
    way = state.position[:, 0].mean() - 0.015
    assert way == pytest.approx(speed**2 / (2 * mu * g), rel=0.01)
    held = state.position.copy()
    state.advance(6e-3)
    assert np.abs(state.position - held)[:, :2].max() < 1e-3 * way
    e = state.energies
    # friction has taken what the block had; what is left in the springs is small
    assert e["contact"] == pytest.approx(0.5 * state.mass * speed**2, rel=0.05)
    assert abs(e["residual"]) < 1e-3 * e["contact"]


@pytest.mark.parametrize(("mu", "slides"), [(0.7, False), (0.3, True)])
def test_block_on_a_slope_sticks_or_slides(mu, slides):
    """On 30 degrees it stays where mu > tan 30, else it goes by g (sin - mu cos)."""
    g, angle = 1000.0, np.radians(30.0)
    gravity = (g * np.sin(angle), 0.0, -g * np.cos(angle))
    state = ShellState(block(RigidObstacle(Shape.PLANE, (0, 0, 0), friction=mu), (0, 0, 0), gravity))
    t = 4e-3
    state.advance(t)
    way = state.position[:, 0].mean() - 0.015
    free = g * (np.sin(angle) - mu * np.cos(angle)) * t**2 / 2
    if slides:
        assert way == pytest.approx(free, rel=0.02)
    else:
        # what the springs of friction give, no creep
        assert 0.0 < way < 1e-3 * g * t**2
        assert abs(state.velocity[0][:, 0].mean()) < 1e-4


def test_block_lies_still_and_its_weight_is_carried():
    g = 500.0
    state = ShellState(block(RigidObstacle(Shape.PLANE, (0, 0, 0)), (0, 0, 0), (0, 0, -g), height=T / 2))
    state.advance(4e-3)
    before = state.obstacles[0, 11:14].copy()
    start = state.time
    state.advance(8e-3)
    mean = (state.obstacles[0, 11:14] - before) / (state.time - start)
    assert mean[2] == pytest.approx(-state.mass * g, rel=2e-3)
    assert np.abs(state.velocity[0]).max() < 1e-3


def test_oblique_impact_balances_momentum_and_energy():
    """What the sheet loses the plane has taken; sliding friction takes mu times the normal impulse."""
    x, quads = grid(6, 6, 0.06, 0.06)
    x[:, 2] = 1.5e-3
    velocity = np.tile([8.0, 3.0, -20.0], (len(x), 1))
    plane = RigidObstacle(Shape.PLANE, (0, 0, 0), friction=0.15)
    m = model(x, quads, T, ELASTIC, velocity=velocity, obstacles=[plane])
    state = ShellState(m)
    first, weight = state.energies["kinetic"], state.mass
    state.advance(1e-3)
    impulse = state.obstacles[0, 11:14]
    lost = weight * (velocity[0] - _mean(m, state.velocity[0]))
    assert impulse == pytest.approx(lost, rel=1e-9, abs=1e-9 * np.linalg.norm(lost))
    assert np.hypot(*impulse[:2]) == pytest.approx(0.15 * -impulse[2], rel=0.02)
    assert impulse[1] / impulse[0] == pytest.approx(3.0 / 8.0, rel=0.05)
    e = state.energies
    assert abs(e["residual"]) < 1e-4 * first
    assert state.obstacles[0, 14] < 0.9


def _mean(m, velocity):
    """Mass-weighted mean over equal elements."""
    share = np.bincount(m.elements.ravel(), minlength=len(m.position))
    return share @ velocity / share.sum()


def test_ball_with_a_mass_stops_on_a_plate_and_shares_its_momentum():
    x, quads = grid(12, 12, 0.12, 0.12)
    ball = RigidObstacle(
        Shape.SPHERE,
        (0.061, 0.058, 0.0301 + T / 2),
        radius=0.03,
        mass=0.5,
        guide=(0, 0, 1),
        velocity=(0, 0, -10.0),
    )
    m = model(x, quads, T, STEEL, obstacles=[ball], settings={"self_contact": True})
    state = ShellState(m)
    first = state.energies["kinetic"]
    assert first == pytest.approx(0.5 * 0.5 * 100.0)
    for _ in range(8):
        state.advance(state.time + 2.5e-4)
        e = state.energies
        assert abs(e["residual"]) < 1e-3 * first
        # the plate is free: all momentum stays along the guide
        momentum = 0.5 * state.obstacles[0, 5] + state.mass * _mean(m, state.velocity[0])[2]
        assert momentum == pytest.approx(-5.0, rel=2e-3)
    assert state.obstacles[0, 5] > -10.0
    assert e["plastic"] > 0
    assert 0 < state.obstacles[0, 14] < 0.5


def test_light_mass_does_not_run_away():
    """A plate 60 times as heavy as the obstacle on its guide: the penalty is softened, energy kept."""
    plane = RigidObstacle(Shape.PLANE, (0, 0, 0), mass=2.4e-4, guide=(0, 0, 1))
    state = ShellState(block(plane, (0, 0, -5.0), height=1.1e-3))
    first = state.energies["kinetic"]
    state.advance(1e-3)
    e = state.energies
    assert abs(e["residual"]) < 1e-3 * first
    assert state.obstacles[0, 5] < -5.0


def test_driven_plane_pushes_and_its_work_is_booked():
    """Constant 4 m/s against a block at rest: it leaves with at least that, the plane gave the energy."""
    plane = RigidObstacle(Shape.PLANE, (0, 0, 0), motion=(None, None, ([0.0], [4.0])))
    state = ShellState(block(plane, (0, 0, 0), height=1.5e-3))
    state.advance(1e-3)
    e = state.energies
    assert state.obstacles[0, 2] == pytest.approx(4.0 * state.time, rel=1e-9)
    # the damper of contact takes a little of the rebound at twice the speed
    assert 4.0 < state.velocity[0][:, 2].mean() < 8.0
    assert e["external_work"] == pytest.approx(4.0 * -state.obstacles[0, 13], rel=1e-9)
    assert abs(e["residual"]) < 1e-6 * e["external_work"]


def test_turning_plane_carries_a_sheet_along():
    """A plane that turns about y through its point sweeps a sheet: work from its torque, none lost."""
    plane = RigidObstacle(
        Shape.PLANE, (0, 0, 0), turn_axis=(0, -1, 0), turning=([0.0, 1e-3, 2e-3], [0.0, 100.0, 100.0])
    )
    x, quads = grid(4, 4, 0.04, 0.04)
    x += [0.1, 0.0, 1.2e-3]
    state = ShellState(model(x, quads, T, ELASTIC, obstacles=[plane], settings={"contact_damping": 0.1}))
    state.advance(2e-3)
    e = state.energies
    angle = state.obstacles[0, 6]
    assert angle == pytest.approx(0.05 + 0.1, rel=1e-3)
    above = state.position @ np.array([-np.sin(angle), 0.0, np.cos(angle)])
    assert above.min() > 0.9e-3
    assert e["external_work"] > 0.5 * state.mass * (0.1 * 100) ** 2
    assert abs(e["residual"]) < 1e-3 * e["external_work"]


def test_plane_ends_at_its_edge():
    """Of two blocks that fall, the one beyond the edge goes on; between them the edge is round."""
    edge = RigidObstacle(Shape.EDGE, (0.02, 0, 0), edge=(1, 0, 0))
    for shift, stopped in ((-0.03, True), (0.03, False)):
        m = block(edge, (0, 0, -10.0), height=1.5e-3)
        state = ShellState(replace(m, position=m.position + np.array([shift, 0, 0])))
        state.advance(5e-4)
        speed = state.velocity[0][:, 2].mean()
        assert bool(speed > 0) is stopped
        assert state.deepest_penetration < 0.9
    # a node beside the edge and below it is pushed out sideways
    m = block(edge, (-10.0, 0, 0), height=-0.01)
    state = ShellState(replace(m, position=m.position + np.array([0.0215, 0, 0])))
    state.advance(5e-4)
    assert state.velocity[0][:, 0].mean() > 0


@pytest.mark.parametrize("shape", [Shape.POLE, Shape.CYLINDER, Shape.SPHERE])
def test_round_obstacles_keep_their_radius(shape):
    """A sheet that falls on a round obstacle bends over it and stays out."""
    x, quads = grid(10, 10, 0.1, 0.1)
    x[:, 2] = 0.0412
    x[:, 1] -= 0.05
    obstacle = RigidObstacle(shape, (0.05, 0, 0), axis=(0, 1, 0), radius=0.04, length=0.02)
    m = model(x, quads, T, STEEL, velocity=np.tile([0.0, 0.0, -30.0], (len(x), 1)), obstacles=[obstacle])
    state = ShellState(m)
    first = state.energies["kinetic"]
    state.advance(1e-3)
    d = state.position - np.array([0.05, 0, 0])
    along = {Shape.POLE: d[:, 1], Shape.CYLINDER: np.clip(d[:, 1], 0, 0.02), Shape.SPHERE: 0 * d[:, 1]}[shape]
    d[:, 1] -= along
    assert np.linalg.norm(d, axis=1).min() > 0.04 + 0.5 * T / 2
    assert state.velocity[0][:, 2].mean() > -29.0
    assert abs(state.energies["residual"]) < 2e-3 * first


def test_wall_end_that_stands_on_a_plane_keeps_its_place():
    """Nodes that start on the plane are not pushed off it by half their wall's thickness."""
    plane = RigidObstacle(Shape.PLANE, (0, 0, 0))
    x, quads = grid(4, 4, 0.04, 0.04)
    upright = x[:, [0, 2, 1]]
    state = ShellState(model(upright, quads, T, obstacles=[plane]))
    state.advance(1.0, steps=50)
    assert state.energies["kinetic"] == 0.0
    assert state.touching_nodes == 0


def test_absent_obstacle_does_nothing_and_only_given_nodes_touch():
    falling = {"velocity": (0, 0, -10.0), "height": 1.5e-3}
    for obstacle in (
        RigidObstacle(Shape.PLANE, (0, 0, 0), active=False),
        RigidObstacle(Shape.PLANE, (0, 0, 0), nodes=[]),
    ):
        state = ShellState(block(obstacle, **falling))
        state.advance(4e-4)
        assert state.velocity[0][:, 2] == pytest.approx(-10.0)


def test_restored_run_with_friction_and_masses_gives_the_same_bits():
    x, quads = grid(8, 8, 0.08, 0.08)
    x[:, 2] = 1.1e-3
    obstacles = [
        RigidObstacle(Shape.PLANE, (0, 0, 0), friction=0.3),
        RigidObstacle(
            Shape.SPHERE, (0.04, 0.04, 0.0232), radius=0.02, mass=0.2, velocity=(0, 0, -8.0), friction=0.2
        ),
    ]
    m = model(
        x, quads, T, STEEL, velocity=np.tile([3.0, 0.0, -2.0], (len(x), 1)), obstacles=obstacles,
        settings={"self_contact": True, "contact_friction": 0.1, "contact_damping": 0.1},
    )  # fmt: skip
    whole = ShellState(m)
    whole.advance(1.0, steps=731)
    saved = whole.checkpoint()
    whole.advance(1.0, steps=600)
    again = ShellState(m)
    again.restore(saved)
    again.advance(1.0, steps=600, threads=2)
    assert np.array_equal(whole.position, again.position)
    assert np.array_equal(whole.obstacles, again.obstacles)
    assert whole.energies == again.energies
    assert whole.obstacles[1, 14] > 0


def test_obstacles_without_direction_are_refused():
    from crumple.errors import InputError

    for wrong in ({"axis": (0, 0, 0)}, {"guide": (0, 0, 0)}):
        with pytest.raises(InputError, match="no length"):
            ShellState(block(RigidObstacle(Shape.PLANE, (0, 0, 0), **wrong), (0, 0, 0)))


@pytest.mark.parametrize("node", [-1, 16, 10**6])
def test_nodes_that_do_not_exist_are_refused(node):
    from crumple.errors import InputError

    with pytest.raises(InputError, match=r"obstacle 0: node \d+ does not exist"):
        ShellState(block(RigidObstacle(Shape.PLANE, (0, 0, 0), nodes=np.array([0, node])), (0, 0, 0)))


def test_stack_of_plates_lies_still_and_carries_its_weight():
    """Two free plates on a plane under gravity: a thickness apart, no jitter, all weight below."""
    x, quads = grid(5, 5, 0.05, 0.05)
    stack = np.concatenate([x + np.array([0, 0, T / 2]), x + np.array([0.0031, 0.0017, 1.5 * T])])
    g = 500.0
    plane = RigidObstacle(Shape.PLANE, (0, 0, 0), friction=0.2)
    m = model(
        stack, np.concatenate([quads, quads + len(x)]), T, ELASTIC, obstacles=[plane],
        settings={
            "self_contact": True, "contact_friction": 0.2, "contact_damping": 0.1, "gravity": (0, 0, -g)
        },
    )  # fmt: skip
    state = ShellState(m)
    state.advance(6e-3)
    before, start, speed = state.obstacles[0, 11:14].copy(), state.time, 0.0
    for _ in range(6):
        state.advance(state.time + 1e-3)
        speed = max(speed, np.abs(state.velocity[0]).max())
    mean = (state.obstacles[0, 11:14] - before) / (state.time - start)
    assert mean[2] == pytest.approx(-state.mass * g, rel=0.01)
    # falling over the same time would give 3 m/s
    assert speed < 5e-3
    z = state.position[:, 2]
    assert z[: len(x)] == pytest.approx(T / 2, rel=0.01)
    assert z[len(x) :] == pytest.approx(1.5 * T, rel=0.01)


def test_mass_on_a_guide_falls_freely():
    ball = RigidObstacle(Shape.SPHERE, (0, 0, 1.0), radius=0.01, mass=2.0, guide=(0, 0, -1))
    state = ShellState(block(ball, (0, 0, 0), (0, 0, -9.81)))
    state.advance(1e-3)
    assert state.obstacles[0, 2] == pytest.approx(-9.81 * state.time**2 / 2, rel=2e-3)
    e = state.energies
    assert abs(e["residual"]) < 1e-6 * e["kinetic"]
