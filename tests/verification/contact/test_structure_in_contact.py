"""A chain of bars with plastic hinges runs into a wall: momentum, energy and convergence.

There is no closed form.  What must hold: the impulse of the wall is the change of momentum, the energy is
balanced, the wall is not penetrated, and the result converges with the accuracy.  The members of the chain
touch each other.

Kind: invariant.  Source: derived here.
"""

import itertools

import numpy as np
import pytest
from tests.support.multibody.contact_models import all_pairs, plane, rod, rod_shape
from tests.support.multibody.space_models import component, with_mass

from crumple._core.outcome import Outcome
from crumple._core.spatial.model import SpatialContact, SpatialHinge, SpatialModel, revolute
from crumple._core.spatial.simulation import SpatialSimulation

BARS, RADIUS, SPEED = 8, 0.02, 10.0


def crash(accuracy, friction=0.3):
    """Zigzag of eight bars of 1 kg, 50 kg at its end, at 10 m/s; record of 0.1 s."""
    points = [np.array([0.15 * k, 0.03 * (-1) ** k, 0.0]) for k in range(BARS + 1)]
    ends = list(itertools.pairwise(points))
    bodies = [rod(*pair, RADIUS, 1.0) for pair in ends]
    bodies[-1] = with_mass(bodies[-1], points[-1], 50.0)
    joints = tuple(revolute(k - 1, k, points[k], (0, 0, 1)) for k in range(1, BARS))
    neighbours = [pair for pair in all_pairs(BARS).pairs if abs(pair[0] - pair[1]) > 1]
    model = SpatialModel(
        tuple(bodies),
        joints,
        tuple(SpatialHinge(k, (component(3, 800.0),)) for k in range(BARS - 1)),
        obstacles=(plane((-2 * RADIUS, 0, 0), (1, 0, 0), friction=friction),),
        capsules=tuple(rod_shape(k, *pair, RADIUS) for k, pair in enumerate(ends)),
        contact=SpatialContact(tuple(neighbours), friction),
    )
    run = SpatialSimulation(model, accuracy)
    run.set_motion(np.array([[0, 0, 0, -SPEED, 0, 0]] * BARS), np.zeros((BARS, 6)))
    record = run.run(np.linspace(0, 0.1, 51))
    assert record.outcome is Outcome.COMPLETE
    return model, record


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_impulse_and_energy(friction, record_figure):
    model, record = crash(1e-3, friction)
    mass = np.array([body.mass for body in model.bodies])
    momentum = np.einsum("b,tbi->ti", mass, record.velocity[:, :, 3:])
    impulse = -np.sum(record.obstacle_force[1:, 0] * np.diff(record.time)[:, None], axis=0)
    gained = momentum[-1] - momentum[0]
    name = f"friction {friction}"
    record_figure(f"impulse of the wall, {name}", impulse[0], gained[0], 1e-6, "N s", relative=True)
    record_figure(f"friction's impulse, {name}", impulse[1], gained[1], 1e-6 * gained[0], "N s")
    record_figure(f"residual, {name}", record.residual, 0.0, 1e-4, "")
    ends = [record.centre[:, 0, 0].min(), record.centre[:, -1, 0].min()]
    assert min(ends) > -2 * RADIUS
    assert record.energy.dissipated[-1] > 1000


def test_settles_with_the_accuracy(record_figure):
    """Plastic work and the mass's place at 1e-3 against 1e-4, without friction; the mass goes 0.35 m."""
    (_, coarse), (_, fine) = crash(1e-3, 0.0), crash(1e-4, 0.0)
    record_figure(
        "plastic work", coarse.energy.dissipated[-1], fine.energy.dissipated[-1], 1e-3, "J", relative=True
    )
    place = np.linalg.norm(coarse.centre[-1, -1] - fine.centre[-1, -1])
    record_figure("difference of the mass's place", float(place), 0.0, 2e-3, "m")
