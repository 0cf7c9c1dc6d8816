"""Rotation vectors over time go on across half a turn; what is not a number stays, and stops nothing."""

import numpy as np

from crumple.numeric.rotation import continuous, quaternion_vector, vector_quaternion


def test_turns_of_more_than_half_are_counted():
    angles = np.linspace(0.0, 9.0, 40)[:, None] * np.array([0.0, 0.6, 0.8])
    np.testing.assert_allclose(continuous(quaternion_vector(vector_quaternion(angles))), angles, atol=1e-12)


def test_what_is_not_a_number_stays():
    vectors = np.array([[3.0, 0.0, 0.0], [np.nan] * 3, [-3.0, 0.0, 0.0], [3.1, 0.0, 0.0]])
    found = continuous(vectors)
    np.testing.assert_array_equal(found[:3], vectors[:3])
    assert np.isfinite(found[3]).all()
