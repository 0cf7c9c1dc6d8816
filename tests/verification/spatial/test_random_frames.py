"""Random frames of stated distributions: small ones always, a hundred of any size in the slow run.

Kind: invariant.  Source: derived here.
"""

import numpy as np
import pytest
from tests.benchmark.random_frames import campaign, outcome, solved, table
from tests.support.random_frames import SEEDS, frame

import crumple

FEW, SMALL, LIMIT = 10, 4, 30.0
"""Frames of the short run, most members in one of them, and processor time of each [s]."""
MANY, LEAST, MOST_STEPS = 100, 96, 200_000
"""Frames of the slow run, how many of them at least are solved, and most steps of one."""


def small_frame(seed, index):
    """A frame with few members, for 10 ms at the accuracy of a first look."""
    for sub in range(100):
        found = frame(seed + index, sub)
        if len(found.structure.members) <= SMALL and not found.stages:
            break
    settings = {"mechanism_check": "off", "accuracy": 1e-2}
    return crumple.Analysis(title=found.title, structure=found.structure, duration=0.01, multibody=settings)


def explained(row):
    """Whether a run that did not complete says why, with finite numbers."""
    return (
        row.get("finite", True)
        and row["status"] not in {"crashed", "raised", "time limit", "hung"}
        and row["reason"]
    )


def test_small_frames_are_solved():
    rows = [outcome(small_frame, SEEDS["campaign"], index, LIMIT) for index in range(FEW)]
    missed = [row for row in rows if not solved(row)]
    assert all(explained(row) for row in missed), table(rows)
    assert len(missed) <= 1, table(rows)


@pytest.mark.slow
def test_a_hundred_frames(tmp_path):
    """At least 96 %, where the aim is 99 %.  What is not solved says why, and its work is bounded."""
    rows = campaign(frame, SEEDS["campaign"], range(MANY), tmp_path / "rows.jsonl", 120.0)
    missed = [row for row in rows if not solved(row)]
    assert all(explained(row) for row in missed), table(rows)
    assert len(rows) - len(missed) >= LEAST, table(rows)
    steps = np.array([row.get("steps", 0) for row in rows])
    assert steps.max() < MOST_STEPS, table(rows)
