"""Best-fit planes: rotations that are known come back, whatever the section has been pressed into."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.numeric.rotation import continuous, relative_rotation, rotation_vector
from crumple.shell.answer.sections import mean_spin, section_rotation

RING = np.array(
    [[0.0, y, z] for y, z in ((2, -1), (2, 0), (2, 1), (0, 1), (-2, 1), (-2, 0), (-2, -1), (0, -1))]
)


def turn(vector):
    """Rotation matrix of a rotation vector (Rodrigues)."""
    angle = np.linalg.norm(vector)
    if angle == 0.0:
        return np.eye(3)
    x, y, z = np.asarray(vector) / angle
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew


@given(st.tuples(*[st.floats(-1.7, 1.7)] * 3))
def test_rigid_rotation_comes_back(vector):
    rotation = section_rotation(RING, RING @ turn(vector).T + [1.0, 2.0, 3.0])
    assert rotation == pytest.approx(turn(vector), abs=1e-9)
    assert rotation_vector(rotation) == pytest.approx(np.array(vector), abs=1e-7)


def test_section_pressed_flat_keeps_its_plane():
    pressed = RING * [1.0, 1.1, 0.3]
    rotation = section_rotation(RING, pressed @ turn((0.0, -0.6, 0.0)).T)
    assert rotation_vector(rotation) == pytest.approx([0.0, -0.6, 0.0], abs=1e-9)


def test_warping_that_adds_no_tilt_is_no_rotation():
    bulged = RING + np.column_stack(
        [0.2 * (RING[:, 1] ** 2 - 2.0 * RING[:, 2] ** 2), *np.zeros((2, len(RING)))]
    )
    assert rotation_vector(section_rotation(RING, bulged)) == pytest.approx(np.zeros(3), abs=1e-9)


def test_relative_rotation_is_seen_from_the_first_section():
    first = np.array([turn((0.0, 0.0, 1.0))] * 3)
    second = np.array([turn((0.0, 0.0, 1.0)) @ turn((0.0, angle, 0.0)) for angle in (0.0, 0.4, 0.8)])
    assert relative_rotation(first, second, np.array([0.0, 1.0, 0.0])) == pytest.approx([0.0, 0.4, 0.8])


def test_rotation_passes_half_a_turn_without_a_jump():
    angles = np.linspace(0.0, 9.0, 40)
    vectors = continuous(rotation_vector(np.array([turn((0.0, 0.0, angle)) for angle in angles])))
    assert vectors[:, 2] == pytest.approx(angles, abs=1e-6)


def test_mean_spin_of_rigid_motion():
    spin = np.array([1.0, -2.0, 3.0])
    assert mean_spin(RING, np.cross(spin, RING) + np.array([5.0, 0.0, 0.0])) == pytest.approx(spin)
