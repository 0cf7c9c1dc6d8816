"""Clear errors: settings that do not fit the mesh, obstacles that appear inside, wrong restart files."""

import numpy as np
import pytest
from tests.support.shell.structures import cantilever, thrown

from crumple._core.shell.simulation import ShellState
from crumple.errors import InputError, Status
from crumple.shell import LongRun, ShellRun, lower, mesh_of, solve_shell
from crumple.structure import Outputs, ShellSettings, Stage

COARSE = {"element_size": 24e-3}


def refused(given=None, stages=(), **settings):
    run = ShellRun(2e-3, 1e-3, settings=ShellSettings(**{**COARSE, **settings}), stages=tuple(stages))
    with pytest.raises(InputError) as error:
        solve_shell(given or thrown(), run, cancel=lambda: True)
    (problem,) = error.value.problems
    return problem


@pytest.mark.parametrize("sizes", [{"element_size": 51e-3}, {"element_size": 90e-3, "fine_size": 51e-3}])
def test_elements_longer_than_the_section_are_refused(sizes):
    problem = refused(**sizes)
    assert "larger than the section of member tube" in problem.what
    assert problem.where == f"analysis.shell.{[*sizes][-1]}"
    assert "at most 50 mm" in problem.allowed
    assert mesh_of(thrown(), ShellSettings(element_size=90e-3, fine_size=49e-3)).quads.size


def test_imperfection_that_crosses_elements_is_one_message():
    problem = refused(imperfection=40e-3)
    assert problem.where == "analysis.shell.imperfection"
    assert "at most 5.59 mm" in problem.allowed
    # a quarter of 22.35 mm; as much as is allowed makes a sound mesh
    state = solve_shell(thrown(), ShellRun(1e-4, 5e-5, ShellSettings(**COARSE, imperfection=5.58e-3)))
    assert state.status is Status.COMPLETE


def test_least_step_above_the_first_is_refused():
    problem = refused(minimum_time_step=1e-5)
    assert problem.where == "analysis.shell.minimum_time_step"
    assert problem.came == "1e-05 s"


def test_mass_scaling_to_few_steps_is_refused():
    problem = refused(mass_scaling=3e-4)
    assert problem.where == "analysis.shell.mass_scaling"
    assert "at most 0.0002 s" in problem.allowed


def test_damping_that_stops_everything_is_refused():
    problem = refused(damping=1e5)
    assert problem.where == "analysis.shell.damping"
    most = float(problem.allowed.split()[2])
    run = ShellRun(1e-4, 5e-5, ShellSettings(**COARSE, damping=0.99 * most))
    assert solve_shell(thrown(), run).status is not Status.REFUSED
    slow = Stage(name="push", kind="quasi-static", duration=4e-4)
    problem = refused(cantilever(), [Stage(name="a", duration=1e-3), slow])
    assert problem.where == "analysis.stages[1].duration"
    assert "the quasi-static stage push" in problem.what


def test_friction_of_walls_is_bounded():
    with pytest.raises(InputError, match="at most 10"):
        ShellSettings(contact_friction=11.0)


def test_obstacle_that_appears_inside_the_deformed_structure_ends_the_run():
    """A pole clear of the tube at first, into which it has been thrown by the time the pole appears."""
    pole = {"type": "cylinder", "point": (0.75, 0, 0.1137), "axis": (0, 1, 0), "radius": 0.1}
    given = thrown().model_copy(update={"obstacles": {"pole": pole}})
    stages = (
        Stage(name="throw", duration=1e-3, obstacles=()),
        Stage(name="hit", duration=1e-3),
    )
    run = ShellRun(2e-3, 2e-4, ShellSettings(**COARSE), Outputs(nodes=("tip",)), stages=stages)
    result = solve_shell(given, run)
    assert result.status is Status.OVERLAPPING
    alone = ShellState(lower(thrown(), ShellSettings(**COARSE)).model)
    alone.advance(1e-3)
    deepest = 0.1 - np.linalg.norm(alone.position[:, [0, 2]] - [0.75, 0.1137], axis=1).min()
    assert deepest > 5e-3
    assert float(result.reason.split(" mm inside")[0].split()[-1]) == pytest.approx(1e3 * deepest, rel=1e-3)
    assert "stage hit: walls of member tube are" in result.reason
    assert "obstacle pole" in result.reason
    assert result.time[-1] == pytest.approx(1e-3)
    assert len(result.stages) == 1
    # a pole that was there all the time is run into instead
    both = run.__class__(2e-3, 2e-4, ShellSettings(**COARSE), stages=(stages[0].model_copy(
        update={"obstacles": None}), stages[1]))  # fmt: skip
    assert solve_shell(given, both).status is Status.COMPLETE


@pytest.fixture
def saved(tmp_path):
    file = tmp_path / "restart.npz"
    asked = iter(range(1000))
    run = ShellRun(2e-3, 1e-3, ShellSettings(**COARSE))
    solve_shell(thrown(), run, cancel=lambda: next(asked) > 1, long_run=LongRun(restart_to=file))
    return file


def unreadable(file):
    with pytest.raises(InputError) as error:
        solve_shell(
            thrown(), ShellRun(2e-3, 1e-3, ShellSettings(**COARSE)), long_run=LongRun(restart_from=file)
        )
    (problem,) = error.value.problems
    text = str(problem)
    for word in ("Error", "zip", "pickle", "numpy", "npz file", "Errno", "None"):
        assert word not in text.replace(str(file), ""), text
    assert problem.todo
    assert problem.file == str(file)
    return problem.what


def test_files_that_are_no_restart_files_are_named_for_what_they_are(saved, tmp_path):
    whole = saved.read_bytes()
    missing = tmp_path / "no.npz"
    assert unreadable(missing) == "there is no such restart file"
    assert unreadable(tmp_path) == "this is a folder and not a restart file"
    for content, what in (
        (b"", "the restart file is empty"),
        (b"title: tube\n", "this is no restart file, or it was cut off"),
        (whole[: len(whole) // 2], "this is no restart file, or it was cut off"),
        (whole[:2000] + bytes(200) + whole[2200:], "the restart file is damaged, or another program's"),
    ):
        saved.write_bytes(content)
        assert unreadable(saved) == what
    np.savez(saved, other=np.zeros(3))
    assert unreadable(saved) == "the restart file is damaged, or another program's"
