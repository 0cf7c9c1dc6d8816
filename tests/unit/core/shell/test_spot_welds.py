"""Spot welds of the stepper: force, failure, balance of momentum, same bits, restart, refusals."""

import dataclasses

import numpy as np
import pytest
from tests.support.shell.sheets import bits, grid, model

from crumple._core.shell.simulation import (
    NodalLoad,
    PrescribedVelocity,
    RigidObstacle,
    RigidSet,
    Shape,
    ShellState,
    SpotWeld,
)
from crumple.errors import InputError, Status

THICKNESS = 2e-3
STRONG = {"normal_strength": 1e9, "shear_strength": 1e9}


def pair(speed=(0.0, 0.0, 0.0), number=8, settings=None, spots=None, **more):
    """Two square sheets of 80 mm that lie on each other and move apart, tied to both sides of the middle."""
    strength = {name: more.pop(name) for name in STRONG}
    x, quads = grid(number, number, 0.08, 0.08)
    n, above = len(x), x + np.array([0.0, 0.0, THICKNESS])
    velocity = np.zeros((2 * n, 3))
    velocity[n:] = speed
    return model(
        np.vstack([x, above]),
        np.vstack([quads, quads + n]),
        THICKNESS,
        velocity=velocity,
        spot_welds=[tie(x, n, at, **strength) for at in spots or ((0.04, 0.03), (0.04, 0.05))],
        settings={"self_contact": True, **(settings or {})},
        **more,
    )


def tie(x, n, at, **strength):
    """Weld at a place of both sheets, by the four nodes around on the first and nine on the second."""
    sides = []
    for number, shift in ((4, 0), (9, n)):
        nodes = np.argsort(np.linalg.norm(x[:, :2] - at - 1e-4, axis=1), kind="stable")[:number]
        rows = np.vstack([np.ones(number), (x[nodes, :2] - at).T])
        sides.append((nodes + shift, np.linalg.pinv(rows)[:, 0]))
    (first, one), (second, two) = sides
    return SpotWeld(first, second, one / one.sum(), two / two.sum(), **strength)


def momenta(state):
    """Momentum and angular momentum of the nodes half a step ago, by the lumped masses of equal squares.

    Central differences keep both there: positions move along the velocities.
    """
    x = state.position
    v, _, w = np.split(state.checkpoint()["nodes"][4 * len(x) :].reshape(-1, 8), [3, 4], axis=1)
    w = w[:, :3]
    area = 0.01**2
    mass = np.zeros(len(x))
    np.add.at(mass, state.model.elements, 7850.0 * THICKNESS * area / 4)
    kg = 5 / 6 / 2.6
    spin = mass * (THICKNESS**2 + 3 * kg / (1 / 0.91 - kg) * area) / 12
    return mass @ v, np.cross(x, mass[:, None] * v).sum(axis=0) + spin @ w


@pytest.mark.parametrize("speed", [(0.0, 0.0, 8.0), (4.0, 1.0, 0.0), (3.0, -2.0, 5.0)])
def test_failing_welds_keep_momentum_and_energy(speed):
    strength = {"normal_strength": 1000.0, "shear_strength": 1500.0}
    state = ShellState(pair(speed, **strength))
    first, start = momenta(state), state.energies["kinetic"]
    failed = 0
    for _ in range(40):
        state.advance(1.0, steps=10)
        linear, angular = momenta(state)
        assert linear == pytest.approx(first[0], abs=1e-12)
        assert angular == pytest.approx(first[1], abs=1e-11)
        assert abs(state.energies["residual"]) < 2e-3 * start
        failed = max(failed, int(state.spot_welds[:, 0].sum()))
    assert failed == 2
    normal, shear, use = state.spot_welds[:, 2], state.spot_welds[:, 3], state.spot_welds[:, 4]
    assert (use >= 1.0).all()
    # the reported forces are those that met the criterion
    assert use == pytest.approx((np.maximum(normal, 0.0) / 1000.0) ** 2 + (shear / 1500.0) ** 2, rel=1e-12)


def test_strong_welds_hold_and_carry_half_of_what_pulls_one_sheet():
    """A sheet is pulled along itself: the force in the welds accelerates the other one, of the same mass."""
    force, rise = 2000.0, 2e-4
    loads = [NodalLoad(n, "x", [0.0, rise], [0.0, force / 9]) for n in range(72, 81)]
    state = ShellState(pair(loads=loads, settings={"damping": 3e4}, **STRONG))
    state.advance(1.5e-3)
    welds = state.spot_welds
    assert not welds[:, 0].any()
    assert welds[:, 3].sum() == pytest.approx(force / 2, rel=0.01)
    assert np.abs(welds[:, 2]).max() < 0.05 * force


def test_a_compressed_weld_holds():
    """Thrown together as fast as apart the welds carry the opposite force, which does not count."""
    weak = {"normal_strength": 100.0, "shear_strength": 1e9}
    one, other = (
        ShellState(pair((0.0, 0.0, v), settings={"self_contact": False}, **weak)) for v in (-2.0, 2.0)
    )
    for state in (one, other):
        state.advance(1.0, steps=3)
    assert (one.spot_welds[:, 2] < -100.0).all()
    assert not one.spot_welds[:, 0].any()
    assert other.spot_welds[:, 0].all()
    one, other = (
        ShellState(pair((0.0, 0.0, v), settings={"self_contact": False}, **STRONG)) for v in (-2.0, 2.0)
    )
    for state in (one, other):
        state.advance(1.0, steps=3)
    assert one.spot_welds[:, 2] == pytest.approx(-other.spot_welds[:, 2], rel=1e-4)


def test_threads_and_restart_give_the_same_bits_before_and_after_failure():
    given = pair((3.0, -2.0, 5.0), number=32, normal_strength=1500.0, shear_strength=2000.0)
    one, two = ShellState(given), ShellState(given)
    one.advance(1.0, steps=300, threads=1)
    two.advance(1.0, steps=300, threads=2)
    assert one.spot_welds[:, 0].all()
    assert bits(one) == bits(two)
    for begun in (2, 299):
        stopped, resumed = ShellState(given), ShellState(given)
        stopped.advance(1.0, steps=begun)
        resumed.restore(stopped.checkpoint())
        assert np.array_equal(resumed.spot_welds, stopped.spot_welds)
        resumed.advance(1.0, steps=300 - begun)
        assert bits(resumed) == bits(one)
    # the next stage knows which have failed
    later = ShellState(given)
    later.restore(one.checkpoint(), of_stage_before=True)
    for state in (later, one):
        state.advance(1.0, steps=100)
    assert np.array_equal(later.position, one.position)


def test_freed_nodes_touch_obstacles_by_themselves():
    plane = RigidObstacle(Shape.PLANE, (0.0, 0.0, -1.5e-3))
    weak = {"normal_strength": 50.0, "shear_strength": 50.0}
    state = ShellState(pair((2.0, 0.0, 6.0), obstacles=[plane], settings={"gravity": (0, 0, -4e4)}, **weak))
    start = state.energies["kinetic"]
    assert state.advance(1.2e-3) is Status.COMPLETE
    assert state.spot_welds[:, 0].all()
    assert state.obstacles[0, 13] < 0.0  # impulse on the plane
    assert state.obstacles[0, 14] < 0.5
    assert abs(state.energies["residual"]) < 1e-2 * (start + abs(state.energies["external_work"]))


ONES = (np.ones(1), np.ones(1))


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"rigid_sets": [RigidSet([20, 21])]}, "belongs to a rigid set"),
        ({"fixed": np.arange(162)[:, None] == np.full((1, 6), 30)}, "node 30 is held"),
        ({"loads": [NodalLoad(30, "x", [0.0], [1.0])]}, "node 30 carries a load"),
        ({"motions": [PrescribedVelocity(30, "x", [0.0], [1.0])]}, "node 30 is driven"),
        ({"spot_welds": [SpotWeld([30], [999], *ONES)]}, "node 999 does not exist"),
        ({"spot_welds": [SpotWeld([30], [30], *ONES)]}, "node 30 appears twice"),
        ({"spot_welds": [SpotWeld([30], [], *ONES)]}, "both sheets need nodes"),
        ({"spot_welds": [SpotWeld([30], [111], np.ones(1), np.full(1, 0.9))]}, "do not add up to 1"),
        ({"spot_welds": [SpotWeld([30], [111], *ONES, 0.0)]}, "strength is not positive"),
    ],
)
def test_welds_that_cannot_be_are_refused(change, why):
    whole = pair(**STRONG)
    welds = [SpotWeld([20, 30], [101, 111], np.full(2, 0.5), np.full(2, 0.5))]
    with pytest.raises(InputError, match=why):
        ShellState(dataclasses.replace(whole, **{"spot_welds": welds, **change}))


def test_sheets_that_lie_within_each_other_cannot_be_tied():
    given = pair(**STRONG)
    flat = dataclasses.replace(given, position=given.position * [1.0, 1.0, 0.0])
    with pytest.raises(InputError, match="two sheets coincide"):
        ShellState(flat)
