"""Dents of tubes: force, work, the moment that is left, and the motion of the walls."""

import math

import numpy as np
import pytest

from crumple.hinge.dent import Striker, dent_of, left_by_dent, left_in_bending, round_walls_move
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, density=7850.0, yield_stress=350e6)
TUBE = CircularTube(60e-3, 2e-3)
POLE = Striker(50e-3)


@pytest.mark.parametrize("section", [TUBE, RectangularTube(60e-3, 40e-3, 2e-3)])
def test_work_is_the_area_under_the_force(section):
    dent = dent_of(section, STEEL, 40e-3, POLE)
    fine = np.linspace(0.0, dent.depth[-1], 200_001)
    work = np.concatenate([[0.0], np.cumsum(np.diff(fine) * (dent.at(fine)[1:] + dent.at(fine)[:-1]) / 2.0)])
    np.testing.assert_allclose(dent.absorbed(fine), work, rtol=1e-4, atol=1e-3)
    assert np.all(np.diff(dent.depth) > 0.0)


def test_walls_that_meet_stop_the_dent():
    dent = dent_of(TUBE, STEEL, 60e-3, POLE)
    assert dent.depth[-2] == pytest.approx(56e-3)
    assert dent.force[-1] == pytest.approx(50.0 * dent.force[-2])


def test_a_rectangular_tube_is_dented_on_the_side_that_is_struck():
    flat, deep = (
        dent_of(RectangularTube(60e-3, 40e-3, 2e-3), STEEL, depth, POLE) for depth in (40e-3, 60e-3)
    )
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
    spans, moment, dent = (0.4, 0.6), 2500.0, dent_of(section, STEEL, 60e-3, POLE)
    left = left_in_bending(section, dent, 60e-3, moment, spans, held)
    depths = np.linspace(0.0, 29e-3, 20_001)
    shares = np.array([left_by_dent(section, depth, 60e-3, dent.takes) for depth in depths])
    bends = sum((shares + carries) / span for carries, span in zip(held, spans, strict=True)) * moment
    first = int(np.argmax(dent.at(depths) > bends))
    assert first > 0
    assert left == pytest.approx(shares[first], abs=1e-4)


def test_short_spans_are_dented_to_the_middle():
    dent = dent_of(TUBE, STEEL, 60e-3, POLE)
    left = left_in_bending(TUBE, dent, 60e-3, 2500.0, (0.05, 0.05), (True, True))
    assert left == pytest.approx(1.0 - math.exp(-7.0 / 36.0) * (1.5 - math.cos(math.pi / 4.0)))


# width, depth along the force, wall, ball [mm], yield stress [MPa]; work [J] in shells up to 0.2 to 0.58 of
# the depth, on a rigid floor in 20 ms (elements of 4 mm); the law was read off all of them
BALLS = [
    ((60, 40, 2, 50, 350), (66, 203, 363, 522, 653)),
    ((50, 50, 2, 80, 350), (266, 464, 671, 925, 1145)),
    ((80, 60, 2.5, 100, 300), (305, 642, 985, 1357, 1708)),
    ((60, 60, 1.5, 60, 400), (144, 290, 448, 630, 791)),
    ((70, 50, 3, 50, 280), (140, 405, 736, 1065, 1323)),
    ((90, 50, 2, 120, 320), (124, 338, 554, 779, 976)),
    ((40, 50, 2.5, 40, 450), (396, 720, 1041, 1402, 1730)),
    ((60, 60, 2, 150, 350), (413, 681, 1007, 1380, 1693)),
]


def ball_dent(width, depth, wall, ball, stress):
    section = RectangularTube(width / 1e3, depth / 1e3, wall / 1e3)
    metal = Material("steel", 210e9, 0.3, 7850.0, 1e6 * stress)
    return dent_of(section, metal, depth / 1e3, Striker(ball / 1e3, is_ball=True)), section, metal


@pytest.mark.parametrize(("sizes", "works"), BALLS)
def test_a_ball_on_a_flat_wall_takes_the_work_of_shells(sizes, works):
    dent, _, _ = ball_dent(*sizes)
    found = dent.absorbed(np.array([0.2, 0.3, 0.4, 0.5, 0.58]) * sizes[1] / 1e3) / np.array(works) - 1.0
    assert np.abs(found[2:]).max() < 0.25
    assert np.abs(found).max() < 0.33


def test_a_ball_dishes_the_wall_until_it_meets_the_webs_and_then_is_a_pole():
    sizes = (60, 40, 2, 50, 350)
    dent, section, metal = ball_dent(*sizes)
    meets = 0.05 - math.sqrt(0.05**2 - 0.03**2)
    assert meets == pytest.approx(0.01)
    early = np.array([0.002, 0.005, 0.009])
    np.testing.assert_allclose(dent.at(early), 3.0 * 350e6 * 0.002 * early, rtol=0.02)
    pole = dent_of(section, metal, 0.04, POLE)
    late = np.array([0.014, 0.018, 0.022])
    np.testing.assert_allclose(dent.at(late), pole.at(late - meets), rtol=0.03)
    wide = dent_of(section, metal, 0.04, Striker(1e3, is_ball=True))
    np.testing.assert_allclose(wide.at(late), pole.at(late), rtol=1e-3)


@pytest.mark.parametrize("sizes", [sizes for sizes, _ in BALLS])
def test_webs_that_have_just_been_met_carry_no_less_than_the_dish(sizes):
    width, depth, wall, ball, stress = (1e-3 * size for size in sizes)
    dent, _, _ = ball_dent(*sizes)
    meets = ball - math.sqrt(ball**2 - (width / 2.0) ** 2)
    between = np.linspace(meets, 0.9 * depth, 2001)
    assert dent.at(between).min() > 0.95 * 3.0 * 1e9 * stress * wall * meets
