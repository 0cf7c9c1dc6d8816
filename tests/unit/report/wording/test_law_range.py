"""The table of ranges: what the laws do not change is left out, what is next to nothing is 0."""

import math
from types import SimpleNamespace

from crumple.report.wording.law_range import range_rows
from crumple.result.nearby import LawRange


def result_with(ranges):
    hinges = {
        name: SimpleNamespace(rotation_max=math.radians(20.0), energy=700.0)
        for name in ("knee", "foot", "tip")
    }
    return SimpleNamespace(law_range=LawRange(ranges, {}, (), ()), hinges=hinges)


def test_widest_ranges_come_first_and_negligible_ones_are_left_out():
    rows = range_rows(
        result_with(
            {
                "hinge.tip.rotation_max": (1e-10, 3e-10),
                "hinge.foot.rotation_max": (1e-10, math.radians(10.0)),
                "hinge.knee.rotation_max": (math.radians(10.0), math.radians(30.0)),
                "hinge.knee.energy": (600.0, 600.0 + 1e-7),
            }
        )
    )
    assert [row[0] for row in rows] == ["hinge.knee.rotation_max", "hinge.foot.rotation_max"]
    assert rows[0][1:] == ("deg", "20", "10", "30")
    assert rows[1][3:] == ("0", "10")


def test_rounding_of_what_stands_still_is_no_range():
    """Where the hinges that turn have no band, all that differs are the energies of those that do not."""
    found = result_with({"hinge.foot.energy": (-1.3e-14, 1.6e-14), "hinge.knee.energy": (700.0, 700.0)})
    assert range_rows(found) == []


def test_without_bands_there_are_no_rows():
    assert range_rows(SimpleNamespace(law_range=None)) == []
