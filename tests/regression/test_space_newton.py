"""Newton steps of the spatial kernel where many ball hinges lock, slide and turn at once: past numbers.

A tower of eight portals, its beams thrown in different directions. With directions of sliding hinges taken
from their rates it took 70 Newton steps per step tried, from their impulses 30. A tower of 60 took 131 from
their impulses, 82 along the central path. Of a buggy of rigid tubes that yield along their axes, which lands
on a corner, half of the passes cycle: it took 116 before these followed the path in contact, 79 before they
did so at once where the passes before had cycled, and takes 68; a hoop of tubes 57 and 45.
"""

from __future__ import annotations

import numpy as np
import pytest
from tests.concordance.suite import CASES
from tests.support.multibody.space_models import tower

from crumple._core.outcome import Outcome
from crumple.multibody import Run
from crumple.multibody.spatial.solver import SpatialSolver
from crumple.structure import placed_hinges

MOST_NEWTON_STEPS = 45
MOST_ON_PATH = 105
MOST_IN_CONTACT = 74
MOST_AT_ONCE = 51


def test_sliding_ball_hinges_follow_their_impulses():
    run = tower(8, error=1e-5, sway=(3.0, 3.0, 0.0)).run(np.array([0.1]))
    assert run.residual < 1e-4
    assert run.solves <= MOST_NEWTON_STEPS * (run.steps + run.rejected)


def test_many_hinges_follow_the_central_path():
    run = tower(60, error=1e-5, sway=(3.0, 3.0, 0.0)).run(np.array([0.05]))
    assert run.residual < 1e-4
    assert run.solves <= MOST_ON_PATH * (run.steps + run.rejected)


@pytest.mark.parametrize(
    ("name", "accuracy", "most"),
    [("buggy", 2.5e-4, MOST_IN_CONTACT), ("drawn_11_hoop", 1e-3, MOST_AT_ONCE)],
)
def test_rigid_hinges_follow_the_central_path(name, accuracy, most):
    analysis = CASES[name].analysis()
    structure, run = analysis.structure, Run(analysis.duration, analysis.duration)
    solved = SpatialSolver(structure, run, placed_hinges(structure)).run(accuracy, None, ends_only=True)
    assert solved.outcome is Outcome.COMPLETE
    assert solved.residual < 1e-6
    assert solved.solves <= most * (solved.steps + solved.rejected)
