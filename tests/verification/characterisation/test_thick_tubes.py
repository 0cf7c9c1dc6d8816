"""Tubes of ten to fifteen walls: the laws of the library below its thickest solved tubes, against shells.

The laws are those of 15 walls beside a clamp; of free folds those of 18.5 walls, times what the same step
changes beside a clamp.  Shells on the nominal mesh of the library (8 elements along half a fold), solved by
`python -m tools.tube_library.thick solve`: tubes that were listed before they were solved, and by which
nothing was chosen.  Expected: work over M_p up to 10, 20 and 30 degrees.  Found: -9 to 0 % up to 20 and -15
to +1 % up to 30 degrees; of cantilevers of 2.5 larger sides -5 to +14 and 0 to +19 %.  Tolerances: 10 and
15 %, of short ones 15 and 20 %.  The formula takes 11 to 12 % more up to 20 degrees in square tubes that do
not harden, and 37 to 38 % more in short ones.

Kind: independent calculation.  Source: run here.
"""

import math

import numpy as np
import pytest

from crumple.hinge import build_law
from crumple.material import Material
from crumple.material.hardening.swift import Swift
from crumple.section import RectangularTube

WALL = 1e-3
AT = (10, 20, 30)
# larger side over wall, flange over depth, yield strain, hardening: work over M_p up to 5, 10, 20, 30 deg
CLAMPED = {
    (12, 1, 0.001714, 1): (0.0868, 0.1693, 0.3106, 0.4140),
    (12.5, 1, 0.0012, 1): (0.0869, 0.1692, 0.3104, 0.4157),
    (10, 1, 0.0035, 1): (0.0864, 0.1693, 0.3133, 0.4218),
    (13.3333, 1, 0.0017, 1.5): (0.1050, 0.2230, 0.4534, 0.6651),
    (10, 2, 0.0017, 1): (0.0870, 0.1726, 0.3305, 0.4665),
    (10, 0.7, 0.0022, 1.3): (0.0993, 0.2083, 0.4343, 0.6550),
    (16.6667, 1, 0.0017, 1): (0.0860, 0.1618, 0.2869, 0.3870),
    (11, 1.2, 0.0025, 1.2): (0.0942, 0.1932, 0.3831, 0.5497),
}
SHORT = {
    (12, 1, 0.001714, 1): (0.0785, 0.1478, 0.2515, 0.3237),
    (12.5, 1, 0.0012, 1): (0.0785, 0.1476, 0.2509, 0.3231),
    (10, 1, 0.0035, 1): (0.0782, 0.1485, 0.2552, 0.3294),
    (13.3333, 1, 0.0017, 1.5): (0.1016, 0.2161, 0.4428, 0.6404),
    (10, 2, 0.0017, 1): (0.0809, 0.1568, 0.2861, 0.3883),
    (10, 0.7, 0.0022, 1.3): (0.0970, 0.2028, 0.4071, 0.5558),
    (16.6667, 1, 0.0017, 1): (0.0778, 0.1429, 0.2409, 0.3103),
    (11, 1.2, 0.0025, 1.2): (0.0893, 0.1822, 0.3526, 0.4875),
}
FREE = {
    (12, 1, 0.001714, 1): (0.0860, 0.1678, 0.3087, 0.4249),
    (13.3333, 1, 0.0017, 1.5): (0.1002, 0.2099, 0.4192, 0.5984),
    (16.6667, 1, 0.0017, 1): (0.0851, 0.1604, 0.2807, 0.3711),
}
CASES = [
    (kind, place)
    for kind, found in (("clamped", CLAMPED), ("short", SHORT), ("free", FREE))
    for place in found
]
SIDES = {"clamped": 6.0, "short": 2.5}


def tube_of(place):
    side, ratio, strain, hardening = place
    section = RectangularTube(side * min(ratio, 1.0) * WALL, side / max(ratio, 1.0) * WALL, WALL)
    stress = strain * 210e9
    curve = Swift(stress, 0.01, math.log(hardening) / math.log(11.0)) if hardening > 1.0 else None
    return section, Material("steel", 210e9, 0.3, 7850.0, stress, hardening=curve)


def works(law, section, material):
    plastic = material.yield_stress * section.plastic_section_modulus("y")
    fine = [np.linspace(0.0, math.radians(end), 601) for end in AT]
    return [float(np.trapezoid(law.moment_capacity(one), one)) / plastic for one in fine]


@pytest.mark.parametrize(("kind", "place"), CASES)
def test_work_of_tubes_thicker_than_the_library(kind, place, record_figure):
    section, material = tube_of(place)
    if kind == "free":
        law = build_law("library", section, material)
    else:
        law = build_law("clamped_tube", section, material, span=SIDES[kind] * place[0] * WALL)
    shells = {"clamped": CLAMPED, "short": SHORT, "free": FREE}[kind][place]
    for end, own, expected in zip(AT, works(law, section, material), shells[1:], strict=True):
        title = f"{kind} fold, {place[0]:.4g} walls, a/b {place[1]}, h {place[3]}, work to {end} deg"
        tolerance = (0.15 if end == 30 else 0.10) + (0.05 if kind == "short" else 0.0)
        record_figure(title, own, expected, tolerance, "M_p", relative=True)


@pytest.mark.parametrize(
    "place", [place for place in CLAMPED if place[1] == place[3] == 1.0 and place[0] < 15.0]
)
def test_the_formula_of_square_tubes_takes_too_much(place):
    section, material = tube_of(place)
    formula = works(build_law("kecman", section, material), section, material)
    for shells, least in ((CLAMPED, 1.09), (SHORT, 1.25)):
        assert formula[1] > least * shells[place][2]
