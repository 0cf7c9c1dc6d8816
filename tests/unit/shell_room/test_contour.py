"""Sections divided into element sides: closed forms, corners kept, bends simplified."""

import numpy as np
import pytest

from crumple.section import CircularTube, RectangularTube
from crumple.shell.contour import contour_of


def lengths(contour):
    ends = contour.points[contour.sides]
    return np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)


def test_sharp_tube_has_even_numbers_of_sides_on_every_wall():
    tube = RectangularTube(0.05, 0.025, 2.65e-3)
    contour = contour_of(tube, 5e-3)
    assert len(contour.sides) == 2 * (10 + 4)
    assert sorted(np.round(lengths(contour) * 1e3, 4)) == [4.735] * 20 + [5.5875] * 8
    # a row of nodes runs along the middle of every wall
    assert np.isclose(contour.points[:, 0], 0).sum() == 2
    assert np.isclose(contour.points[:, 1], 0).sum() == 2


def test_area_of_sharp_tube_is_exact():
    tube = RectangularTube(0.05, 0.025, 2.65e-3)
    assert contour_of(tube, 7e-3).area == pytest.approx(tube.area, rel=1e-12)


def test_contour_runs_counter_clockwise():
    points = contour_of(RectangularTube(0.05, 0.025, 2e-3), 5e-3).points
    after = np.roll(points, -1, axis=0)
    assert (points[:, 0] * after[:, 1] - points[:, 1] * after[:, 0]).sum() / 2 == pytest.approx(48e-3 * 23e-3)


def test_circle_is_divided_evenly():
    tube = CircularTube(0.06, 2e-3)
    contour = contour_of(tube, 6e-3)
    assert len(contour.sides) % 4 == 0
    assert np.ptp(lengths(contour)) < 1e-3 * lengths(contour).mean()
    assert contour.area == pytest.approx(tube.area, rel=0.01)


def test_large_bend_gets_sides_of_its_own():
    contour = contour_of(RectangularTube(0.08, 0.06, 2e-3, corner_radius=0.012), 5e-3)
    # the arc of a mid-line radius 11 mm is 17.3 mm: three sides, of which none lies on a sharp corner
    assert len(contour.sides) == 4 * 3 + 2 * (12 + 8)
    assert np.abs(contour.points).max(axis=0) == pytest.approx([0.039, 0.029])


def test_small_bend_becomes_a_corner():
    sharp = contour_of(RectangularTube(0.05, 0.05, 2e-3), 6e-3)
    round_ = contour_of(RectangularTube(0.05, 0.05, 2e-3, corner_radius=2e-3), 6e-3)
    assert len(round_.sides) == len(sharp.sides)
    assert lengths(round_).min() > 4e-3
