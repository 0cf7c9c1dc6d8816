"""Rings along a member: exact divisions, growth bounded, asked places kept."""

import numpy as np
import pytest

from crumple.shell.mesh.stations import Sizes, stations

GRADED = Sizes(coarse=20e-3, fine=5e-3, growth=1.2)


def test_uniform_mesh_divides_evenly():
    rings = stations((0.0, 1.0), [], [], Sizes(5e-3, 5e-3, 1.2))
    assert len(rings) == 201
    assert np.diff(rings) == pytest.approx(5e-3)


def test_fine_zone_has_the_fine_size_and_the_rest_grows_to_the_coarse():
    sides = np.diff(stations((0.0, 1.0), [], [(-0.1, 0.2)], GRADED))
    assert sides[:40] == pytest.approx(5e-3)
    assert sides.max() == pytest.approx(20e-3, rel=0.05)
    ratio = sides[1:] / sides[:-1]
    assert ratio.max() < 1.2 * 1.02
    assert ratio.min() > 0.95


def test_growth_on_both_sides_of_a_zone_is_symmetric():
    sides = np.diff(stations((0.0, 1.0), [], [(0.4, 0.6)], GRADED))
    assert sides == pytest.approx(sides[::-1], rel=1e-9)


def test_asked_station_gets_a_ring():
    rings = stations((0.0, 1.0), [0.1234], [(0.0, 0.05)], GRADED)
    assert np.abs(rings - 0.1234).min() < 1e-12


def test_asked_station_beside_an_end_makes_no_sliver():
    rings = stations((0.0, 1.0), [1e-3], [], Sizes(10e-3, 10e-3, 1.2))
    assert np.diff(rings).min() > 5e-3


def test_overlapping_zones_are_one():
    together = stations((0.0, 1.0), [], [(0.0, 0.1), (0.05, 0.2)], GRADED)
    assert together == pytest.approx(stations((0.0, 1.0), [], [(0.0, 0.2)], GRADED))


def test_short_member_still_has_an_element():
    assert len(stations((0.0, 3e-3), [], [], Sizes(10e-3, 10e-3, 1.2))) == 2
