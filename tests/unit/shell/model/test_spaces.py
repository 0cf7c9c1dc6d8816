"""Clearances on a mesh: rigid motion keeps them, and a member that moves takes its distance along."""

import numpy as np
import pytest
from tests.support.shell.structures import knee

from crumple.numeric.rotation import turned, vector_quaternion
from crumple.shell import lower
from crumple.shell.model.spaces import clearance_now
from crumple.structure import Outputs, ShellSettings

COARSE = ShellSettings(element_size=24e-3)


@pytest.fixture(scope="module", name="case")
def _case():
    first, second = knee().members
    corners = ((0.1, 0.0, 0.1), (0.4, 0.0, 0.1), (0.4, 0.0, 0.4), (0.1, 0.0, 0.4))
    outputs = Outputs(clearances={"free": {"points": corners, "moves_with": first, "members": (second,)}})
    return lower(knee(), COARSE, outputs)


def test_rigid_motion_keeps_a_clearance(case):
    (space,) = case.spaces
    start = case.mesh.position
    before = clearance_now(space, start, start)
    moved = turned(vector_quaternion(np.array([0.3, -0.8, 0.5])), start) + np.array([0.2, 0.1, -0.4])
    assert clearance_now(space, start, moved) == pytest.approx(before, abs=1e-12)


def test_a_member_that_moves_takes_its_distance_along(case):
    (space,) = case.spaces
    start = case.mesh.position
    (bar,) = space.bars
    moved = start.copy()
    away = np.array([0.03, 0.0, 0.0])
    moved[np.unique(bar.nodes)] += away
    before = clearance_now(space, start, start)
    assert before == pytest.approx(0.1 - bar.radius, rel=1e-9)
    assert clearance_now(space, start, moved) == pytest.approx(before + 0.03, rel=1e-9)
