"""Redundant rows of a loop that is badly conditioned: which rows are redundant must not depend on
rounding."""

import numpy as np
import pytest
from tests.support.multibody.frames import structure

from crumple.errors import Status
from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings

NODES = {
    "n0": (0.0, 0.0, 0.0),
    "n1": (-0.149, 0.0, 0.605),
    "n2": (0.198, 0.0, -0.869),
    "n3": (0.738, 0.0, 0.655),
    "n5": (-0.609, 0.0, 0.814),
    "n7": (0.541, 0.0, -0.158),
    "n8": (-0.308, 0.0, 0.604),
}
MEMBERS = (
    ("n0", "n1", None),
    ("n0", "n2", 378.0),
    ("n0", "n3", 976.0),
    ("n1", "n5", None),
    ("n0", "n7", 976.0),
    ("n5", "n8", 976.0),
    ("n7", "n3", 976.0),
)
"""Nodes, and the moment of a hinge about both bending axes at the first node; the triangle n0, n3, n7 turns
about n0 as one, since two of its hinges lie there."""


@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("size", [1.0, 0.8, 1.2])
def test_a_triangle_that_turns_about_two_of_its_hinges(accuracy, size):
    members = {}
    for i, (first, second, moment) in enumerate(MEMBERS):
        keys = {"axes": ("y", "z"), "coupling": "ellipsoid", "law": {"type": "constant", "moment": moment}}
        hinges = [{"name": f"h{i}", "at": first, "offset": 0.0, **keys}] if moment else []
        members[f"b{i}"] = {
            "nodes": (first, second),
            "section": "tube",
            "material": "steel",
            "up": (0.0, 1.0, 0.0),
            "hinges": hinges,
        }
    frame = structure(
        {name: tuple(size * np.array(place)) for name, place in NODES.items()},
        members,
        supports={},
        masses={"m": {"node": "n2", "mass": 20.0 * size}},
        initial_velocity=[
            {"translation": (-7.0, 0.0, -5.0)},
            {"axis": (0.0, 1.0, 0.0), "nodes": ("n5", "n7", "n2", "n1"), "rotation": 10.5},
        ],
    )
    settings = MultibodySettings(accuracy=accuracy, mechanism_check="off", kernel="spatial")
    result = solve_multibody(frame, Run(0.028, 0.028, settings))
    assert result.status is Status.COMPLETE, result.reason
    assert result.energy_residual < 1e-6
