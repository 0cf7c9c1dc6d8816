"""Zones of nodes do not end in the middle of a fold where an obstacle strikes."""

import pytest
from tests.support.structures import STEEL

from crumple.comparison.measure.measures import REACH, _borders
from crumple.section import half_fold_length
from crumple.structure import Structure

TUBE = {"type": "square_tube", "side": 0.042, "thickness": 2e-3}
REACHES = REACH * 0.04


def beam(station):
    pole = {
        "type": "cylinder", "point": (station, 0.0, 0.1), "axis": (0.0, 1.0, 0.0), "radius": 0.03,
        "mass": 20.0, "velocity": (0.0, 0.0, -3.0),
    }  # fmt: skip
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"a": (0.0, 0.0, 0.0), "b": (1.0, 0.0, 0.0)},
        members={"bar": {"nodes": ("a", "b"), "section": "tube", "material": "steel"}},
        hinges="auto",
        supports={n: {"node": n, "fix": "all"} for n in "ab"},
        obstacles={"pole": pole},
    )


def test_borders_away_from_the_fold_stay():
    assert _borders(beam(0.5), "bar") == pytest.approx((REACHES, 1.0 - REACHES))


@pytest.mark.parametrize("off", [-4e-4, 4e-4])
def test_a_border_in_a_fold_moves_half_a_fold_away_from_it(off):
    structure = beam(REACHES + off)
    half = half_fold_length(structure.section_of("bar"))
    low, high = _borders(structure, "bar")
    # the fold stays on its side of the border
    assert low - (REACHES + off) == pytest.approx(-half if off > 0 else half)
    assert high == pytest.approx(1.0 - REACHES)
    low, high = _borders(beam(1.0 - REACHES + off), "bar")
    assert low == pytest.approx(REACHES)
    assert high - (1.0 - REACHES + off) == pytest.approx(-half if off > 0 else half)
