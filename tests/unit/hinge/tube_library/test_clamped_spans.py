"""Span and distance of the law of tubes beside a clamp: what they mean, and where they end."""

from dataclasses import replace

import numpy as np
import pytest

from crumple.errors import InputError
from crumple.hinge import build_law
from crumple.hinge.tube_library.clamped import clamped_fold_distance
from crumple.material import Material
from crumple.material.hardening.swift import Swift
from crumple.section import CircularTube, RectangularTube, fold_distance, half_fold_length

STEEL = Material("steel", 210e9, 0.3, 7850.0, 350e6)
HARD = replace(STEEL, hardening=Swift(350e6, 0.01, 0.18))
SQUARE, ROUND = RectangularTube(0.050, 0.050, 0.0015), CircularTube(0.050, 0.002)
AT = np.radians([0.0, 2.0, 8.0, 20.0, 30.0])


def moment(section, material=HARD, **options):
    return build_law("clamped_tube", section, material, **options).moment_capacity(AT)


@pytest.mark.parametrize(("section", "sides"), [(SQUARE, 6.0), (ROUND, 8.0)])
def test_the_span_and_the_distance_of_the_cantilevers_change_nothing(section, sides):
    own = moment(section, span=sides * 0.050, distance=fold_distance(section, "y"))
    np.testing.assert_allclose(own, moment(section), rtol=1e-12)


@pytest.mark.parametrize(("section", "sides"), [(SQUARE, 6.0), (ROUND, 8.0)])
def test_the_moment_further_out_is_that_of_the_cantilever_there(section, sides):
    length, near, far = sides * 0.050, fold_distance(section, "y"), 0.040
    np.testing.assert_allclose(
        moment(section, distance=far), moment(section) * (length - far) / (length - near), rtol=1e-12
    )


def test_a_slender_tube_that_hardens_carries_more_in_a_short_span():
    short, long = moment(SQUARE, span=0.125), moment(SQUARE)
    assert np.all(short[1:] > 1.05 * long[1:])
    # beyond the solved ones the nearest counts
    np.testing.assert_allclose(moment(SQUARE, span=0.05), short)
    np.testing.assert_allclose(moment(SQUARE, span=3.0), moment(SQUARE, span=0.4))
    bands = [build_law("clamped_tube", SQUARE, HARD, span=one).validity.uncertainty for one in (0.3, 0.125)]
    assert bands[1] > bands[0] + 0.05


def test_a_thick_tube_that_does_not_harden_carries_less_in_a_short_span():
    thick = RectangularTube(0.050, 0.050, 0.0031)
    assert np.all(moment(thick, STEEL, span=0.125) < 0.98 * moment(thick, STEEL))


def test_the_force_of_a_round_tube_is_that_of_the_fold_at_its_place():
    """Beyond 8 degrees the same moment at the fold, whatever the span: the hinge is where the fold is."""
    far = clamped_fold_distance(ROUND, HARD, "y")
    short, long = (moment(ROUND, span=one, distance=far)[3:] for one in (0.15, 0.40))
    np.testing.assert_allclose(short, long, rtol=1e-12)
    early = [moment(ROUND, span=one, distance=far)[0] for one in (0.15, 0.40)]
    assert early[0] < early[1]


def test_hardening_puts_the_fold_further_out():
    for section in (SQUARE, ROUND):
        plain, hard = (clamped_fold_distance(section, metal, "y") for metal in (STEEL, HARD))
        half = half_fold_length(section, "y")
        assert 0.4 * half < plain < hard < 2.5 * half
    assert clamped_fold_distance(ROUND, HARD, "y") > 1.5 * clamped_fold_distance(ROUND, STEEL, "y")


def test_a_hinge_far_from_the_clamp_is_refused():
    with pytest.raises(InputError, match="distance is out of range"):
        moment(SQUARE, distance=0.08)
