"""Shear areas of thin sections against their shear flows in closed form."""

import math

import pytest

from crumple.material import Material
from crumple.section import CircularTube, RectangularTube
from crumple.section.wall import Wall
from crumple.section.wall_section import WallSection, walls_of

THIN = 1e-4
STEEL = Material("steel", 210e9, 0.3, 7850.0, 300e6)


def area(section, axis="y"):
    return walls_of(section).shear_area(axis, STEEL)


@pytest.mark.parametrize("axis", ["y", "z", math.pi / 4.0])
def test_a_square_tube_has_five_twelfths_of_its_area(axis):
    tube = RectangularTube(0.05 + THIN, 0.05 + THIN, THIN)
    assert area(tube, axis) == pytest.approx(5.0 / 12.0 * 4.0 * 0.05 * THIN, rel=1e-9)


def test_a_rectangular_tube_has_the_work_of_its_flow():
    """Depth 80, width 30 mm: flow t h s/2 in half a flange, t (b h/4 + h^2/8 - s^2/2) in a web."""
    b, h = 0.03, 0.08
    second = THIN * (h**3 / 6.0 + b * h**2 / 2.0)
    corner, s = b * h / 4.0 + h**2 / 8.0, h / 2.0
    web = 2.0 * (corner**2 * s - corner * s**3 / 3.0 + s**5 / 20.0)
    flange = 2.0 * (h / 2.0) ** 2 * (b / 2.0) ** 3 / 3.0
    expected = second**2 / (2.0 * THIN * (web + flange))
    assert area(RectangularTube(b + THIN, h + THIN, THIN)) == pytest.approx(expected, rel=1e-9)


def test_a_ring_has_half_of_its_area():
    # it is a polygon here
    assert area(CircularTube(0.05 + THIN, THIN)) == pytest.approx(math.pi * 0.05 * THIN / 2.0, rel=0.01)


def test_open_sections():
    strip = WallSection((Wall(((0.0, -0.05), (0.0, 0.05)), THIN),))
    assert area(strip) == pytest.approx(5.0 / 6.0 * 0.1 * THIN, rel=1e-9)
    b, h = 0.06, 0.1
    flanges = [Wall(((-b / 2.0, z), (b / 2.0, z)), THIN) for z in (-h / 2.0, h / 2.0)]
    beam = WallSection((Wall(((0.0, -h / 2.0), (0.0, h / 2.0)), THIN), *flanges))
    second = THIN * (h**3 / 12.0 + b * h**2 / 2.0)
    corner, s = b * h / 2.0 + h**2 / 8.0, h / 2.0
    web = 2.0 * (corner**2 * s - corner * s**3 / 3.0 + s**5 / 20.0)
    flange = 4.0 * (h / 2.0) ** 2 * (b / 2.0) ** 3 / 3.0
    assert area(beam) == pytest.approx(second**2 / (THIN * (web + flange)), rel=1e-9)
