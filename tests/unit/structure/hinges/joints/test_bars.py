"""What bends as one: neither nodes inside a tube nor the order of its input change how it bends."""

import numpy as np
import pytest
from tests.support.multibody.frames import CLAMP, member, structure

from crumple.errors import Status
from crumple.multibody import Run, solve_multibody
from crumple.structure import placed_hinges
from crumple.structure.hinges.runs.bars import bar_of
from crumple.structure.hinges.shares import moment_free_ends

NODES = {"a": (0.0, 0.0, 0.0), "b": (0.4, 0.0, 0.0), "c": (1.0, 0.0, 0.0)}
HELD = CLAMP | {"far": {"node": "c", "fix": "all"}}
ORDERS = ("ab bc", "ba bc", "ab cb", "ba cb", "bc ab", "cb ba")


def line(order, **parts):
    """A clamped tube along x: members by their nodes."""
    members = {ends: member(*ends) | {"hinges": (), "elastic": 6} for ends in order.split()}
    nodes = {name: NODES[name] for name in sorted({*order} - {" "})}
    return structure(nodes, members, **{"supports": HELD, "hinges": "auto"} | parts)


def joints(whole):
    """Place and elastic stiffness of every hinge and joint along x, (n, 2)."""
    found = [(hinge.position[0], hinge.record.elastic_stiffness) for hinge in placed_hinges(whole)]
    return np.array(sorted(found))


@pytest.mark.parametrize("order", ORDERS[1:])
def test_a_tube_bends_alike_whichever_way_its_members_lead(order):
    # the hinge at b is 14 micrometres before it, seen from the end at which the first member begins
    np.testing.assert_allclose(joints(line(order)), joints(line(ORDERS[0])), rtol=3e-4)


def test_a_node_adds_nothing():
    np.testing.assert_allclose(joints(line("ab bc")), joints(line("ac")), rtol=1e-12)


@pytest.mark.parametrize("order", ["ac", *ORDERS])
def test_joints_of_a_bar_share_its_flexibility(order):
    whole = line(order)
    places, stiffness = joints(whole).T
    lengths = whole.flexural_rigidity(order.split()[0], "y") / stiffness
    for power in range(3):
        assert np.sum(lengths * places**power) == pytest.approx(1.0 / (power + 1), rel=1e-9)


def test_a_joint_belongs_to_the_member_in_which_it_lies():
    for hinge in placed_hinges(line("ba bc")):
        assert (hinge.member == "ba") == (hinge.position[0] <= 0.4)
        assert hinge.station == pytest.approx(abs(hinge.position[0] - 0.4))


def test_members_with_other_axes_bend_alone():
    round_tube = {"tube": {"type": "circular_tube", "diameter": 0.05, "thickness": 0.002}}
    turned = {"ab": {"up": [0, 0, 1]}, "bc": {"up": [0, 1, 0]}}
    members = {ends: member(*ends) | {"hinges": (), "elastic": 6} | up for ends, up in turned.items()}
    whole = structure(NODES, members, supports=HELD, hinges="auto", sections=round_tube)
    assert list(bar_of(whole, "ab").stretches) == ["ab"]
    assert list(bar_of(line("ab bc"), "bc").stretches) == ["ab", "bc"]
    rigid = {ends: member(*ends) | {"hinges": ()} for ends in ("ab", "bc")}
    whole = structure(NODES, rigid, supports=HELD, hinges="auto")
    assert list(bar_of(whole, "bc").stretches) == ["bc"]


def test_an_end_is_free_about_the_axes_about_which_nothing_holds_it():
    pinned = {"l": {"node": "a", "fix": ("x", "y", "z", "rx", "rz")}, "r": {"node": "c", "fix": ("y", "z")}}
    free = moment_free_ends(line("ab bc", supports=pinned))
    assert {axis: free("ab", axis) for axis in ("y", "z")} == {"y": (True, False), "z": (False, False)}
    assert {axis: free("bc", axis) for axis in ("y", "z")} == {"y": (False, True), "z": (False, True)}


def test_a_joint_may_lie_at_a_node_within_a_bar():
    """A pole strikes within one fold of the node, which then has no candidate, and not beside the joint."""
    pole = {"type": "cylinder", "point": (0.27, 0.0, 0.0635), "axis": (0.0, 1.0, 0.0), "radius": 0.05}
    moves = {"mass": 5.0, "velocity": (0.0, 0.0, -1.0), "guide": (0.0, 0.0, -1.0)}
    nodes = {"a": (0.0, 0.0, 0.0), "b": (0.25, 0.0, 0.0), "c": (0.5, 0.0, 0.0)}
    members = {ends: member(*ends) | {"hinges": (), "elastic": 12} for ends in ("ab", "bc")}
    whole = structure(nodes, members, supports=HELD, hinges="auto", obstacles={"pole": pole | moves})
    hinges = [one for one in placed_hinges(whole) if one.plastic]
    assert [round(float(one.position[0]), 2) for one in hinges][1:-1] == [0.27]
    (at_node,) = [one for one in placed_hinges(whole) if abs(one.position[0] - 0.25) < 1e-9]
    assert not at_node.plastic
    assert solve_multibody(whole, Run(0.002, 0.0005)).status is Status.COMPLETE


def test_a_hinge_beside_a_rough_pole_lies_towards_the_nearer_end_however_the_tube_leads():
    pole = {"type": "cylinder", "point": (0.3, 0.0, 0.0635), "axis": (0.0, 1.0, 0.0), "radius": 0.05}
    moves = {"mass": 5.0, "velocity": (0.0, 0.0, -1.0), "guide": (0.0, 0.0, -1.0), "friction": 0.2}
    (forth, back) = (
        [one.position[0] for one in placed_hinges(line(order, obstacles={"pole": pole | moves}))]
        for order in ("ac", "ca")
    )
    np.testing.assert_allclose(sorted(forth), sorted(back), atol=1e-9)
