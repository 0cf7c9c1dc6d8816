"""Inverse design: the lightest walls are those of the whole grid, ranking, refusals with lines."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from tests.support.short_layouts import short_layout

from crumple.analysis import load
from crumple.analysis.solve import run_of
from crumple.errors import InputError
from crumple.multibody import solve_variants
from crumple.structure import changed
from crumple.study import LoadedTarget, check_target, run_target

TUBE = Path("examples/01_tube_bending.yaml").resolve()
TURN = "rotation: {channel: hinge.root.rotation, at_most: 20 deg}"
SIZES = "sizes: [2 mm, 2.5 mm, 3 mm, 3.2 mm, 3.5 mm, 4 mm, 4.5 mm, 5 mm, 6 mm]"


def written(folder, criterion=TURN, walls=SIZES, bases=(TUBE,), more=""):
    file = folder / "target.yaml"
    lines = ["crumple_study: 1", "bases:", *(f"  - {base}" for base in bases), "target:"]
    lines += ["  criteria:", f"    {criterion}", f"  {walls}", more]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def test_the_lightest_size_is_that_of_all_sizes(tmp_path):
    (found,) = run_target(LoadedTarget(written(tmp_path)), tmp_path / "out")
    analysis = load(TUBE)
    sizes = np.array([0.002, 0.0025, 0.003, 0.0032, 0.0035, 0.004, 0.0045, 0.005, 0.006])
    table = solve_variants(analysis.structure, run_of(analysis), {"sections.tube.thickness": sizes})
    sound = sizes[table["hinge.root.rotation_max"] <= np.radians(20.0)]
    wall = float(sound.min())
    assert found.answer.best["variables"] == {"tube": wall}
    mass = changed(analysis.structure, {"sections.tube.thickness": wall}).mass_of_members
    assert found.mass == pytest.approx(mass, rel=1e-12)


def test_of_two_walls_the_lightest_pair_is_found_without_solving_all(tmp_path):
    """Against all 16 pairs of a frame in space."""
    criterion = "intrusion: {channel: intrusion, take: final, at_least: -112 mm}"
    cab = short_layout("strong_beam", tmp_path)
    file = written(tmp_path, criterion, "sizes: [2 mm, 2.5 mm, 3 mm, 4 mm]", (cab,))
    (found,) = run_target(LoadedTarget(file), tmp_path / "out", 2)
    analysis = load(cab)
    sizes = np.array([0.002, 0.0025, 0.003, 0.004])
    tube, beam = (grid.ravel() for grid in np.meshgrid(sizes, sizes))
    paths = "sections.tube.thickness", "sections.beam.thickness"
    table = solve_variants(analysis.structure, run_of(analysis), dict(zip(paths, (tube, beam), strict=True)))
    pairs = zip(tube.tolist(), beam.tolist(), strict=True)
    masses = [
        changed(analysis.structure, dict(zip(paths, pair, strict=True))).mass_of_members for pair in pairs
    ]
    best = int(np.argmin(np.where(table["intrusion"] >= -0.112, masses, np.inf)))
    assert 0 < np.sum(table["intrusion"] >= -0.112) < 16
    assert found.answer.best["variables"] == {"tube": tube[best], "beam": beam[best]}
    assert found.answer.rows < 16


def test_a_continuous_wall_is_within_a_step_of_a_fine_grid(tmp_path):
    file = written(tmp_path, walls="low: 2 mm\n  high: 6 mm\n  rows: 320")
    (found,) = run_target(LoadedTarget(file), tmp_path / "out")
    analysis = load(TUBE)
    grid = np.arange(3.9e-3, 4.5e-3, 0.01e-3)
    table = solve_variants(analysis.structure, run_of(analysis), {"sections.tube.thickness": grid})
    first = grid[table["hinge.root.rotation_max"] <= np.radians(20.0)][0]
    assert first > grid[0]
    assert first - 0.01e-3 <= found.answer.best["variables"]["tube"] <= first + 0.01e-3


def test_ranking_of_several_bases(tmp_path, run_command):
    soft = tmp_path / "soft.yaml"
    text = TUBE.read_text()
    # a tube of which no size is enough, and one that needs less
    soft.write_text(text.replace("yield_stress: 488 MPa", "yield_stress: 100 MPa"), encoding="utf-8")
    strong = tmp_path / "strong.yaml"
    strong.write_text(text.replace("yield_stress: 488 MPa", "yield_stress: 700 MPa"), encoding="utf-8")
    file, out = written(tmp_path, bases=(soft, TUBE, strong)), tmp_path / "out"
    code, said, _ = run_command("study", file, "--out", out)
    assert code == 0
    assert "1. strong" in said
    assert "3. soft: no variant of 9 keeps all criteria" in said
    rows = list(csv.DictReader((out / "ranking.csv").read_text(encoding="utf-8").splitlines()))
    assert [row["name"] for row in rows] == ["strong", "01_tube_bending", "soft"]
    assert float(rows[0]["mass"]) < float(rows[1]["mass"])
    assert rows[2]["mass"] == ""
    assert [one["rank"] for one in json.loads((out / "ranking.json").read_text())] == [1, 2, 3]
    before = (out / "ranking.csv").read_bytes()
    assert run_command("study", file, "--out", out, "--resume", "--workers", "3")[0] == 0
    assert (out / "ranking.csv").read_bytes() == before
    assert run_command("study", written(tmp_path, bases=(soft,)), "--out", tmp_path / "none")[0] == 1
    assert run_command("check", file)[0] == 0


@pytest.mark.parametrize(
    ("criterion", "walls", "said", "line"),
    [
        (TURN.replace("root", "rot"), SIZES, "no such channel", 6),
        (TURN.replace("20 deg", "20 mm"), SIZES, "20 mm", 6),
        (TURN.replace("at_most: 20 deg", "take: max"), SIZES, "limit is missing", 6),
        (TURN, "sizes: [2 mm, 3 kg]", "3 kg", 4),
        (TURN, "low: 2 mm", "thicknesses are not given", 4),
        (TURN, f"{SIZES}\n  low: 2 mm\n  high: 3 mm", "thicknesses are not given", 4),
        (TURN, f"{SIZES}\n  sections: [beam]", "none of these sections", 8),
        (TURN.replace("rotation:", "mass:", 1), SIZES, "is called 'mass'", 6),
        (TURN.replace("rotation:", "tube:", 1), SIZES, "name of a section", 6),
        (TURN.replace("at_most", "at_least_"), SIZES, "at_least_", 6),
    ],
)
def test_mistakes_have_lines(tmp_path, criterion, walls, said, line):
    with pytest.raises(InputError, match=said) as refused:
        check_target(LoadedTarget(written(tmp_path, criterion, walls)))
    assert {problem.line for problem in refused.value.problems} == {line}


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (f"bases:\n  - {TUBE}", "title: none", "the base input is missing"),
        (f"  - {TUBE}", f"  - {TUBE}\n  - other/{TUBE.name}", "two bases have the same name"),
        (f"criteria:\n    {TURN}", "criteria: {}", "no criterion is given"),
    ],
)
def test_missing_parts(tmp_path, old, new, said):
    file = written(tmp_path)
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(InputError, match=said) as refused:
        LoadedTarget(file)
    assert all(problem.file == str(file) for problem in refused.value.problems)


def test_a_target_is_verified(tmp_path, run_command):
    """The same wall; its values are those of the verification."""
    (plain,) = run_target(LoadedTarget(written(tmp_path)), tmp_path / "plain")
    more = "verify: {best: 1, sample: 2, fidelity: multibody}"
    (found,) = run_target(LoadedTarget(written(tmp_path, more=more)), tmp_path / "out")
    assert found.best["variables"] == plain.best["variables"]
    assert found.mass == pytest.approx(plain.mass, rel=1e-12)
    assert found.best["responses"]["rotation"] == plain.best["responses"]["rotation"]
    assert found.answer.verification["best"]["keeps_constraints"]
    assert (tmp_path / "out" / "01_tube_bending" / "verify.sqlite").exists()
    # with a reserve of a tenth the walls keep 18 degrees
    file = written(tmp_path, more=more.replace("best: 1", "best: 1, reserve: 0.1"))
    assert run_command("study", file, "--out", tmp_path / "clear")[0] == 0
    clear = json.loads((tmp_path / "clear" / "ranking.json").read_text())[0]["best"]
    assert clear["responses"]["rotation"] <= np.radians(18.0)
    assert clear["responses"]["mass"] > plain.mass


def test_a_target_whose_lightest_walls_are_not_confirmed(tmp_path, monkeypatch):
    from crumple.study import target

    monkeypatch.setattr(target, "_confirmed", lambda answer: None)
    more = "verify: {best: 1, sample: 0, fidelity: multibody}"
    (found,) = run_target(LoadedTarget(written(tmp_path, more=more)), tmp_path / "out")
    assert found.best is None
    assert "confirms none" in found.reason
    assert found.mass == np.inf
