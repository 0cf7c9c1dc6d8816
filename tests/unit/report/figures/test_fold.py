"""Close-ups of folds and colours of plastic strain."""

import dataclasses

import numpy as np
import pytest
from tests.support.shell.structures import thrown

from crumple.report import ReportInput, write_report
from crumple.report.drawing.strain import SCALE, largest_strain, wall_colours
from crumple.report.figures.fold import folds, found_folds
from crumple.shell import ShellRun, solve_shell
from crumple.structure import Outputs, ShellSettings


@pytest.fixture(scope="module")
def result():
    settings = ShellSettings(element_size=25e-3)
    return solve_shell(thrown(), ShellRun(15e-3, 1e-3, settings, Outputs(pictures=(0.0, 7e-3, 15e-3))))


def with_strain(states, member_station, value):
    """States with one strained wall at a station."""
    strain = np.zeros_like(states.cell_data["plastic_strain"])
    middle = states.station[states.quads].mean(axis=1)
    for station, amount in zip(member_station, value, strict=True):
        strain[-1, int(np.argmin(np.abs(middle - station)))] = amount
    return dataclasses.replace(states, cell_data={"plastic_strain": strain})


def test_fold_is_found_where_the_strain_is(result):
    (fold,) = found_folds(result.states)
    assert fold.member == "tube"
    assert fold.station < 0.06


def test_two_folds_apart_are_two_and_a_faint_one_is_none(result):
    states = with_strain(result.states, (0.2, 0.8, 0.5), (0.3, 0.2, 0.01))
    assert [round(fold.station, 1) for fold in found_folds(states)] == [0.2, 0.8]


def test_neighbouring_strain_is_one_fold(result):
    assert len(found_folds(with_strain(result.states, (0.20, 0.24), (0.3, 0.29)))) == 1


def test_colours_run_from_wall_to_dark(result):
    states = with_strain(result.states, (0.2,), (0.3,))
    top = largest_strain(states)
    assert top == pytest.approx(0.3)
    colours = wall_colours(states, -1, top)
    assert len(np.unique(colours, axis=0)) == 2
    assert colours.sum(axis=1).min() == pytest.approx(
        sum(int(SCALE[-1][i : i + 2], 16) for i in (1, 3, 5)) / 255
    )


def test_result_without_strain_has_no_close_up(result):
    bare = dataclasses.replace(result.states, cell_data={})
    assert folds(dataclasses.replace(result, states=bare)) == []
    assert folds(dataclasses.replace(result, states=None)) == []
    assert largest_strain(bare) == 0.0


def test_page_shows_the_fold_and_no_law(result, tmp_path):
    page = write_report(result, ReportInput(), tmp_path).read_text(encoding="utf-8")
    assert "Member tube around" in page
    assert "plastic strain" in page
    assert "Hinge laws" not in page
    assert "and its law" not in page
    assert "hourglass and contact" in page
    assert (tmp_path / "figures" / "fold_1.svg").exists()
