"""Plastic bimoment of walls without cells against closed forms of their mid-lines."""

import numpy as np
import pytest

from crumple.section import Angle, Channel, Hat, Wall, WallSection, outline_section
from crumple.section.properties.plastic_bimoment import plastic_bimoment

YIELD = 300e6


def bimoment(section, stress=YIELD):
    return plastic_bimoment(section.skeleton, np.full(len(section.skeleton.pieces), stress))


def i_section(b, h, t):
    """Mid-lines of flanges b wide at the distance h."""
    flanges = [Wall(((-b / 2.0, z), (0.0, z), (b / 2.0, z)), t) for z in (-h / 2.0, h / 2.0)]
    return WallSection((*flanges, Wall(((0.0, -h / 2.0), (0.0, h / 2.0)), t)))


def test_flanges_of_an_i_section_yield_in_sway():
    """Each has the plastic moment s_y t b^2/4, at the distance h; walls across add less than 2 %."""
    b, h, t = 0.08, 0.12, 0.002
    section = i_section(b, h, t)
    assert bimoment(section) == pytest.approx(YIELD * t * b**2 / 4.0 * h, rel=0.02)
    assert bimoment(section) > YIELD * t * b**2 / 4.0 * h
    flange = t * b**3 / 12.0
    midline = section.properties.midline_warping_constant
    assert midline == pytest.approx(flange * h**2 / 2.0, rel=1e-9)
    assert section.shear_centre == pytest.approx((0.0, 0.0), abs=1e-12)


@pytest.mark.parametrize(("width", "depth"), [(0.04, 0.08), (0.05, 0.1), (0.06, 0.06)])
def test_the_web_of_a_channel_takes_part(width, depth):
    """The warping changes sign at x from the web, and the web balances the moment of the flanges."""
    t = 0.001
    b, h = width - t / 2.0, depth - t
    x = b / 2.0 - h / 8.0
    section = Channel(width, depth, t)
    assert bimoment(section) == pytest.approx(YIELD * t * h * (b**2 / 2.0 - x**2), rel=0.01)
    properties = section.properties
    warping = t * h**2 * b**3 / 12.0 * (2.0 * h + 3.0 * b) / (h + 6.0 * b)
    assert properties.midline_warping_constant == pytest.approx(warping, rel=1e-9)
    # the centroid lies b^2/(2 b + h) from the web, the shear centre 3 b^2/(6 b + h) behind it
    assert -properties.shear_centre[0] == pytest.approx(
        3.0 * b**2 / (6.0 * b + h) + b**2 / (2.0 * b + h), rel=1e-3
    )


def test_an_angle_warps_across_its_walls_alone():
    t, a = 0.004, 0.06
    section = Angle(a + t / 2.0, a + t / 2.0, t)
    assert bimoment(section) == pytest.approx(YIELD * t**2 * a**2 / 4.0, rel=0.01)


def test_it_grows_with_the_yield_stress_and_depends_on_no_origin():
    points = np.array(
        [(-0.06, -0.03), (-0.03, -0.03), (-0.03, 0.02), (0.03, 0.02), (0.03, -0.03), (0.06, -0.03)]
    )
    turn = np.array([[0.8, 0.6], [-0.6, 0.8]])
    plain, moved = (outline_section(p, 2e-3, closed=False) for p in (points, points @ turn + (0.4, -0.2)))
    assert bimoment(moved) == pytest.approx(bimoment(plain), rel=1e-3)
    assert bimoment(plain, 2.0 * YIELD) == pytest.approx(2.0 * bimoment(plain), rel=1e-9)


def test_no_axis_takes_less_work():
    """The work about the shear centre is an upper bound: by up to 5 % for a hat."""
    section = Hat(0.05, 0.04, 0.0005, 0.025)
    skeleton = section.skeleton
    s = (np.arange(400) + 0.5) / 400
    work = 0.0
    pole = complex(*section.shear_centre) + complex(*section.properties.centroid)
    warping = _about(skeleton, pole)
    for (first, last), area in zip(skeleton.ends, skeleton.thickness * skeleton.length, strict=True):
        work += YIELD * area * np.abs(warping[first] * (1.0 - s) + warping[last] * s).mean()
    assert bimoment(section) <= work * (1.0 + 1e-3)
    assert bimoment(section) > 0.9 * work


def _about(skeleton, pole):
    """Warping of the nodes of one open line about a pole, without that of the node in its middle."""
    found = {int(skeleton.ends[0, 0]): 0.0}
    for first, last in skeleton.ends.tolist():
        a, b = skeleton.nodes[first] - pole, skeleton.nodes[last] - pole
        found[last] = found[first] - (a.conjugate() * b).imag
    values = np.array([found[node] for node in range(len(skeleton.nodes))])
    # a hat is symmetric: its warping is odd about the middle of its crown
    return values - (values.max() + values.min()) / 2.0
