"""Stages: conditions that end them, and names that they refer to."""

import pytest

from crumple.errors import InputError
from crumple.structure import Stage, Structure, Until, stage_problems

RAM = {"type": "plane", "point": (0, 0, 0.2), "normal": (0, 0, -1), "velocity": (0, 0, -0.1)}
WALL = {"type": "plane", "point": (2, 0, 0), "normal": (-1, 0, 0)}


def test_condition_knows_its_quantity_and_value():
    until = Until(force="20 kN", of="ram")
    assert (until.quantity, until.value) == ("force", 20e3)
    assert Until(energy=5e3).quantity == "energy"
    assert Until(distance=-0.05, between=("a", "b")).value == -0.05
    assert Until(displacement="100 mm", of="ram").value == 0.1


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ({}, "names no quantity"),
        ({"force": 1.0, "energy": 1.0, "of": "ram"}, "several quantities"),
        ({"force": 1.0}, "'force' needs 'of'"),
        ({"displacement": 1.0}, "'displacement' needs 'of'"),
        ({"energy": 1.0, "of": "ram"}, "'energy' has no 'of'"),
        ({"distance": -0.1}, "'distance' needs 'between'"),
        ({"energy": 1.0, "between": ("a", "b")}, "'energy' has no 'between'"),
        ({"distance": 0.0, "between": ("a", "b")}, "change of distance of 0"),
        ({"distance": 0.1, "between": ("a", "a")}, "both nodes are the same"),
        ({"force": -1.0, "of": "ram"}, "more than 0"),
    ],
)
def test_wrong_condition_is_refused(keys, expected):
    with pytest.raises(InputError, match=expected):
        Until(**keys)


@pytest.mark.parametrize(
    "motion",
    [
        {"initial_velocity": [{"translation": (1, 0, 0)}]},
        {"impulses": [{"node": "tip", "impulse": (1, 0, 0)}]},
    ],
)
def test_quasi_static_stage_has_no_inertia(motion):
    Stage(name="hit", duration=0.1, **motion)
    with pytest.raises(InputError, match="no inertia"):
        Stage(name="push", kind="quasi-static", duration=1.0, **motion)


# keys of a stage, the path of the mistake below the stage, the message
WRONG = {
    "drive": ({"drive": ("rem",)}, "drive[0]", "no obstacle or support 'rem'"),
    "obstacles": ({"obstacles": ("clamp",)}, "obstacles[0]", "no obstacle 'clamp'"),
    "of": ({"until": ({"force": 1, "of": "rom"},)}, "until[0].of", "no obstacle or support 'rom'"),
    "absent": ({"obstacles": ("wall",), "until": ({"force": 1, "of": "ram"},)}, "until[0].of", "not present"),
    "clamp": ({"until": ({"force": 1, "of": "clamp"},)}, "until[0].of", "not driven"),
    "still": ({"until": ({"displacement": 1, "of": "wall"},)}, "until[0].of", "never moves"),
    "none there": ({"obstacles": (), "until": ({"force": 1, "of": "ram"},)}, "until[0].of", "not present"),
    "between": ({"until": ({"distance": 1, "between": ("root", "tap")},)}, "until[0].between[1]", "'tap'"),
    "impulse": ({"impulses": ({"node": "x"},)}, "impulses[0].node", "no node 'x'"),
    "nodes": ({"initial_velocity": ({"nodes": ("x",)},)}, "initial_velocity[0].nodes[0]", "no node 'x'"),
    "members": ({"initial_velocity": ({"members": ("x",)},)}, "initial_velocity[0].members[0]", "no member"),
}


@pytest.mark.parametrize("name", WRONG)
def test_names_that_do_not_exist_are_refused(name, keys):
    given, where, expected = WRONG[name]
    structure = Structure(**keys, obstacles={"ram": RAM, "wall": WALL})
    problems = stage_problems((Stage(name="push", duration=1.0, **given),), structure)
    assert [problem.where for problem in problems] == [f"analysis.stages[0].{where}"]
    assert expected in problems[0].what


def test_sound_stages_have_no_problem(keys):
    structure = Structure(**keys, obstacles={"ram": RAM, "wall": WALL})
    push = Stage(
        name="push",
        kind="quasi-static",
        duration=1.0,
        drive=("ram",),
        obstacles=("ram",),
        until=({"force": 1e3, "of": "ram"}, {"distance": -0.1, "between": ("root", "tip")}),
    )
    hit = Stage(name="hit", duration=0.1, initial_velocity=({"translation": (10, 0, 0)},))
    assert stage_problems((push, hit), structure) == []
    assert "two stages" in stage_problems((push, push), structure)[0].what


def test_thrown_mass_needs_inertia(keys):
    ram = {**RAM, "mass": 5.0}
    press = {**RAM, "point": (0, 0, 0.5)}
    structure = Structure(**keys, obstacles={"ram": ram, "wall": WALL, "press": press})
    push = Stage(name="push", kind="quasi-static", duration=1.0)
    (problem,) = stage_problems((push,), structure)
    assert "'ram' has a velocity" in problem.what
    assert stage_problems((push.model_copy(update={"obstacles": ("wall",)}),), structure) == []
    assert stage_problems((push.model_copy(update={"kind": "dynamic"}),), structure) == []


HEAVY = {**RAM, "point": (0, 0, 0.5), "mass": 5.0}
IDLE = {
    "fixed": ("dynamic", ("wall",), "drive[0]", "the obstacle 'wall' is not driven"),
    "held": ("dynamic", ("clamp",), "drive[0]", "the support 'clamp' is not driven"),
    "with a mass": ("dynamic", ("heavy",), "drive[0]", "'heavy' has a mass and is not driven"),
    "empty": ("quasi-static", (), "drive", "no drive and no load"),
}


@pytest.mark.parametrize("name", IDLE)
def test_drives_that_do_nothing_are_refused(name, keys):
    kind, drive, where, expected = IDLE[name]
    obstacles = {"ram": RAM, "wall": WALL, "heavy": HEAVY}
    structure = Structure(**keys, obstacles=obstacles)
    there = ("ram", "wall")
    stage = Stage(name="push", kind=kind, duration=1.0, drive=drive, obstacles=there)
    (problem,) = stage_problems((stage,), structure)
    assert problem.where == f"analysis.stages[0].{where}"
    assert expected in problem.what
    # rams that rest in an impact, and an elastic structure that springs back
    resting = stage.model_copy(update={"kind": "dynamic", "drive": ()})
    later = stage.model_copy(update={"name": "back", "kind": "quasi-static", "drive": ()})
    assert stage_problems((resting, later), structure) == []


def test_first_push_needs_something_that_pushes(keys):
    push = Stage(name="push", kind="quasi-static", duration=1.0)
    (problem,) = stage_problems((push,), Structure(**keys, obstacles={"wall": WALL}))
    assert "no drive and no load" in problem.what
    load = {"node": "tip", "force": {"z": "1 kN"}}
    assert stage_problems((push,), Structure(**keys, loads=[load])) == []
