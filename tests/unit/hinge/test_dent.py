"""Dents of tubes: force, work, the moment that is left, and the motion of the walls."""

import math

import numpy as np
import pytest

from crumple.hinge.dent import dent_of, left_by_dent, left_in_bending, round_walls_move
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, density=7850.0, yield_stress=350e6)
TUBE = CircularTube(60e-3, 2e-3)


@pytest.mark.parametrize("section", [TUBE, RectangularTube(60e-3, 40e-3, 2e-3)])
def test_work_is_the_area_under_the_force(section):
    dent = dent_of(section, STEEL, 40e-3)
    fine = np.linspace(0.0, dent.depth[-1], 200_001)
    work = np.concatenate([[0.0], np.cumsum(np.diff(fine) * (dent.at(fine)[1:] + dent.at(fine)[:-1]) / 2.0)])
    np.testing.assert_allclose(dent.absorbed(fine), work, rtol=1e-4, atol=1e-3)
    assert np.all(np.diff(dent.depth) > 0.0)


def test_walls_that_meet_stop_the_dent():
    dent = dent_of(TUBE, STEEL, 60e-3)
    assert dent.depth[-2] == pytest.approx(56e-3)
    assert dent.force[-1] == pytest.approx(50.0 * dent.force[-2])


def test_a_rectangular_tube_is_dented_on_the_side_that_is_struck():
    flat, deep = (dent_of(RectangularTube(60e-3, 40e-3, 2e-3), STEEL, depth) for depth in (40e-3, 60e-3))
    # a fifth of the depth along the force: the same share of the curve
    assert float(flat.at(np.array(8e-3))) == pytest.approx(float(deep.at(np.array(12e-3))), rel=0.01)
    # the wider wall moves the mean more
    share = [float(np.interp(5e-3, one.depth, one.moves)) / 5e-3 for one in (flat, deep)]
    assert share == pytest.approx([(60 + 20) / 200, (40 + 30) / 200], rel=1e-6)


def test_the_moment_that_a_dent_leaves():
    """The stresses of the section without the chord, summed over the middle line."""
    radius, depth = 29e-3, 10e-3
    around = (np.arange(100_000) + 0.5) / 100_000 * 2.0 * np.pi
    height = radius * np.cos(around)
    carries = height < radius - depth
    neutral = np.median(height[carries])
    moment = np.abs(height[carries] - neutral).sum()
    assert left_by_dent(TUBE, depth, 60e-3) == pytest.approx(moment / np.abs(height).sum(), rel=1e-3)


@pytest.mark.parametrize("section", [TUBE, RectangularTube(60e-3, 40e-3, 2e-3)])
def test_a_deeper_dent_leaves_less(section):
    left = [left_by_dent(section, depth, 40e-3) for depth in np.linspace(0.0, 19e-3, 20)]
    assert left[0] == pytest.approx(1.0)
    assert np.all(np.diff(left) < 0.0)
    assert left[-1] > 0.0


def test_the_walls_of_a_round_tube_move_to_the_chord():
    radius, depth = 29e-3, 10e-3
    around = (np.arange(100_000) + 0.5) / 100_000 * 2.0 * np.pi
    moved = np.maximum(radius * np.cos(around) - (radius - depth), 0.0).mean()
    assert float(round_walls_move(np.array(depth), radius)) == pytest.approx(moved, rel=1e-3)


@pytest.mark.parametrize("held", [(True, True), (True, False), (False, False)])
@pytest.mark.parametrize("section", [TUBE, RectangularTube(80e-3, 60e-3, 1.5e-3)])
def test_a_dent_grows_until_the_tube_bends(section, held):
    spans, moment = (0.4, 0.6), 2500.0
    left = left_in_bending(section, dent_of(section, STEEL, 60e-3), 60e-3, moment, spans, held)
    depths = np.linspace(0.0, 29e-3, 20_001)
    shares = np.array([left_by_dent(section, depth, 60e-3) for depth in depths])
    bends = sum((shares + carries) / span for carries, span in zip(held, spans, strict=True)) * moment
    first = int(np.argmax(dent_of(section, STEEL, 60e-3).at(depths) > bends))
    assert first > 0
    assert left == pytest.approx(shares[first], abs=1e-4)


def test_short_spans_are_dented_to_the_middle():
    left = left_in_bending(TUBE, dent_of(TUBE, STEEL, 60e-3), 60e-3, 2500.0, (0.05, 0.05), (True, True))
    assert left == pytest.approx(math.cos(math.pi / 4.0) - 0.5)
