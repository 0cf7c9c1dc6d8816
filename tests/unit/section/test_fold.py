import pytest

from crumple.section import CircularTube, RectangularTube, half_fold_length


def test_half_fold_length_of_the_tube_about_both_axes():
    tube = RectangularTube(0.050, 0.025, 0.00265)
    # 1.276 (47.35 mm)^(2/3) (2.65 mm)^(1/3), worked by hand: 13.088 and 1.3838 mm^(1/3)
    assert half_fold_length(tube, "y") == pytest.approx(23.11e-3, abs=0.01e-3)
    assert half_fold_length(tube, "z") < half_fold_length(tube, "y")


def test_half_fold_length_scales_with_the_section():
    small, large = RectangularTube(0.04, 0.04, 0.002), RectangularTube(0.12, 0.12, 0.006)
    assert half_fold_length(large) == pytest.approx(3.0 * half_fold_length(small))


def test_circular_tube_takes_its_midline_diameter():
    assert half_fold_length(CircularTube(0.04, 0.002)) == half_fold_length(RectangularTube(0.04, 0.03, 0.002))
