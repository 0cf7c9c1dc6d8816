"""The view is square on to a planar motion, whatever its plane, and axonometric for one in space."""

from dataclasses import replace

import numpy as np
import pytest
from tests.support.result.synthetic_frame import CUBE, PORTAL, frame_states
from tests.support.result.synthetic_tube import tube_states

from crumple.report.drawing.view import choose_view


def turned(states, rotation):
    rotation = np.array(rotation, dtype=float)
    moved = {name: getattr(states, name) @ rotation.T for name in ("points", "displacement")}
    return replace(states, **moved)


def frame_of(view):
    return np.stack([view.right, view.up, view.towards])


X, Y, Z = np.eye(3)


@pytest.mark.parametrize(
    ("rotation", "right", "up"),
    [
        (np.eye(3), X, Z),  # in the x-z plane
        ([Y, -X, Z], -Y, Z),  # thrown along -y
        ([X, -Z, Y], X, Y),  # in the x-y plane, where z cannot be up
        ([[0.6, 0, 0.8], [0, 1, 0], [-0.8, 0, 0.6]], X, Z),  # leaning in its own plane
        ([[0.6, -0.8, 0], [0.8, 0.6, 0], [0, 0, 1]], [0.6, 0.8, 0.0], Z),  # in an upright plane at an angle
    ],
    ids=["xz", "yz", "xy", "leaning", "oblique"],
)
def test_planar_motion_is_seen_square_on(rotation, right, up):
    view = choose_view(turned(tube_states(np.linspace(0, 0.1, 6)), rotation))
    if np.allclose(right, -Y):
        right = Y  # whatever the motion, an axis points to the right of the picture
    np.testing.assert_allclose(view.right, right, atol=2e-2)
    np.testing.assert_allclose(view.up, up, atol=1e-12)


@pytest.mark.parametrize("members", [PORTAL, CUBE], ids=["portal", "cube"])
def test_a_view_is_a_right_handed_frame(members):
    frame = frame_of(choose_view(frame_states(members, [0.0, 0.05], 0.3)))
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(frame) == pytest.approx(1.0)


def test_a_structure_in_space_is_seen_from_above_a_corner():
    view = choose_view(frame_states(CUBE, [0.0, 0.05], 0.3))
    assert np.abs(view.towards).min() > 0.2
    assert view.towards[2] > 0
    assert [name for name, _ in view.axis_arrows()] == ["x", "y", "z"]


@pytest.mark.parametrize(("member", "right"), [(((0, 0, 0), (1, 0, 0)), X), (((0, 0, 0), (0, 1, 0)), Y)])
def test_a_bar_at_rest_is_seen_from_the_side(member, right):
    view = choose_view(frame_states([member], [0.0], 0.0))
    np.testing.assert_allclose(view.right, right, atol=1e-12)
    np.testing.assert_allclose(view.up, Z, atol=1e-12)


def test_flat_drops_depth():
    view = choose_view(tube_states([0.0, 0.05]))
    np.testing.assert_allclose(view.flat(np.array([[1.0, 2.0, 3.0]])), [[1.0, 3.0]])
    assert view.depth(np.array([1.0, 2.0, 3.0])) == pytest.approx(-2.0)
