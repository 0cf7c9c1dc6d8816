"""Where joints cut members back, obstacles touch the outlines of what was cut and do not enter the joint."""

import numpy as np
import pytest
from tests.support.shell.structures import structure

from crumple.errors import Status
from crumple.section import RectangularTube
from crumple.shell import ShellRun, solve_shell
from crumple.shell.mesh.mesh import mesh_of
from crumple.shell.model.bodies import bodies_of
from crumple.shell.model.obstacles import obstacles_of
from crumple.structure import Outputs, ShellSettings, Stage

COARSE = ShellSettings(element_size=10e-3)
STAGE = Stage(name="run", duration=1.0)
HEIGHT, SPEED, LUMP = 0.03, 2.0, 20.0
"""Of the joint's node above the plane [m], downwards [m/s], at the node [kg]."""


def tripod(**more):
    """Three tubes that rise from a heavy node at 40 degrees."""
    up, out = 0.2 * np.sin(np.radians(40)), 0.2 * np.cos(np.radians(40))
    ends = {
        f"end_{i}": (out * np.cos(a), out * np.sin(a), up) for i, a in enumerate(np.radians([0, 120, 240]))
    }
    return structure(
        {"joint": (0, 0, 0), **ends}, {f"leg_{i}": ("joint", f"end_{i}") for i in range(3)}, **more
    )


def plane(**more):
    return {"ground": {"type": "plane", "point": (0, 0, -HEIGHT), "normal": (0, 0, 1), **more}}


def test_the_outlines_between_the_node_and_the_first_rings_belong_to_the_joint():
    legs = tripod(obstacles=plane())
    mesh, hollow = mesh_of(legs, COARSE), mesh_of(tripod(), COARSE)
    assert hollow.cut_ends == ()
    assert mesh.walls == hollow.walls
    np.testing.assert_array_equal(mesh.quads, hollow.quads)
    (body,) = bodies_of(legs, mesh)
    assert [end.member for end in mesh.cut_ends] == ["leg_0", "leg_1", "leg_2"]
    for end in mesh.cut_ends:
        tube = mesh.tubes[end.member]
        points = mesh.position[end.nodes].reshape(-1, len(tube.contour.points), 3)
        # up to the first ring, with no gap wider than an element
        gaps = np.linalg.norm(np.diff([*points, mesh.position[tube.nodes[0]]], axis=0), axis=2)
        assert gaps.max() <= 10e-3
        assert np.isin(end.nodes, body.nodes).all()


def test_the_outlines_of_three_square_tubes_meet_in_the_corner_of_a_cube():
    """Half the mid-line beyond the node at the outer corner, and as far inside at the inner one."""
    corner = structure(
        {"joint": (0, 0, 0), "x": (0.5, 0, 0), "y": (0, 0.5, 0), "z": (0, 0, 0.5)},
        {name: ("joint", name) for name in "xyz"},
        obstacles=plane(),
    )
    square = RectangularTube(width=0.04, depth=0.04, thickness=2e-3)
    mesh = mesh_of(corner.model_copy(update={"sections": {"tube": square}}), COARSE)
    around = len(mesh.tubes["x"].contour.points)
    starts = np.concatenate([mesh.position[end.nodes[:around]] for end in mesh.cut_ends])
    assert starts.min(axis=0) == pytest.approx([-0.019] * 3)
    assert starts.max(axis=0) == pytest.approx([0.019] * 3)
    # on the plane that halves the angle to the nearer of the other tubes
    ordered = np.sort(starts, axis=1)
    assert ordered[:, 1] == pytest.approx(ordered[:, 2], abs=1e-12)


def test_an_obstacle_of_some_members_touches_the_outlines_of_these():
    legs = tripod(obstacles=plane(members=["leg_1"]))
    mesh = mesh_of(legs, COARSE)
    (obstacle,) = obstacles_of(legs, mesh, STAGE, 0.0)
    own = np.concatenate([mesh.tubes["leg_1"].nodes.reshape(-1), mesh.cut_ends[1].nodes])
    assert set(obstacle.nodes) == set(own)


def test_a_joint_stops_where_its_outline_meets_the_plane():
    """The rings at the cuts are above the lowest point of the outlines: the plane would enter by so much."""
    legs = tripod(
        masses={"lump": {"node": "joint", "mass": LUMP}},
        initial_velocity=[{"translation": (0, 0, -SPEED)}],
        obstacles=plane(),
    )
    mesh = mesh_of(legs, COARSE)
    lowest = min(mesh.position[end.nodes, 2].min() for end in mesh.cut_ends)
    rings = min(mesh.position[tube.nodes[0], 2].min() for tube in mesh.tubes.values())
    assert rings - lowest > 5e-3
    free = HEIGHT + lowest - 2.65e-3 / 2
    run = ShellRun(1.3 * free / SPEED, 1e-4, COARSE, Outputs(nodes=("joint",)))
    result = solve_shell(legs, run)
    assert result.status is Status.COMPLETE
    assert result["node.joint.displacement.z"].min() == pytest.approx(-free, abs=0.1e-3)
    pushed = np.diff(result.time) @ -result["obstacle.ground.force.z"][1:]
    stopped = SPEED + result["node.joint.velocity.z"][-1]
    # the tubes are 3 kg
    assert LUMP * stopped < pushed < (LUMP + 3.0) * stopped + 1.0
