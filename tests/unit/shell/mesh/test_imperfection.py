"""Waviness of walls: the same on every machine, across the walls, never more than asked, none at the ends."""

import numpy as np
import pytest
from tests.support.shell.structures import cantilever

from crumple.shell import mesh_of
from crumple.shell.mesh.imperfection import spread
from crumple.structure import ShellSettings


def test_numbers_are_those_of_splitmix64():
    """Its first output from the seed 0 is 0xE220A8397B1DCDAF."""
    assert spread(0, 1)[0] == (0xE220A8397B1DCDAF >> 11) * 2.0**-52 - 1.0
    many = spread(3, 100_000)
    assert np.abs(many).max() < 1.0
    assert many.mean() == pytest.approx(0.0, abs=0.01)
    assert many.std() == pytest.approx(1 / np.sqrt(3), rel=0.01)
    assert not np.array_equal(many, spread(4, 100_000))


def test_nodes_move_across_their_walls_and_the_ends_stay():
    size, amplitude = 12e-3, 1e-4
    even = mesh_of(cantilever(), ShellSettings(element_size=size))
    wavy = mesh_of(cantilever(), ShellSettings(element_size=size, imperfection=amplitude))
    shift = wavy.position - even.position
    nodes = even.tubes["tube"].nodes
    assert np.abs(shift[nodes[[0, -1]]]).max() == 0.0
    assert np.abs(shift[:, 0]).max() == 0.0
    size = np.linalg.norm(shift[nodes[1:-1]], axis=2)
    assert 0.9 * amplitude < size.max() <= amplitude * (1 + 1e-12)
    # in a flat wall only across it
    top = np.isclose(even.position[:, 2], even.position[:, 2].max()) & (np.abs(even.position[:, 1]) < 0.02)
    assert np.abs(shift[top, 1]).max() < 1e-15
    assert np.abs(shift[top, 2]).max() > 0.0
