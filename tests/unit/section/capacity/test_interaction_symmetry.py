"""The fit of the interaction has the symmetry of the section, and mirrored sections have mirrored fits."""

import numpy as np
import pytest

from crumple.material import Material
from crumple.section import (
    Channel,
    CircularTube,
    ClosedHat,
    Hat,
    MultiCellTube,
    RectangularTube,
    Wall,
    WallSection,
    fitted_interaction,
    plastic_interaction,
)
from crumple.section.capacity.interaction_rows import nonnegative_least_squares, whole_power
from crumple.section.capacity.interaction_symmetry import (
    axisymmetric,
    multiplicity,
    symmetry,
    with_images,
)

MM = 1e-3
STEEL = Material("steel", 210e9, 0.3, 7850.0, 350e6)
SOFT = Material("soft", 210e9, 0.3, 7850.0, 200e6)
ABOUT_Y, ABOUT_Z, HALF_TURN = (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)
SIGNS = (ABOUT_Y, ABOUT_Z, HALF_TURN)


def drawn(points, one=1.0, other=1.0, **options):
    """Section of one wall through points [mm], mirrored by signs of y and z."""
    return WallSection((Wall([(one * y * MM, other * z * MM) for y, z in points], 2 * MM, **options),))


Z_POINTS = [(-40, 50), (0, 50), (0, -50), (40, -50)]
L_POINTS = [(40, 0), (0, 0), (0, 60)]
HAT_POINTS = [(-50, 0), (-30, 0), (-30, 50), (30, 50), (30, 0), (50, 0)]
# a tube whose long wall has a corner in its middle on one side only
SPLIT = [(0, 0), (30, 0), (60, 0), (60, 40), (0, 40)]
CASES = {
    "square": (RectangularTube(50 * MM, 50 * MM, 2 * MM), SIGNS, 8),
    "thick square": (RectangularTube(50 * MM, 50 * MM, 5 * MM), SIGNS, 8),
    "rectangle": (RectangularTube(60 * MM, 40 * MM, 2 * MM), SIGNS, 4),
    "rounded rectangle": (RectangularTube(50 * MM, 25 * MM, 2.65 * MM, 5 * MM), SIGNS, 4),
    "round": (CircularTube(50 * MM, 2 * MM), SIGNS, 8),
    "split": (drawn(SPLIT, closed=True), SIGNS, 4),
    "cells": (MultiCellTube(100 * MM, 60 * MM, 2 * MM, 3, 2), SIGNS, 4),
    "closed hat": (ClosedHat(70 * MM, 60 * MM, 1.6 * MM, 18 * MM), [ABOUT_Z], 2),
    "two metals": (ClosedHat(60 * MM, 50 * MM, 1.5 * MM, 20 * MM, plate_material=SOFT), [ABOUT_Z], 2),
    "hat": (Hat(60 * MM, 50 * MM, 1.5 * MM, 20 * MM), [ABOUT_Z], 2),
    "channel": (Channel(50 * MM, 100 * MM, 2 * MM), [ABOUT_Y], 2),
    "Z": (drawn(Z_POINTS), [HALF_TURN], 2),
    "L": (drawn(L_POINTS), [], 1),
}
FORCES = np.random.default_rng(1).normal(size=(200, 4))


def fit_of(section, rows=16):
    return fitted_interaction(plastic_interaction(section, STEEL), rows=rows)


@pytest.mark.parametrize("name", CASES)
def test_symmetry_is_that_of_the_walls(name):
    section, signs, number = CASES[name]
    images = symmetry(plastic_interaction(section, STEEL))
    assert len(images) == number
    np.testing.assert_array_equal(images[0], np.eye(3))
    found = {tuple(np.diag(image)[1:]) for image in images if np.count_nonzero(np.diag(image)) == 3}
    assert found - {(1.0, 1.0)} == set(signs)


def polygon(sides):
    angle = 2.0 * np.pi * np.arange(sides) / sides
    return drawn(list(zip(25.0 * np.cos(angle), 25.0 * np.sin(angle), strict=True)), closed=True)


def test_round_tubes_alone_are_axisymmetric():
    interactions = {name: plastic_interaction(section, STEEL) for name, (section, _, _) in CASES.items()}
    assert [name for name, interaction in interactions.items() if axisymmetric(interaction)] == ["round"]
    assert not axisymmetric(plastic_interaction(polygon(16), STEEL))
    # a ring drawn by walls is one
    assert axisymmetric(plastic_interaction(polygon(96), STEEL))


def test_round_tube_has_one_capacity_about_all_axes():
    fit = fit_of(CircularTube(50 * MM, 2 * MM))
    forces = FORCES[:20] * fit.scales
    g, gradient = fit.gauge_and_gradient(forces)
    for angle in (0.4, 1.0, 2.5):
        turn = np.eye(4)
        turn[1:3, 1:3] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
        turned, slope = fit.gauge_and_gradient(forces @ turn.T)
        # both moments have one scale, but for the sides by which the ring is drawn
        np.testing.assert_allclose(turned, g, rtol=1e-5)
        np.testing.assert_allclose(slope * fit.scales, gradient * fit.scales @ turn.T, atol=1e-4)
    ends = [fit.gauge(forces + s * 1e-7 * fit.scales * np.eye(4)[:, None]) for s in (1.0, -1.0)]
    np.testing.assert_allclose((gradient * fit.scales).T, (ends[0] - ends[1]) / 2e-7, atol=1e-6)


def test_nearly_symmetric_is_not_symmetric():
    off = [(0, 0), (60, 0), (60, 40.01), (0, 40)]
    assert len(symmetry(plastic_interaction(drawn(off, closed=True), STEEL))) == 1
    assert len(symmetry(plastic_interaction(RectangularTube(50 * MM, 50.01 * MM, 2 * MM), STEEL))) == 4


@pytest.mark.parametrize("rows", [16, 24])
@pytest.mark.parametrize("name", CASES)
def test_capacity_and_flow_of_images(name, rows):
    section, signs, _ = CASES[name]
    fit = fit_of(section, rows)
    assert len(fit.rows) <= rows
    value, slope = fit.gauge_and_gradient(FORCES * fit.scales)
    for about_y, about_z in signs:
        image = np.array([1.0, about_y, about_z, 1.0])
        of_image, slope_of_image = fit.gauge_and_gradient(FORCES * image * fit.scales)
        np.testing.assert_allclose(of_image, value, rtol=1e-13)
        np.testing.assert_allclose(slope_of_image * image * fit.scales, slope * fit.scales, atol=1e-12)


def test_pure_moments_of_a_square_tube_turn_it_about_their_axis_alone():
    fit = fit_of(CASES["square"][0])
    for column in range(4):
        slope = fit.gauge_and_gradient(np.eye(4)[column] * fit.scales)[1] * fit.scales
        np.testing.assert_allclose(slope / slope[column], np.eye(4)[column], atol=1e-12)
    swapped = FORCES[:, [0, 2, 1, 3]]
    np.testing.assert_allclose(fit.gauge(FORCES * fit.scales), fit.gauge(swapped * fit.scales), rtol=1e-12)


@pytest.mark.parametrize("points", [L_POINTS, HAT_POINTS, [*Z_POINTS[:3], (55, -50)]])
@pytest.mark.parametrize("signs", [(-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)])
def test_mirrored_sections_have_mirrored_fits(points, signs):
    one, other = fit_of(drawn(points)), fit_of(drawn(points, *signs))
    image = np.array([1.0, signs[1], signs[0], 1.0])
    np.testing.assert_allclose(
        other.gauge(FORCES * image * other.scales), one.gauge(FORCES * one.scales), rtol=1e-10
    )


def test_images_of_rows():
    images = symmetry(plastic_interaction(CASES["square"][0], STEEL))
    rows = np.array([[1.0, 0, 0], [0, 1, 0], [0.5, 1, 0], [0, 1, 1], [0.5, 1, 1], [0, 1, 0.5], [0.5, 1, 0.3]])
    count, projection = multiplicity(rows, images)
    np.testing.assert_array_equal(count, [1, 2, 4, 2, 4, 4, 8])
    assert [len(with_images(row[None], images)) for row in rows] == count.tolist()
    np.testing.assert_allclose(np.einsum("kij,kj->ki", projection, rows), rows, atol=1e-15)
    # what a move may change: the number of images stays
    moved = np.einsum("kij,kj->ki", projection, rows + np.array([0.1, 0.2, 0.04]))
    assert [len(with_images(row[None], images)) for row in moved] == count.tolist()


def test_costs_limit_what_enters():
    generator = np.random.default_rng(0)
    matrix = np.abs(generator.normal(size=(40, 8)))
    costs = np.array([4.0, 4, 4, 4, 2, 2, 1, 1])
    x = nonnegative_least_squares(matrix, np.ones(40), 7, costs)
    assert 0.0 < costs[x > 0.0].sum() <= 7.0


@pytest.mark.parametrize("power", [1, 2, 8, 10, 14, 16, 23])
def test_whole_power(power):
    values = np.array([0.0, 0.3, 1.0, 1.7])
    np.testing.assert_allclose(whole_power(values, power), values**power, rtol=1e-14)
