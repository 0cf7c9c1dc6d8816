"""Moment over curvature: a rectangle, tubes by their exact widths, limits, hardening.

A solid rectangle of elastic-perfectly plastic metal carries M/M_y = 3/2 - (kappa_y/kappa)^2/2 (textbook).
Tubes are compared with a quadrature over their exact widths, which uses neither polygons nor layers.  The
tolerance is that of the layers, 400 over the depth.

Kind: closed form; independent calculation.  Source: textbook; derived here.
"""

import numpy as np
import pytest

from crumple.material import Material, Swift
from crumple.section import Hat, RectangularTube, Wall, WallSection, bending_moment, walls_of

STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
TIMES = (0.5, 1.0, 1.1, 1.3, 2.0, 5.0, 50.0)


@pytest.mark.parametrize("times", TIMES)
def test_flat_bar_follows_the_rectangle(times, record_figure):
    bar = WallSection((Wall(((0.0, -0.02), (0.0, 0.02)), 0.004),))
    first = STEEL.yield_stress * 0.004 * 0.04**2 / 6.0
    yields = STEEL.yield_stress / STEEL.youngs_modulus / 0.02
    exact = times if times < 1.0 else 1.5 - 0.5 / times**2
    value = bending_moment(bar, STEEL, "y", [times * yields])[0] / first
    record_figure(f"M/My of a flat bar at {times:g} times the curvature of first yield", value, exact, 1e-4)


@pytest.mark.parametrize("axis", ["y", "z"])
@pytest.mark.parametrize("times", TIMES)
def test_tube_follows_its_exact_widths(axis, times):
    tube = RectangularTube(0.050, 0.025, 0.00265)
    width, depth = (0.050, 0.025) if axis == "y" else (0.025, 0.050)
    z = (np.arange(200_000) + 0.5) / 200_000 * depth - depth / 2
    widths = np.where(np.abs(z) > depth / 2 - 0.00265, width, 2 * 0.00265)
    kappa = times * STEEL.yield_stress / STEEL.youngs_modulus / (depth / 2)
    stress = np.clip(STEEL.youngs_modulus * kappa * z, -488e6, 488e6)
    exact = (stress * z * widths).sum() * depth / 200_000
    assert bending_moment(tube, STEEL, axis, [kappa])[0] == pytest.approx(exact, rel=2e-4)


@pytest.mark.parametrize(
    "section", [RectangularTube(0.06, 0.06, 0.003, 0.006), Hat(0.06, 0.05, 0.002, 0.02)], ids=["tube", "hat"]
)
@pytest.mark.parametrize("axis", ["y", "z"])
def test_limits_are_elastic_and_fully_plastic(section, axis):
    kappa = np.array([1e-3, 1e4])
    low, high = bending_moment(section, STEEL, axis, kappa)
    properties = walls_of(section)
    assert low == pytest.approx(STEEL.youngs_modulus * properties.second_moment(axis) * 1e-3, rel=2e-4)
    assert high == pytest.approx(STEEL.yield_stress * properties.plastic_section_modulus(axis), rel=2e-4)


def test_hardening_goes_on_beyond_the_plastic_moment():
    curve = Swift(700e6, 0.005, 0.1)
    metal = Material("hard", 210e9, 0.3, 7850.0, curve.yield_stress, hardening=curve)
    tube = RectangularTube(0.06, 0.06, 0.003)
    few, many = bending_moment(tube, metal, "y", [0.5, 2.0])
    assert curve.yield_stress * tube.plastic_section_modulus("y") < few < many
    # a thin flange at one strain, webs below it
    strain = 2.0 * 0.03
    assert many < float(curve.stress(np.array([strain]))[0]) * tube.plastic_section_modulus("y")
