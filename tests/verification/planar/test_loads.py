"""Loads, gravity and impulses: pendulum from the horizontal, forces, impulse as velocity.

Simple pendulum from the horizontal: period 4 sqrt(L/g) K(1/2) = 2.3678419475762373 s for L = 1 m, g = 9.81
m/s^2.  A constant moment C on a wheel against a hinge M gives the rate (C - M) t/I.  The work of a force
F(t) on the tip of a bar that is free to rotate is its kinetic energy.  An impulse is the velocity that it
gives.

Kind: closed form.  Source: derived here.
"""

import math

import numpy as np
import pytest
from tests.support.multibody.chains import hinge, started, wheel
from tests.support.structures import cantilever, constant_law

from crumple._core.planar.simulation import JointKind, TreeBody, TreeLoad, TreeModel
from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, Outputs

PERIOD = 2.3678419475762373
TIGHT = MultibodySettings(accuracy=1e-6)


def test_pendulum(record_figure):
    """Passes its lowest point after a quarter and comes back after a whole period."""
    point = TreeBody(-1, JointKind.REVOLUTE, (0.0, 0.0), (1.0, 0.0), 1.0, 1e-12)
    model = TreeModel((point,), (hinge(0, 1e-12),), gravity=(0.0, -9.81))
    times = np.linspace(0.0, 1.02 * PERIOD, 2001)
    record = started(model, [0.0], 1e-6).run(times)
    angle, rate = record.q[:, 0], record.w[:, 0]
    quarter = np.interp(math.pi / 2, -angle[:800], times[:800])
    record_figure("quarter of the period", quarter, PERIOD / 4, 1e-6, "s", relative=True)
    # back at rest: the rate passes zero once more (upwards at half, downwards at the whole)
    late = times > 0.9 * PERIOD
    whole = np.interp(0.0, -rate[late], times[late])
    record_figure("period", whole, PERIOD, 1e-6, "s", relative=True)
    assert record.residual < 1e-6
    np.testing.assert_allclose(rate**2 / 2, -9.81 * np.sin(angle), atol=2e-5)


@pytest.mark.parametrize("moment", [500.0, 50.0])
def test_moment_against_a_hinge(moment, record_figure):
    """Below the capacity of 100 N m it stays at rest and shows the moment that it carries."""
    load = TreeLoad(0, (0.0, 0.0), (1.0, 0.0, 0.0), np.zeros(1), np.array([moment]))
    record = started(TreeModel((wheel(2.0),), (hinge(0, 100.0),), (load,)), [0.0]).run(
        np.linspace(0, 0.1, 11)
    )
    turned = max(0.0, moment - 100.0) / 2.0 * 0.1**2 / 2
    record_figure(f"rotation under {moment:g} N m", record.q[-1, 0], turned, 1e-9, "rad")
    # the hinge resists: it carries what the load asks for, up to its capacity
    record_figure(f"moment under {moment:g} N m", record.hinge.moment[-1, 0], min(moment, 100.0), 1e-6, "N*m")
    assert record.energy.external_work[-1] == pytest.approx(moment * turned, rel=1e-6, abs=1e-7)


def test_force_as_a_function_of_time(record_figure):
    """A force across a nearly free bar: angular momentum and work of the bar."""
    force = {"havsin": {"x0": 0.01, "h0": 0.0, "x1": 0.05, "h1": 40.0}}
    structure = cantilever(
        constant_law(1e-6), hinge_place=0.0, loads=[{"node": "tip", "force": {"z": force}}]
    )
    outputs = Outputs(nodes=("tip",))
    result = solve_multibody(structure, Run(0.08, 0.001, TIGHT, outputs))
    kinetic, work = result["energy.kinetic"][-1], result["energy.external_work"][-1]
    record_figure("work as kinetic energy", kinetic, work, 1e-6, "J", relative=True)
    # independent: force times the tip's vertical velocity, by Simpson's rule over the outputs
    t = result.time
    values = 40.0 * np.clip(0.5 - 0.5 * np.cos(np.pi * (t - 0.01) / 0.04), 0.0, 1.0)
    values[t < 0.01], values[t > 0.05] = 0.0, 40.0
    power = values * result["node.tip.velocity.z"]
    simpson = (t[1] - t[0]) / 3 * (power[0] + power[-1] + 4 * power[1:-1:2].sum() + 2 * power[2:-1:2].sum())
    record_figure("work of the force", work, float(simpson), 1e-5, "J", relative=True)
    assert kinetic > 0.1


def test_impulse_is_the_velocity_that_it_gives(record_figure):
    """An impulse at the tip against a rotation with the same angular momentum about the hinge."""
    law = constant_law(400.0)
    thrown = cantilever(law, hinge_place=0.0, initial_velocity=[{"rotation": 5.0, "axis": (0.0, -1.0, 0.0)}])
    energy = solve_multibody(thrown, Run(0.1, 0.01, TIGHT))["energy.kinetic"][0]
    impulse = 2 * energy / 5.0 / 1.0
    struck = cantilever(law, hinge_place=0.0, impulses=[{"node": "tip", "impulse": (0.0, 0.0, impulse)}])
    spun = cantilever(
        law, hinge_place=0.0, impulses=[{"node": "tip", "angular_impulse": (0.0, -impulse, 0.0)}]
    )
    expected = solve_multibody(thrown, Run(0.1, 0.01, TIGHT)).hinges["root"].rotation_final
    for name, structure in (("impulse", struck), ("angular impulse", spun)):
        result = solve_multibody(structure, Run(0.1, 0.01, TIGHT))
        found = result.hinges["root"].rotation_final
        record_figure(f"rotation after an {name}", found, expected, 1e-9, "rad", relative=True)
        assert result["energy.kinetic"][0] == pytest.approx(energy, rel=1e-12)
    assert expected < -0.1
