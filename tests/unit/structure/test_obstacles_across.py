"""A frame in a plane is planar only if no obstacle pushes it out of its plane."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from crumple.structure import Structure, across_plane, planar

STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 340e6}
TUBE = {"type": "square_tube", "side": 0.04, "thickness": 0.002}
NORMAL = np.array([0.0, 1.0, 0.0])


def portal(**obstacle: Any) -> Structure:
    """Portal in the plane y = 0.1 m, with one obstacle."""
    nodes = {"a": (0.0, 0.1, 0.0), "b": (0.0, 0.1, 0.5), "c": (0.6, 0.1, 0.5), "d": (0.6, 0.1, 0.0)}
    members = {n: {"nodes": tuple(n), "section": "tube", "material": "steel"} for n in ("ab", "bc", "cd")}
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes=nodes,
        members=members,
        supports={n: {"node": n, "fix": "all"} for n in "ad"},
        hinges="auto",
        obstacles={"hit": {"point": (-0.2, 0.1, 0.4)} | obstacle},
    )


WALL = {"type": "plane", "normal": (1.0, 0.0, 0.2)}
POLE = {"type": "cylinder", "axis": (0.0, 1.0, 0.0), "radius": 0.05}
BALL = {"type": "sphere", "radius": 0.1}
RAMP = {"table": {"time": (0.0, 1.0), "value": (0.0, 0.1)}}
TURNED = {"about": (0.0, 0.0, 0.0), "angle": RAMP}


@pytest.mark.parametrize(
    "obstacle",
    [
        WALL | {"mass": 50.0, "velocity": (5.0, 0.0, 1.0), "friction": 0.3},
        WALL | {"edge": (-0.2, 0.0, 1.0)},
        # a plane without friction has no way to drag the frame along
        WALL | {"velocity": (5.0, 2.0, 0.0)},
        WALL | {"turning": TURNED | {"axis": (0.0, -2.0, 0.0)}},
        POLE,
        POLE | {"velocity": (5.0, 2.0, 0.0)},
        # the same, but for rounding
        POLE | {"axis": (1e-9, -3.0, 0.0)},
        POLE | {"length": 0.4, "point": (-0.2, -0.1, 0.4)},
        POLE | {"length": 0.4, "point": (-0.2, 0.05 - 1e-9, 0.4)},
        # symmetric, though shorter than the section is wide
        POLE | {"length": 0.02, "point": (-0.2, 0.09, 0.4)},
        POLE | {"axis": (0.3, 0.0, -1.0)},
        BALL,
        BALL | {"mass": 20.0, "velocity": (4.0, 0.0, -4.0)},
    ],
)
def test_obstacles_that_are_symmetric_to_the_plane_keep_it(obstacle: dict[str, Any]) -> None:
    assert planar(portal(**obstacle))


@pytest.mark.parametrize(
    ("obstacle", "key"),
    [
        (WALL | {"normal": (1.0, 0.01, 0.2)}, "normal"),
        (WALL | {"normal": (0.0, 1.0, 0.0)}, "normal"),
        (WALL | {"edge": (-0.2, 0.5, 1.0)}, "edge"),
        (WALL | {"velocity": (5.0, 2.0, 0.0), "friction": 0.1}, "velocity"),
        (WALL | {"mass": 50.0, "guide": (1.0, 0.2, 0.0), "friction": 0.1}, "velocity"),
        (WALL | {"turning": TURNED | {"axis": (0.1, 1.0, 0.0)}}, "turning"),
        (POLE | {"axis": (0.1, 1.0, 0.0)}, "axis"),
        # an axis beside the plane: the pole touches beside the members' axes
        (POLE | {"axis": (0.3, 0.0, -1.0), "point": (-0.2, 0.11, 0.4)}, "point"),
        # its end is inside the section, or it ends before the plane
        (POLE | {"length": 0.4}, "length"),
        (POLE | {"length": 0.4, "axis": (0.0, -1.0, 0.0), "point": (-0.2, 0.11, 0.4)}, "length"),
        (POLE | {"length": 0.4, "point": (-0.2, -0.1, 0.4), "velocity": (5.0, 1.0, 0.0)}, "velocity"),
        (BALL | {"point": (-0.2, 0.12, 0.4)}, "point"),
        (BALL | {"motion": {"y": RAMP}}, "motion"),
    ],
)
def test_obstacles_that_push_out_of_the_plane_are_named(obstacle: dict[str, Any], key: str) -> None:
    structure = portal(**obstacle)
    assert not planar(structure)
    assert across_plane(structure, NORMAL) == f"obstacles.hit.{key}"
