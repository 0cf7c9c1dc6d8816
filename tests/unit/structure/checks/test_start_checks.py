"""Impulses and velocities that a support would swallow are refused by name, at the start and in stages."""

import pytest
from tests.support.shell.structures import cantilever

from crumple.analysis import Analysis
from crumple.errors import InputError

PIN = {"supports": {"pin": {"node": "root", "fix": ["x", "z", "ry"]}}}


def problems(**more):
    with pytest.raises(InputError) as refused:
        cantilever(**{**PIN, **more})
    return {problem.where: problem for problem in refused.value.problems}


def test_impulse_along_a_held_freedom_is_refused():
    found = problems(
        impulses=[
            {"node": "tip", "impulse": (1, 1, 1), "angular_impulse": (1, 1, 1)},
            {"node": "root", "impulse": (0, 3, 5), "angular_impulse": (2, 0, 0)},
        ]
    )
    (problem,) = found.values()
    assert problem.where == "impulses[1].impulse[2]"
    assert "the support 'pin' fixes z of node 'root'" in problem.what
    assert problem.came == "5 N s"


def test_angular_impulse_along_a_driven_freedom_is_refused():
    driven = {"node": "root", "motion": {"rz": {"table": {"time": [0.0, 1.0], "value": [0.0, 1.0]}}}}
    found = problems(supports={"turn": driven}, impulses=[{"node": "root", "angular_impulse": (1, 0, 3)}])
    assert set(found) == {"impulses[0].angular_impulse[2]"}


def test_velocity_of_a_named_node_is_refused_along_what_is_held_alone():
    """About a point 1 m above the root it would move along x and turn about y."""
    field = {"rotation": 2.0, "about": (0, 0, 1), "axis": (0, 1, 0)}
    found = problems(initial_velocity=[{**field, "nodes": ["tip", "root"]}])
    (problem,) = found.values()
    assert problem.where == "initial_velocity[0].nodes[1]"
    with pytest.raises(InputError) as refused:
        cantilever(**PIN, initial_velocity=[{**field, "nodes": ["tip", "root"]}])
    assert [problem.came for problem in refused.value.problems] == ["-2 m/s", "2 rad/s"]


@pytest.mark.parametrize(
    "field",
    [
        {"translation": (0, 4, 0), "nodes": ["root"]},
        {"translation": (1, 0, 1), "members": ["tube"]},
        {"translation": (1, 0, 1)},
        {"rotation": 2.0, "axis": (1, 0, 0), "about": (0.3, 0, 0), "nodes": ["root"]},
    ],
)
def test_what_is_free_or_not_named_passes(field):
    assert cantilever(**PIN, initial_velocity=[field]).initial_velocity


def test_stages_are_checked_too():
    stages = [
        {"name": "a", "duration": 1e-3},
        {"name": "b", "duration": 1e-3, "impulses": [{"node": "root", "impulse": (1, 0, 0)}]},
    ]
    with pytest.raises(InputError) as refused:
        Analysis(structure=cantilever(**PIN), duration=2e-3, stages=stages)
    assert refused.value.problems[0].where == "analysis.stages[1].impulses[0].impulse[0]"
