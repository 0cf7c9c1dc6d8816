"""What the compressed edge of a tube that bends about its diagonal does not lose: limits of the formula."""

import pytest

from crumple.hinge.bending.edge_fold import SLENDERNESS, THIN, edge_relief
from crumple.section import RectangularTube


def test_thin_square_tubes_have_the_most_and_thick_ones_nothing():
    assert edge_relief(RectangularTube(1.0, 1.0, 1e-4)) == pytest.approx(THIN, rel=1e-6)
    half = RectangularTube(1.0 + SLENDERNESS, 1.0 + SLENDERNESS, SLENDERNESS)
    assert edge_relief(half) == pytest.approx(THIN / 2.0, rel=1e-12)
    assert edge_relief(RectangularTube(0.05, 0.05, 0.008)) < 0.01


def test_the_smaller_the_flatter_whichever_side_is_the_longer():
    flat = edge_relief(RectangularTube(0.09 + 1e-6, 0.03 + 1e-6, 1e-6))
    assert flat == pytest.approx(THIN / 9.0, rel=1e-4)
    assert flat == edge_relief(RectangularTube(0.03 + 1e-6, 0.09 + 1e-6, 1e-6))


def test_size_does_not_matter():
    one, other = (RectangularTube(k * 0.05, k * 0.07, k * 0.002) for k in (1.0, 7.0))
    assert edge_relief(one) == pytest.approx(edge_relief(other), rel=1e-12)
