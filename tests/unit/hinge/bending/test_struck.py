"""Laws of folds that an obstacle starts: they fall at once, or begin at what the dented section carries."""

import math
from itertools import pairwise

import numpy as np
import pytest

from crumple.hinge import build_law
from crumple.hinge.bending.struck import StruckLaw
from crumple.material import Material
from crumple.section import CircularTube, RectangularTube

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, density=7850.0, yield_stress=350e6)
SQUARE = build_law("kecman", RectangularTube(50e-3, 50e-3, 2e-3), STEEL, "y")
ROUND = build_law("circular", CircularTube(60e-3, 2e-3), STEEL, "y")
GRID = np.radians(np.linspace(0.0, 40.0, 401))


def test_a_flat_wall_folds_without_a_plateau():
    struck = StruckLaw(SQUARE)
    moment = SQUARE.moment_capacity(GRID)
    begins = max(kink for kink in SQUARE.kinks() if SQUARE.moment_capacity(kink) == pytest.approx(moment[0]))
    assert begins > math.radians(0.5)
    np.testing.assert_allclose(struck.moment_capacity(GRID), SQUARE.moment_capacity(GRID + begins))
    assert np.all(struck.moment_capacity(GRID[1:]) < moment[0])


@pytest.mark.parametrize("left", [0.3, 0.7])
def test_a_dented_tube_carries_no_more_than_the_dent_leaves(left):
    struck = StruckLaw(ROUND, left)
    own, first = ROUND.moment_capacity(GRID), float(ROUND.moment_capacity(0.0))
    np.testing.assert_allclose(struck.moment_capacity(GRID), np.minimum(own, left * first))
    assert struck.moment_capacity(0.0) == pytest.approx(left * first)


@pytest.mark.parametrize("law", [StruckLaw(SQUARE), StruckLaw(ROUND, 0.7)])
def test_kinks_are_where_the_slope_jumps(law):
    """Between two of them the law is smooth, so the middle of a short step lies on it up to its square."""
    kinks = np.array([0.0, *law.kinks(), GRID[-1]])
    step = 1e-5
    for start, end in pairwise(kinks):
        if end - start < 4 * step or end > GRID[-1]:
            continue
        at = np.linspace(start + 2 * step, end - 2 * step, 50)
        bow = law.moment_capacity(at - step) - 2 * law.moment_capacity(at) + law.moment_capacity(at + step)
        assert np.abs(bow).max() < 1e-5 * float(law.moment_capacity(0.0))


def test_what_does_not_change():
    struck = StruckLaw(ROUND, 0.7)
    for name in ("name", "source", "validity", "elastic_stiffness", "softening_variable", "rate", "stop"):
        assert getattr(struck, name) == getattr(ROUND, name)
    assert "dented, at most 0.7" in struck.title
    assert "without plateau" in StruckLaw(SQUARE).title
