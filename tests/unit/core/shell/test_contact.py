"""Contact of walls: plate on plate, small elements in thick walls, folding, momentum, energy, edges."""

import time
from dataclasses import replace

import numpy as np
import pytest
from tests.support.shell.sheets import ELASTIC, STEEL, bits, grid, model

from crumple._core.shell.simulation import (
    PrescribedVelocity,
    RigidObstacle,
    RigidSet,
    Shape,
    Sheet,
    ShellState,
    SpotWeld,
)
from crumple.errors import Status

T = 2e-3


def two_plates(gap, speed, n=6, offset=0.37, slide=0.0, **settings):
    """A small plate above a larger one, their nodes not facing each other."""
    below, quads_below = grid(n, n, 0.06, 0.06)
    above, quads_above = grid(n - 2, n - 2, 0.04, 0.04)
    step = 0.06 / n
    above += np.array([offset * step + 0.01, 0.6 * offset * step + 0.01, gap])
    x = np.concatenate([below, above])
    quads = np.concatenate([quads_below, quads_above + len(below)])
    velocity = np.zeros_like(x)
    velocity[len(below) :, 2], velocity[len(below) :, 0] = -speed, slide
    return model(x, quads, T, ELASTIC, velocity=velocity, settings={"self_contact": True, **settings}), len(
        below
    )


def momentum(m, state):
    """Momentum of the translations; masses from the model by lumping a quarter of each element."""
    mass = np.zeros(len(m.position))
    d = m.position[m.elements]
    area = 0.5 * np.linalg.norm(np.cross(d[:, 2] - d[:, 0], d[:, 3] - d[:, 1]), axis=1)
    np.add.at(mass, m.elements, (7850 * T * area / 4)[:, None])
    return mass @ state.velocity[0]


def test_plate_hits_plate_oblique():
    """Momentum kept to round-off, energy within the ledger's bound, no penetration to the mid-surface."""
    m, below = two_plates(0.004, 20.0, slide=8.0, contact_friction=0.3)
    state = ShellState(m)
    first, energy = momentum(m, state), state.energies["kinetic"]
    for _ in range(10):
        state.advance(state.time + 5e-5)
        e = state.energies
        assert abs(e["residual"]) < 2e-3 * energy
    assert momentum(m, state) == pytest.approx(first, abs=1e-9 * np.linalg.norm(first))
    v = state.velocity[0]
    assert v[below:, 2].mean() > v[:below, 2].mean()
    assert v[below:, 0].mean() < 7.9
    assert e["contact"] > 0
    assert 0 < state.deepest_penetration < 0.9


def test_plate_comes_to_rest_on_plate():
    """With gravity and damping the upper plate lies on the lower, a thickness away."""
    m, below = two_plates(0.0021, 0.0, damping=4000.0, gravity=(0.0, 0.0, -300.0))
    fixed = np.zeros((len(m.position), 6), dtype=bool)
    fixed[:below] = True
    state = ShellState(replace(m, fixed=fixed))
    state.advance(8e-3)
    lying = state.position[below:, 2]
    assert lying == pytest.approx(T, rel=0.02)
    assert abs(state.velocity[0][below:, 2]).max() < 1e-2
    assert state.touching_nodes > 0


def test_elements_smaller_than_the_wall_do_not_repel_each_other():
    """1 mm elements in a 2 mm wall, bent and compressed: no contact force."""
    x, quads = grid(20, 20, 0.02, 0.02)
    velocity = np.zeros_like(x)
    velocity[:, 0] = -2.0 * (x[:, 0] - 0.01) / 0.01
    velocity[:, 2] = 4.0 * np.sin(np.pi * x[:, 0] / 0.02)
    state = ShellState(model(x, quads, T, STEEL, velocity=velocity, settings={"self_contact": True}))
    for _ in range(20):
        state.advance(1.0, steps=50)
        assert state.touching_nodes == 0


def test_fold_stops_at_the_wall_thickness():
    """A strip folded by a throw of both halves towards each other: they do not pass through each other."""
    x, quads = grid(60, 4, 0.12, 0.01)
    velocity = np.zeros_like(x)
    velocity[:, 2] = 2500 * np.abs(x[:, 0] - 0.06)
    velocity[:, 0] = -900 * (x[:, 0] - 0.06)
    depth = {}
    for on in (True, False):
        state = ShellState(model(x, quads, T, STEEL, velocity=velocity, settings={"self_contact": on}))
        status = state.advance(1.6e-3)
        assert status.ok, state.reason
        p = state.position
        left, right = p[x[:, 0] < 0.03], p[x[:, 0] > 0.09]
        depth[on] = right[:, 0].min() - left[:, 0].max()
        if on:
            e = state.energies
            assert abs(e["residual"]) < 0.01 * (e["kinetic"] + e["plastic"])
    assert depth[False] < 0 < depth[True]


def test_node_on_the_border_of_an_element_is_held():
    """A node that comes down beside the rim of a plate is pushed away from the rim, not through it."""
    plate, quads = grid(4, 4, 0.04, 0.04)
    other, more = grid(1, 1, 0.01, 0.01)
    other = other[:, [0, 2, 1]] + [0.0405, 0.0137, 0.0012]  # stands upright just outside the rim x = 0.04
    x = np.concatenate([plate, other])
    velocity = np.zeros_like(x)
    velocity[25:, 0] = -5.0
    m = model(
        x - [0, 0, 0],
        np.concatenate([quads, more + 25]),
        T,
        ELASTIC,
        velocity=velocity,
        settings={"self_contact": True},
    )
    far = x.copy()
    far[25:, 0] += 0.005
    state = ShellState(replace(m, position=far))
    state.advance(3e-3)
    # its lower corner stands 1.2 mm above the plate's mid-surface: 1.6 mm from the rim is one thickness
    assert state.position[25, 0] > 0.04 + 0.95 * np.sqrt(2.0**2 - 1.2**2) * 1e-3
    assert state.deepest_penetration > 0
    assert abs(state.energies["residual"]) < 1e-3 * state.energies["kinetic"]


def test_any_number_of_threads_gives_the_same_bits():
    """Touches, sliding friction and new searches, shared among as many members as there are threads."""
    m, _ = two_plates(0.003, 30.0, n=40, slide=30.0, contact_friction=0.2)
    plane = RigidObstacle(Shape.PLANE, (0.0, 0.0, -0.0012), (0.0, 0.0, 1.0), friction=0.1)
    m = replace(m, obstacles=[plane])
    states = [ShellState(m) for _ in range(3)]
    for state, threads in zip(states, (1, 2, 5), strict=True):
        state.advance(1.0, steps=400, threads=threads)
    first = states[0]
    assert first.deepest_penetration > 0
    assert first.contact_searches > 2
    for state in states[1:]:
        assert bits(state) == bits(first)
        assert state.energies == first.energies
        assert state.deepest_penetration == first.deepest_penetration


def test_team_may_change_and_rest_between_calls():
    m, _ = two_plates(0.003, 30.0, n=40, slide=30.0)
    state, alone = ShellState(m), ShellState(m)
    for threads in (2, 5, 1, 5, 2, 2):
        state.advance(1.0, steps=30, threads=threads)
        time.sleep(0.005)
    alone.advance(1.0, steps=180)
    assert bits(state) == bits(alone)


def test_a_checkpoint_restores_what_has_failed_since():
    """Plates in contact and, far away, an element that a drive turns over: no later touch is known."""
    m, _ = two_plates(0.0021, 30.0)
    far, quad = grid(1, 1, 0.01, 0.01)
    far[:, 0] += 1.0
    corner = len(m.position)
    fixed = np.zeros((corner + 4, 6), dtype=bool)
    fixed[corner + 1 :] = True
    m = replace(
        m,
        position=np.concatenate([m.position, far]),
        elements=np.concatenate([m.elements, quad + corner]),
        velocity=np.concatenate([m.velocity, np.zeros((4, 3))]),
        fixed=fixed,
        motions=[PrescribedVelocity(corner, dof, [0.0], [150.0]) for dof in ("x", "y")],
    )
    failed, other = ShellState(m), ShellState(m)
    failed.advance(1.0, steps=10)
    assert failed.touching_nodes > 0
    saved = failed.checkpoint()
    assert failed.advance(1.0) is Status.INVERTED
    for state in (failed, other):
        state.restore(saved)
        assert state.advance(1.0, steps=10) is Status.COMPLETE
    assert bits(failed) == bits(other)


@pytest.mark.parametrize("speed", [np.nan, np.inf])
def test_a_rigid_set_that_is_nowhere_leaves_the_search_to_the_others(speed):
    """A rigid sheet far away is driven out of all numbers; the plates meet as without it."""
    m, _ = two_plates(0.0021, 30.0)
    far, quads = grid(2, 2, 0.02, 0.02)
    far[:, 0] += 0.3
    nodes = np.arange(len(far)) + len(m.position)
    with_set = replace(
        m,
        position=np.concatenate([m.position, far]),
        elements=np.concatenate([m.elements, quads + nodes[0]]),
        velocity=np.concatenate([m.velocity, np.zeros((9, 3))]),
        materials=[ELASTIC, replace(STEEL, rigid=True)],
        sheets=[m.sheets[0], Sheet(1)],
        sheet=np.repeat([0, 1], [len(m.elements), 4]),
        rigid_sets=[RigidSet(nodes)],
        motions=[PrescribedVelocity(0, "x", [0.0], [speed], rigid_set=True)],
    )
    state, alone = ShellState(with_set), ShellState(m)
    for each in (state, alone):
        each.advance(1.0, steps=40)
    assert not np.isfinite(state.position[nodes]).all()
    assert state.contact_searches > alone.contact_searches
    np.testing.assert_allclose(state.position[: nodes[0]], alone.position, rtol=0, atol=1e-15)


def crossing_strips(height, **settings):
    """Two upright strips, one across the other: their rims cross in the middle of elements."""
    strip, quads = grid(6, 2, 0.06, 0.02)
    below = strip[:, [0, 2, 1]] + [-0.035, 0.0, -0.02]  # rim at z = 0 along x
    above = strip[:, [2, 0, 1]] + [0.0, -0.025, height]  # rim at z = height along y
    x = np.concatenate([below, above])
    velocity = np.zeros_like(x)
    velocity[len(below) :, 2] = -10.0
    m = model(
        x, np.concatenate([quads, quads + len(below)]), T, ELASTIC, velocity=velocity,
        settings={"self_contact": True, **settings},
    )  # fmt: skip
    return m, len(below)


def welded_plates():
    """Two elements, every node of them tied, thrown at a plate that is held."""
    m, below = two_plates(0.003, 30.0, n=3)
    upper = m.position[below:] + np.array([0.0, 0.0, 0.0022])
    fixed = np.zeros((below + 8, 6), dtype=bool)
    fixed[:below] = True
    even = np.full(4, 0.25)
    return replace(
        m,
        position=np.concatenate([m.position, upper]),
        elements=np.concatenate([m.elements, m.elements[-1:] + 4]),
        velocity=np.concatenate([m.velocity, m.velocity[below:]]),
        fixed=fixed,
        spot_welds=[SpotWeld(below + np.arange(4), below + 4 + np.arange(4), even, even)],
    )


@pytest.mark.parametrize("what", ["plates", "rims", "tied"])
def test_looking_at_close_pairs_alone_misses_nothing(what):
    """A restored state looks at everything listed: one restored before every step makes the same bits."""
    if what == "tied":
        m = welded_plates()
    elif what == "rims":
        m, _ = crossing_strips(0.0025, contact_friction=0.2)
    else:
        m, _ = two_plates(0.003, 30.0, n=12, slide=30.0, contact_friction=0.2)
    state, looks = ShellState(m), ShellState(m)
    state.advance(1.0, steps=500)
    for _ in range(500):
        looks.restore(looks.checkpoint())
        looks.advance(1.0, steps=1)
    assert state.deepest_penetration > 0
    assert bits(state) == bits(looks)


def test_rims_that_cross_between_their_nodes_hold_each_other():
    m, below = crossing_strips(0.0025)
    state = ShellState(m)
    first, start = state.energies["kinetic"], momentum(m, state)
    for _ in range(8):
        state.advance(state.time + 5e-5)
        # closest point of the two rims
        lower, upper = state.position[:below][::3][2:5], state.position[below:][::3][2:5]
        assert upper[:, 2].min() > lower[:, 2].max() + 0.5 * T
    e = state.energies
    assert abs(e["residual"]) < 1e-3 * first
    assert momentum(m, state) == pytest.approx(start, abs=1e-9 * np.linalg.norm(start))
    assert 0 < state.deepest_penetration < 0.5


def test_crease_holds_a_crossing_crease():
    """Two gutters, ridge against ridge at right angles: creases of walls that fold, not rims."""
    x, quads = grid(6, 6, 0.06, 0.06)
    x -= [0.035, 0.03, 0.0]
    below = x.copy()
    below[:, 2] = -np.abs(below[:, 1])  # ridge along x
    above = x[:, [1, 0, 2]] * [1, 1, 1]
    above[:, 2] = 0.0025 + np.abs(above[:, 0])  # ridge along y
    m = model(
        np.concatenate([below, above]), np.concatenate([quads, quads + len(below)]), T, ELASTIC,
        velocity=np.concatenate([0 * below, np.tile([0.0, 0.0, -10.0], (len(above), 1))]),
        settings={"self_contact": True},
    )  # fmt: skip
    state = ShellState(m)
    first = state.energies["kinetic"]
    for _ in range(10):
        state.advance(state.time + 5e-5)
        ridge = [abs(m.position[: len(below), 1]) < 1e-9, abs(m.position[len(below) :, 0]) < 1e-9]
        p = [state.position[: len(below)][ridge[0]], state.position[len(below) :][ridge[1]]]
        near = [q[np.abs(q[:, i]) < 0.015, 2] for i, q in enumerate(p)]
        assert near[1].min() > near[0].max() + 0.5 * T
    assert abs(state.energies["residual"]) < 1e-3 * first
    assert 0 < state.deepest_penetration < 0.5


def test_wall_between_two_walls_is_held_by_both():
    """Three plates pressed together: the middle one keeps a thickness from each."""
    x, quads = grid(5, 5, 0.05, 0.05)
    shifts = np.array([[0, 0, 0], [0.0031, 0.0017, 1.05 * T], [0.0012, 0.0043, 2.1 * T]])
    stack = np.concatenate([x + shift for shift in shifts])
    velocity = np.zeros_like(stack)
    velocity[: len(x), 2], velocity[2 * len(x) :, 2] = 4.0, -4.0
    m = model(
        stack, np.concatenate([quads + i * len(x) for i in range(3)]), T, ELASTIC, velocity=velocity,
        settings={"self_contact": True, "contact_damping": 0.1},
    )  # fmt: skip
    state = ShellState(m)
    first = state.energies["kinetic"]
    for _ in range(6):
        state.advance(state.time + 2e-5)
        z = [state.position[i * len(x) : (i + 1) * len(x), 2] for i in range(3)]
        assert z[1].min() - z[0].max() > 0.8 * T
        assert z[2].min() - z[1].max() > 0.8 * T
    assert abs(state.energies["residual"]) < 1e-3 * first


def test_node_that_swings_around_a_rim_is_not_taken_for_one_pressed_through():
    """A plate passes beside another's rim from below and comes over it from above."""
    plate, quads = grid(4, 4, 0.04, 0.04)
    other = plate + np.array([0.043, 0.001, -0.0025])
    x = np.concatenate([plate, other])
    velocity = np.zeros_like(x)
    velocity[len(plate) :, 2] = 60.0
    m = model(
        x, np.concatenate([quads, quads + len(plate)]), T, ELASTIC, velocity=velocity,
        settings={"self_contact": True},
    )  # fmt: skip
    state = ShellState(m)
    state.advance(8e-5)
    turn = np.zeros_like(x)
    turn[len(plate) :] = [-60.0, 0.0, -70.0]
    state.add_motion(turn, np.zeros_like(x))
    first = state.energies["kinetic"]
    for _ in range(25):
        state.advance(state.time + 1e-5)
        e = state.energies
        assert abs(e["residual"]) < 1e-3 * first
        assert e["kinetic"] + e["elastic"] < 1.005 * first
    assert 0 < state.deepest_penetration < 0.9
