"""Which times of a structure's functions become ends of steps, in the models of both kernels."""

import numpy as np
from tests.support.multibody.frames import CLAMP, structure

from crumple.multibody import link, lower
from crumple.multibody.bodies.sampled_functions import breaks_of
from crumple.multibody.planar.model import tree_model
from crumple.multibody.spatial.model import spatial_model


def table(*times):
    """Zero but for its second point."""
    return {"table": {"time": times, "value": [1.0 if k == 1 else 0.0 for k in range(len(times))]}}


def push(*times):
    return {"node": "b", "force": {"z": table(*times)}, "moment": {"y": table(*(t + 0.01 for t in times))}}


def test_loads_supports_and_obstacles_give_breaks_within_the_duration():
    drive = {"drive": {"node": "b", "fix": ["y"], "motion": {"z": table(0.2, 0.3, 0.4)}}}
    ram = {"type": "sphere", "point": (0.9, 0.0, 0.5), "radius": 0.1, "motion": {"z": table(0.5, 0.6, 0.7)}}
    turning = {"axis": (0.0, 1.0, 0.0), "about": (0.9, 0.0, 0.5), "angle": table(0.72, 0.74, 1.5)}
    whole = structure(
        loads=[push(0.1, 0.12, 2.0)],
        supports=CLAMP | drive,
        obstacles={"ram": ram, "arm": ram | {"motion": {}, "turning": turning}},
    )
    expected = [0.1, 0.11, 0.12, 0.13, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.72, 0.74]
    np.testing.assert_allclose(breaks_of(whole, 1.0), expected)
    assert breaks_of(structure(), 1.0).size == 0


def test_models_of_both_kernels_have_them():
    whole = structure(loads=[push(0.1, 0.2, 0.3)])
    for model in (tree_model(whole, lower(whole), 1.0), spatial_model(whole, link(whole), 1.0)):
        np.testing.assert_allclose(model.breaks, [0.1, 0.11, 0.2, 0.21, 0.3, 0.31])
