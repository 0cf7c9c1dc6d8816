"""Sections divided into element sides: closed forms, corners kept, bends simplified."""

import numpy as np
import pytest

from crumple.section import CircularTube, RectangularTube, Wall, WallSection, Weld, outline_section
from crumple.shell.mesh.contour import contour_of


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


def test_open_channel_is_divided_wall_by_wall():
    channel = outline_section([(0.03, -0.02), (0.0, -0.02), (0.0, 0.02), (0.03, 0.02)], 2e-3, closed=False)
    contour = contour_of(channel, 5e-3)
    assert len(contour.sides) == 6 + 8 + 6
    assert len(contour.points) == 21
    assert contour.area == pytest.approx(200e-3 * 1e-3, rel=1e-9)
    # points are taken from the centroid, which counts the corners of the metal too
    ends = contour.points[contour.sides]
    weight = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert weight @ ends.mean(axis=1) == pytest.approx([0.0, 0.0], abs=2e-6)


def test_two_cells_share_their_middle_wall():
    outer = Wall(((-0.03, -0.02), (0.03, -0.02), (0.03, 0.02), (-0.03, 0.02)), 2e-3, closed=True)
    middle = Wall(((0.0, -0.02), (0.0, 0.02)), 3e-3)
    contour = contour_of(WallSection((outer, middle)), 10e-3)
    meeting = np.bincount(contour.sides.reshape(-1))
    assert (meeting == 3).sum() == 2
    assert set(contour.thickness) == {2e-3, 3e-3}
    assert contour.area == pytest.approx(200e-3 * 2e-3 + 40e-3 * 3e-3, rel=1e-9)


@pytest.mark.parametrize(("radius", "sides"), [(1e-3, 20), (2e-3, 22), (9e-3, 3 * 4 + 2 * 3)])
def test_bends_of_a_channel(radius, sides):
    points = [(0.03, -0.02), (0.0, -0.02), (0.0, 0.02), (0.03, 0.02)]
    channel = outline_section(points, 1e-3, corner_radius=radius, closed=False)
    contour = contour_of(channel, 5e-3)
    assert len(contour.sides) == sides
    assert contour.area == pytest.approx(channel.area, rel=0.02)


def test_lines_of_spot_welds_tie_points_of_both_sheets():
    flat = Wall(((-0.03, 0.0), (0.03, 0.0)), 2e-3)
    other = Wall(((-0.03, 2e-3), (0.03, 2e-3)), 2e-3)
    welded = WallSection((flat, other), (Weld((-0.02, 0.0), (-0.02, 2e-3)), Weld((0.02, 0.0), (0.02, 2e-3))))
    contour = contour_of(welded, 5e-3)
    assert contour.points[contour.welds][..., 0] == pytest.approx(np.array([[-0.02, -0.02], [0.02, 0.02]]))
    assert np.ptp(contour.points[contour.welds][..., 1], axis=1) == pytest.approx(2e-3)
    assert contour.area == pytest.approx(2 * 60e-3 * 2e-3, rel=1e-9)
    # a weld is no wall
    assert len(contour.sides) == 2 * (2 + 8 + 2)
