"""Random frames that once did not end as they should: one for each cause that was found.

82: a crossing of several ways; moved aside by 0.1 % of its size its loops still left no digits.
387: a planar frame that locks at rest; the rounding of its rates was held against the accuracy.
499: locked members with restitution; impacts followed on each other without end.
81, 900: a driven plane meets what is locked; contacts were taken to close much too early, over and over.
601: a driven support stretches a frame to its limit; the motion that followed had no meaning.
"""

import numpy as np
import pytest
from tests.support.random_frames import SEEDS, frame

import crumple
from crumple.errors import Status


def solve(index):
    return crumple.solve(frame(SEEDS["campaign"], index))


@pytest.mark.parametrize("index", [82, 387, 499])
def test_solved(index):
    result = solve(index)
    assert result.status is Status.COMPLETE, result.reason
    assert result.energy_residual < 1e-3


@pytest.mark.parametrize("index", [81, 116, 900, 989])
def test_a_driven_obstacle_at_what_is_locked_crushes_it(index):
    """Rigid contact ended these runs after endless impacts."""
    result = solve(index)
    assert result.status is Status.COMPLETE, result.reason
    assert result.energy_residual < 1e-3
    assert "crushed_contact" in {caution.code for caution in result.cautions}


def test_what_is_driven_beyond_its_limit_ends_before_numbers_lose_their_meaning():
    result = solve(601)
    assert result.status is Status.STEP_COLLAPSED
    assert "lost the balance of energy; where what is driven" in result.reason
    assert result.energy_residual < 1e-3
    turned = [channel.values for name, channel in result.channels.items() if name.endswith(".rotation")]
    assert np.abs(turned).max() < 10
