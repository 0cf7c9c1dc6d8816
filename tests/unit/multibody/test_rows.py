"""Rows of histories follow each other in time, also where a state between steps cannot be solved again."""

import numpy as np
import pytest
from tests.support.structures import STEEL

from crumple.analysis import Analysis, solve
from crumple.structure import Structure


def tripod(thickness):
    """Mast on three struts with an arm of a channel, thrown sideways and down."""
    ends = {"sa": ("a", "o"), "sb": ("b", "o"), "sc": ("c", "o"), "arm": ("o", "m")}
    return Structure(
        materials={"steel": {**STEEL, "yield_stress": 350e6}},
        sections={
            "channel": {"type": "channel", "width": 0.04, "depth": 0.06, "thickness": 0.002},
            "tube": {"type": "square_tube", "side": 0.04, "thickness": thickness},
        },
        nodes={
            "o": (0.0, 0.0, 0.6), "a": (0.5, 0.0, 0.0), "b": (-0.3, 0.45, 0.0),
            "c": (-0.3, -0.4, 0.0), "m": (0.6, 0.1, 0.7),
        },
        members={
            name: {"nodes": nodes, "section": "channel" if name == "arm" else "tube", "material": "steel"}
            for name, nodes in ends.items()
        },
        hinges="auto",
        supports={node: {"node": node, "fix": "all"} for node in "abc"},
        masses={"tip": {"node": "m", "mass": 30.0}, "knot": {"node": "o", "mass": 40.0}},
        initial_velocity=({"translation": (1.0, 2.0, -6.0)},),
        gravity=(0.0, 0.0, -9.81),
    )  # fmt: skip


@pytest.mark.parametrize("thickness", [0.00365, 0.004750000000000001])
def test_no_hinge_gives_energy_back(thickness):
    """Rows had the state before the step in which they lie, which could be before the row above."""
    settings = {"members": "rigid", "mechanism_check": "off"}
    result = solve(Analysis(structure=tripod(thickness), duration=0.05, multibody=settings), checks=False)
    assert result.status.ok, result.reason
    energy = result["hinge.arm-o.energy"]
    assert energy[-1] > 100.0
    assert np.diff(energy).min() > -1e-9 * energy[-1]
