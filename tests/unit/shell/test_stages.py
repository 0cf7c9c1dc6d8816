"""Sequences of stages and obstacles in shells: from the description to channels, conditions, restart."""

from itertools import count

import numpy as np
import pytest
from tests.support.shell.structures import cantilever, structure, thrown

from crumple.analysis import Analysis, solve
from crumple.errors import InputError, Status
from crumple.shell import LongRun, ShellRun, lower, solve_shell
from crumple.shell.stepping import output_times
from crumple.structure import Outputs, ShellSettings, Stage

COARSE = ShellSettings(element_size=24e-3)
PUSH = {"table": {"time": [0.0, 0.02], "value": [0.0, 0.05]}}


def run(stages, every=2e-4, **more):
    stages = tuple(Stage(**stage) for stage in stages)
    given = {"settings": COARSE, "outputs": Outputs(nodes=("tip",)), "stages": stages, **more}
    return ShellRun(sum(stage.duration for stage in stages), every, **given)


def pole(**more):
    """A pole under the middle of the cantilever's free half, clear of it by 1.2 mm."""
    return {"type": "cylinder", "point": (0.75, 0, -0.1137), "axis": (0, 1, 0), "radius": 0.1, **more}


def test_two_stages_are_one_run_where_nothing_changes():
    """Functions count from a stage's start, so only a structure without them can show it."""
    whole = solve_shell(thrown(), run([{"name": "all", "duration": 2e-3}]))
    parts = solve_shell(thrown(), run([{"name": "a", "duration": 8e-4}, {"name": "b", "duration": 1.2e-3}]))
    assert parts.time == pytest.approx(whole.time)
    for name in ("node.tip.displacement.z", "energy.dissipated", "energy.residual"):
        assert parts[name] == pytest.approx(whole[name], rel=1e-9, abs=1e-12)
    first, second = parts.stages
    assert (first.name, first.start, first.ended_by) == ("a", 0.0, "its duration")
    assert second.start == first.end == pytest.approx(8e-4)
    assert second.end == pytest.approx(2e-3)
    assert parts.energy_residual < 1e-4


def test_impulse_of_a_later_stage_adds_to_the_motion():
    """A free bar that flies: the second stage's impulse over its mass is added, the work is booked."""
    bar = structure({"a": (0, 0, 0), "tip": (0.5, 0, 0)}, {"tube": ("a", "tip")}, masses={
        "lump": {"node": "tip", "mass": 3.0}}, initial_velocity=[{"translation": (4.0, 0, 0)}])  # fmt: skip
    mass = bar.section_of("tube").mass_per_length(7850.0) * 0.5 + 3.0
    stages = [
        {"name": "fly", "duration": 4e-4},
        {"name": "hit", "duration": 4e-4, "impulses": [{"node": "tip", "impulse": (0, 0, 6.0)}]},
        {"name": "all", "duration": 4e-4, "initial_velocity": [{"translation": (0, 5.0, 0)}]},
    ]
    result = solve_shell(bar, run(stages, every=1e-4))
    assert result.status is Status.COMPLETE
    start = result["energy.kinetic"][0]
    assert start == pytest.approx(0.5 * mass * 16.0, rel=5e-3)
    # the impulse on a rigid section at the end: J . v of that section, between J^2/2m of all and of it alone
    given = result["energy.external_work"][7]
    assert 0.5 * 36.0 / mass < given < 0.5 * 36.0 / 3.0
    pushed = result["energy.external_work"][-1] - given
    assert pushed == pytest.approx(0.5 * mass * 25.0, rel=5e-3)
    assert result["node.tip.velocity.y"][-1] == pytest.approx(5.0, rel=0.02)
    assert result.energy_residual < 1e-3


def test_driven_obstacle_bends_the_cantilever_and_a_condition_ends_it():
    """A pole pushed up slowly: its force, work and way end the stage."""
    ram = pole(motion={"z": PUSH})
    given = cantilever(obstacles={"ram": ram})
    slow = {"name": "push", "kind": "quasi-static", "duration": 0.02}
    result = solve_shell(given, run([{**slow, "until": [{"displacement": 4e-3, "of": "ram"}]}]))
    assert result.status is Status.COMPLETE
    (stage,) = result.stages
    assert stage.ended_by == "displacement of ram reached 0.004 m"
    assert result["obstacle.ram.displacement.z"][-1] == pytest.approx(4e-3, rel=0.02)
    assert result.time[-1] == stage.end == pytest.approx(0.02 * 4 / 50, rel=0.02)
    # the pole is pushed down, the clamp held down
    assert result["obstacle.ram.force.z"][-1] < 0
    work = result["energy.external_work"]
    assert work[-1] > 0
    ended = solve_shell(given, run([{**slow, "until": [{"energy": 0.5 * work[-1]}]}]))
    assert 0.5 * work[-1] <= ended["energy.external_work"][-1] < 0.6 * work[-1]
    assert ended.time[-1] < result.time[-1]
    ended = solve_shell(given, run([{**slow, "until": [{"force": 300.0, "of": "ram"}]}]))
    assert ended.stages[0].ended_by == "force on ram reached 300 N"
    assert ended.time[-1] < 0.01


def test_distance_of_two_nodes_ends_a_stage():
    given = thrown()
    stages = [{"name": "turn", "duration": 4e-3, "until": [{"distance": -1e-4, "between": ("root", "tip")}]}]
    result = solve_shell(given, run(stages, outputs=Outputs(nodes=("root", "tip"))))
    x, y, z = (result[f"node.tip.displacement.{axis}"][-1] for axis in "xyz")
    tip = np.array([1.0 + x, y, z])
    assert np.linalg.norm(tip) - 1.0 == pytest.approx(-1e-4, rel=0.1)
    assert "distance" in result.stages[0].ended_by


def test_obstacle_is_absent_before_its_stage_and_what_is_not_driven_stays():
    given = cantilever(
        obstacles={"ram": pole(motion={"z": PUSH}), "other": pole(velocity=(0, 0, 3.0), members=["tube"])}
    )
    stages = [
        {"name": "nothing", "duration": 1e-3, "drive": [], "obstacles": ["ram"]},
        {"name": "push", "duration": 1e-3, "drive": ["ram"]},
    ]
    result = solve_shell(given, run(stages))
    assert result["obstacle.ram.displacement.z"][:6] == pytest.approx(0.0)
    assert result["obstacle.ram.displacement.z"][-1] == pytest.approx(2.5e-3, rel=5e-3)
    assert result["obstacle.other.displacement.z"] == pytest.approx(0.0)
    assert result["energy.kinetic"][5] == 0.0
    assert result["energy.kinetic"][-1] > 0.0


def test_quasi_static_stage_ends_at_rest_and_warns_where_it_was_fast():
    given = cantilever(obstacles={"ram": pole(motion={"z": PUSH})})
    stages = [
        {
            "name": "push",
            "kind": "quasi-static",
            "duration": 2e-3,
            "until": [{"displacement": 3e-3, "of": "ram"}],
        },
        {"name": "hold", "duration": 4e-4, "drive": []},
    ]
    result = solve_shell(given, run(stages))
    at = int(np.searchsorted(result.time, result.stages[0].end))
    assert result["energy.kinetic"][at] > 0.0
    # what was moving is damped, what was bent springs back in the dynamic stage
    assert result["energy.damping"][-1] >= result["energy.kinetic"][at]
    # damping this strong costs the ledger its second order
    assert result.energy_residual < 1e-2
    assert any("push is not quasi-static" in warning for warning in result.warnings)


def test_interrupted_sequence_goes_on_with_the_same_bits(tmp_path, monkeypatch):
    given = cantilever(obstacles={"ram": pole(motion={"z": PUSH}, friction=0.2)})
    stages = [
        {"name": "a", "duration": 3e-3, "until": [{"force": 250.0, "of": "ram"}]},
        {"name": "b", "duration": 1e-3, "impulses": [{"node": "tip", "impulse": (0, 0, 0.5)}],
         "until": [{"energy": 1e6}]},
    ]  # fmt: skip
    given = given.model_copy(update={"masses": cantilever(masses={"m": {"node": "tip", "mass": 1.0}}).masses})
    monkeypatch.setattr("crumple.shell.stepping.REPORT_INTERVAL", 0.0)
    looks = count()
    whole = solve_shell(given, run(stages), cancel=lambda: next(looks) < 0)
    assert 0 < whole.stages[0].end < 3e-3
    number = next(looks)
    for stop, ended in ((number // 4, 0), (number - 10, 1)):
        calls = count()
        path = tmp_path / f"{stop}.restart"
        broken = solve_shell(
            given,
            run(stages),
            cancel=lambda calls=calls, stop=stop: next(calls) >= stop,
            long_run=LongRun(restart_to=path),
        )
        assert broken.status is Status.CANCELLED
        assert len(broken.stages) == ended
        again = solve_shell(given, run(stages), long_run=LongRun(restart_from=path))
        assert np.array_equal(again.time, whole.time)
        for name, channel in whole.channels.items():
            assert np.array_equal(again[name], channel.values), name
        assert again.stages == whole.stages


def test_walls_inside_an_obstacle_are_refused_by_name():
    given = cantilever(obstacles={"pole": pole(point=(0.75, 0, -0.108))})
    with pytest.raises(InputError, match="walls of member tube start inside"):
        lower(given, COARSE)


def test_slim_obstacle_is_warned_of():
    given = cantilever(obstacles={"wire": pole(radius=5e-3)})
    result = solve_shell(given, run([{"name": "a", "duration": 2e-4}]))
    assert any("Obstacle wire has so small a radius" in warning for warning in result.warnings)


def test_analysis_with_stages_solves_and_keeps_its_stages(tmp_path):
    from crumple.result import read, summary, write

    analysis = Analysis(
        structure=cantilever(obstacles={"ram": pole(motion={"z": PUSH})}),
        duration=6e-4,
        stages=[{"name": "a", "duration": 2e-4}, {"name": "b", "duration": 4e-4}],
        shell=COARSE,
    )
    result = solve(analysis, "shell")
    assert [stage["name"] for stage in summary(result)["stages"]] == ["a", "b"]
    write(result, tmp_path)
    assert read(tmp_path).equals(result)


def test_outputs_of_all_stages_lie_on_one_grid():
    given = run([{"name": "a", "duration": 1.0}], outputs=Outputs(pictures=(0.0,)))
    assert output_times(given, 5.5e-4, 6e-4) == pytest.approx([5.5e-4, 6e-4, 8e-4, 1e-3, 1.15e-3])
    assert output_times(given, 0.0, 5e-4) == pytest.approx([0.0, 2e-4, 4e-4, 5e-4])
