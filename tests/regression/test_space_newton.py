"""Newton steps of the spatial kernel where many ball hinges lock, slide and turn at once: past numbers.

A tower of eight portals, its beams thrown in different directions. With directions of sliding hinges taken
from their rates it took 70 Newton steps per step tried, from their impulses 30. A tower of 60 took 131 from
their impulses, 82 along the central path.
"""

from __future__ import annotations

import numpy as np
from tests.support.multibody.space_models import tower

MOST_NEWTON_STEPS = 45
MOST_ON_PATH = 105


def test_sliding_ball_hinges_follow_their_impulses():
    run = tower(8, error=1e-5, sway=(3.0, 3.0, 0.0)).run(np.array([0.1]))
    assert run.residual < 1e-4
    assert run.solves <= MOST_NEWTON_STEPS * (run.steps + run.rejected)


def test_many_hinges_follow_the_central_path():
    run = tower(60, error=1e-5, sway=(3.0, 3.0, 0.0)).run(np.array([0.05]))
    assert run.residual < 1e-4
    assert run.solves <= MOST_ON_PATH * (run.steps + run.rejected)
