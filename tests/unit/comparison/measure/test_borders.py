"""Zones of nodes do not end in the middle of a fold where an obstacle strikes."""

import numpy as np
import pytest
from tests.support.structures import STEEL

from crumple.analysis import Analysis, solve
from crumple.comparison import with_frames
from crumple.comparison.measure.measures import REACH, _borders, measure
from crumple.section import half_fold_length
from crumple.structure import Structure

REACHES = REACH * 0.04


def beam(station, thickness=2e-3):
    pole = {
        "type": "cylinder", "point": (station, 0.0, 0.1), "axis": (0.0, 1.0, 0.0), "radius": 0.03,
        "mass": 20.0, "velocity": (0.0, 0.0, -3.0),
    }  # fmt: skip
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": {"type": "square_tube", "side": 0.04 + thickness, "thickness": thickness}},
        nodes={"a": (0.0, 0.0, 0.0), "b": (1.0, 0.0, 0.0)},
        members={"bar": {"nodes": ("a", "b"), "section": "tube", "material": "steel"}},
        hinges="auto",
        supports={n: {"node": n, "fix": "all"} for n in "ab"},
        obstacles={"pole": pole},
    )


@pytest.mark.parametrize("station", [REACHES, 0.6 * REACHES])
def test_a_hinge_at_a_border_turns_one_side_of_it_or_the_other(station):
    parts = beam(0.5)
    bar = {
        "nodes": ("a", "b"),
        "section": "tube",
        "material": "steel",
        "hinges": [{"name": "fold", "at": station}],
    }
    whole = Structure(
        materials=parts.materials,
        sections=parts.sections,
        nodes=parts.nodes,
        members={"bar": bar},
        supports={"a": {"node": "a", "fix": "all"}},
        masses={"load": {"node": "b", "mass": 10.0}},
        initial_velocity=[{"translation": (0.0, 0.0, -8.0), "nodes": ["b"]}],
    )
    result = solve(with_frames(Analysis(structure=whole, duration=0.02)))
    (turned,) = (abs(hinge.rotation_final) for hinge in result.hinges.values())
    shares = [np.linalg.norm(measure(result, whole).rotations[name]) for name in ("a, bar", "span of bar")]
    assert turned > 0.05
    assert max(shares) == pytest.approx(turned, rel=1e-3)
    assert min(shares) < 1e-3 * turned


def test_borders_away_from_the_fold_stay():
    assert _borders(beam(0.5), "bar") == pytest.approx((REACHES, 1.0 - REACHES))


def test_a_zone_takes_half_the_way_to_the_place_that_an_obstacle_strikes():
    low, high = _borders(beam(0.12), "bar")
    assert (low, high) == pytest.approx((0.06, 1.0 - REACHES))
    low, high = _borders(beam(0.88), "bar")
    assert (low, high) == pytest.approx((REACHES, 0.94))


@pytest.mark.parametrize("off", [-4e-4, 4e-4])
def test_a_border_in_a_fold_beside_that_of_the_node_moves_half_a_fold_away_from_it(off):
    """The walls are so thick that half the way to the obstacle would cut through the fold at the node."""
    place = REACHES + off
    structure = beam(place, thickness=3e-3)
    half = half_fold_length(structure.section_of("bar"))
    assert place / 2 < 2.0 * half < place
    low, high = _borders(structure, "bar")
    # the fold stays on its side of the border
    assert low - place == pytest.approx(-half if off > 0 else half)
    assert high == pytest.approx(1.0 - REACHES)
    low, high = _borders(beam(1.0 - place, thickness=3e-3), "bar")
    assert low == pytest.approx(REACHES)
    assert high - (1.0 - place) == pytest.approx(half if off > 0 else -half)
