"""Lee & Symonds (1952): free rigid-plastic beam of length 2L under a central force P.

With p = P L/M_p the beam moves as a rigid body up to p = 4; then it folds in its middle; above p = 22.887 a
hinge forms in each half too.  A free chain of bars reproduces the first figure wherever its hinges are, and
the second as closely as a hinge is to the largest moment of the halves (second order in the distance).
Loads are varied in one call.

Kind: published.  Source: quoted.
"""

import math

import numpy as np
import pytest
from tests.support.structures import STEEL, constant_law

from crumple.multibody import Run, solve_variants
from crumple.structure import MultibodySettings, Structure

HALF, MOMENT, BARS = 1.0, 100.0, 25
SECTION = {"type": "circular_tube", "diameter": 0.010, "thickness": 0.001}
MASS_PER_LENGTH = 7850.0 * math.pi / 4 * (0.010**2 - 0.008**2)


@pytest.fixture(scope="module")
def beam():
    """Free beam of 2 x 25 bars under p = 1."""
    law = constant_law(MOMENT)
    half = {"section": "rod", "material": "steel", "bars": {"number": BARS, "law": law}}
    return Structure(
        materials={"steel": STEEL},
        sections={"rod": SECTION},
        nodes={"a": (-HALF, 0.0, 0.0), "m": (0.0, 0.0, 0.0), "b": (HALF, 0.0, 0.0)},
        members={
            "left": {**half, "nodes": ("a", "m")},
            "right": {
                **half,
                "nodes": ("m", "b"),
                "hinges": [{"name": "middle", "at": "m", "offset": 0.0, "law": law}],
            },
        },
        loads=[{"node": "m", "force": {"z": MOMENT / HALF}}],
    )


def turned(table):
    """Whether the middle hinge, and any other, has turned; by variant."""
    names = [name for name in table.quantities if name.endswith(".rotation_max")]
    turns = np.array([table[name] for name in names])
    middle = names.index("hinge.middle.rotation_max")
    # in 1 ms a hinge that is loaded 1e-3 beyond its capacity turns by more, a locked one creeps by less
    open_ = turns > 1e-8
    return open_[middle], np.delete(open_, middle, axis=0)


def threshold(p, opened):
    """Middle of the interval of p in which hinges open."""
    first = int(np.argmax(opened))
    assert opened[first:].all()
    assert first > 0
    return (p[first - 1] + p[first]) / 2, p[first] - p[first - 1]


def test_thresholds(beam, record_figure):
    run = Run(1e-3, 1e-3, MultibodySettings(accuracy=1e-4))
    low, high = np.linspace(3.9, 4.1, 41), np.linspace(22.0, 24.0, 41)
    table = solve_variants(beam, run, {"loads": np.concatenate([low, high])})
    assert all(status.ok for status in table.status)
    middle, sides = turned(table)
    assert not sides[:, : low.size].any()
    assert middle[low.size :].all()
    first, width = threshold(low, middle[: low.size])
    record_figure("p at which the beam folds", first, 4.0, width)
    second, width = threshold(high, sides[:, low.size :].any(axis=0))
    # hinges lie every L/25: the largest moment is missed by 2 % of L at most
    record_figure("p at which the halves fold", second, 22.887, 0.005 * 22.887 + width)
    # the side hinges lie alike in both halves
    which = np.flatnonzero(sides[:, -1])
    assert which.size >= 2
