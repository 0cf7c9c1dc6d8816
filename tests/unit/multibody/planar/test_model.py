"""From a mechanism to the kernel's arrays: inertia in the plane, laws by sense, loads, drives, start."""

import numpy as np
import pytest
from tests.support.multibody.frames import CLAMP, THROWN, member, structure

from crumple._core.planar.simulation import JointKind
from crumple.errors import InputError
from crumple.hinge import Envelope, Form, HingeRecord, SofteningVariable, Stop
from crumple.multibody import lower, planar_initial_motion, tree_hinge, tree_model


def modelled(whole, duration=0.1):
    return tree_model(whole, lower(whole), duration)


def test_arrays_of_one_bar():
    whole = structure(
        members={"bar": member("a", "b", ("h", 0.25))}, masses={"m": {"node": "b", "mass": 6.0}}
    )
    model = modelled(whole)
    (body,) = model.bodies
    assert (body.parent, body.joint) == (-1, JointKind.REVOLUTE)
    line = 7850.0 * (0.050 * 0.025 - 0.0447 * 0.0197)
    centre = (line * 0.75 * 0.375 + 6.0 * 0.75) / (line * 0.75 + 6.0)
    assert np.hypot(*body.centre) == pytest.approx(centre)
    section = 7850.0 * 0.75 * (0.050 * 0.025**3 - 0.0447 * 0.0197**3) / 12
    about_hinge = line * 0.75**3 / 3 + 6.0 * 0.75**2 + section
    assert body.inertia + body.mass * centre**2 == pytest.approx(about_hinge)
    assert model.dofs == 1
    assert model.length == 1.0


def record(**keys):
    one = Envelope(np.array([0.0, 1.0]), np.array([5.0, 4.0]))
    other = Envelope(np.array([0.0, 2.0]), np.array([3.0, 2.0]))
    return HingeRecord(
        Form.REGULARISED, SofteningVariable.ACCUMULATED, one, other, stop_positive=Stop(0.4, 1e5), **keys
    )


def test_joint_of_the_other_sense_swaps_the_senses():
    ahead, back = tree_hinge(record(), 0, 1.0), tree_hinge(record(), 3, -1.0)
    assert ahead.positive[1][0] == back.negative[1][0] == 5.0
    assert ahead.negative[0][1] == back.positive[0][1] == 2.0
    assert ahead.stop_positive[:2] == back.stop_negative[:2] == (0.4, 1e5)
    assert ahead.stop_negative == back.stop_positive == ()
    assert (back.dof, back.form, back.softening) == (3, 2, 2)


def test_critical_stop_is_asked_for_by_nan():
    assert np.isnan(tree_hinge(record(), 0).stop_positive[3])


def test_loads_on_the_ground_and_across_the_plane_are_left_out():
    loads = [
        {"node": "a", "force": {"z": 10.0}},
        {"node": "b", "force": {"y": 10.0, "z": 20.0}, "moment": {"y": 3.0, "x": 4.0}},
    ]
    model = modelled(structure(loads=loads))
    assert sorted(load.values[0] for load in model.loads) == [3.0, 20.0]
    turning = next(load for load in model.loads if load.values[0] == 3.0)
    assert turning.direction == pytest.approx((1.0, 0.0, 0.0))


def test_a_roller_is_held_and_a_motion_driven():
    supports = CLAMP | {"roller": {"node": "b", "fix": ["x"], "motion": {"z": {"constant": 0.0}}}}
    model = modelled(structure(supports=supports, members={"bar": member("a", "b", ("h", 0.1), ("k", 0.5))}))
    (drive,), (hold,) = model.drives, model.holds
    assert not drive.rates.any()
    np.testing.assert_allclose(np.abs(drive.direction), (0.0, 1.0, 0.0), atol=1e-12)
    np.testing.assert_allclose(np.abs(hold.direction), (0.0, 0.0, 1.0), atol=1e-12)


def test_driven_rates_add_up_to_the_motion():
    """Also if the motion has kinks: the rate changes there within a negligible time."""
    tables = [
        {"havsin": {"x0": 0.01, "h0": 0.0, "x1": 0.05, "h1": 0.2}},
        {"table": {"time": [0.0, 0.03, 0.031, 0.1], "value": [0.0, 0.05, 0.0, 0.1]}},
    ]
    for function in tables:
        whole = structure(supports=CLAMP | {"driver": {"node": "b", "motion": {"z": function}}})
        (drive,) = modelled(whole).drives
        travelled = np.concatenate(
            [[0.0], np.cumsum(np.diff(drive.times) * (drive.rates[1:] + drive.rates[:-1]) / 2)]
        )
        reported = whole.supports["driver"].driven["z"](drive.times)
        assert np.abs(drive.values[0] + travelled - reported).max() < 1e-6 * np.abs(reported).max()


def test_drive_across_the_plane_is_refused():
    supports = CLAMP | {"driver": {"node": "b", "motion": {"y": {"constant": 0.0}}}}
    members = {"bar": member("a", "b", ("h", "a", {"axis": "y"}))}
    with pytest.raises(InputError, match="across the plane"):
        modelled(structure(members=members, supports=supports))


def test_start_gathers_momentum():
    """A rigid rotation about the root fits a hinge there and gives m v and I w of the body."""
    whole = structure(
        members={"bar": member("a", "b", ("h", "a", {"offset": 0.0}))},
        initial_velocity=THROWN,
        masses={"m": {"node": "b", "mass": 6.0}},
    )
    mechanism = lower(whole)
    start = planar_initial_motion(whole, mechanism)
    body = mechanism.bodies[0]
    spin = mechanism.plane.normal[1] * 10.0
    np.testing.assert_allclose(start.velocity[0, 0], spin)
    np.testing.assert_allclose(np.hypot(*start.velocity[0, 1:]), 10.0 * body.centre[0])
    inertia = body.inertia[1, 1] + body.mass * body.centre[0] ** 2
    assert start.given_energy == pytest.approx(inertia * 10.0**2 / 2)


def test_velocity_of_some_nodes_moves_their_lumps_alone():
    whole = structure(
        initial_velocity=[{"translation": (0.0, 0.0, 2.0), "nodes": ("b",)}],
        masses={"m": {"node": "b", "mass": 6.0}},
    )
    assert planar_initial_motion(whole, lower(whole)).given_energy == pytest.approx(6.0 * 2.0**2 / 2)


def test_impulse_acts_at_its_node():
    whole = structure(impulses=[{"node": "b", "impulse": (0.0, 0.0, 3.0)}])
    mechanism = lower(whole)
    spin, *linear = planar_initial_motion(whole, mechanism).impulse[0]
    assert np.hypot(*linear) == pytest.approx(3.0)
    assert abs(spin) == pytest.approx(3.0 * (1.0 - mechanism.bodies[0].centre[0]))


def test_floating_part_may_not_leave_the_plane():
    velocity = [{"translation": (0.0, 5.0, 1.0)}]
    whole = structure(members={"bar": member("a", "b", ("h", 0.3))}, supports={}, initial_velocity=velocity)
    with pytest.raises(InputError, match="out of the plane"):
        planar_initial_motion(whole, lower(whole))
