"""Round tubes in chains that lie in no plane: mitres at every corner, however the section axes are turned."""

import numpy as np
import pytest
from tests.support.shell.structures import STEEL

from crumple.section import CircularTube
from crumple.shell.mesh.joints import Kind
from crumple.shell.mesh.mesh import mesh_of
from crumple.structure import ShellSettings, Structure
from crumple.structure.hinges.corners import corners

COARSE = ShellSettings(element_size=12e-3)
NODES = {
    "a": (0.0, 0.0, 0.0),
    "b": (0.0, 0.3, 0.0),
    "c": (-0.1, 0.45, 0.2),
    "d": (-0.2, 0.75, 0.25),
}
MEMBERS = {"one": ("a", "b"), "two": ("b", "c"), "three": ("c", "d")}


def chain(nodes=NODES, members=MEMBERS, **more):
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": CircularTube(diameter=0.04, thickness=0.002)},
        nodes=nodes,
        members={
            name: {"nodes": ends, "section": "tube", "material": "steel", **more.get(name, {})}
            for name, ends in members.items()
        },
        supports={"clamp": {"node": "a", "fix": "all"}},
    )


@pytest.mark.parametrize(
    "given",
    [
        chain(),
        chain(two={"up": (0.3, 0.2, 0.9)}, three={"roll": 0.4}),
        chain(members={"three": ("d", "c"), "one": ("a", "b"), "two": ("c", "b")}),
    ],
    ids=["plain", "turned about their axes", "some the other way round"],
)
def test_every_corner_of_a_chain_in_space_is_mitred(given):
    mesh = mesh_of(given, COARSE)
    assert {node for node, joint in mesh.joints.items() if joint.kind is Kind.MITRED} == {"b", "c"}
    assert set(corners(given)) == {"b", "c"}
    # all points keep their distance from the axes
    for name, tube in mesh.tubes.items():
        middle = mesh.position[tube.nodes[len(tube.nodes) // 2]]
        arm = middle - tube.frame.origin
        arm = arm - np.outer(arm @ tube.frame.x, tube.frame.x)
        assert np.linalg.norm(arm, axis=1) == pytest.approx(0.019, rel=0.01), name


def test_sections_of_a_plane_chain_stay_as_they_are():
    plane = {name: (x, 0.0, z) for name, (_, x, z) in NODES.items()}
    mesh = mesh_of(chain(plane), COARSE)
    first, *others = (mesh.tubes[name].contour.points for name in MEMBERS)
    for points in others:
        assert (points == first).all()


def test_a_closed_loop_keeps_a_rigid_corner_where_its_turns_do_not_add_up():
    nodes = {"a": (0.0, 0.0, 0.0), "b": (0.4, 0.0, 0.0), "c": (0.4, 0.4, 0.15), "d": (0.0, 0.4, 0.0)}
    ring = {"one": ("a", "b"), "two": ("b", "c"), "three": ("c", "d"), "four": ("d", "a")}
    kinds = [joint.kind for node, joint in mesh_of(chain(nodes, ring), COARSE).joints.items() if node != "a"]
    assert kinds.count(Kind.MITRED) >= 2
