"""Distance between a space that must stay free and bars: closed forms in any plane and under motion."""

import numpy as np
import pytest

from crumple.result.clearance import clearance, signed_distance

SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]])
NOTCHED = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 1.0], [0.0, 2.0]])


@pytest.mark.parametrize(
    ("corners", "point", "distance"),
    [
        (SQUARE, (3.0, 0.5), 1.0),
        (SQUARE, (1.0, -0.25), 0.25),
        (SQUARE, (5.0, 5.0), 5.0),
        (SQUARE, (0.1, 0.5), -0.1),
        (SQUARE, (1.0, 0.7), -0.3),
        (NOTCHED, (1.0, 1.5), 0.5 / np.sqrt(2.0)),
        (NOTCHED, (1.0, 0.5), -0.5),
    ],
)
@pytest.mark.parametrize("reverse", [False, True])
def test_signed_distance_of_a_point(corners, point, distance, reverse):
    corners = corners[::-1] if reverse else corners
    found = signed_distance(np.array([[point]]), corners[None])
    assert found[0, 0] == pytest.approx(distance, abs=1e-12)


def rotation(seed):
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return q * np.sign(np.linalg.det(q))


@pytest.mark.parametrize("seed", range(4))
def test_clearance_is_the_same_in_any_frame_and_follows_the_motion(seed):
    turn, place = rotation(seed), np.array([3.0, -2.0, 0.5])
    space = np.array([[[*corner, 0.0] for corner in SQUARE]] * 3)
    bars = np.array([[[[3.0, 0.0, 5.0], [3.0, 1.0, -5.0]], [[-1.0, 0.5, 0.0], [-0.5, 0.5, 0.0]]]] * 3)
    # the first bar comes nearer, ends inside by 0.1
    bars[1, 0, :, 0] = 2.2
    bars[2, 0, :, 0] = 1.95
    expected = [0.5 - 0.05, 0.2 - 0.05, -0.05 - 0.05]
    found = clearance(space @ turn.T + place, bars @ turn.T + place, np.array([0.05, 0.05]))
    assert found == pytest.approx(expected, abs=1e-12)


def test_a_bar_through_the_space_is_seen_although_its_ends_are_outside():
    space = np.array([[[*corner, 0.0] for corner in SQUARE]])
    bar = np.array([[[[-3.0, 0.5, 0.0], [5.0, 0.5, 0.0]]]])
    assert clearance(space, bar, np.zeros(1))[0] == pytest.approx(-0.5, abs=1e-12)
