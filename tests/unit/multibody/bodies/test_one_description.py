"""Both kernels get the same bodies, hinges and actions from one description of a structure."""

import numpy as np
import pytest
from tests.support.multibody.frames import CLAMP, member, structure

from crumple.multibody import link, lower
from crumple.multibody.planar.mechanism import hinge_links
from crumple.multibody.planar.model import tree_model
from crumple.multibody.spatial.model import spatial_model

NODES = {"a": (0.0, 0.0, 0.0), "b": (1.0, 0.0, 0.0), "c": (1.0, 0.0, 0.5), "d": (2.0, 0.0, 0.0)}
LOPSIDED = {
    "type": "table",
    "rotation": [0.0, 1.0],
    "moment": [500.0, 200.0],
    "negative_rotation": [0.0, 0.5],
    "negative_moment": [400.0, 100.0],
}
MEMBERS = {
    "ab": member("a", "b", ("h", 0.4, {"law": LOPSIDED}), up=(0.0, 0.0, -1.0)),
    "bc": member("b", "c", up=(1.0, 0.0, 0.0)),
    "bd": member("b", "d", ("k", 0.3)),
}
DURATION = 0.1


@pytest.fixture(name="tee", scope="module")
def _tee():
    """A tee on a clamp; local y of its first member is -y, so that its hinge turns against its joint."""
    return structure(
        NODES,
        MEMBERS,
        masses={"m": {"node": "c", "mass": 2.0}},
        supports=CLAMP
        | {"pull": {"node": "d", "motion": {"z": {"table": {"time": [0.0, 0.1], "value": [0.0, 0.05]}}}}},
        loads=[
            {"node": "c", "force": {"x": 20.0, "z": 100.0}, "moment": {"y": 3.0}},
            {"node": "d", "force": {"x": {"table": {"time": [0.0, 0.1], "value": [0.0, 5.0]}}}},
        ],
    )


def test_bodies_are_the_same(tee):
    mechanism, linkage = lower(tee), link(tee)
    tree, space = tree_model(tee, mechanism, DURATION), spatial_model(tee, linkage, DURATION)
    for node, there in linkage.node_body.items():
        here = mechanism.node_body[node]
        assert (here < 0) == (there < 0)
        if here >= 0:
            assert tree.bodies[here].mass == space.bodies[there].mass
            normal = mechanism.plane.normal
            assert tree.bodies[here].inertia == normal @ space.bodies[there].inertia @ normal


def test_hinges_are_the_same_in_the_sense_of_their_joint(tee):
    mechanism, linkage = lower(tee), link(tee)
    tree, space = tree_model(tee, mechanism, DURATION), spatial_model(tee, linkage, DURATION)
    in_space = {c.name: h.components[0] for c, h in zip(linkage.connections, space.hinges, strict=False)}
    signs = {}
    for hinge, (_, placed, sign) in zip(tree.hinges, hinge_links(mechanism.links), strict=True):
        there, signs[placed.name] = in_space[placed.name].constants(), sign
        if sign < 0.0:
            swapped = {"positive": "negative", "negative": "positive"}
            there = {
                key.replace(sense, swapped[sense]) if (sense := key.split("_")[0]) in swapped else key: value
                for key, value in there.items()
            }
        assert hinge.constants() == there
    assert signs == {"h": -1.0, "k": 1.0}


def test_actions_are_the_same(tee):
    mechanism, linkage = lower(tee), link(tee)
    tree, space = tree_model(tee, mechanism, DURATION), spatial_model(tee, linkage, DURATION)
    assert (len(tree.loads), len(tree.drives)) == (4, 1)
    for here, there in zip([*tree.loads, *tree.drives], [*space.loads, *space.drives], strict=True):
        np.testing.assert_array_equal(here.times, there.times)
    for here, there in zip(tree.loads, space.loads, strict=True):
        np.testing.assert_array_equal(here.values, there.values)
        assert here.direction[0] == there.moment @ mechanism.plane.normal
        np.testing.assert_array_equal(here.direction[1:], mechanism.plane.flat(there.force))
    np.testing.assert_array_equal(tree.drives[0].rates, space.drives[0].rates)
