"""Laws of folds in dents begin at what the dented section carries."""

from itertools import pairwise

import numpy as np
import pytest

from crumple.hinge import build_law
from crumple.hinge.bending.dented import DentedLaw
from crumple.material import Material
from crumple.section import CircularTube

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, density=7850.0, yield_stress=350e6)
ROUND = build_law("circular", CircularTube(60e-3, 2e-3), STEEL, "y")
GRID = np.radians(np.linspace(0.0, 40.0, 401))


@pytest.mark.parametrize("left", [0.3, 0.7])
def test_a_dented_tube_carries_no_more_than_the_dent_leaves(left):
    dented = DentedLaw(ROUND, left)
    own, first = ROUND.moment_capacity(GRID), float(ROUND.moment_capacity(0.0))
    np.testing.assert_allclose(dented.moment_capacity(GRID), np.minimum(own, left * first))
    assert dented.moment_capacity(0.0) == pytest.approx(left * first)


def test_kinks_are_where_the_slope_jumps():
    """Between two of them the law is smooth: the bow over a short step is of the second order."""
    law = DentedLaw(ROUND, 0.7)
    kinks = [kink for kink in (0.0, *law.kinks(), GRID[-1]) if kink <= GRID[-1]]
    assert len(kinks) > 2
    step = 1e-5
    for start, end in pairwise(kinks):
        at = np.linspace(start + 2 * step, end - 2 * step, 50)
        bow = law.moment_capacity(at - step) - 2 * law.moment_capacity(at) + law.moment_capacity(at + step)
        assert np.abs(bow).max() < 1e-5 * float(law.moment_capacity(0.0))


def test_the_limit_ends_where_the_law_falls_below_it():
    law = DentedLaw(ROUND, 0.7)
    limit = 0.7 * float(ROUND.moment_capacity(0.0))
    own = [kink for kink in law.kinks() if kink not in ROUND.kinks()]
    np.testing.assert_allclose(ROUND.moment_capacity(own), limit, rtol=1e-14)


def test_what_does_not_change():
    dented = DentedLaw(ROUND, 0.7)
    for name in ("name", "source", "validity", "elastic_stiffness", "softening_variable", "rate", "stop"):
        assert getattr(dented, name) == getattr(ROUND, name)
    assert "dented: at most 0.7" in dented.title
