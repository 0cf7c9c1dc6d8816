"""Rigid sets with heavy lumps against obstacles: held within part of a thickness, as rigid bodies rebound.

An impact takes about ten steps, and its first touch is seen up to one step late: e errs by up to 0.07.
"""

import numpy as np
import pytest
from tests.support.shell.sheets import grid, model
from tests.support.shell.structures import structure

from crumple._core.shell.simulation import RigidObstacle, RigidSet, Shape, ShellState
from crumple.errors import Status
from crumple.shell import ShellRun, solve_shell
from crumple.shell.model.obstacles import rebound, rebound_damping
from crumple.structure import Outputs, ShellSettings

T = 2e-3
SPEED = 10.0


def plate(lump=0.0, tilt=0.0, across=0.0, held=(), **obstacle):
    """Rigid plate 30 x 30 mm with a lump in its middle, just above the plane z = 0; tilted about y."""
    x, quads = grid(3, 3, 0.03, 0.03)
    c, s = np.cos(tilt), np.sin(tilt)
    x = (x - [0.015, 0.015, 0]) @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T
    x[:, 2] += T / 2 - x[:, 2].min() + 1e-5
    middle = tuple(x.mean(axis=0))
    return ShellState(
        model(
            x,
            quads,
            T,
            velocity=np.tile([across, 0.0, -SPEED], (len(x), 1)),
            rigid_sets=[RigidSet(np.arange(len(x)), mass=lump, at=middle, fixed=held)],
            obstacles=[RigidObstacle(Shape.PLANE, (0, 0, 0), **obstacle)],
            settings={"contact_damping": 0.1},
        )
    )


def after(state, time=4e-4):
    """Velocity of the centre and spin about y after the impact, and momentum that the plane took."""
    assert state.advance(time) is Status.COMPLETE
    assert state.time_step == pytest.approx(state.first_time_step, rel=1e-6)
    return state.rigid_sets[0, 3:6], state.rigid_sets[0, 7], state.obstacles[0, 11:14]


@pytest.mark.parametrize("mass", [0.0, 1.0, 50.0, 5000.0])
def test_depth_does_not_depend_on_the_lump(mass):
    """v dt / sqrt(s), s = 0.1, from 15 g to 5 t; the springs of the walls alone would yield by sqrt(M)."""
    state = plate(mass)
    first = state.energies["kinetic"]
    velocity, _, impulse = after(state)
    depth = state.obstacles[0, 14] * T / 2
    assert depth < 1.05 * SPEED * state.first_time_step / np.sqrt(0.1)
    assert depth < 0.05 * T
    assert -impulse[2] == pytest.approx((mass + state.mass) * (velocity[2] + SPEED), rel=1e-9)
    assert abs(state.energies["residual"]) < 1e-9 * first


@pytest.mark.parametrize("restitution", [0.0, 0.3, 0.8])
@pytest.mark.parametrize("tilt", [0.0, 0.4])
def test_impact_on_a_face_or_an_edge_is_that_of_a_rigid_body(restitution, tilt):
    """Impulse J = (1 + e) v / (1/m + r^2/I); the centre then moves by J/m, the plate turns by J r/I."""
    state = plate(tilt=tilt, damping=rebound_damping(restitution))
    m, x = state.mass, state.position - state.rigid_sets[0, :3]
    share = np.bincount(state.model.elements.ravel(), minlength=16) / 36.0
    # the nodes' own inertia: docs/theory/explicit_stepper.md, a = 1.235 for steel
    own = (T**2 + 1.235 * 0.01**2) / 12
    inertia = m * ((share * (x[:, 0] ** 2 + x[:, 2] ** 2)).sum() + own)
    r = 0.015 * np.cos(tilt) if tilt else 0.0
    velocity, spin, impulse = after(state, 6e-5)
    j = -impulse[2]
    assert j == pytest.approx((1 + restitution) * SPEED / (1 / m + r**2 / inertia), rel=0.05)
    assert velocity[2] == pytest.approx(-SPEED + j / m, rel=1e-9, abs=1e-9)
    assert abs(spin) == pytest.approx(j * r / inertia, rel=0.02, abs=1e-6)


def test_friction_of_a_heavy_lump_takes_mu_times_its_impulse():
    state = plate(100.0, across=8.0, friction=0.25, damping=rebound_damping(0.5))
    velocity, _, impulse = after(state)
    assert impulse[0] == pytest.approx(-0.25 * impulse[2], rel=1e-3)
    assert 8.0 - velocity[0] == pytest.approx(0.25 * 1.5 * SPEED, rel=0.02)
    # slow enough it sticks; the springs give back little
    state = plate(100.0, across=1.0, friction=0.25, damping=rebound_damping(0.5))
    velocity, _, _ = after(state)
    assert abs(velocity[0]) < 0.2


def test_what_a_support_holds_does_not_yield_to_the_touch():
    """Held against turning, an edge carries the whole plate."""
    state = plate(tilt=0.4, held=("rx", "ry", "rz"), damping=rebound_damping(0.0))
    velocity, spin, impulse = after(state)
    assert spin == 0.0
    assert -impulse[2] == pytest.approx(SPEED * state.mass, rel=0.03)
    assert abs(velocity[2]) < 0.03 * SPEED


def test_lump_and_obstacle_with_a_mass_share_their_momentum():
    state = plate(20.0, mass=2.0, guide=(0, 0, 1), damping=rebound_damping(0.6))
    velocity, _, _ = after(state)
    m, other = 20.0 + state.mass, state.obstacles[0, 5]
    assert m * velocity[2] + 2.0 * other == pytest.approx(-SPEED * m, rel=1e-9)
    assert velocity[2] - other == pytest.approx(0.6 * SPEED, rel=0.05)


def test_rebound_at_critical_damping_and_its_inverse():
    assert rebound(1.0) == pytest.approx(np.exp(-2.0))
    assert rebound(0.0) == 1.0
    for z in (0.999999, 1.000001):
        assert rebound(z) == pytest.approx(np.exp(-2.0), rel=1e-5)
    for e in (0.01, 0.135, 0.5, 1.0):
        assert rebound(rebound_damping(e)) == pytest.approx(e, rel=1e-9)


def test_restored_lump_with_friction_gives_the_same_bits_on_two_threads():
    whole = plate(30.0, tilt=0.2, across=3.0, friction=0.3)
    whole.advance(1.0, steps=40)
    saved = whole.checkpoint()
    whole.advance(1.0, steps=60)
    again = plate(30.0, tilt=0.2, across=3.0, friction=0.3)
    again.restore(saved)
    again.advance(1.0, steps=60, threads=2)
    assert np.array_equal(whole.position, again.position)
    assert np.array_equal(whole.obstacles, again.obstacles)
    assert whole.energies == again.energies


@pytest.mark.parametrize("rigid", [False, True])
@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_heavy_lump_on_a_tube_end_hits_a_wall(restitution, rigid):
    """500 kg on the end of a tube at 10 m/s: no warning of what went in, the rebound that was asked for.

    Where two thirds of the tube are rigid, the end section that touches is a small part of the set.
    """
    wall = {
        "type": "plane",
        "point": (0.3014, 0, 0),
        "normal": (-1, 0, 0),
        "restitution": restitution,
    }
    given = structure(
        {"a": (0, 0, 0), "b": (0.1, 0, 0), "tip": (0.3, 0, 0)},
        {"first": ("a", "b"), "second": ("b", "tip")},
        masses={"lump": {"node": "tip", "mass": 500.0}},
        initial_velocity=[{"translation": (SPEED, 0, 0)}],
        obstacles={"wall": wall},
    )
    if rigid:
        second = given.members["second"].model_copy(update={"rigid": True})
        given = given.model_copy(update={"members": {**given.members, "second": second}})
    run = ShellRun(4e-4, 2e-5, ShellSettings(element_size=12e-3), Outputs(nodes=("tip",)))
    result = solve_shell(given, run)
    assert result.status is Status.COMPLETE
    assert not [warning for warning in result.warnings if "obstacle" in warning]
    assert result.energy_residual < 1e-3
    # from half a thickness before the wall
    assert result["node.tip.displacement.x"].max() < 0.2e-3
    assert result["node.tip.velocity.x"][-1] == pytest.approx(-restitution * SPEED, abs=0.07 * SPEED)
