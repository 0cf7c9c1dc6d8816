"""Range of a result from the bands of its laws: edges of the bands, laws without one, where it is kept."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from tests.support.multibody.frames import THROWN, member, structure
from tests.support.structures import STEEL, TUBE
from typer.testing import CliRunner

from crumple.analysis import load, solve
from crumple.analysis.solve import run_of
from crumple.cli.main import app
from crumple.errors import CancelledError, Status
from crumple.hinge import build_law
from crumple.multibody import Run, law_range, solve_multibody, solve_variants
from crumple.multibody.variants.law_range import run_as_solved
from crumple.result import read, summary, write
from crumple.structure import MultibodySettings, Stage, Structure

RUN = Run(duration=0.3, every=1e-3)
TIP = {"tip": {"node": "b", "mass": 5.0}}


def bar(law, **keys):
    hinge = ("h", 0.05, {"law": law})
    return structure(members={"bar": member("a", "b", hinge)}, masses=TIP, initial_velocity=THROWN, **keys)


def solved(whole):
    result = solve_multibody(whole, RUN)
    return result, law_range(whole, RUN, result, 1)


def test_the_range_is_that_of_runs_with_the_edges_of_the_band():
    _, found = solved(bar("kecman"))
    edges = [
        solve_multibody(bar({"type": "kecman", "bound": bound}), RUN).hinges["h"].rotation_max
        for bound in ("upper", "lower")
    ]
    assert edges[0] < 0.95 * edges[1]
    whole = bar("kecman")
    law = build_law("kecman", whole.section_of("bar"), whole.material_of("bar"), "y")
    assert found.bands == {"h": pytest.approx(law.validity.uncertainty)}
    assert found.of("hinge.h.rotation_max") == pytest.approx(tuple(edges), rel=2e-3)
    assert found.failed == ()


def test_a_range_that_is_stopped_is_not_one_of_runs_that_failed(monkeypatch):
    def stopped(*what, **options):
        table = solve_variants(*what, **options)
        return replace(table, status=(*table.status[1:], Status.CANCELLED))

    monkeypatch.setattr("crumple.multibody.variants.law_range.solve_variants", stopped)
    with pytest.raises(
        CancelledError, match="while the variants were solved: the range from the laws is not"
    ):
        solved(bar("kecman"))


def equal_to_the_result(whole, run, result):
    """A variant without changes has the bits of the result, which is the nominal case."""
    found = law_range(whole, run, result, 1)
    assert found.failed == ()
    unchanged = {f"hinges.{name}.capacity": [1.0] for name in found.bands}
    table = solve_variants(whole, run_as_solved(run, result), unchanged, 1, as_answer=True)
    nominal = found.cases["nominal"]
    assert nominal["energy.dissipated"] == result["energy.dissipated"][-1] > 0.0
    for name, value in nominal.items():
        hinge, _, key = name.removeprefix("hinge.").rpartition(".")
        expected = getattr(result.hinges[hinge], key) if name.startswith("hinge.") else result[name][-1]
        assert value == expected == table[name][0]


@pytest.mark.parametrize("kernel", ["tree", "spatial"])
def test_the_nominal_case_is_the_result(kernel):
    whole, run = bar("kecman"), replace(RUN, settings=MultibodySettings(kernel=kernel))
    result = solve_multibody(whole, run)
    assert result.provenance.settings["kernel"] == kernel
    equal_to_the_result(whole, run, result)


@pytest.mark.parametrize("name", ["15_crash_box", "14_rops"])
def test_the_nominal_case_of_crushed_rails_and_of_quasi_static_stages_is_the_result(name):
    analysis = load(Path("examples") / f"{name}.yaml")
    equal_to_the_result(analysis.structure, run_of(analysis), solve(analysis, checks=False))


def test_the_nominal_case_is_not_solved_again(monkeypatch):
    solved_again = []

    def counted(*what, **options):
        solved_again.append(what[2])
        return solve_variants(*what, **options)

    monkeypatch.setattr("crumple.multibody.variants.law_range.solve_variants", counted)
    _, found = solved(bar("kecman"))
    (factors,) = solved_again
    band = found.bands["h"]
    assert factors["hinges.h.capacity"].tolist() == [1.0 - band, 1.0 + band, 1.0 - band, 1.0 + band]
    assert next(iter(found.cases)) == "nominal"
    assert len(found.cases) == 5


@pytest.mark.parametrize("kind", ["dynamic", "quasi-static"])
def test_walls_that_crush_under_a_contact_do_so_in_every_case(kind):
    """A ram along a straight bar: rigid contacts cannot go on; the run is repeated with walls that crush."""
    ram = {"type": "plane", "point": (1.05, 0, 0), "normal": (-1, 0, 0), "velocity": (-0.1, 0, 0)}
    hinge = {"name": "fold", "at": 0.5, "law": {"type": "kecman"}}
    whole = Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"root": (0.0, 0.0, 0.0), "tip": (1.0, 0.0, 0.0)},
        members={
            "bar": {"nodes": ("root", "tip"), "section": "tube", "material": "steel", "hinges": [hinge]}
        },
        supports={"clamp": {"node": "root", "fix": "all"}},
        obstacles={"ram": ram},
    )
    run = Run(1.0, 0.05, stages=(Stage(name="push", kind=kind, duration=1.0),))
    result = solve_multibody(whole, run)
    assert result["energy.contact"][-1] > 1e3
    table = solve_variants(whole, run, {"hinges.fold.capacity": [1.0, 1.1]}, 1, as_answer=True)
    assert [status.ok for status in table.status] == [True, True]
    assert table["energy.contact"][0] == result["energy.contact"][-1]
    assert law_range(whole, run, result, 1).failed == ()


def test_alternating_laws_move_the_fold_from_one_hinge_to_the_next():
    """Two hinges near each other: with equal factors the first folds, weakened alone the second one does."""
    hinges = (("h", 0.05, {"law": "kecman"}), ("k", 0.12, {"law": "kecman"}))
    whole = structure(members={"bar": member("a", "b", *hinges)}, masses=TIP, initial_velocity=THROWN)
    result, found = solved(whole)
    assert result.hinges["k"].rotation_max < 0.1 * result.hinges["h"].rotation_max
    assert found.of("hinge.k.rotation_max")[1] > 0.5 * result.hinges["h"].rotation_max


def test_hinges_without_a_band_keep_their_law_and_are_listed():
    constant = {"type": "constant", "moment": 900.0}
    hinges = (("h", 0.05, {"law": "kecman"}), ("k", 0.5, {"law": constant}))
    whole = structure(members={"bar": member("a", "b", *hinges)}, masses=TIP, initial_velocity=THROWN)
    _, found = solved(whole)
    assert (set(found.bands), found.without) == ({"h"}, ("k",))
    assert solved(bar(constant))[1] is None


def test_the_range_is_written_and_read_with_the_result(tmp_path):
    result, found = solved(bar("kecman"))
    result = replace(result, law_range=found)
    write(result, tmp_path)
    assert read(tmp_path).law_range == found
    assert summary(result)["law_range"]["ranges"]["hinge.h.energy"] == list(found.of("hinge.h.energy"))


def test_the_command_prints_the_range_unless_it_is_switched_off(tmp_path):
    def run(*options):
        arguments = ["run", "examples/12_l_frame.yaml", "--out", str(tmp_path / "out"), *options]
        found = CliRunner().invoke(app, arguments)
        assert found.exit_code == 0, found.output
        text = (tmp_path / "out" / "summary.json").read_text(encoding="utf-8")
        page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
        return found.output, json.loads(text)["law_range"], page

    output, kept, page = run()
    assert "Range from the laws (a range, not a bound): hinge." in output
    assert kept["ranges"]["hinge.corner-corner.rotation_max"][1] > 0.1
    assert "It is a range, not a bound." in page
    output, kept, page = run("--no-law-range")
    assert "Range from the laws" not in output
    assert kept is None
    assert "It is a range, not a bound." not in page
