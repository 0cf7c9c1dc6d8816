"""Figures of a crush zone from its histories."""

import numpy as np
import pytest

from crumple.result import crush_summary
from crumple.result.crush import slip_work, stretch_summary


def test_a_constant_force_is_its_own_mean_and_peak():
    travel = np.array([0.0, -0.02, -0.05, -0.045])
    crush = crush_summary(travel, np.array([-4e4, -4e4, -4e4, 0.0]), 0.25, 0.06)
    assert crush.length == 0.05
    assert crush.length_final == 0.045
    assert crush.peak_force == 4e4
    # what comes back in the last interval is no crushing
    assert crush.energy == pytest.approx(4e4 * 0.05)
    assert crush.mean_force == pytest.approx(crush.energy / 0.05)
    assert crush.efficiency == pytest.approx(0.2)
    assert not crush.bottomed_out
    known = crush_summary(travel, np.zeros(4), 0.25, 0.06, energy=50.0)
    assert (known.energy, known.mean_force) == (50.0, pytest.approx(1000.0))


def test_beyond_the_stroke_it_has_bottomed_out():
    force = np.full(3, -1e4)
    assert crush_summary(np.array([0.0, -0.06, -0.0601]), force, 0.25, 0.06).bottomed_out
    assert not crush_summary(np.array([0.0, -0.06, -0.0601]), force, 0.25, None).bottomed_out


def test_tension_crushes_nothing():
    crush = crush_summary(np.array([0.0, 0.01]), np.array([2e4, 2e4]), 0.25, 0.06)
    assert (crush.length, crush.peak_force, crush.mean_force, crush.efficiency) == (0.0, 0.0, 0.0, 0.0)


def test_of_a_hinge_that_lengthens_crushing_is_the_compression_alone():
    travel, force = np.array([0.0, -1e-5, 0.0, 0.01, 0.008]), np.array([0.0, -2e4, 0.0, 3e4, 3e4])
    crush = crush_summary(travel, force, 0.25, None)
    assert (crush.energy, crush.mean_force) == (pytest.approx(2e4 * 1e-5), pytest.approx(2e4))
    assert crush.peak_force == 2e4
    stretch = stretch_summary(travel, force, 0.25)
    assert (stretch.length, stretch.length_final, stretch.peak_force) == (0.01, 0.008, 3e4)
    assert stretch.energy == pytest.approx(3e4 * 0.01)
    assert stretch_summary(travel / 100.0, force, 0.25) is None


def test_slip_that_turns_about_between_outputs_gives_no_energy_back():
    """Outputs miss the turning points: the force changes sign over each of the two slips."""
    travel, force = np.array([0.0, 0.004, -0.006]), np.array([-1e4, 3e4, -1e4])
    assert slip_work(travel, force) == (pytest.approx(1e4 * 0.01), pytest.approx(3e4 * 0.004))
    # the product of means, which was reported, is negative: (-1e4 + 3e4)/2 * (0.004 - 0.01) = -60 J
    assert sum(slip_work(travel, force)) > 0.0
    # a force against the slip at both ends says nothing of that in between
    assert slip_work(np.array([0.0, 0.01]), np.array([-1e4, -1e4])) == (0.0, 0.0)
