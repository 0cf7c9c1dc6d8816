"""Functions of time in both kernels: loads act by their impulse, steps end at breaks."""

import numpy as np
import pytest

from crumple._core.planar.simulation import JointKind, Simulation, TreeBody, TreeHinge, TreeLoad, TreeModel
from crumple._core.spatial.model import (
    GROUND,
    SpatialBody,
    SpatialComponent,
    SpatialDrive,
    SpatialHinge,
    SpatialJoint,
    SpatialLoad,
    SpatialModel,
    revolute,
)
from crumple._core.spatial.simulation import SpatialSimulation

INERTIA, CAPACITY = 0.1, 1.0
ENVELOPE = (np.zeros(1), np.array([CAPACITY]))
KERNELS = ("planar", "spatial")


def wheel(kernel, times=(0.0,), moments=(0.0,), breaks=(), **settings):
    """A wheel on a rigid-plastic hinge about z under a moment."""
    times, moments, ends = np.array(times), np.array(moments), np.array(breaks)
    if kernel == "planar":
        body = TreeBody(-1, JointKind.REVOLUTE, (0.0, 0.0), (0.0, 0.0), 1.0, INERTIA)
        load = TreeLoad(0, (0.0, 0.0), (1.0, 0.0, 0.0), times, moments)
        hinge = TreeHinge(0, 0, 0, positive=ENVELOPE, negative=ENVELOPE)
        return Simulation(TreeModel((body,), (hinge,), (load,), breaks=ends), **settings)
    body = SpatialBody(1.0, INERTIA * np.eye(3), np.zeros(3))
    push = SpatialLoad(0, np.zeros(3), np.zeros(3), np.array([0.0, 0.0, 1.0]), times, moments)
    axle = revolute(GROUND, 0, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    hinge = SpatialHinge(0, (SpatialComponent(3, positive=ENVELOPE, negative=ENVELOPE),))
    return SpatialSimulation(SpatialModel((body,), (axle,), (hinge,), loads=(push,), breaks=ends), **settings)


def rate(record):
    """Rate of the wheel at the end [rad/s]."""
    return float(record.velocity[-1, 0, 0] if record.velocity.shape[2] == 3 else record.velocity[-1, 0, 2])


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("lasts", [1e-2, 1e-5, 1e-8])
def test_a_pulse_acts_by_its_impulse_without_any_break(kernel, lasts):
    begins, impulse = 0.437, 2.0
    peak = 2.0 * impulse / lasts
    times = (0.0, begins, begins + lasts / 3.0, begins + lasts, 1.0)
    simulation = wheel(kernel, times, (0.0, 0.0, peak, 0.0, 0.0))
    record = simulation.run(np.array([begins + 0.1]))
    # it slips from where the moment exceeds the capacity
    slips = lasts / 3.0 * CAPACITY / peak
    expected = (impulse - CAPACITY * slips / 2.0 - CAPACITY * (0.1 - slips)) / INERTIA
    # the step in which it begins to slip counts as a whole
    assert rate(record) == pytest.approx(expected, rel=1e-5)
    assert record.steps < 1000


@pytest.mark.parametrize("kernel", KERNELS)
def test_steps_end_at_breaks(kernel):
    """A wheel at rest takes few steps; with breaks one between any two, or as many as are asked for."""
    free = wheel(kernel).run(np.array([1.0])).steps
    breaks = np.linspace(0.0, 1.0, 502)[1:-1]
    once = wheel(kernel, breaks=breaks).run(np.array([1.0])).steps
    twice = wheel(kernel, breaks=breaks, parts=2).run(np.array([1.0])).steps
    assert free < 400
    assert 501 <= once <= 501 + free
    assert 1002 <= twice <= 1002 + free


@pytest.mark.parametrize("kernel", KERNELS)
def test_breaks_out_of_order_are_refused(kernel):
    with pytest.raises(ValueError, match="breaks are finite and increase"):
        wheel(kernel, breaks=(0.5, 0.2))


@pytest.mark.parametrize("back", [False, True])
def test_within_a_smallest_step_a_drive_may_change_its_rate_but_not_go_there_and_back(back):
    """A wheel on a hinge at rest, whose axle is turned about another axis in steps of 1e-6 s at least."""
    at, lasts, rate = 0.5, 3e-7, 0.1
    times = np.array([0.0, at, at + lasts / 2, at + lasts, 1.0])
    rates = np.array([0.0, 0.0, rate, 0.0, 0.0] if back else [0.0, 0.0, rate / 2, rate, rate])
    bodies = tuple(SpatialBody(1.0, INERTIA * np.eye(3), np.zeros(3)) for _ in range(2))
    held = SpatialJoint(GROUND, 0, np.zeros(3), np.eye(3), (True,) * 6)
    hinge = SpatialHinge(1, (SpatialComponent(3, positive=ENVELOPE, negative=ENVELOPE),))
    model = SpatialModel(
        bodies,
        (held, revolute(0, 1, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0))),
        (hinge,),
        drives=(SpatialDrive(0, 3, times, rates),),
    )
    record = SpatialSimulation(model, 1e-3, minimum_step=1e-6).run(np.array([0.4, 0.6]))
    assert (record.unseen > 0.1) is back
