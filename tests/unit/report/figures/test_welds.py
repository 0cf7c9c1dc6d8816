"""Loads of spot welds on the page: which entries are drawn, what they are called, when there is nothing."""

from dataclasses import replace

import numpy as np
import pytest
from tests.support.result.synthetic_tube import tube_result

from crumple.report import ReportInput, write_report
from crumple.report.drawing.style import drawing
from crumple.report.figures.welds import MOST_FORCES, MOST_RATIOS, weld_loads
from crumple.result import Channel


def with_welds(names, *, fail=True):
    """A result with entries of spot welds, the later ones loaded more."""
    result = tube_result()
    ramp = np.linspace(0.0, 1.0, len(result.time))
    channels = {}
    for i, name in enumerate(names, 1):
        load = i / len(names) * ramp
        parts = {
            "failed": ("1", 0.0 * ramp),
            "normal_force": ("N", 500.0 * load),
            "shear_force": ("N", 3e3 * load),
        }
        if fail:
            parts["use"] = ("1", load**2)
        channels |= {f"weld.{name}.{key}": Channel("", unit, values) for key, (unit, values) in parts.items()}
    return replace(result, channels={**result.channels, **channels})


def drawn(result):
    with drawing():
        return weld_loads(result)


def test_without_welds_there_is_no_figure():
    assert drawn(tube_result()) is None


def test_the_most_loaded_entries_are_drawn_and_counted():
    names = [f"seam{i}" for i in range(9)]
    svg, caption = drawn(with_welds(names))
    for name in names[-MOST_RATIOS:]:
        assert f">{name}<" in svg
    assert not any(f">{name}<" in svg for name in names[:-MOST_RATIOS])
    assert svg.count(", across<") == svg.count(", along<") == MOST_FORCES
    assert ">seam8, along<" in svg
    assert "Largest force in a spot, kN" in svg
    assert "The 6 most loaded of 9 entries" in caption
    assert "of the 3 most loaded of 9 entries" in caption


def test_welds_that_cannot_fail_show_forces_alone():
    svg, caption = drawn(with_welds(["seam"], fail=False))
    assert "Load over strength" not in svg + caption
    assert "Largest force across" in caption


@pytest.mark.parametrize(("names", "shown"), [((), False), (("seam",), True)])
def test_the_page_of_a_run_shows_them(tmp_path, names, shown):
    page = write_report(with_welds(names), ReportInput(), tmp_path).read_text(encoding="utf-8")
    assert ("<summary>Spot welds</summary>" in page) == shown
    assert (tmp_path / "figures" / "welds.svg").is_file() == shown
