"""From an analysis to a result: provenance, filters, and the same answer from file and Python."""

import re
import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from crumple.analysis import input_hash, load, loads, solve
from crumple.analysis.filters import with_filters
from crumple.analysis.unmet import with_unmet
from crumple.errors import InputError, Status
from crumple.result import cfc

SHELLS_ALONE = ("07_axial_crush",)
"""Examples that only shells solve; they run in tests/verification."""
LONG = ("diagonal", "strong_beam")
"""Layouts that take twenty seconds each; others like them are among the rest."""
TEXT = Path("examples/01_tube_bending.yaml").read_text(encoding="utf-8")


def test_the_python_example_is_the_file_and_gives_the_same_bits():
    built = runpy.run_path("examples/01_tube_bending.py")["analysis"]
    read = load("examples/01_tube_bending.yaml")
    assert input_hash(built) == input_hash(read)
    one, two = solve(built), solve(read)
    assert one.title == two.title
    for name, channel in one.channels.items():
        np.testing.assert_array_equal(channel.values, two[name], err_msg=name)


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(path, marks=pytest.mark.slow if path.stem in LONG else ())
        for path in sorted(Path("examples").rglob("*.yaml"))
        if path.stem not in SHELLS_ALONE and path.parent.name != "studies"
    ],
    ids=lambda path: path.stem,
)
def test_every_example_runs_and_keeps_its_energy(path):
    result = solve(load(path))
    assert result.status is Status.COMPLETE
    assert result.energy_residual < 1e-3


def test_the_result_has_its_provenance():
    analysis = loads(TEXT)
    result = solve(analysis)
    assert result.provenance.input_hash == input_hash(analysis)
    assert result.provenance.version
    assert result.provenance.settings["accuracy"] == 1e-3
    assert result.title == analysis.title


def test_a_stage_that_no_condition_ended_is_a_warning():
    ram = """
obstacles:
  ram: {type: plane, point: [0 m, 0 m, 5 m], normal: [0, 0, -1], velocity: [0 m/s, 0 m/s, -1 m/s]}
"""

    def warned(until):
        stage = f"stages: [{{name: push, duration: 100 ms, until: [{until}]}}]"
        result = solve(loads(TEXT.replace("duration: 100 ms", stage) + ram))
        assert result.status.ok
        return [warning for warning in result.warnings if "ended by its duration" in warning]

    assert warned("{energy: 80 kJ}, {force: 500 kN, of: ram}, {displacement: 400 mm, of: ram}") == [
        "Stage push ended by its duration: energy 80 kJ was not reached (0 J at most) and "
        "force of ram 500 kN was not reached (0 N at most) and "
        "displacement of ram 400 mm was not reached (100 mm at most)."
    ]
    assert warned("{displacement: 90 mm, of: ram}, {energy: 80 kJ}") == []


@pytest.mark.parametrize("fidelity", ["multibody", "shell"])
def test_stages_say_apart_from_their_words_that_they_ended_by_their_duration(fidelity):
    stage = "stages: [{name: push, duration: 0.1 ms, until: [{energy: 80 kJ}]}]"
    short = re.sub(r"\n  (pictures|every):.*", "", TEXT)
    analysis = loads(short.replace("duration: 100 ms", stage))
    result = solve(analysis, fidelity)
    assert [one.by_duration for one in result.stages] == [True]
    told = tuple(replace(one, ended_by="time") for one in result.stages)
    (warning,) = with_unmet(replace(result, stages=told, warnings=()), analysis.stages).warnings
    assert warning.startswith("Stage push ended by its duration: energy 80 kJ was not reached")
    met = tuple(replace(one, by_duration=False) for one in result.stages)
    assert with_unmet(replace(result, stages=met, warnings=()), analysis.stages).warnings == ()


def test_unknown_solvers_and_no_threads_are_refused():
    analysis = loads(TEXT)
    with pytest.raises(InputError, match="unknown fidelity"):
        solve(analysis, fidelity="shells")
    with pytest.raises(InputError, match="an analysis is needed"):
        solve(3)
    with pytest.raises(InputError, match="number of threads is below 1"):
        solve(analysis, threads=0)


def test_progress_is_reported_and_a_cancelled_run_keeps_its_results():
    reported = []
    result = solve(loads(TEXT), progress=reported.append)
    assert result.status is Status.COMPLETE
    assert reported == sorted(reported)
    assert 0.0 <= reported[0] <= reported[-1] <= 1.0
    shares = [0.0]
    long = loads(TEXT.replace("accuracy: 1e-3", "accuracy: 1e-10"))
    cancelled = solve(long, progress=shares.append, cancel=lambda: shares[-1] > 0.0)
    assert cancelled.status is Status.CANCELLED
    assert re.fullmatch(r"stopped on request; the last output is at [0-9.]+ ms of 100 ms", cancelled.reason)
    # without an output after the start there is nothing to keep
    nothing = solve(loads(TEXT), cancel=lambda: True)
    assert nothing.status is Status.CANCELLED
    assert nothing.time.size == 0


def test_a_filtered_channel_is_that_of_the_equally_spaced_samples():
    text = TEXT + "  filters: {smooth: {channel: node.tip.velocity.z, cfc: 60}}\n"
    # pictures at odd times make the recorded times unequal
    result = solve(loads(text.replace("pictures: [0 ms,", "pictures: [0.123 ms, 0.777 ms,")))
    assert "smooth" in result.output_names
    assert result.channels["smooth"].unit == "m/s"
    regular = np.flatnonzero(np.isclose(result.time / 0.5e-3, np.round(result.time / 0.5e-3)))
    assert regular.size == result.time.size - 2 == 201
    raw = result["node.tip.velocity.z"]
    np.testing.assert_allclose(result["smooth"][regular], cfc(raw[regular], 0.5e-3, 60), atol=1e-9)
    assert np.max(np.abs(result["smooth"] - raw)) > 1e-3 * np.max(np.abs(raw))


def test_a_run_that_ended_early_reports_missing_filters():
    analysis = loads(TEXT + "  filters: {smooth: {channel: node.tip.velocity.z, cfc: 60}}\n")
    whole = solve(analysis)
    channels = {name: replace(channel, values=channel.values[:3]) for name, channel in whole.channels.items()}
    channels.pop("smooth")
    short = with_filters(
        replace(whole, time=whole.time[:3], channels=channels), analysis.outputs, analysis.output_interval
    )
    assert "smooth" not in short.channels
    assert any("smooth" in warning for warning in short.warnings)


def test_a_solver_refuses_what_it_would_leave_out():
    joints = "joints:\n  j: {node: root, member: tube, type: revolute, axis: [0, 1, 0]}\n"
    forces = "  section_forces: {f: {member: tube, at: 0.5 m}}\n"
    text = TEXT.replace("supports:\n", joints + "supports:\n") + forces
    with pytest.raises(InputError) as refused:
        solve(loads(text), "shell")
    assert {problem.where for problem in refused.value.problems} == {"joints", "outputs.section_forces"}
    assert solve(loads(text)).status.ok


def test_without_filters_times_of_any_length_cost_nothing():
    analysis = loads(TEXT)
    whole = solve(analysis)
    late = replace(whole, time=whole.time * 1e9)
    assert with_filters(late, analysis.outputs, analysis.output_interval) is late
