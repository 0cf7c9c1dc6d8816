"""Measured curves: a known law comes back from noisy specimens, its scatter with it."""

import numpy as np
import pytest

from crumple.errors import InputError
from crumple.hinge import HingeRate, Trust, record_of
from crumple.hinge.axial.axial_law import AxialLaw
from crumple.hinge.measured.measured import bending_band, crushing_of, measured_band, read_specimens, smoothed

STIFFNESS = 40e3


def capacity(plastic):
    return 400.0 + 600.0 * np.exp(-plastic / 0.2)


def specimen(factor=1.0, noise=0.0, seed=0):
    """Total rotation and moment of a hinge with an elastic rise."""
    plastic = np.linspace(0.0, 0.8, 400)
    moment = factor * capacity(plastic)
    rise = np.linspace(0.0, 0.99, 40)
    total = np.concatenate([rise * moment[0] / STIFFNESS, plastic + moment / STIFFNESS])
    moment = np.concatenate([rise * moment[0], moment])
    return total, moment + noise * np.random.default_rng(seed).standard_normal(moment.size)


def test_parabolas_pass_the_smoothing_unchanged():
    x = np.sort(np.random.default_rng(1).uniform(0.0, 1.0, 2000))
    grid, values = smoothed(x, 3.0 + 2.0 * x - x**2, 0.2)
    np.testing.assert_allclose(values, 3.0 + 2.0 * grid - grid**2, atol=1e-5)
    assert grid[0] == x[0]
    assert grid[-1] == x[-1]


def test_smoothing_takes_noise_away():
    x = np.linspace(0.0, 1.0, 1000)
    noise = np.random.default_rng(2).standard_normal(x.size)
    grid, values = smoothed(x, np.sin(x) + 0.1 * noise, 0.3)
    assert np.std(values - np.sin(grid)) < 0.06


def test_mean_of_identical_specimens_is_the_law_without_its_elastic_part():
    band = measured_band([specimen(), specimen(), specimen()])
    np.testing.assert_allclose(band.mean, capacity(band.abscissa), rtol=1e-3)
    assert band.elastic_stiffness == pytest.approx(STIFFNESS, rel=1e-6)
    assert band.scatter == pytest.approx(0.0, abs=1e-9)


def test_scatter_is_that_of_the_specimens():
    factors = np.array([0.9, 1.0, 1.1])
    band = measured_band([specimen(factor) for factor in factors], coverage=2.0)
    np.testing.assert_allclose(band.mean, capacity(band.abscissa), rtol=2e-3)
    assert band.scatter == pytest.approx(2.0 * factors.std(ddof=1), rel=2e-2)
    laws = bending_band(band)
    assert laws.nominal.validity.uncertainty == pytest.approx(band.scatter)
    assert laws.nominal.source.trust is Trust.MEASURED
    rotation = np.linspace(0.0, 0.7, 20)
    low, middle, high = (law.moment_capacity(rotation) for law in (laws.lower, laws.nominal, laws.upper))
    np.testing.assert_allclose(high / middle, 1.2, rtol=1e-2)
    np.testing.assert_allclose(low / middle, 0.8, rtol=1e-2)
    assert len({record_of(law).positive.moment[0] for law in (laws.lower, laws.nominal, laws.upper)}) == 3


def test_noisy_specimens():
    curves = [specimen(noise=15.0, seed=seed) for seed in range(5)]
    band = measured_band(curves, window=0.08, elastic_stiffness=STIFFNESS)
    beyond = band.abscissa > 0.05
    np.testing.assert_allclose(band.mean[beyond], capacity(band.abscissa[beyond]), rtol=0.03)


def test_a_curve_without_a_plastic_part_says_why():
    rotation, moment = [0.0, 0.01, 0.02, 0.3], [0.0, 500.0, 1000.0, 0.0]
    with pytest.raises(InputError, match="falls to 0"):
        measured_band([(rotation, moment)], elastic_stiffness=50e3)
    with pytest.raises(InputError, match="lies on the elastic line to its end"):
        measured_band([(rotation[:3], moment[:3])], elastic_stiffness=50e3)


def test_band_ends_with_the_shortest_specimen():
    short = tuple(values[:200] for values in specimen())
    band = measured_band([specimen(), short])
    assert band.abscissa[-1] == pytest.approx(measured_band([short]).abscissa[-1])


def test_dynamic_factor_and_rate_exclude_each_other():
    band = measured_band([specimen()], dynamic_factor=1.2)
    np.testing.assert_allclose(band.mean, 1.2 * capacity(band.abscissa), rtol=1e-3)
    with pytest.raises(InputError, match="twice"):
        bending_band(band, rate=HingeRate(100.0, 4.0))
    slow = bending_band(measured_band([specimen()]), rate=HingeRate(100.0, 4.0))
    assert slow.nominal.rate_factor(100.0) == 2.0


def test_one_specimen_has_no_band():
    laws = bending_band(measured_band([specimen()]))
    assert laws.nominal.validity.uncertainty is None
    np.testing.assert_array_equal(laws.lower.moment_capacity([0.1]), laws.upper.moment_capacity([0.1]))


def test_crush_tests():
    head = "displacement [mm], force [kN]\n"
    rows = [(0.0, 0.0), (0.2, 20.0), (0.5, 50.0), (1.0, 100.0), (5.0, 40.0), (100.0, 40.0)]
    texts = {
        f"{name}.csv": head + "\n".join(f"{x}, {factor * force}" for x, force in rows)
        for name, factor in (("a", 0.95), ("b", 1.05))
    }
    band = measured_band(read_specimens(texts, crush=True), names=list(texts))
    law = crushing_of(band, 0.15)
    assert isinstance(law, AxialLaw)
    # from the peak of 100 kN at 1 mm (all elastic) to 40 kN at 5 mm, held to 100 mm, elastic part out
    assert law.peak_force == pytest.approx(100e3, rel=1e-3)
    stroke = 0.100 - 40.0 / 100.0 * 1e-3
    triangle = 30e3 * (0.005 - 0.0004)
    assert law.mean_crushing_force == pytest.approx(40e3 + triangle / stroke, rel=5e-3)
    assert law.effective_stroke == pytest.approx(stroke / 0.15, rel=1e-3)
    assert law.validity.uncertainty == pytest.approx(2.0 * 0.05 * np.sqrt(2.0), rel=1e-2)
    with pytest.raises(InputError, match="shorter"):
        crushing_of(band, 0.05)


def test_mistakes_of_all_files_at_once_and_by_name():
    with pytest.raises(InputError) as caught:
        read_specimens({"a.csv": "rotation [deg], moment [kN]\n1, 2", "b.csv": ""})
    assert {problem.file for problem in caught.value.problems} == {"a.csv", "b.csv"}
    with pytest.raises(InputError, match="specimen second"):
        measured_band([specimen(), ([0.0, 0.1, 0.2], [0.0, np.nan, 1.0])], names=["first", "second"])
    with pytest.raises(InputError, match="no curve"):
        measured_band([])
    with pytest.raises(InputError, match="window"):
        smoothed([0.0, 0.5, 1.0], [0.0, 1.0, 2.0], 2.0)
    with pytest.raises(InputError, match="dynamic factor"):
        measured_band([specimen()], dynamic_factor=0.5)


def test_a_window_far_shorter_than_the_curve_is_refused_before_its_grid_is_made():
    x = np.linspace(0.0, 1.0, 50)
    assert len(smoothed(x, x, 1e-3)[0]) == 10_001
    with pytest.raises(InputError, match="window is out of range"):
        smoothed(x, x, 1e-12)
