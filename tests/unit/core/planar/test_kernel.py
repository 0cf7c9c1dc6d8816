"""Typed face of the kernel: what it refuses, and that a run can be taken step by step."""

import numpy as np
import pytest
from tests.support.multibody.records import same

from crumple._core.planar.simulation import (
    JointKind,
    Outcome,
    Simulation,
    TreeBody,
    TreeHinge,
    TreeLoad,
    TreeModel,
)

CURVE = (np.array([0.0, 1.0]), np.array([100.0, 50.0]))

STRAY_LOAD = TreeLoad(3, (0.0, 0.0), (1.0, 0.0, 0.0), np.zeros(1), np.ones(1))


def body(parent=-1, joint=JointKind.REVOLUTE, mass=1.0, inertia=0.1):
    anchor = (0.0, 0.0) if parent < 0 else (1.0, 0.0)
    return TreeBody(parent, joint, anchor, (0.5, 0.0), mass, inertia)


def hinge(dof=0, curve=CURVE):
    return TreeHinge(dof, 0, 0, positive=curve, negative=curve)


@pytest.mark.parametrize(
    ("model", "message"),
    [
        (TreeModel((body(parent=1), body()), ()), "parent must come before"),
        (TreeModel((body(), body(parent=0, joint=JointKind.FREE)), ()), "free joint must hang on the ground"),
        (TreeModel((body(mass=0.0),), ()), "mass and inertia must be positive"),
        (TreeModel((body(inertia=float("nan")),), ()), "must be finite"),
        (TreeModel((body(),), (hinge(dof=1),)), "unknown coordinate"),
        (TreeModel((body(),), (hinge(curve=(np.array([0.0, 0.0]), np.ones(2))),)), "must increase"),
        (TreeModel((body(),), (hinge(curve=(np.zeros(0), np.zeros(0))),)), "at least one"),
        (TreeModel((body(),), (hinge(),), (STRAY_LOAD,)), "unknown body"),
    ],
)
def test_arrays_that_make_no_sense_are_refused(model, message):
    with pytest.raises(ValueError, match=message):
        Simulation(model)


def test_times_are_needed():
    with pytest.raises(ValueError, match="output time"):
        Simulation(TreeModel((body(),), (hinge(),))).run(np.zeros(0))


def test_steps_by_hand_agree_with_a_run():
    model = TreeModel((body(), body(parent=0)), (hinge(0), hinge(1)))
    stepped, run = Simulation(model), Simulation(model, 1e-6)
    for simulation in (stepped, run):
        simulation.set_rates(np.array([3.0, -2.0]))
    for _ in range(400):
        assert stepped.step(1e-4)
    record = run.run(np.array([0.04]))
    assert stepped.time == pytest.approx(run.time)
    np.testing.assert_allclose(stepped.q, record.q[-1], atol=1e-6)
    assert record.outcome is Outcome.COMPLETE


def test_same_run_same_bits():
    def once():
        simulation = Simulation(TreeModel((body(), body(parent=0)), (hinge(0), hinge(1))))
        simulation.set_rates(np.array([3.0, -2.0]))
        return simulation.run(np.linspace(0.0, 0.1, 11))

    first, second = once(), once()
    np.testing.assert_array_equal(first.q, second.q)
    assert same(first, second)


def test_effective_inertia_leaves_the_other_hinges_free():
    """A bar with a heavy one hinged to its end feels more than itself, less than the two locked together."""
    model = TreeModel((body(), body(parent=0, mass=10.0)), (hinge(0), hinge(1)))
    free = Simulation(model).effective_inertia(0)
    locked = 0.1 + 0.25 + 0.1 + 10.0 * 1.5**2
    assert 0.35 < free < locked


def test_poll_cancels():
    simulation = Simulation(TreeModel((body(),), (hinge(),)))
    simulation.set_rates(np.array([3.0]))
    record = simulation.run(np.linspace(0.0, 0.1, 100001), lambda reached: reached < 1e-3)
    assert record.outcome is Outcome.CANCELLED
    assert 1000 < record.time.size < 100001


def test_numbers_that_overflow_end_the_run():
    simulation = Simulation(TreeModel((body(), body(parent=0)), (hinge(0), hinge(1))))
    simulation.set_rates(np.array([1e200, -1e200]))
    record = simulation.run(np.linspace(0.0, 0.1, 11))
    assert record.outcome in {Outcome.NOT_FINITE, Outcome.STEP_COLLAPSED}
    assert record.reason
    assert record.time.size >= 1
