"""Energy-equivalent flow stress against closed forms and against plain integration of moments."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.errors import InputError
from crumple.material import (
    HardeningTable,
    PerfectlyPlastic,
    Swift,
    Voce,
    bending_flow_stress,
    mean_flow_stress,
    membrane_flow_stress,
    power_law_flow_stress,
)


@given(st.floats(0.0, 0.5), st.floats(0.05, 0.8))
def test_power_law(exponent, strain):
    # a Swift curve of tiny prestrain is s_u (e/e_u)^n
    curve = Swift(1.0, 1e-12, exponent)
    last = float(curve.stress(strain))
    assert membrane_flow_stress(curve, strain) == pytest.approx(last / (exponent + 1.0), rel=1e-6)
    closed = 2.0 * last / ((exponent + 1.0) * (exponent + 2.0))
    assert bending_flow_stress(curve, strain) == pytest.approx(closed, rel=1e-6)


@given(st.floats(0.01, 0.8))
def test_perfect_plasticity_gives_yield(strain):
    curve = PerfectlyPlastic(355e6)
    assert membrane_flow_stress(curve, strain) == pytest.approx(355e6, rel=1e-12)
    assert bending_flow_stress(curve, strain) == pytest.approx(355e6, rel=1e-12)


@pytest.mark.parametrize(
    "curve", [Voce(300.0, 200.0, 0.1), HardeningTable([0.0, 0.05, 0.2], [300.0, 400.0, 450.0])]
)
@pytest.mark.parametrize("strain", [0.1, 0.4])
def test_bending_is_the_work_of_the_wall(curve, strain):
    # wall of thickness 2 with z in -1..1, curvature up to the surface strain: integrate moments plainly
    z = (np.arange(2000) + 0.5) / 2000
    curvatures = (np.arange(2000) + 0.5) / 2000 * strain
    moments = [2.0 * np.mean(curve.stress(curvature * z) * z) for curvature in curvatures]
    assert bending_flow_stress(curve, strain) == pytest.approx(np.mean(moments), rel=1e-6)
    assert bending_flow_stress(curve, strain) < membrane_flow_stress(curve, strain)


def test_rules_in_common_use():
    assert mean_flow_stress(355e6, 510e6) == pytest.approx(432.5e6)
    assert power_law_flow_stress(400e6, 400e6, 0.0) == pytest.approx(400e6)
    assert power_law_flow_stress(300e6, 400e6, 0.2) == pytest.approx(316.227766e6)


def test_no_strain_is_refused():
    with pytest.raises(InputError, match="final strain"):
        membrane_flow_stress(PerfectlyPlastic(1.0), 0.0)
