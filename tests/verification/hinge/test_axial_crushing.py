"""Axial crushing: the quoted coefficients are consistent with each other, and the peak with effective widths.

Square tubes after Abramowicz & Jones (1984, 1986), superfolding elements after Wierzbicki & Abramowicz,
circular tubes after Alexander (1960), hats after White, Jones & Abramowicz (1999).  The coefficients are
quoted and the originals were not seen, so nothing here confirms the level of a force.  What can be checked
is their consistency: the three constants of the superfolding element belong to one minimum with 4 pi of
straight hinge lines; both hats follow from the square tube; Alexander's short form is the leading term of
the long one.  No test result was obtained.

First folds, first troughs and the peaks of metal that hardens are those of columns between rigid ends that
shells push slowly (five elements along half a fold); of the peaks none was used to find the constants.

Kind: published; closed form; independent calculation.  Source: quoted; derived here; run here.
"""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import trapezoid

from crumple.errors import InputError
from crumple.hinge import (
    AxialLaw,
    Trust,
    absorbed_by,
    axial_law_types,
    build_axial_law,
)
from crumple.hinge.axial.axial_collapse import AxialCollapse
from crumple.hinge.axial.axial_law import rate_factor_of
from crumple.hinge.axial.circular import HALF_FOLD as CONCERTINA_FOLD
from crumple.hinge.axial.circular import concertina_force, effective_distance
from crumple.hinge.axial.square import Mode, mode_forces
from crumple.hinge.axial.squash import FREE, HELD, effective_width
from crumple.hinge.axial.superfolding import COEFFICIENT, HALF_FOLD, ROLLING_RADIUS
from crumple.hinge.axial.top_hat import DOUBLE_HAT, TOP_HAT, HatCrushing
from crumple.material import CowperSymonds, HardeningTable, Material, Swift
from crumple.section import CircularTube, ClosedHat, RectangularTube

STEEL = Material("steel", 210e9, 0.3, 7850.0, 300e6)
SQUARE = RectangularTube(0.040, 0.040, 0.002)
ROUND = CircularTube(0.042, 0.002)
HAT = ClosedHat(0.060, 0.040, 0.0015, 0.020)
LAWS = [
    ("square", SQUARE),
    ("superfolding", RectangularTube(0.05, 0.04, 0.002)),
    ("circular", ROUND),
    ("top_hat", HAT),
]
FIRST_FOLDS = [
    ("square", 3.3, 0.977),
    ("square", 2.7, 0.948),
    ("square", 2.0, 0.722),
    ("circular", 3.0, 1.012),
    ("circular", 2.0, 0.975),
    ("circular", 1.4, 0.806),
]
"""Wall [mm], and the shells' mean force over the squash load."""
every_law = pytest.mark.parametrize(("name", "section"), LAWS, ids=[name for name, _ in LAWS])


def test_forces_of_the_notes(record_figure):
    square = build_axial_law("square", SQUARE, STEEL)
    record_figure(
        "40x40x2, 300 MPa, 52.22 (c/h)^(1/3) M0", square.mean_crushing_force / 1e3, 42.5, 0.05, "kN"
    )
    folding = build_axial_law("superfolding", SQUARE, STEEL, crush_distance="full")
    force = folding.mean_crushing_force / 1e3
    record_figure("40x40x2, 300 MPa, 38.27 (c/h)^(1/3) M0", force, 31.2, 0.05, "kN")
    tube = build_axial_law("circular", ROUND, STEEL, crush_distance="full")
    force = tube.mean_crushing_force / 1e3
    record_figure("R 20, h 2, 300 MPa, Alexander", force, 36.3, 0.05, "kN")


def test_hats_follow_from_the_square_tube(record_figure):
    square = mode_forces(1.0)[Mode.SYMMETRIC]
    record_figure("top hat from the square tube", square / 4.0 ** (1 / 3), TOP_HAT, 5e-4, relative=True)
    record_figure("double hat from two top hats", 2.0 ** (2 / 3) * TOP_HAT, DOUBLE_HAT, 5e-4, relative=True)


def test_superfolding_constants_belong_to_one_minimum(record_figure):
    # P = A1 r/h + A2 c/H + A3 H/r is least where its three terms are P/3 each
    straight = COEFFICIENT / 3.0 * HALF_FOLD
    record_figure("straight hinge lines, 4 pi", straight, 4.0 * math.pi, 5e-3, relative=True)
    toroidal, inclined = COEFFICIENT / 3.0 / ROLLING_RADIUS, COEFFICIENT / 3.0 * ROLLING_RADIUS / HALF_FOLD
    radii = np.linspace(0.5, 1.0, 201)
    folds = np.linspace(0.7, 1.3, 241)
    forces = toroidal * radii[:, None] + straight / folds + inclined * folds / radii[:, None]
    place = np.unravel_index(np.argmin(forces), forces.shape)
    record_figure("least force on a grid", forces.min(), COEFFICIENT, 1e-4, relative=True)
    record_figure("its rolling radius over h^(2/3) c^(1/3)", radii[place[0]], ROLLING_RADIUS, 0.003)
    record_figure("its half fold length over h^(1/3) c^(2/3)", folds[place[1]], HALF_FOLD, 0.003)


def test_the_concertina_has_the_fold_of_least_force(record_figure):
    # y = 2 R/h, H in h y^(1/2)
    y = 20.0
    folds = np.linspace(0.8, 1.1, 301)
    long = folds * math.sqrt(y)
    forces = math.pi**2 * y / long + 2.0 * math.pi + 2.0 * math.sqrt(3.0) * math.pi * long
    place = int(np.argmin(forces))
    record_figure("its half fold length over h y^(1/2)", float(folds[place]), CONCERTINA_FOLD, 0.002)
    root = (float(forces[place]) - 2.0 * math.pi) / math.sqrt(y)
    record_figure("its term with y^(1/2)", root, 20.79, 5e-3, relative=True)


@pytest.mark.parametrize(
    ("side", "wall", "stress", "at", "trough"),
    [(45, 1.4, 300e6, 15e-3, 13.5e3), (60, 2.5, 250e6, 24e-3, 33.9e3)],
)
def test_the_first_trough_is_that_of_shells(side, wall, stress, at, trough, record_figure):
    metal = Material("steel", 210e9, 0.3, 7850.0, stress)
    tube = RectangularTube(side / 1e3, side / 1e3, wall / 1e3)
    points = [
        part[:-2]
        for part in AxialCollapse.of(build_axial_law("square", tube, metal), 0.28, tension=1e6).points
    ]
    # pushed slowly: docs/theory/axial_crushing.md; in the law the next fold begins at once
    force = min(points[1]) if at > points[0][-2] else float(np.interp(at, *points))
    record_figure(f"{side}x{wall} mm, first trough", force, trough, 0.15, "N", relative=True)


HARDENED = [
    ("square", 60, 2, (320e6, 0.006, 0.13), 1.160),
    ("square", 35, 1.8, (400e6, 0.012, 0.07), 1.090),
    ("square", 50, 4, (320e6, 0.006, 0.13), 1.423),
    ("square", 45, 1.5, (250e6, 0.005, 0.2), 1.294),
    ("circular", 60, 2, (320e6, 0.006, 0.13), 1.223),
    ("circular", 30, 1.5, (250e6, 0.005, 0.2), 1.646),
    ("circular", 50, 3.5, (400e6, 0.012, 0.07), 1.144),
    ("circular", 70, 1.8, (320e6, 0.006, 0.13), 1.175),
    ("superfolding", (60, 30), 2, (280e6, 0.008, 0.16), 1.234),
    ("superfolding", (50, 30), 1.5, (350e6, 0.01, 0.1), 1.099),
    ("superfolding", (40, 20), 2, (280e6, 0.008, 0.16), 1.351),
    ("superfolding", (80, 40), 3, (350e6, 0.01, 0.1), 1.139),
    ("top_hat", (60, 50), 1.5, (280e6, 0.008, 0.16), 1.094),
    ("top_hat", (70, 60), 2, (350e6, 0.01, 0.1), 1.054),
]
"""Yield stress, prestrain and exponent of Swift's curve, and largest force of shells over the squash load."""


@pytest.mark.parametrize(("kind", "wall", "shells"), FIRST_FOLDS)
def test_the_first_fold_takes_the_work_of_shells(kind, wall, shells, record_figure):
    """Columns of 40 mm and 350 MPa between clamps, pushed slowly: docs/theory/axial_crushing.md."""
    metal = Material("steel", 210e9, 0.3, 7850.0, 350e6)
    tube = RectangularTube(0.04, 0.04, wall / 1e3) if kind == "square" else CircularTube(0.04, wall / 1e3)
    law = AxialCollapse.of(
        build_axial_law("superfolding" if kind == "square" else kind, tube, metal), 0.4, tension=1e6
    )
    fold = (law.points[0][-3] + law.points[0][-4]) / 2.0
    u = np.linspace(0.0, fold / 4.0, 10_001)
    work = trapezoid(law.moment_capacity(u, -1), u) / (metal.yield_stress * tube.area * fold / 4.0)
    name = f"{kind} 40x{wall} mm, mean over a quarter of the first fold, over the squash load"
    record_figure(name, work, shells, 0.10, "", relative=True)


CLOSING = [
    ("square", (40, 40), 2.0, 350, 2.10),
    ("square", (45, 45), 1.4, 210, 1.61),
    ("square", (50, 50), 1.2, 350, 1.76),
    ("square", (60, 40), 1.5, 300, 1.99),
    ("square", (60, 60), 2.5, 250, 1.90),
    ("square", (80, 80), 2.0, 400, 2.02),
    ("square", (70, 70), 2.0, 300, 1.97),
    ("square", (40, 60), 1.8, 500, 2.26),
    ("circular", (50, 50), 1.5, 300, 2.51),
    ("circular", (40, 40), 2.0, 350, 2.37),
    ("circular", (60, 60), 3.0, 300, 2.30),
]
"""Mean force between the effective stroke and 0.9 of the length, over that before, of columns in shells."""


@pytest.mark.parametrize(("kind", "size", "wall", "stress", "shells"), CLOSING)
def test_the_force_of_closing_folds_is_that_of_shells(kind, size, wall, stress, shells, record_figure):
    """Three sides long, pushed slowly: docs/theory/axial_crushing.md; the last two square ones not used."""
    metal = Material("steel", 210e9, 0.3, 7850.0, 1e6 * stress)
    sides = [one / 1e3 for one in size]
    tube = CircularTube(sides[0], wall / 1e3) if kind == "circular" else RectangularTube(*sides, wall / 1e3)
    length = 1.5 * sum(sides)
    crushing = build_axial_law("superfolding" if kind == "square" else kind, tube, metal)
    law = AxialCollapse.of(crushing, length, tension=1e6)
    u = np.linspace(law.stroke, 0.9 * length, 1001)
    mean = float(np.mean(law.moment_capacity(u, -1))) / law.mean
    name = f"{kind} {'x'.join(map(str, size))}x{wall} mm, {stress} MPa, mean force of closing folds over P_m"
    record_figure(name, mean, shells, 0.20, "", relative=True)


@pytest.mark.parametrize(("kind", "size", "wall", "metal", "shells"), HARDENED)
def test_the_peak_of_metal_that_hardens_is_that_of_shells(kind, size, wall, metal, shells, record_figure):
    """Columns between clamps pushed slowly, of which none was used to find the constants."""
    stress, prestrain, exponent = metal
    hardening = Swift(stress, prestrain, exponent)
    steel = Material("steel", 210e9, 0.3, 7850.0, stress, hardening=hardening)
    sides = [one / 1e3 for one in (size if isinstance(size, tuple) else (size, size))]
    tube = {
        "circular": CircularTube(sides[0], wall / 1e3),
        "top_hat": ClosedHat(*sides, wall / 1e3, 0.02),
    }.get(kind, RectangularTube(*sides, wall / 1e3))
    law = build_axial_law(kind, tube, steel)
    title = f"{kind} {'x'.join(f'{1e3 * one:g}' for one in sides)}x{wall} mm, {stress / 1e6:g} MPa"
    name = f"{title}, n = {exponent:g}, peak over squash load"
    record_figure(name, law.peak_force / (stress * tube.area), shells, 0.05, "", relative=True)


def test_the_force_rises_along_the_hardening_curve_to_the_peak_and_in_tension_to_the_neck():
    curve, tube = Swift(280e6, 0.008, 0.16), RectangularTube(0.04, 0.04, 0.002)
    steel = Material("steel", 210e9, 0.3, 7850.0, 280e6, hardening=curve)
    law, length = build_axial_law("square", tube, steel), 0.3
    squash = 280e6 * tube.area
    exponent = 0.16 * law.peak_strain / (law.peak_strain + 0.008)
    assert law.peak_strain == pytest.approx(4.62 * (2.0 / 38.0) ** 1.53 * exponent**0.327, rel=1e-6)
    curved = build_axial_law("circular", CircularTube(0.04, 0.002), steel).peak_strain
    exponent = 0.16 * curved / (curved + 0.008)
    assert curved == pytest.approx(4.06 * (2.0 / 38.0) ** 1.2 * exponent**0.569, rel=1e-6)
    column = AxialCollapse.of(law, 0.4, tension=squash, closed_stiffness=1e6).hardening(
        steel, law.peak_strain, length
    )
    strains = law.peak_strain * np.array([0.0, 0.25, 1.0])
    wanted = tube.area * curve.stress(strains) * np.exp(strains)
    np.testing.assert_allclose(column.moment_capacity(strains * length, -1), wanted, rtol=2e-3)
    # what follows is the fold of a column of this peak
    later = column.folding.moment_capacity([0.0, 5e-3, 2e-2], -1)
    end = law.peak_strain * length
    np.testing.assert_allclose(column.moment_capacity(end + np.array([0.0, 5e-3, 2e-2]), -1), later)
    assert later[0] == pytest.approx(law.peak_force, rel=1e-9)
    assert column.stop.rotation == pytest.approx(end + 0.9 * 0.4, rel=1e-12)
    # Considere: the neck begins at e = n - e_0, and holds its force
    neck = 0.16 - 0.008
    most = tube.area * float(curve.stress(neck)) * math.exp(-neck)
    np.testing.assert_allclose(
        column.moment_capacity([0.0, neck * length, 0.2], 1), [squash, most, most], rtol=2e-3
    )
    kinks = np.array([0.0, *column.kinks(-1), 0.5])
    middles = (kinks[1:] + kinks[:-1]) / 2.0
    ends = column.moment_capacity(kinks, -1)
    np.testing.assert_allclose(column.moment_capacity(middles, -1), (ends[1:] + ends[:-1]) / 2.0, rtol=1e-9)


@pytest.mark.parametrize(
    "curve", [None, HardeningTable((0.0, 0.02, 0.2), (280e6, 280e6, 400e6))], ids=["none", "plateau"]
)
def test_walls_fold_at_yield_where_nothing_hardens_there(curve):
    steel = Material("steel", 210e9, 0.3, 7850.0, 280e6, hardening=curve)
    for name, section in (("square", SQUARE), ("circular", ROUND)):
        law = build_axial_law(name, section, steel)
        assert law.peak_strain == 0.0
        plain = build_axial_law(name, section, Material("steel", 210e9, 0.3, 7850.0, 280e6))
        assert law.peak_force == plain.peak_force


@every_law
def test_law_has_a_source(name, section):
    law = build_axial_law(name, section, STEEL)
    assert isinstance(law, AxialLaw)
    assert law.name == name
    assert law.source.trust is Trust.QUOTED
    assert law.title
    assert law.validity.basis
    assert 0.0 < law.effective_stroke <= 1.0
    assert 0.0 < law.mean_crushing_force < law.peak_force
    assert set(axial_law_types()) == {name for name, _ in LAWS}


@every_law
@given(scale=st.floats(0.1, 10.0))
def test_forces_scale_with_size_squared_and_with_stress(name, section, scale):
    sizes = {key: value * scale for key, value in vars(section).items() if isinstance(value, float) and value}
    larger = type(section)(**sizes)
    strong = Material("strong", 210e9 * scale, 0.3, 7850.0, 300e6 * scale)
    base = build_axial_law(name, section, STEEL)
    for law, factor in (
        (build_axial_law(name, larger, STEEL), scale**2),
        (build_axial_law(name, section, strong), scale),
    ):
        assert law.mean_crushing_force == pytest.approx(base.mean_crushing_force * factor, rel=1e-9)
        assert law.peak_force == pytest.approx(base.peak_force * factor, rel=1e-9)


@every_law
def test_rate_factor(name, section):
    fast = Material("steel", 210e9, 0.3, 7850.0, 300e6, flow_rate=CowperSymonds(6844.0, 3.91))
    law = build_axial_law(name, section, fast)
    factors = rate_factor_of(law, [0.0, 1.0, 10.0, 20.0])
    assert factors[0] == 1.0
    assert np.all(np.diff(factors) > 0.0)
    assert np.all(rate_factor_of(build_axial_law(name, section, STEEL), [0.0, 10.0]) == 1.0)


def test_rate_factor_of_the_square_law(record_figure):
    fast = Material("steel", 210e9, 0.3, 7850.0, 300e6, flow_rate=CowperSymonds(6844.0, 3.91))
    value = float(rate_factor_of(build_axial_law("square", SQUARE, fast), 10.0))
    expected = 1.0 + (0.33 * 10.0 / (0.040 * 6844.0)) ** (1.0 / 3.91)
    record_figure("40x40x2 at 10 m/s, 6844 1/s and 3.91", value, expected, 1e-12)


def test_crush_distance_changes_the_mean_but_not_the_energy():
    for name, section in (("superfolding", SQUARE), ("circular", ROUND)):
        full, effective = (
            build_axial_law(name, section, STEEL, crush_distance=distance)
            for distance in ("full", "effective")
        )
        assert absorbed_by(full, 0.3) == pytest.approx(absorbed_by(effective, 0.3), rel=1e-12)
        assert full.mean_crushing_force < effective.mean_crushing_force


def test_superfolding_lies_beside_the_square_law(record_figure):
    square, folding = (build_axial_law(name, SQUARE, STEEL) for name in ("square", "superfolding"))
    ratio = folding.mean_crushing_force / square.mean_crushing_force
    record_figure("superfolding over square, effective crush distance", ratio, 1.0, 0.01)


def test_half_a_fold_is_that_of_the_superfolding_law_unless_the_walls_stretch(record_figure):
    tube = RectangularTube(0.05, 0.05, 0.0015)
    folding = build_axial_law("superfolding", tube, STEEL)
    for mode in ("symmetric", "asymmetric_a", "asymmetric_b"):
        square = build_axial_law("square", tube, STEEL, mode=mode)
        record_figure(f"half a fold, {mode}", square.half_fold_length, folding.half_fold_length, 1e-12, "m")
    assert build_axial_law("square", tube, STEEL, mode="extensional").half_fold_length is None


@given(st.floats(2.0, 200.0))
def test_lowest_mode_is_the_least_and_meets_without_a_jump(slenderness):
    forces = mode_forces(slenderness)
    nearby = mode_forces(slenderness * (1.0 + 1e-9))
    assert min(nearby.values()) == pytest.approx(min(forces.values()), rel=1e-8)
    tube = RectangularTube(0.1, 0.1, 0.1 / max(slenderness, 2.1))
    law = build_axial_law("square", tube, STEEL, mode="lowest")
    assert law.mode is not Mode.LOWEST
    assert law.mean_crushing_force == pytest.approx(
        min(
            build_axial_law("square", tube, STEEL, mode=mode).mean_crushing_force
            for mode in Mode
            if mode is not Mode.LOWEST
        )
    )


@given(st.floats(2.01, 1000.0))
def test_concertina_ends(ratio):
    assert 0.45 < effective_distance(ratio) < 0.86
    # thin walls: Alexander's short form
    assert concertina_force(ratio) / (20.79 * math.sqrt(ratio)) - 1.0 == pytest.approx(
        0.5724 / math.sqrt(ratio), rel=1e-3
    )


@given(st.sampled_from([HELD, FREE]), st.floats(1.0, 500.0))
def test_effective_width_has_no_jump_and_ends_in_the_slender_limit(coefficient, slenderness):
    width = effective_width(slenderness * 1e-3, 1e-3, STEEL, coefficient)
    beside = effective_width(slenderness * (1 + 1e-9) * 1e-3, 1e-3, STEEL, coefficient)
    assert beside == pytest.approx(width, rel=1e-8)
    assert 0.0 < width <= slenderness * 1e-3
    limit = 1e-3 * math.sqrt(coefficient * math.pi**2 * 210e9 / (12 * 0.91 * 300e6))
    assert effective_width(100.0, 1e-3, STEEL, coefficient) == pytest.approx(limit, rel=1e-2)


def test_stout_walls_squash():
    law = build_axial_law("square", RectangularTube(0.04, 0.04, 0.004), STEEL)
    assert law.peak_force == pytest.approx(300e6 * 4 * 0.036 * 0.004, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "section", "options"),
    [
        ("square", RectangularTube(0.05, 0.04, 0.002), {}),
        ("square", ROUND, {}),
        ("superfolding", ROUND, {}),
        ("circular", SQUARE, {}),
        ("circular", ROUND, {"mode": "diamond", "crush_distance": "full"}),
        ("circular", ROUND, {"mode": "spiral"}),
        ("top_hat", SQUARE, {}),
        ("square", SQUARE, {"side": 1.0}),
        ("spiral", SQUARE, {}),
    ],
)
def test_what_does_not_fit_is_refused(name, section, options):
    with pytest.raises(InputError):
        build_axial_law(name, section, STEEL, **options)


def test_warnings():
    thin = build_axial_law("circular", ROUND, STEEL, mode="diamond")
    assert any("stroke of the diamond" in warning for warning in thin.validity.warnings)
    stout = build_axial_law("square", RectangularTube(0.04, 0.04, 0.008), STEEL)
    assert any("extensional" in warning for warning in stout.validity.warnings)
    slow = Material("steel", 210e9, 0.3, 7850.0, 300e6, yield_rate=CowperSymonds(40.4, 5.0))
    assert any("give flow_rate" in w for w in build_axial_law("square", SQUARE, slow).validity.warnings)
    assert HatCrushing.from_perimeter(0.3, 0.0015, STEEL, True).double
