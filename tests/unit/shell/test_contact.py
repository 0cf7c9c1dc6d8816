"""Contact of walls: plate on plate, small elements in thick walls, folding, momentum, energy, edges."""

import numpy as np
import pytest
from sheets import ELASTIC, STEEL, grid, model

from crumple._core.shell import ShellState

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
    from dataclasses import replace

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
    from dataclasses import replace

    state = ShellState(replace(m, position=far))
    state.advance(3e-3)
    # its lower corner stands 1.2 mm above the plate's mid-surface: 1.6 mm from the rim is one thickness
    assert state.position[25, 0] > 0.04 + 0.95 * np.sqrt(2.0**2 - 1.2**2) * 1e-3
    assert state.deepest_penetration > 0
    assert abs(state.energies["residual"]) < 1e-3 * state.energies["kinetic"]


def test_only_one_answer_with_threads():
    m, _ = two_plates(0.003, 30.0, n=40)
    states = [ShellState(m) for _ in range(2)]
    for state, threads in zip(states, (1, 2), strict=True):
        state.advance(1.0, steps=300, threads=threads)
    assert states[0].deepest_penetration > 0
    assert np.array_equal(states[0].position, states[1].position)
