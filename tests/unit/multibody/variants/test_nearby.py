"""Range from the laws and modes in one call: the same bits as alone; what both need is solved once."""

from pathlib import Path

import pytest

from crumple.analysis import loads, solve, with_law_range, with_modes, with_range_and_modes
from crumple.analysis.solve import run_of
from crumple.multibody import law_range, modes, range_and_modes, solve_variants

RAIL = Path("examples/08_s_rail.yaml").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def solved():
    analysis = loads(RAIL)
    rigid = analysis.multibody.model_copy(update={"members": "rigid"})
    analysis = analysis.model_copy(update={"multibody": rigid})
    return analysis, solve(analysis)


def test_both_are_those_of_two_calls(solved):
    analysis, result = solved
    alone = with_modes(with_law_range(result, analysis), analysis)
    both = with_range_and_modes(result, analysis)
    assert alone.law_range is not None
    assert alone.modes is not None
    assert (both.law_range, both.modes) == (alone.law_range, alone.modes)
    assert (both.warnings, both.cautions) == (alone.warnings, alone.cautions)


def test_a_run_that_both_need_is_solved_once(solved, monkeypatch):
    analysis, result = solved
    counts = []

    def counted(structure, run, columns, *rest, **options):
        table = solve_variants(structure, run, columns, *rest, **options)
        counts.append(len(table))
        return table

    for name in ("law_range", "modes", "nearby"):
        monkeypatch.setattr(f"crumple.multibody.variants.{name}.solve_variants", counted)
    whole, run = analysis.structure, run_of(analysis)
    law_range(whole, run, result)
    modes(whole, run, result)
    range_and_modes(whole, run, result)
    ranged, moded, both = counts
    # with two hinges all four patterns of the modes are laws alternately low and high
    assert both == ranged + moded - 4
