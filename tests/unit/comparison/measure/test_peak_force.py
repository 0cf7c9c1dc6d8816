"""The filtered force of an obstacle depends neither on outputs between nor on when it begins."""

from types import SimpleNamespace

import numpy as np
import pytest

from crumple.comparison.measure.measures import _filtered

EVERY, FRAME, DURATION = 0.5e-3, 1.2e-3, 60e-3


def filtered(time, struck):
    """Of an impact [N s] at 30.9 ms on a constant 2 kN, recorded as means since the output before."""
    passed = 2e3 * (time + EVERY) + struck * (time >= 30.9e-3)
    force = np.diff(passed, prepend=0.0) / np.diff(time, prepend=-EVERY)
    return _filtered(SimpleNamespace(time=time), np.column_stack([force, 0.0 * time, 0.0 * time]))


def test_outputs_of_shapes_change_no_filtered_force():
    even = np.arange(0.0, DURATION + EVERY / 2, EVERY).round(9)
    with_shapes = np.union1d(even, np.arange(0.0, DURATION, FRAME).round(9))
    assert filtered(with_shapes, 3.0) == pytest.approx(filtered(even, 3.0), rel=1e-6)
    # what the impact adds contains its impulse
    added = filtered(even, 3.0) - filtered(even, 0.0)
    assert added.sum() * EVERY == pytest.approx(3.0, rel=1e-3)


@pytest.mark.parametrize("start", [0.0, 0.5e-3, 20e-3])
def test_a_pulse_at_the_start_is_filtered_as_one_later(start):
    """Before the run nothing pressed: its mirror image took back more than half of a pulse at the start."""
    time = np.arange(0.0, DURATION + EVERY / 2, EVERY).round(9)
    force = np.where((time > start) & (time <= start + 4 * EVERY), 30e3, 0.0)
    peak = _filtered(SimpleNamespace(time=time), np.column_stack([force, 0.0 * time, 0.0 * time])).max()
    assert peak == pytest.approx(15.1e3, rel=0.02)
