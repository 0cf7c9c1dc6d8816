"""Walls that are narrower than an image shows are joined: only of round tubes, only while they are narrow."""

import numpy as np
import pytest

from crumple.report.drawing.narrow_walls import without_narrow_walls
from crumple.report.figures.shape import surface_of
from crumple.result import States

SIDES, RINGS, RADIUS = 64, 4, 0.02


def tube(around, rings=RINGS):
    """Points, (rings around, 3), and walls of a tube with an outline, (around, 2), along x."""
    count = len(around)
    points = np.concatenate([np.column_stack([np.full(count, 0.1 * x), around]) for x in range(rings)])
    i, j = np.divmod(np.arange((rings - 1) * count), count)
    k = (j + 1) % count
    return points, np.stack([i * count + j, (i + 1) * count + j, (i + 1) * count + k, i * count + k], axis=1)


def states(*outlines, **data):
    points, quads, member = [], [], []
    for number, around in enumerate(outlines):
        own, walls = tube(np.asarray(around, float))
        quads.append(walls + sum(map(len, points)))
        points.append(own + np.array([0.0, number, 0.0]))
        member.append(np.full(len(own), number))
    points = np.concatenate(points)
    return States(
        points=points,
        quads=np.concatenate(quads),
        member=np.concatenate(member),
        station=points[:, 0],
        contour=np.zeros(len(points), dtype=np.int64),
        member_names=tuple("ab"[: len(outlines)]),
        times=np.zeros(1),
        displacement=np.zeros((1, len(points), 3)),
        **data,
    )


def circle(sides=SIDES):
    angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    return RADIUS * np.column_stack([np.cos(angle), np.sin(angle)])


SQUARE = 0.02 * np.array([(1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)])


def side(sides):
    """Width of a wall of a polygon of so many sides [m]."""
    return 2.0 * RADIUS * np.sin(np.pi / sides)


@pytest.mark.parametrize(("narrow", "sides"), [(0.9, 64), (1.01, 32), (1.9, 32), (2.0, 16)])
def test_a_round_tube_keeps_as_many_sides_as_can_be_seen(narrow, sides):
    found = without_narrow_walls(states(circle()), narrow * side(32))
    assert len(found.quads) == (RINGS - 1) * sides
    edges = np.linalg.norm(found.points[found.quads[:, 3]] - found.points[found.quads[:, 0]], axis=1)
    assert edges == pytest.approx(side(sides))
    # still closed: every wall has a neighbour on both sides, and only the ends are free
    surface = surface_of(found)
    assert np.count_nonzero(surface.sides[:, 0] == surface.sides[:, 1]) == 2 * sides


def test_walls_that_meet_in_an_edge_stay():
    """However wide an image's pixels: a square keeps its corners, and round tubes have no edges."""
    found = without_narrow_walls(states(SQUARE, circle()), 1.0)
    owner = found.member[found.quads[:, 0]]
    # pairs of walls of this outline lie around a corner or along a side, as its first point decides
    assert np.count_nonzero(owner == 0) == (RINGS - 1) * 4
    corners = np.unique(np.abs(found.points[found.quads[owner == 0]][..., 1:].round(6)), axis=0)
    assert corners.max() == pytest.approx(0.02)
    assert np.count_nonzero(owner == 1) == (RINGS - 1) * 16
    # edges are drawn at the free ends alone
    surface = surface_of(without_narrow_walls(states(circle()), 1.0))
    assert (surface.sharp == (surface.sides[:, 0] == surface.sides[:, 1])).all()
    turned = without_narrow_walls(states(np.roll(SQUARE, 1, axis=0)), 1.0)
    assert len(turned.quads) == (RINGS - 1) * 8


def test_walls_with_data_of_their_own_stay():
    walls = (RINGS - 1) * SIDES
    given = states(circle(), cell_data={"strain": np.zeros((1, walls))})
    assert without_narrow_walls(given, 1.0) is given
