"""Rotation vectors over time go on across half a turn; what is not a number stays, and stops nothing."""

import numpy as np

from crumple.numeric.rotation import (
    continuous,
    quaternion_vector,
    relative_rotation,
    relative_vector,
    turned,
    vector_quaternion,
)


def test_turns_of_more_than_half_are_counted():
    angles = np.linspace(0.0, 9.0, 40)[:, None] * np.array([0.0, 0.6, 0.8])
    np.testing.assert_allclose(continuous(quaternion_vector(vector_quaternion(angles))), angles, atol=1e-12)


def test_what_is_not_a_number_stays():
    vectors = np.array([[3.0, 0.0, 0.0], [np.nan] * 3, [-3.0, 0.0, 0.0], [3.1, 0.0, 0.0]])
    found = continuous(vectors)
    np.testing.assert_array_equal(found[:3], vectors[:3])
    assert np.isfinite(found[3]).all()


def matrix(vectors):
    """Matrices of rotation vectors, (n, 3) to (n, 3, 3)."""
    columns = [turned(vector_quaternion(vectors), np.broadcast_to(one, vectors.shape)) for one in np.eye(3)]
    return np.stack(columns, axis=-1)


def test_relative_rotation_is_seen_from_the_first_side_and_counts_on():
    first = matrix(np.linspace(0.0, 2.0, 30)[:, None] * np.array([0.3, -1.0, 0.4]))
    vectors = np.linspace(0.0, 4.5, 30)[:, None] * np.array([0.6, 0.0, -0.8])
    last = first @ matrix(vectors)
    np.testing.assert_allclose(relative_vector(first, last), vectors, atol=1e-12)
    np.testing.assert_allclose(relative_rotation(first, last, np.eye(3)[2]), vectors[:, 2], atol=1e-12)
