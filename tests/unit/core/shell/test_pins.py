"""Rigid bodies held at a place beside their centre of mass."""

import numpy as np
import pytest
from tests.support.shell.sheets import grid, model

from crumple._core.shell.simulation import PrescribedVelocity, RigidSet, ShellState


def test_body_pinned_beside_its_centre_swings_as_a_compound_pendulum():
    """Small swings: period 2 pi sqrt(J_p / (m g l)); the pin stays, energy is kept."""
    x, quads = grid(8, 2, 0.08, 0.02)
    x = x[:, [2, 1, 0]] * [1, 1, -1]  # hangs from z = 0
    g = 5000.0
    body = RigidSet(np.arange(len(x)), pin=(0, 0.01, 0), fixed=("x", "y", "z"))
    omega = np.array([0.0, 3.0, 0.0])
    velocity = np.cross(omega, x - [0, 0.01, 0])
    m = model(
        x,
        quads,
        2e-3,
        velocity=velocity,
        spin=np.broadcast_to(omega, x.shape),
        rigid_sets=[body],
        settings={"gravity": (0, 0, -g)},
    )
    state = ShellState(m)
    first = state.energies["kinetic"]
    inertia, arm = 2 * first / 9.0 / state.mass, 0.04
    period = 2 * np.pi * np.sqrt(inertia / (g * arm))
    swing = []
    times = np.linspace(0, 1.1 * period, 160)[1:]
    for time in times:
        state.advance(time)
        swing.append(state.velocity[0][:, 0].mean())
        assert abs(state.energies["residual"]) < 1e-4 * first
    sign = np.flatnonzero(np.diff(np.sign(swing)))
    crossings = times[sign]
    # the bob's velocity is zero a quarter and three quarters of a period after the start
    assert crossings[1] - crossings[0] == pytest.approx(period / 2, rel=0.02)
    assert np.abs(state.rigid_sets[0, :3] - [0, 0.01, 0]).max() < 1e-15


def test_pin_takes_a_blow_on_its_axis_and_turns_by_one_beside_it():
    """A pinned bar given a translation keeps its angular momentum about the pin: omega = m l v / J_p."""
    x, quads = grid(8, 2, 0.08, 0.02)
    velocity = np.tile([0.0, 0.0, 2.0], (len(x), 1))
    body = RigidSet(np.arange(len(x)), pin=(0, 0.01, 0), fixed=("x", "y", "z"))
    state = ShellState(model(x, quads, 2e-3, velocity=velocity, rigid_sets=[body]))
    omega = state.rigid_sets[0, 6:9]
    kinetic = state.energies["kinetic"]
    inertia = 2 * kinetic / (omega @ omega)
    assert omega[1] == pytest.approx(-state.mass * 0.04 * 2.0 / inertia, rel=1e-9)
    assert inertia == pytest.approx(state.mass * 0.08**2 / 3, rel=0.05)


def test_a_driven_rigid_set_is_not_damped():
    """Its reaction gives it its velocity: damping takes nothing from it, or the ledger would not close."""
    x, quads = grid(10, 2, 0.1, 0.02)
    ends = [
        RigidSet(np.flatnonzero(x[:, 0] < 1e-9), mass=0.3),
        RigidSet(np.flatnonzero(x[:, 0] > 0.1 - 1e-9)),
    ]
    motions = [
        PrescribedVelocity(0, dof, [0.0, 1e-3], [0.0, value], rigid_set=True)
        for dof, value in (("z", 2.0), ("ry", -20.0))
    ]
    state = ShellState(model(x, quads, 2e-3, rigid_sets=ends, motions=motions, settings={"damping": 500.0}))
    state.advance(2e-3)
    e = state.energies
    assert e["damping"] > 0.01 * e["external_work"]
    assert abs(e["residual"]) < 1e-3 * e["external_work"]
