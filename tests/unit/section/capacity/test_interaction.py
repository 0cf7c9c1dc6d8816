import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from crumple.errors import InputError
from crumple.material import Material
from crumple.numeric.monotone_root import rising_root
from crumple.section import (
    Channel,
    ClosedHat,
    Hat,
    MultiCellTube,
    RectangularTube,
    fitted_interaction,
    moment_capacity,
    plastic_interaction,
)
from crumple.section.capacity.interaction_rows import nonnegative_least_squares

MM = 1e-3
STEEL = Material("steel", 210e9, 0.3, 7850.0, 488e6)
SOFT = Material("soft", 210e9, 0.3, 7850.0, 200e6)
SURFACES = [
    plastic_interaction(section, STEEL)
    for section in (
        RectangularTube(50 * MM, 25 * MM, 2.65 * MM, 5 * MM),
        Hat(60 * MM, 50 * MM, 1.5 * MM, 20 * MM),
        ClosedHat(60 * MM, 50 * MM, 1.5 * MM, 20 * MM, plate_material=SOFT),
        MultiCellTube(100 * MM, 60 * MM, 2 * MM, 2, 2),
        Channel(50 * MM, 100 * MM, 2 * MM),
    )
]
FITS = [fitted_interaction(surface) for surface in SURFACES]
NUMBERS = range(len(SURFACES))
DIRECTION = arrays(float, 4, elements=st.floats(-1.0, 1.0)).filter(lambda d: np.abs(d).max() > 1e-3)


@given(st.sampled_from(NUMBERS), DIRECTION, DIRECTION)
def test_no_point_passes_any_tangent_plane(number, one, other):
    surface = SURFACES[number]
    one, other = one / surface.scales, other / surface.scales
    # the point of one rate never dissipates more in another rate: maximum of plastic dissipation
    assert surface.point(other) @ one <= surface.support(one) * (1 + 1e-9) + 1e-12


@given(st.sampled_from(NUMBERS), DIRECTION, DIRECTION, st.floats(0.0, 1.0))
def test_dissipation_is_convex_and_even(number, one, other, share):
    surface = SURFACES[number]
    one, other = one / surface.scales, other / surface.scales
    mixed = surface.support(share * one + (1 - share) * other)
    bound = share * surface.support(one) + (1 - share) * surface.support(other)
    assert mixed <= bound * (1 + 1e-9) + 1e-12
    assert surface.support(-one) == pytest.approx(surface.support(one), rel=1e-9)


@given(st.sampled_from(NUMBERS), DIRECTION, st.floats(0.01, 100.0))
def test_points_do_not_depend_on_the_size_of_the_rate(number, rate, factor):
    surface = SURFACES[number]
    rate = rate / surface.scales
    off = (surface.point(factor * rate) - surface.point(rate)) / surface.scales
    assert np.abs(off).max() < 1e-6


@pytest.mark.parametrize("number", NUMBERS)
def test_point_is_the_slope_of_the_dissipation(number):
    surface = SURFACES[number]
    rate = np.array([0.2, 0.7, -0.5, 0.4]) / surface.scales
    step = 1e-6 / surface.scales
    steps = np.diag(step)
    slope = (surface.support(rate + steps) - surface.support(rate - steps)) / (2 * step)
    np.testing.assert_allclose(slope / surface.scales, surface.point(rate) / surface.scales, atol=1e-5)


@pytest.mark.parametrize("number", NUMBERS)
def test_multiplier_agrees_with_surface_points(number):
    surface = SURFACES[number]
    rates = np.array([[0.1, 0.8, 0.3, 0.2], [0.4, -0.3, 0.5, 0.0], [0.0, 0.2, 0.1, 0.9]]) / surface.scales
    for point in surface.point(rates):
        assert surface.multiplier(point) == pytest.approx(1.0, abs=3e-3)
        assert surface.multiplier(2 * point) == pytest.approx(0.5, abs=2e-3)


def test_soft_plate_lowers_the_squash_force():
    hat = SURFACES[2]
    areas = hat.section.skeleton_areas
    plate = np.array([name == 1 for name in hat.section.skeleton.wall])
    expected = 488e6 * areas[~plate].sum() + 200e6 * areas[plate].sum()
    assert hat.squash_force == pytest.approx(expected)
    assert hat.support([1.0, 0, 0, 0]) == pytest.approx(expected)


def test_axial_force_in_capacity_is_that_of_the_surface():
    stiff = Material("stiff", 1e18, 0.3, 7850.0, 488e6)
    tube = RectangularTube(50 * MM, 25 * MM, 2.65 * MM, 5 * MM)
    surface = plastic_interaction(tube, stiff)
    curve = surface.force_moment_curve("y", points=2001)[:2001]
    for share in (-0.6, -0.2, 0.3):
        force = share * surface.squash_force
        expected = np.interp(force, *curve[np.argsort(curve[:, 0])].T)
        value = moment_capacity(tube, stiff, axial_force=force).moment
        assert value == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("bad", [{"axial_force": -1e9}, {"axial_force": 1e9}, {"sense": 0}, {"axis": "x"}])
def test_capacity_refuses(bad):
    with pytest.raises(InputError):
        moment_capacity(RectangularTube(50 * MM, 25 * MM, 2 * MM), STEEL, **bad)


def test_cross_moment_of_a_held_axis():
    # a symmetric section needs none; a channel whose compressed flange buckles loses its symmetry
    for axis in ("y", "z"):
        capacity = moment_capacity(SURFACES[0].section, STEEL, axis)
        assert capacity.cross_moment == pytest.approx(0.0, abs=1e-6 * capacity.moment)
    thin = moment_capacity(Channel(50 * MM, 100 * MM, 1 * MM), STEEL, "y")
    assert abs(thin.cross_moment) > 0.01 * thin.moment
    assert [part.plate for part in thin.lost]
    assert np.isfinite(thin.neutral_axis)


# the compact fit


@given(st.sampled_from(NUMBERS), DIRECTION, DIRECTION)
def test_gauge_is_a_norm(number, one, other):
    fit = FITS[number]
    one, other = one * fit.scales, other * fit.scales
    g = fit.gauge
    assert g(3.0 * one) == pytest.approx(3.0 * g(one), rel=1e-9)
    assert g(-one) == pytest.approx(g(one), rel=1e-12)
    assert g(one + other) <= (g(one) + g(other)) * (1 + 1e-9)


@given(st.sampled_from(NUMBERS), DIRECTION)
def test_gradient_of_the_gauge(number, direction):
    fit = FITS[number]
    x = direction * fit.scales
    value, gradient = fit.gauge_and_gradient(x)
    # linear along rays (Euler)
    assert gradient @ x == pytest.approx(value, rel=1e-9)
    step = 1e-6 * np.diag(fit.scales)
    slope = (fit.gauge(x + step) - fit.gauge(x - step)) / 2e-6
    np.testing.assert_allclose(slope, gradient * fit.scales, atol=2e-3)


def test_gauge_at_the_origin():
    value, gradient = FITS[0].gauge_and_gradient(np.zeros(4))
    assert value == 0.0
    assert (gradient == 0.0).all()


def test_fit_uses_no_more_rows_than_asked():
    fit = fitted_interaction(SURFACES[0], rows=8)
    assert len(fit.rows) <= 8
    assert fit.error > 0.0
    assert fit.mean_error <= fit.error


@pytest.mark.parametrize("change", [1e-3, 1e-5, -1e-5, 1e-6, -1e-6])
def test_the_fit_of_a_mirrored_section_does_not_jump_with_rounding(change):
    """Strength scales the surface alone: the rows, which are shares, stay."""
    section = RectangularTube(50 * MM, 25 * MM, 2.65 * MM)
    rows = [
        fitted_interaction(plastic_interaction(section, Material("", 210e9, 0.3, 7850.0, strength))).rows
        for strength in (488e6, 488e6 * (1.0 + change))
    ]
    np.testing.assert_allclose(rows[0], rows[1], atol=1e-9)


def test_nonnegative_least_squares_finds_the_constrained_minimum():
    generator = np.random.default_rng(0)
    matrix, right = generator.normal(size=(40, 8)), generator.normal(size=40)
    x = nonnegative_least_squares(matrix, right, 8)
    slope = matrix.T @ (matrix @ x - right)
    assert (x >= 0.0).all()
    np.testing.assert_allclose(slope[x > 0.0], 0.0, atol=1e-8)
    assert (slope[x == 0.0] >= -1e-8).all()


def test_root_of_a_jump_and_of_ends():
    assert rising_root(lambda x: x - 0.3, 0.0, 1.0, 1e-14) == pytest.approx(0.3, abs=1e-12)
    assert rising_root(lambda x: -1.0 if x < 0.7 else 2.0, 0.0, 1.0, 0.0) == pytest.approx(0.7, abs=1e-12)
    assert rising_root(lambda x: x + 1.0, 0.0, 1.0, 0.0) == 0.0
    assert rising_root(lambda x: x - 2.0, 0.0, 1.0, 0.0) == 1.0


@pytest.mark.parametrize("angle", [np.nan, np.inf])
def test_an_angle_that_is_not_finite_is_refused(angle):
    with pytest.raises(InputError, match="angle of the axis is not finite"):
        moment_capacity(RectangularTube(0.06, 0.04, 0.002), STEEL, angle)
