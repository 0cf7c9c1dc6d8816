"""Joints between members and nodes: what they free, and what is refused."""

import numpy as np
import pytest
from tests.support.multibody.frames import CLAMP, member, structure

from crumple.errors import InputError
from crumple.multibody.bodies.linkage import joint_axes
from crumple.structure import Joint

NODES = {"a": (0.0, 0.0, 0.0), "b": (1.0, 0.0, 0.0), "c": (2.0, 0.0, 0.0)}
MEMBERS = {"ab": member("a", "b"), "bc": member("b", "c")}


def jointed(**joints):
    return structure(nodes=NODES, members=MEMBERS, supports=CLAMP, joints=joints)


def refusal(**joints):
    with pytest.raises(InputError) as caught:
        jointed(**joints)
    return str(caught.value)


@pytest.mark.parametrize(
    ("joint", "free"),
    [
        ({"type": "revolute", "axis": (0, 2, 0)}, 1),
        ({"type": "universal", "axis": (0, 1, 0), "second": (0, 0, 1)}, 2),
        ({"type": "spherical"}, 3),
        ({"type": "prismatic", "axis": (1, 0, 0)}, 1),
        ({"type": "cylindrical", "axis": (1, 0, 0)}, 2),
        ({"type": "planar", "axis": (0, 0, 1)}, 3),
    ],
)
def test_every_joint_type_has_its_free_motions(joint, free):
    whole = jointed(j={"node": "b", "member": "bc", **joint})
    assert len(whole.joints["j"].free) == free
    axes = joint_axes(whole.joints["j"])
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(axes) == pytest.approx(1.0)


def test_axes_of_a_universal_joint_are_its_y_and_z():
    axes = joint_axes(Joint(node="b", member="bc", type="universal", axis=(0, 0, 3), second=(0, 2, 0)))
    np.testing.assert_allclose(axes[1:], [[0, 0, 1], [0, 1, 0]], atol=1e-15)


@pytest.mark.parametrize(
    ("joint", "words"),
    [
        ({"type": "revolute"}, "needs 'axis'"),
        ({"type": "revolute", "axis": (0, 0, 0)}, "the axis is zero"),
        ({"type": "spherical", "axis": (0, 1, 0)}, "has no 'axis'"),
        ({"type": "universal", "axis": (0, 1, 0)}, "needs 'second'"),
        ({"type": "universal", "axis": (0, 1, 0), "second": (0, 1, 1)}, "not perpendicular"),
        ({"type": "revolute", "axis": (0, 1, 0), "second": (0, 0, 1)}, "has no 'second'"),
        ({"type": "weld"}, "not one of the permitted values"),
    ],
)
def test_axes_that_do_not_fit_the_type_are_refused(joint, words):
    assert words in refusal(j={"node": "b", "member": "bc", **joint})


def test_names_that_do_not_meet_are_refused():
    ball = {"type": "spherical"}
    assert "there is no member 'cd'" in refusal(j={"node": "b", "member": "cd", **ball})
    assert "does not end at node 'a'" in refusal(j={"node": "a", "member": "bc", **ball})


def test_two_joints_at_one_end_are_refused():
    end = {"node": "b", "member": "bc", "type": "spherical"}
    assert "'j' and 'k' join the same end" in refusal(j=end, k=end)


def test_a_node_that_hangs_on_joints_alone_needs_an_inertia():
    joints = {name: {"node": "b", "member": name, "type": "spherical"} for name in MEMBERS}
    assert "so the node itself has no inertia" in refusal(**joints)
    heavy = {"m": {"node": "b", "mass": 1.0, "rotary_inertia": (0.1, 0.1, 0.1)}}
    structure(nodes=NODES, members=MEMBERS, supports=CLAMP, joints=joints, masses=heavy)
