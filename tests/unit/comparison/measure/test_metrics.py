"""Figures of a hinge: peak, energies at levels, opening, errors."""

import math
from dataclasses import replace

import numpy as np
import pytest

from crumple.comparison.measure.metrics import compared, metrics_of, rotation_levels
from crumple.comparison.measure.motion import HingeMotion


def motion(scale=1.0, sense=1.0, **changes):
    time = np.linspace(0.0, 0.1, 101)
    turned = scale * 0.5 * np.sin(np.pi * time / 0.16)
    fields = {
        "name": "root", "member": "tube", "station": 0.02, "time": time, "rotation": sense * turned,
        "rotation_rate": np.gradient(sense * turned, time), "plastic_rotation": sense * (turned - 0.01),
        "moment": sense * np.full_like(time, 1000.0), "how": "",
        "plastic_work": 1000 * np.maximum.accumulate(np.maximum(turned - 0.01, 0)),
    }  # fmt: skip
    return HingeMotion(**{**fields, **changes})


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_figures_do_not_depend_on_the_sense(sense):
    figures = metrics_of(motion(sense=sense), (0.1, 0.3, 0.6))
    assert figures.rotation_max == pytest.approx(0.5)
    assert figures.time_of_peak == pytest.approx(0.08)
    assert figures.plastic_rotation == pytest.approx(0.49)
    assert figures.energy_at[:2] == pytest.approx((100.0, 300.0))
    assert figures.energy_at[2] is None
    assert figures.moment_peak == pytest.approx(1000.0)
    assert figures.moment_mean == pytest.approx(1000.0)


def test_the_opening_is_interpolated():
    time = np.array([0.0, 1.0, 2.0])
    turned = np.array([0.0, 0.0, math.radians(1.0)])
    half = motion(time=time, rotation=turned, plastic_rotation=turned, moment=turned, plastic_work=turned)
    assert metrics_of(half, ()).opened == pytest.approx(1.5)
    assert metrics_of(replace(half, plastic_rotation=0.1 * turned), ()).opened is None


@pytest.mark.parametrize(
    ("largest", "degrees"),
    [(math.radians(31), [5, 10, 15, 20, 25, 30]), (math.radians(9), [2, 4, 6, 8]), (1e-4, [])],
)
def test_levels_are_round_and_about_five(largest, degrees):
    assert np.degrees(rotation_levels(largest)) == pytest.approx(degrees)


def test_errors_are_relative_to_the_reference():
    pair = compared(motion(), motion(scale=1.2), motion())
    assert pair.error("rotation_max") == pytest.approx(0.2)
    assert all(error == pytest.approx(0.0, abs=1e-9) for error in pair.energy_errors())
    assert pair.error("far_rotation_max") is None


def test_without_a_fold_in_the_reference_there_is_no_error():
    assert compared(motion(), motion(), motion(fold=False)).error("rotation_max") is None
    assert compared(motion(), motion(), None).error("rotation_max") is None
