"""A mass on a guide strikes a sheet that is held, guided or free: it rebounds with e in each case.

Two bodies of masses m and M meet with v along the normal: the impulse is (1 + e) v / (1/m + 1/M).  For what a
support holds 1/M is 0: the mass m alone gives way and leaves with -e v, however light the sheet is.  An
impact takes about ten steps, and the first touch is seen up to one step late: e errs by up to 0.07
(docs/theory/contact.md).

Kind: independent calculation.  Source: derived here.
"""

import numpy as np
import pytest
from tests.support.shell.sheets import grid, model

from crumple._core.shell.simulation import RigidObstacle, RigidSet, Shape, ShellState
from crumple.errors import Status
from crumple.shell.model.obstacles import rebound_damping

T, SPEED, RAM = 2e-3, 6.0, 150.0
ALL = ("x", "y", "z", "rx", "ry", "rz")


def struck(held, restitution, *, lump=0.0, parts=1, lean=0.0, friction=0.0):
    """Plates 30 x 30 mm below a plane of 150 kg whose guide leans from the vertical."""
    x, quads = grid(3, 3, 0.03, 0.03)
    places = [x + np.array([0.1 * i, 0.0, 0.0]) for i in range(parts)]
    nodes = [np.arange(len(x)) + i * len(x) for i in range(parts)]
    all_nodes = np.vstack(places)
    more = {}
    if held == "nodes":
        more["fixed"] = np.ones((len(all_nodes), 6), dtype=bool)
    else:
        more["rigid_sets"] = [
            RigidSet(n, mass=lump, at=tuple(p.mean(axis=0)), fixed=held)
            for n, p in zip(nodes, places, strict=True)
        ]
    ram = RigidObstacle(
        Shape.PLANE,
        (0.03, 0.0, T / 2 + 1e-5),
        axis=(0.0, 0.0, -1.0),
        mass=RAM,
        guide=(np.sin(lean), 0.0, -np.cos(lean)),
        velocity=(SPEED * np.sin(lean), 0.0, -SPEED * np.cos(lean)),
        damping=rebound_damping(restitution),
        friction=friction,
    )
    elements = np.vstack([quads + i * len(x) for i in range(parts)])
    return ShellState(
        model(all_nodes, elements, T, obstacles=[ram], settings={"contact_damping": 0.1}, **more)
    )


def after(state):
    """Velocity of the ram, its impulse, and its depth over half a thickness."""
    first = state.energies["kinetic"]
    assert state.advance(1e-4) is Status.COMPLETE
    assert abs(state.energies["residual"]) < 1e-9 * first
    assert state.obstacles[0, 14] * T / 2 < 1.5 * SPEED * state.first_time_step / np.sqrt(0.1)
    return state.obstacles[0, 3:6], state.obstacles[0, 11:14]


@pytest.mark.parametrize("restitution", [0.0, 0.5])
@pytest.mark.parametrize("parts", [1, 2])
@pytest.mark.parametrize("held", ["nodes", ALL])
def test_what_is_held_stops_the_mass(held, parts, restitution):
    """Two feet at once share the ram: together they stop it as one does."""
    velocity, impulse = after(struck(held, restitution, parts=parts))
    assert velocity[2] == pytest.approx(restitution * SPEED, abs=0.07 * SPEED)
    assert impulse[2] == pytest.approx(RAM * (velocity[2] + SPEED), rel=1e-9)


@pytest.mark.parametrize("restitution", [0.0, 0.5])
@pytest.mark.parametrize("lump", [0.0, 20.0])
@pytest.mark.parametrize("held", [(), ("x", "y", "rx", "ry", "rz")])
def test_what_is_free_along_the_normal_shares_its_momentum(held, lump, restitution):
    state = struck(held, restitution, lump=lump)
    velocity, _ = after(state)
    mass = lump + state.mass
    sheet = state.rigid_sets[0, 5]
    assert sheet - velocity[2] == pytest.approx(-restitution * SPEED, abs=0.07 * SPEED)
    assert RAM * velocity[2] + mass * sheet == pytest.approx(-RAM * SPEED, rel=1e-9)


@pytest.mark.parametrize("held", ["nodes", ALL])
def test_a_guide_that_leans_brings_its_part_of_the_mass(held):
    """The ram stops, with and without friction: the guide holds it across."""
    for friction in (0.0, 0.3):
        velocity, _ = after(struck(held, 0.0, lean=0.6, friction=friction))
        assert np.linalg.norm(velocity) < 0.07 * SPEED
