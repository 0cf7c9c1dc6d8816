"""Sections of flat plates that no other formula describes take the work of their law in shells.

Sub-models of docs/theory/characterisation.md (two halves turned against each other, 4 elements along half a
fold), solved once by this program: work [J] up to 5, 10 and 20 degrees of plastic rotation.  The constants
were fitted to those under FITTED (and to angles of equal legs about z, where they are as about y).  The rest
was set aside before, though its errors were seen while the form was chosen; the sections of walls, those with
round corners and the metals that harden were chosen after.  One channel is solved again.  The moment of the
plates equals that of an integration over their fibres, and the law without folds is the plastic moment.

Kind: independent calculation; closed form.  Source: run here; derived here.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from crumple.analysis import solve
from crumple.characterisation.combined import Combined
from crumple.characterisation.resolution import Resolution
from crumple.errors import InputError
from crumple.hinge import build_law
from crumple.hinge.bending.profiles.folded_plates import ANY, BANDS, FAMILIES
from crumple.hinge.bending.profiles.folding_plates import FoldingPlates
from crumple.material import Material
from crumple.material.hardening.swift import Swift
from crumple.section import CircularTube, RectangularTube
from crumple.section.shapes.written import written_section
from crumple.section.wall import Wall
from crumple.section.wall_section import WallSection, outline_section

STEEL = Material("steel", 210e9, 0.3, 7850.0, 300e6)
ALUMINIUM = Material("aluminium", 70e9, 0.33, 2700.0, 220e6)
ENDS = (5.0, 10.0, 20.0)
# section, yield stress [MPa], axis, sense, work of the shells; fitted to
FITTED = [
    ("channel 40x80x2 mm", 300, "y", 1, (143.3, 222.2, 329.4)),
    ("channel 50x100x3 mm", 350, "y", 1, (445.2, 704.8, 1059.5)),
    ("channel 60x80x1.5 mm", 350, "y", 1, (107.0, 163.6, 241.3)),
    ("channel 50x120x4 mm", 420, "y", 1, (1082.8, 1767.2, 2678.3)),
    ("channel 40x60x1.5 mm, lip 10 mm", 350, "y", 1, (106.4, 161.5, 235.3)),
    ("channel 60x100x2 mm, lip 15 mm", 500, "y", 1, (428.6, 642.7, 931.6)),
    ("channel 70x90x3 mm", 280, "y", 1, (358.2, 560.9, 846.0)),
    ("channel 45x110x2 mm", 600, "y", 1, (357.6, 552.4, 813.8)),
    ("channel 50x100x5 mm", 300, "y", 1, (825.4, 1498.5, 2471.4)),
    ("channel 50x90x2.5 mm, lip 14 mm", 260, "y", 1, (311.1, 477.4, 693.9)),
    ("closed_hat 70x60x1.6 mm, flange 18 mm", 400, "z", 1, (347.4, 546.9, 825.7)),
    ("closed_hat 90x50x1 mm, flange 20 mm", 280, "z", 1, (123.8, 188.4, 308.3)),
    ("closed_hat 60x45x1.4 mm, flange 16 mm", 500, "z", 1, (286.1, 448.3, 672.3)),
    ("closed_hat 50x50x2 mm, flange 20 mm", 400, "z", 1, (392.4, 665.7, 1052.1)),
    ("closed_hat 80x60x1.2 mm, flange 18 mm", 350, "z", 1, (196.8, 306.6, 470.2)),
    ("closed_hat 60x30x1.6 mm, flange 15 mm", 500, "z", 1, (329.5, 529.6, 824.5)),
    ("closed_hat 100x60x1.5 mm, flange 20 mm", 450, "z", 1, (457.0, 711.0, 1094.7)),
    ("closed_hat 50x40x1.5 mm, flange 15 mm", 400, "z", 1, (223.9, 364.8, 557.2)),
    ("multi_cell_tube 90x60x2 mm, cells 3x1", 250, "y", 1, (366.6, 730.0, 1364.3)),
    ("multi_cell_tube 90x60x2 mm, cells 3x1", 250, "z", 1, (417.8, 736.0, 1238.8)),
    ("multi_cell_tube 60x80x1.5 mm, cells 1x2", 300, "y", 1, (236.0, 416.2, 701.9)),
    ("multi_cell_tube 60x80x1.5 mm, cells 1x2", 300, "z", 1, (259.8, 448.5, 711.4)),
    ("multi_cell_tube 80x80x1.6 mm, cells 2x2", 400, "y", 1, (565.4, 1034.0, 1791.2)),
    ("multi_cell_tube 100x60x1.2 mm, cells 2x1", 350, "y", 1, (198.1, 316.9, 484.5)),
    ("multi_cell_tube 100x60x1.2 mm, cells 2x1", 350, "z", 1, (250.2, 423.9, 688.8)),
    ("hat 50x50x2 mm, flange 20 mm", 400, "z", 1, (245.0, 391.6, 589.6)),
    ("hat 70x60x1.6 mm, flange 18 mm", 350, "z", 1, (185.1, 287.3, 431.7)),
    ("hat 60x40x1.2 mm, flange 15 mm", 300, "z", 1, (81.1, 121.1, 177.9)),
    ("angle 50x50x4 mm", 300, "y", 1, (114.9, 222.7, 411.9)),
    ("angle 50x50x4 mm", 300, "y", -1, (107.8, 174.8, 263.6)),
    ("angle 40x60x3 mm", 300, "y", -1, (74.8, 111.7, 162.8)),
    ("angle 40x60x3 mm", 300, "z", -1, (56.8, 111.8, 209.4)),
    ("angle 60x60x2.5 mm", 350, "y", 1, (118.5, 218.2, 390.7)),
    ("angle 80x50x5 mm", 280, "z", 1, (262.6, 402.3, 587.1)),
    ("angle 40x60x3 mm", 300, "y", 1, (116.3, 216.5, 391.5)),
    ("angle 40x60x3 mm", 300, "z", 1, (50.8, 81.1, 122.1)),
    ("angle 60x60x2.5 mm", 350, "y", -1, (61.4, 91.3, 134.3)),
    ("angle 80x50x5 mm", 280, "y", 1, (136.7, 273.7, 521.4)),
    ("angle 80x50x5 mm", 280, "y", -1, (138.5, 256.2, 408.3)),
    ("angle 80x50x5 mm", 280, "z", -1, (321.6, 610.1, 1111.3)),
]
# the first two were fitted to, the third was not
IN_ALUMINIUM = [
    ("multi_cell_tube 100x50x2.5 mm, cells 2x1", 220, "y", 1, (296.9, 565.4, 1002.2)),
    ("multi_cell_tube 100x50x2.5 mm, cells 2x1", 220, "z", 1, (423.6, 757.4, 1297.7)),
    ("multi_cell_tube 90x50x2 mm, cells 2x1", 240, "z", 1, (290.3, 515.3, 877.9)),
]
OTHERS = [
    ("channel 55x90x2.5 mm", 400, "y", 1, (333.5, 521.0, 781.0)),
    ("channel 65x75x1.8 mm", 300, "y", 1, (125.6, 193.5, 287.7)),
    ("channel 50x70x2 mm, lip 12 mm", 300, "y", 1, (187.6, 287.0, 419.9)),
    ("channel 40x120x3 mm", 500, "y", 1, (692.3, 1091.9, 1633.6)),
    ("channel 60x140x5 mm", 355, "y", 1, (1651.6, 2749.7, 4205.4)),
    ("channel 50x90x2 mm, corner radius 6 mm", 350, "y", 1, (186.3, 287.9, 426.7)),
    ("channel 45x85x2.5 mm, corner radius 5 mm, lip 12 mm", 400, "y", 1, (382.6, 590.2, 860.0)),
    ("closed_hat 65x50x1.3 mm, flange 15 mm", 350, "z", 1, (188.2, 292.1, 437.9)),
    ("closed_hat 75x55x1.5 mm, flange 17 mm", 450, "z", 1, (347.2, 544.3, 821.7)),
    ("closed_hat 120x70x2 mm, flange 25 mm", 300, "z", 1, (721.0, 1105.5, 1676.6)),
    ("closed_hat 50x60x1.2 mm, flange 15 mm", 300, "z", 1, (113.9, 181.5, 276.9)),
    ("closed_hat 70x50x1.5 mm, flange 18 mm, corner radius 5 mm", 350, "z", 1, (271.9, 404.2, 592.5)),
    ("multi_cell_tube 120x60x2 mm, cells 4x1, inner walls 1.5 mm", 250, "y", 1, (451.0, 901.1, 1718.0)),
    ("multi_cell_tube 120x60x2 mm, cells 4x1, inner walls 1.5 mm", 250, "z", 1, (637.6, 1133.6, 1891.8)),
    ("multi_cell_tube 70x90x2.5 mm, cells 2x3", 300, "y", 1, (882.1, 1761.6, 3350.8)),
    ("hat 80x60x2 mm, flange 20 mm", 450, "z", 1, (424.1, 648.4, 950.1)),
    ("angle 45x70x4 mm", 350, "y", 1, (245.8, 462.5, 840.2)),
    ("angle 45x70x4 mm", 350, "y", -1, (175.2, 265.9, 390.1)),
    ("angle 45x70x4 mm", 350, "z", 1, (107.6, 183.3, 283.7)),
    ("angle 45x70x4 mm", 350, "z", -1, (110.4, 220.3, 417.9)),
    ("angle 70x70x6 mm", 260, "y", 1, (292.5, 567.5, 1054.3)),
    ("angle 70x70x6 mm", 260, "y", -1, (286.0, 477.0, 727.8)),
]
I_BEAM = WallSection(
    (
        Wall(((-0.03, -0.05), (0.03, -0.05)), 0.003),
        Wall(((-0.03, 0.05), (0.03, 0.05)), 0.003),
        Wall(((0.0, -0.05), (0.0, 0.05)), 0.002),
    ),
    name="I of 60x100x3 mm, web 2 mm",
)
Z_BAR = outline_section(
    [(0.05, -0.05), (0.0, -0.05), (0.0, 0.05), (-0.05, 0.05)], 0.0025, closed=False, name="Z of 50x100x2.5 mm"
)
HEXAGON = outline_section(
    [(0.035 * math.cos(at), 0.035 * math.sin(at)) for at in np.arange(6) * math.pi / 3],
    0.0018,
    name="hexagon of 35x1.8 mm",
)
TRAPEZOID = outline_section(
    [(-0.04, -0.03), (0.04, -0.03), (0.025, 0.03), (-0.025, 0.03)],
    0.0016,
    name="trapezoid of 80/50x60x1.6 mm",
)
OF_WALLS = [
    (I_BEAM, 350, "y", 1, (658.9, 1075.6, 1461.6)),
    (I_BEAM, 350, "z", 1, (161.5, 327.6, 634.9)),
    (Z_BAR, 300, "y", 1, (307.7, 489.6, 739.2)),
    (HEXAGON, 350, "y", 1, (221.2, 395.9, 683.7)),
    (HEXAGON, 350, "z", 1, (231.8, 434.0, 724.2)),
    (TRAPEZOID, 400, "y", 1, (206.9, 336.4, 513.9)),
    (TRAPEZOID, 400, "y", -1, (219.1, 346.6, 530.1)),
    (TRAPEZOID, 400, "z", 1, (222.6, 362.0, 564.7)),
]


def metal(megapascals, base=STEEL):
    return replace(base, yield_stress=1e6 * megapascals)


def name_of(case):
    section, stress, axis, sense, _ = case
    text = section if isinstance(section, str) else section.title
    return f"{text}, {stress} MPa, {'+' if sense > 0 else '-'}{axis}"


def work(law, sense, degrees):
    at = np.linspace(0.0, math.radians(degrees), 1001)
    return float(np.trapezoid(law.moment_capacity(at, sense), at))


@pytest.mark.parametrize("case", [*FITTED, *OTHERS, *OF_WALLS, *IN_ALUMINIUM], ids=name_of)
def test_work_of_the_law_is_that_of_shells(case, record_figure):
    given, stress, axis, sense, shells = case
    section = written_section(given) if isinstance(given, str) else given
    law = build_law("auto", section, metal(stress, ALUMINIUM if case in IN_ALUMINIUM else STEEL), axis)
    assert law.name == "folded_plates"
    band = law.validity.uncertainty
    assert band == BANDS.get(section.kind, 0.25)
    for degrees, expected in zip(ENDS, shells, strict=True):
        what = f"{name_of(case)}: work up to {degrees:g} deg"
        record_figure(what, work(law, sense, degrees), expected, band, "J", relative=True)


def test_constants_are_not_biased():
    """Mean over those that nothing was fitted to, and all but one in twenty within 20 %."""
    found = []
    for given, stress, axis, sense, shells in [*OTHERS, *OF_WALLS]:
        section = written_section(given) if isinstance(given, str) else given
        law = build_law("folded_plates", section, metal(stress), axis)
        found += [work(law, sense, end) / one - 1.0 for end, one in zip(ENDS, shells, strict=True)]
    assert abs(np.mean(found)) < 0.03
    assert np.quantile(np.abs(found), 0.95) < 0.2


# section, axis, yield stress [MPa], prestrain and exponent of Swift's curve, work of the shells
HARDENING = [
    ("channel 40x80x2 mm", "y", 300, 0.01, 0.15, (172.5, 282.1, 429.7)),
    ("channel 50x100x3 mm", "y", 350, 0.006, 0.14, (544.7, 925.2, 1448.5)),
    ("channel 55x90x2.5 mm", "y", 400, 0.01, 0.18, (417.0, 697.1, 1087.2)),
    ("channel 40x60x1.5 mm, lip 10 mm", "y", 350, 0.01, 0.15, (128.3, 203.3, 305.7)),
    ("closed_hat 50x40x1.5 mm, flange 15 mm", "z", 330, 0.006, 0.14, (229.9, 397.5, 618.5)),
    ("closed_hat 50x40x1.5 mm, flange 15 mm", "z", 330, 0.01, 0.18, (228.0, 397.0, 622.0)),
    ("closed_hat 70x60x1.6 mm, flange 18 mm", "z", 400, 0.01, 0.15, (407.1, 660.2, 1028.3)),
    ("closed_hat 50x50x2 mm, flange 20 mm", "z", 400, 0.006, 0.14, (474.0, 861.8, 1394.8)),
    ("multi_cell_tube 90x60x2 mm, cells 3x1", "y", 250, 0.01, 0.15, (399.8, 839.2, 1775.0)),
    ("multi_cell_tube 60x80x1.5 mm, cells 1x2", "y", 300, 0.006, 0.14, (286.3, 537.6, 957.0)),
    ("hat 70x60x1.6 mm, flange 18 mm", "z", 350, 0.01, 0.15, (222.6, 357.8, 541.8)),
]


@pytest.mark.parametrize("case", HARDENING, ids=lambda case: f"{case[0]}, {case[3]:g}")
def test_metals_that_harden(case, record_figure):
    """Folding plates at yield times the effect of hardening in the tube around; nothing is fitted to them."""
    text, axis, stress, prestrain, exponent, shells = case
    section, steel = written_section(text), metal(stress)
    hardened = replace(steel, hardening=Swift(steel.yield_stress, prestrain, exponent))
    law = build_law("auto", section, hardened, axis)
    plain = build_law("auto", section, steel, axis)
    assert law.name == "hardening_section"
    for degrees, expected in zip(ENDS, shells, strict=True):
        what = f"{text}, {stress} MPa, Swift {prestrain:g} and {exponent:g}: work up to {degrees:g} deg"
        record_figure(what, work(law, 1, degrees), expected, 0.15, "J", relative=True)
    assert work(plain, 1, 20.0) < 0.87 * shells[-1]


def test_a_channel_in_shells_takes_the_work_of_its_law(record_figure):
    channel, steel = written_section("channel 55x90x2.5 mm"), metal(400)
    model = Combined(channel, steel, 0.0, largest=math.radians(20.0), resolution=Resolution(4.0, 6.0))
    found = model.curve(solve(model.analysis(), "shell")).energy_at(math.radians(20.0))
    expected = work(build_law("auto", channel, steel, "y"), 1, 20.0)
    record_figure("channel about y, work up to 20 deg", expected, found, 0.1, "J", relative=True)


@pytest.mark.parametrize("rotation", [1e-4, 0.01, 0.1, 0.4])
def test_moment_is_that_of_fibres(rotation, record_figure):
    """A channel about y: flange, web and flange cut into fibres, line of no stress by Brent's method."""
    width, depth, wall, stress = 0.055, 0.090, 0.0025, 400e6
    constants = FAMILIES["channel"]._replace(buckling=0.0)
    section = written_section("channel 55x90x2.5 mm")
    plates = FoldingPlates.of(section, metal(400), 0.0, constants, flows=False)
    found = float(plates.moment(np.array([rotation]))[0])
    flange, half = width - wall / 2.0, (depth - wall) / 2.0
    scale = wall**2 / (stress / (1.5e-3 * 210e9)) ** constants.strain
    heights = np.linspace(-half, half, 200001)
    heights = 0.5 * (heights[1:] + heights[:-1])

    def share(bow):
        return np.sqrt(1.0 + bow**2) - bow

    def stresses(neutral):
        bow = (rotation * (neutral + half) * flange / (constants.bend * scale)) ** constants.free_power
        below = heights < neutral
        strip = np.where(below, neutral - heights, 0.0) * (neutral + half)
        # both edges of the web meet plates with a free edge
        left = share((rotation * strip / (2.0 * constants.lip * scale)) ** constants.power)
        return np.where(below, -left, 1.0), -share(bow)

    def force(neutral):
        web, pressed = stresses(neutral)
        return web.mean() * 2.0 * half + (pressed + 1.0) * flange

    # it lies in the stretched flange where this cannot be balanced any more
    neutral = brentq(force, -half + 1e-9, half) if force(half) < 0.0 else half
    web, pressed = stresses(neutral)
    moment = (web * (heights - neutral)).mean() * 2.0 * half
    moment += flange * (half - neutral - pressed * (half + neutral))
    thick = stress * section.plastic_section_modulus("y") / (stress * wall * (2.0 * flange * half + half**2))
    record_figure(
        f"moment at {rotation:g} rad", found, moment * wall * stress * thick, 1e-4, "N m", relative=True
    )


@pytest.mark.parametrize(
    ("text", "axis"),
    [("channel 40x60x8 mm", "y"), ("angle 40x40x8 mm", "z"), ("closed_hat 40x30x4 mm, flange 15 mm", "z")],
)
def test_stout_plates_start_at_the_plastic_moment(text, axis):
    section = written_section(text)
    law = build_law("folded_plates", section, STEEL, axis)
    plastic = 300e6 * section.plastic_section_modulus(axis)
    for sense in (1, -1):
        assert float(law.moment_capacity(0.0, sense)) == pytest.approx(plastic, rel=1e-3)
    assert law.moment_capacity(0.5) < 0.9 * plastic


def test_a_thinner_plate_and_a_metal_of_more_stress_fold_sooner():
    def left(section, material):
        law = build_law("folded_plates", written_section(section), material, "y")
        return float(law.moment_capacity(0.2) / law.moment_capacity(0.0))

    thick, thin = "channel 50x100x4 mm", "channel 50x100x2 mm"
    assert left(thin, STEEL) < 0.8 * left(thick, STEEL)
    assert left(thick, metal(500)) < left(thick, STEEL)


def test_flow_stress_counts_in_the_fold_and_yield_stress_before():
    flowing = replace(STEEL, given_flow_stress=400e6)
    channel = written_section("channel 50x100x3 mm")
    plain, law = (build_law("folded_plates", channel, one, "y") for one in (STEEL, flowing))
    assert law.moment_capacity(0.0) == pytest.approx(float(plain.moment_capacity(0.0)))
    ratio = law.moment_capacity(0.3) / plain.moment_capacity(0.3)
    assert float(ratio) == pytest.approx(400.0 / 300.0, rel=1e-3)


def test_a_wall_of_another_metal_counts_by_its_own():
    strong = metal(600)
    top, bottom = ((-0.03, 0.05), (0.03, 0.05)), ((-0.03, -0.05), (0.03, -0.05))
    web = Wall(((0.0, -0.05), (0.0, 0.05)), 0.003)
    own, whole, none = (
        build_law(
            "folded_plates",
            WallSection((Wall(bottom, 0.003, material=one), Wall(top, 0.003, material=one), web)),
            base,
            "y",
        ).moment_capacity(0.1)
        for one, base in ((strong, STEEL), (None, strong), (None, STEEL))
    )
    assert none < own < whole


STRIP = WallSection((Wall(((0.0, 0.0), (0.04, 0.0)), 0.003),))


@pytest.mark.parametrize(
    ("section", "message"),
    [
        (CircularTube(0.05, 0.002), "a formula of its own"),
        (RectangularTube(0.05, 0.03, 0.002), "a formula of its own"),
        (written_section("hat 60x50x1.5 mm, flange 20 mm"), "a formula of its own"),
        (STRIP, "flat walls at different heights"),
    ],
)
def test_other_sections_are_refused(section, message):
    with pytest.raises(InputError, match=message):
        build_law("folded_plates", section, STEEL, "y")


def test_general_constants_hold_for_tubes_that_are_walls():
    """Not what they are for: a rectangular tube has its formula, which shells confirm."""
    walls = outline_section([(-0.029, -0.029), (0.029, -0.029), (0.029, 0.029), (-0.029, 0.029)], 0.002)
    found = build_law("auto", walls, STEEL, "y")
    kecman = build_law("kecman", RectangularTube(0.06, 0.06, 0.002), STEEL, "y")
    assert work(found, 1, 20.0) == pytest.approx(work(kecman, 1, 20.0), rel=0.25)
    assert ANY.lip < ANY.bend < ANY.junction
