"""Laws of folds in dents begin at what the dented section carries."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from crumple.hinge import build_law
from crumple.hinge.bending.dented import DentedLaw, WrappedLaw, wraps
from crumple.material import Material
from crumple.section import CircularTube

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, density=7850.0, yield_stress=350e6)
STEEL_600 = replace(STEEL, yield_stress=600e6)
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


def test_the_fold_of_a_round_tube_softens_from_the_dent_on():
    dented, first = DentedLaw(ROUND, 0.7, is_round=True), float(ROUND.moment_capacity(0.0))
    own, found = ROUND.moment_capacity(GRID), dented.moment_capacity(GRID)
    np.testing.assert_allclose(1.0 / found**2 - 1.0 / own**2, (1.0 / 0.7**2 - 1.0) / first**2)
    assert found[0] == pytest.approx(0.7 * first)
    assert dented.kinks() == ROUND.kinks()


def test_what_does_not_change():
    dented = DentedLaw(ROUND, 0.7)
    for name in ("name", "source", "validity", "elastic_stiffness", "softening_variable", "rate", "stop"):
        assert getattr(dented, name) == getattr(ROUND, name)
    assert "dented: at most 0.7" in dented.title


def test_a_wrapped_law_is_that_of_the_fold_up_to_the_curvature_of_the_pole():
    law = build_law("circular", CircularTube(0.035, 0.0028), STEEL_600, "y")
    wrapped = WrappedLaw(law, 0.25)
    at = np.linspace(0.0, 1.5, 61)
    wanted = law.moment_capacity(np.minimum(at, 0.25))
    np.testing.assert_array_equal(wrapped.moment_capacity(at), wanted)
    assert wrapped.kinks()[-1] == 0.25
    assert all(kink <= 0.25 for kink in wrapped.kinks())
    assert "around a pole from 14.3 deg on" in wrapped.title
    assert wrapped.validity.rotation_max == math.inf
    assert WrappedLaw(law, math.inf).validity == law.validity
    assert WrappedLaw(law, math.inf).jamming_angle == law.jamming_angle
    assert wrapped.jamming_angle is None


def test_a_tube_wraps_if_its_fold_has_not_softened_by_a_seventh():
    law = build_law("circular", CircularTube(0.035, 0.0028), STEEL_600, "y")
    softened = next(
        float(at)
        for at in np.linspace(0.0, 1.0, 1001)
        if law.moment_capacity(at) < 0.85 * law.moment_capacity(0.0)
    )
    assert wraps(law, softened - 2e-3, 1)
    assert not wraps(law, softened + 2e-3, 1)
    # a pole as sharp as this touches it in one place, whatever the law
    flat = build_law("constant", CircularTube(0.035, 0.0028), STEEL_600, "y", moment=1e3)
    assert wraps(flat, 1.5, 1)
    assert not wraps(flat, 1.6, 1)
