"""Range of a result from the bands of its laws: edges of the bands, laws without one, where it is kept."""

import json

import pytest
from tests.support.multibody.frames import THROWN, member, structure
from typer.testing import CliRunner

from crumple.cli.main import app
from crumple.hinge import build_law
from crumple.multibody import Run, law_range, solve_multibody
from crumple.result import read, summary, write

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
    from dataclasses import replace

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
