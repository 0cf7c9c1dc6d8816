"""Largest moment of rectangular tubes: effective section by integration, continuity, limits of the regimes.

The formula of the first regime is compared with the section calculation that it abbreviates (linear stress,
compression edge at yield, reduced flange, walls as lines), to rounding.  The limits of a/t of the third
regime (46 at 235 MPa, 32 at 488 MPa with k = 5.4) are printed as whole numbers, so they are reproduced
within 0.5.

Kind: independent calculation; published.  Source: derived here; quoted.
"""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.hinge.bending.largest_moment import Regime, peak_moment
from crumple.material import Material
from crumple.section import RectangularTube


def metal(yield_stress, youngs_modulus=206e9):
    return Material("steel", youngs_modulus, 0.3, 7850.0, yield_stress)


def metal_with_ratio(section, ratio):
    """Metal whose yield stress makes the flange buckle at a given ratio to it."""
    stiff = peak_moment(section, metal(1e6))
    return metal(1e6 * stiff.buckling_ratio / ratio)


tubes = st.builds(
    lambda width, ratio, slender: RectangularTube(width, width * ratio, min(width, width * ratio) * slender),
    st.floats(0.02, 0.2),
    st.floats(0.3, 3.0),
    st.floats(0.004, 0.05),
)


def effective_section_moment(a, b, t, effective, yield_stress):
    """Moment of walls as lines, compression flange reduced, its edge at yield."""
    walls = [(effective * t, 0.0, 0.0), (a * t, b, 0.0), (2 * b * t, b / 2, 2 * t * b**3 / 12)]
    area = sum(size for size, _, _ in walls)
    centroid = sum(size * place for size, place, _ in walls) / area
    second = sum(own + size * (place - centroid) ** 2 for size, place, own in walls)
    return yield_stress * second / centroid


@given(tubes, st.floats(0.05, 0.999))
def test_first_regime_is_the_effective_section(section, ratio):
    material = metal_with_ratio(section, ratio)
    peak = peak_moment(section, material)
    assert peak.regime is Regime.BUCKLES_ELASTICALLY
    assert peak.effective_width == pytest.approx(section.width * (0.7 * ratio + 0.3))
    exact = effective_section_moment(
        section.width, section.depth, section.thickness, peak.effective_width, material.yield_stress
    )
    assert peak.moment == pytest.approx(min(exact, peak.plastic_moment), rel=1e-12)


@given(tubes, st.sampled_from([1.0, 2.0]))
def test_regimes_join_without_a_jump(section, join):
    below, above = (
        peak_moment(section, metal_with_ratio(section, join + offset)) for offset in (-1e-9, 1e-9)
    )
    # the metals differ by 2e-9 in yield stress
    assert below.moment / below.plastic_moment == pytest.approx(above.moment / above.plastic_moment, rel=1e-7)


@given(tubes, st.floats(0.05, 4.0))
def test_no_regime_passes_the_plastic_moment(section, ratio):
    peak = peak_moment(section, metal_with_ratio(section, ratio))
    assert 0.0 < peak.moment <= peak.plastic_moment
    assert peak.elastic_moment <= peak.plastic_moment
    if ratio >= 2.001:
        assert peak.regime is Regime.FULLY_PLASTIC
        assert peak.moment == peak.plastic_moment


@given(tubes, st.floats(0.05, 3.0), st.floats(0.05, 3.0))
def test_moment_over_plastic_moment_grows_with_the_buckling_stress(section, one, other):
    low, high = (peak_moment(section, metal_with_ratio(section, ratio)) for ratio in sorted((one, other)))
    assert low.moment / low.plastic_moment <= high.moment / high.plastic_moment * (1 + 1e-12)


def test_plastic_moment_closed_form_of_a_sharp_tube():
    a, b, t = 0.050, 0.025, 0.00265
    peak = peak_moment(RectangularTube(a, b, t), metal(488e6))
    assert peak.moment == pytest.approx(488e6 * t * (a * (b - t) + (b - 2 * t) ** 2 / 2), rel=1e-13)


def test_axis_turns_the_tube():
    tube = RectangularTube(0.050, 0.025, 0.0005, 0.001)
    assert peak_moment(tube, metal(488e6), "z") == peak_moment(tube.turned("z"), metal(488e6), "y")


@pytest.mark.parametrize(("yield_stress", "limit"), [(235e6, 46.0), (488e6, 32.0)])
def test_slenderness_limit_of_full_plasticity(yield_stress, limit, record_figure):
    # k = 5.4 at this a/b
    width, depth = 0.1, 0.1 * 0.16 / 0.17
    low, high = 20.0, 80.0
    for _ in range(60):
        middle = (low + high) / 2
        peak = peak_moment(RectangularTube(width, depth, width / middle), metal(yield_stress))
        low, high = (middle, high) if peak.regime is Regime.FULLY_PLASTIC else (low, middle)
    closed = math.sqrt(5.4 * math.pi**2 * 206e9 / (24 * (1 - 0.3**2) * yield_stress))
    assert low == pytest.approx(closed, rel=1e-9)
    record_figure(f"largest a/t of full plasticity at {yield_stress / 1e6:g} MPa", low, limit, 0.5)


def test_buckling_ratios_of_the_tube(record_figure):
    tube = RectangularTube(0.050, 0.025, 0.00265)
    flat, upright = (peak_moment(tube, metal(488e6), axis) for axis in ("y", "z"))
    record_figure("buckling over yield stress, 50x25x2.65 flat", flat.buckling_ratio, 5.95, 0.005)
    record_figure("buckling over yield stress, 50x25x2.65 upright", upright.buckling_ratio, 22.8, 0.05)
    record_figure("plastic moment, flat", flat.moment, 1696.0, 0.5, "N m")
    record_figure("plastic moment, upright", upright.moment, 2823.0, 0.5, "N m")
