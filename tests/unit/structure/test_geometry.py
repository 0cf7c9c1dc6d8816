"""Local axes of members follow the stated conventions."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from crumple.structure import frame_of

coordinate = st.floats(-10.0, 10.0)
point = st.tuples(coordinate, coordinate, coordinate)


def test_member_along_x_has_global_axes():
    frame = frame_of((1, 2, 3), (3, 2, 3))
    assert frame.length == 2.0
    np.testing.assert_allclose(frame.axes, np.eye(3), atol=1e-15)
    np.testing.assert_allclose(frame.position(0.5), [1.5, 2, 3])


def test_vertical_member_takes_global_x_as_up():
    frame = frame_of((0, 0, 0), (0, 0, 2))
    np.testing.assert_allclose(frame.z, [1, 0, 0], atol=1e-15)
    np.testing.assert_allclose(frame.y, [0, -1, 0], atol=1e-15)


@pytest.mark.parametrize("aside", [(1e-5, 0.0), (0.0, -1e-5), (7e-6, 7e-6)])
def test_rounded_coordinates_do_not_turn_the_section_of_an_upright_member(aside):
    frame = frame_of((0, 0, 0), (*aside, 0.5))
    np.testing.assert_allclose(frame.z, [1, 0, 0], atol=1e-4)


def test_roll_turns_right_handed_about_x():
    frame = frame_of((0, 0, 0), (1, 0, 0), roll=np.pi / 2)
    np.testing.assert_allclose(frame.y, [0, 0, 1], atol=1e-15)
    np.testing.assert_allclose(frame.z, [0, -1, 0], atol=1e-15)


def test_up_sets_local_z():
    frame = frame_of((0, 0, 0), (1, 0, 0), up=(5, 0, -2))
    np.testing.assert_allclose(frame.z, [0, 0, -1], atol=1e-15)
    np.testing.assert_allclose(frame.axis("y"), [0, -1, 0], atol=1e-15)


@pytest.mark.parametrize(("second", "up"), [((0, 0, 0), None), ((1, 0, 0), (2, 0, 0))])
def test_undefined_axes_are_refused(second, up):
    with pytest.raises(ValueError, match=r"coincide|along"):
        frame_of((0, 0, 0), second, up=up)


@given(point, point, st.floats(-7, 7))
def test_axes_are_a_right_handed_orthonormal_triple(first, second, roll):
    assume(np.linalg.norm(np.subtract(second, first)) >= 1e-3)
    frame = frame_of(first, second, roll=roll)
    np.testing.assert_allclose(frame.axes @ frame.axes.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(frame.axes) == pytest.approx(1.0)
    np.testing.assert_allclose(frame.position(frame.length), second, atol=1e-9)
