"""Scatter of a run with its input: known probabilities and quantiles, refusals with lines, files, page."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.special import ndtri

from crumple.analysis import check, load, solve
from crumple.analysis.criteria import with_criteria
from crumple.analysis.solve import run_of
from crumple.errors import InputError, Status
from crumple.multibody import solve_variants
from crumple.report.wording.scatter import criterion_sentences
from crumple.result import read, write
from crumple.structure import changed
from crumple.study import with_uncertainty

TUBE = Path("examples/01_tube_bending.yaml").read_text()
SPEED = """
    speed:
      path: initial_velocity
      distribution: {type: normal, mean: 1, deviation: 0.05}
      source: assumed
"""


def written(folder, criteria="", variables=SPEED, rows=400):
    file = folder / "tube.yaml"
    block = f"\nuncertainty:\n  rows: {rows}\n  variables:{variables}" if variables else ""
    file.write_text(TUBE + (f"\ncriteria:\n{criteria}" if criteria else "") + block)
    return file


def test_a_known_probability_lies_in_its_interval(tmp_path):
    """The rotation rises with the speed alone, so it is below that of the speed's 80 % quantile with 80 %."""
    plain = load(written(tmp_path, variables=""))
    factor = 1.0 + 0.05 * ndtri(0.8)
    at = solve_variants(plain.structure, run_of(plain), {"initial_velocity": [factor]})
    limit = float(np.degrees(at["hinge.root.rotation_max"][0]))
    criteria = f"  turn: {{channel: hinge.root.rotation, at_most: {limit!r} deg}}\n"
    analysis = load(written(tmp_path, criteria, rows=2000))
    found = with_uncertainty(solve(analysis), analysis).scatter
    (chance,) = found.chances
    assert chance.rows == found.complete == 2000
    assert chance.interval[0] < 0.8 < chance.interval[1]
    assert chance.interval[1] - chance.interval[0] < 0.04
    # quantiles of the speed give those of the rotation, to the error of 2000 points
    (swing,) = found.swings
    final = abs(np.array(found.bands["hinge.root.rotation"])[:, -1])
    spread = swing.high - swing.low
    assert abs(final[2] - swing.low) < 0.1 * spread
    assert abs(final[1] - swing.middle) < 0.05 * spread
    assert abs(final[0] - swing.high) < 0.1 * spread


def test_variants_that_were_stopped_are_not_those_that_failed(tmp_path):
    # so many that they take hundreds of times the interval at which the kernel asks whether to go on
    rows = 20_000
    analysis, shares = load(written(tmp_path, rows=rows)), [0.0]
    result = solve(analysis)
    found = with_uncertainty(result, analysis, 1, shares.append, lambda: shares[-1] > 0.0).scatter
    (note,) = (note for note in found.notes if "variants" in note and "criterion" not in note)
    assert note == f"{rows - found.complete} of {rows} variants were not solved: stopped on request"
    assert 0 < found.complete < rows


@pytest.mark.parametrize("name", ["01_tube_bending", "08_s_rail"])
def test_histories_of_variants_are_those_of_runs(name):
    """With the accuracy and the output times of `solve` they have its bits, in a plane and in space."""
    analysis = load(f"examples/{name}.yaml")
    result, run = solve(analysis), run_of(analysis)
    settings = run.settings.model_copy(update={"accuracy": run.settings.accuracy / 4.0})
    fine = replace(run, settings=settings)
    table = solve_variants(analysis.structure, fine, {"initial_velocity": [1.0, 1.0]}, times=result.time)
    shared = [channel for channel in table.histories if channel in result.channels]
    assert len(shared) > 10
    for channel in shared:
        np.testing.assert_array_equal(table.histories[channel][1], result[channel], err_msg=channel)


def test_variants_that_end_early_have_no_later_values():
    analysis = load("examples/01_tube_bending.yaml")
    times = np.linspace(0.0, analysis.duration, 5)
    fast = solve_variants(
        analysis.structure, run_of(analysis), {"initial_velocity": [1.0, 1e100]}, times=times
    )
    history = fast.histories["hinge.root.rotation"]
    assert fast.status[1] is Status.STALLED
    assert np.isfinite(history[0]).all()
    assert history[1, 0] == 0.0
    assert np.isnan(history[1, 1:]).all()
    table = solve_variants(
        analysis.structure, run_of(analysis), {"masses.payload.mass": [6.0, -60.0]}, times=times
    )
    assert table.status[1] is Status.REFUSED
    history = table.histories["hinge.root.rotation"]
    assert np.isfinite(history[0]).all()
    assert np.isnan(history[1]).all()


def test_masses_and_walls_together_are_a_change_of_the_input():
    """The hinge moves with the wall, and the mass of a lump is shared between such variants."""
    analysis = load("examples/01_tube_bending.yaml")
    walls, masses = [0.0020, 0.0026, 0.0031], [5.0, 6.5, 7.0]
    paths = "sections.tube.thickness", "masses.payload.mass"
    run = run_of(analysis)
    together = solve_variants(analysis.structure, run, dict(zip(paths, (walls, masses), strict=True)))
    for i, values in enumerate(zip(walls, masses, strict=True)):
        one = changed(analysis.structure, dict(zip(paths, values, strict=True)))
        alone = solve_variants(one, run, {"initial_velocity": [1.0]})
        assert together["hinge.root.rotation_max"][i] == pytest.approx(
            alone["hinge.root.rotation_max"][0], rel=1e-9
        )


def test_sections_with_other_walls_have_other_hashes():
    structure = load("examples/01_tube_bending.yaml").structure
    tube = structure.sections["tube"]
    hashes = {hash(tube.model_copy(update={"thickness": 0.002 + 1e-6 * i})) for i in range(50)}
    assert len(hashes) == 50


@pytest.mark.parametrize(
    ("change", "what"),
    [
        (("source: assumed", ""), "source"),
        (("path: initial_velocity", "path: sections.tube.thicknes"), "thicknes"),
        (("path: initial_velocity", "path: speed"), "no such factor"),
        (("path: initial_velocity\n", "\n"), "the path is missing"),
        ((SPEED, " {}"), "no variable scatters"),
        (("path: initial_velocity", "path: sections.tube.thickness"), "unit is missing"),
        (("deviation: 0.05", "deviation: -0.05"), "not a distribution"),
        (
            ("type: normal, mean: 1, deviation: 0.05", "type: uniform, low: 1, high: 0.9"),
            "not a distribution",
        ),
    ],
)
def test_mistakes_have_lines(tmp_path, change, what):
    file = written(tmp_path, variables=SPEED.replace(*change))
    with pytest.raises(InputError, match=what) as caught:
        load(file)
    assert all(problem.line > TUBE.count("\n") for problem in caught.value.problems)


@pytest.mark.parametrize(
    ("criterion", "what"),
    [
        ("{channel: hinge.rot.rotation, at_most: 25 deg}", "no such channel"),
        ("{channel: hinge.root.rotation, at_most: 25 mm}", "25 mm"),
        ("{channel: hinge.root.rotation}", "limit is missing"),
        (
            "{channel: hinge.root.rotation, at_most: 5 deg, at_least: 20 deg}",
            "no value is within both limits",
        ),
        ("{channel: hinge.root.rotation, take: at, at_most: 25 deg}", "belong together"),
        ("{channel: hinge.root.rotation, take: at, time: 5 s, at_most: 25 deg}", "after the end of the run"),
    ],
)
def test_check_refuses_criteria_that_cannot_be_judged(tmp_path, criterion, what):
    (problem,) = check(written(tmp_path, f"  turn: {criterion}\n"))
    assert what in str(problem)
    assert problem.line > TUBE.count("\n")


def test_a_run_that_ended_early_decides_only_what_cannot_change(tmp_path):
    turn = "channel: hinge.root.rotation"
    criteria = f"""
  most: {{{turn}, at_most: 33 deg}}
  beyond: {{{turn}, at_most: 1 deg}}
  least: {{{turn}, at_least: 40 deg}}
  last: {{{turn}, take: final, at_most: 1 deg}}
  before: {{{turn}, take: at, time: 1 ms, at_least: -90 deg}}
  later: {{{turn}, take: at, time: 50 ms, at_most: 1 deg}}
"""
    analysis = load(written(tmp_path, criteria, variables=""))
    whole = solve(analysis)
    rows = int(np.searchsorted(whole.time, 0.03))
    channels = {
        name: replace(channel, values=channel.values[:rows]) for name, channel in whole.channels.items()
    }
    cut = replace(whole, status=Status.CANCELLED, time=whole.time[:rows], channels=channels)
    judged = with_criteria(cut, analysis.criteria)
    assert [one.kept for one in judged.criteria] == [None, False, None, None, True, None]
    said = list(criterion_sentences(judged))
    assert said[0].startswith(
        "Criterion most not decided: the run ended early, largest hinge.root.rotation is"
    )
    assert "ended before" in said[5]
    # a stage that `until` ends early completes, but not the time of the criterion
    ended = with_criteria(replace(cut, status=Status.COMPLETE), analysis.criteria)
    assert [one.kept for one in ended.criteria] == [True, False, False, True, True, None]


def test_files_and_page(tmp_path, run_command):
    criteria = "  turn: {channel: hinge.root.rotation, at_most: 33 deg}\n"
    file, out = written(tmp_path, criteria, rows=50), tmp_path / "out"
    said = run_command("run", str(file), "--out", str(out))[1]
    assert "Criterion turn kept" in said
    assert re.search(r"Within this model \d", said)
    summary = json.loads((out / "summary.json").read_text())
    assert summary["criteria"][0]["kept"] is True
    assert summary["scatter"]["chances"][0]["rows"] == 50
    assert summary["scatter"]["sources"] == {"speed": "assumed"}
    page = (out / "report.html").read_text()
    assert "Within this model" in page
    assert "range from the bands of the laws" in page
    head = (out / "bands.csv").read_text().splitlines()[0]
    assert head.startswith("time,hinge.root.rotation.q2.5")
    stored = read(out)
    write(stored, tmp_path / "again")
    assert read(tmp_path / "again").scatter == stored.scatter
    said = run_command("run", str(file), "--out", str(out), "--no-uncertainty")[1]
    assert "Within this model" not in said
    assert not (out / "bands.csv").exists()
