"""A law from histories: work is kept, vibrations are averaged, the elastic part does not enter."""

import numpy as np
import pytest

from crumple.characterisation.curve import law_curve
from crumple.errors import InputError


def test_softening_law_is_recovered_with_its_work():
    rotation = np.linspace(0.0, 0.6, 2000)
    moment = 1000.0 / (1.0 + 3.0 * rotation)
    curve = law_curve(rotation, moment, 0.5)
    at = np.linspace(0.02, 0.48, 40)
    assert np.interp(at, curve.rotation, curve.moment) == pytest.approx(1000.0 / (1.0 + 3.0 * at), rel=1e-3)
    assert curve.energy_at(0.5) == pytest.approx(1000.0 / 3.0 * np.log(2.5), rel=1e-3)
    assert curve.rotation[0] == 0.0
    assert curve.rotation[-1] == pytest.approx(0.5)


def test_vibration_leaves_the_work_and_little_else():
    rotation = np.linspace(0.0, 0.6, 4000)
    moment = 1000.0 - 500.0 * rotation
    shaken = moment + 100.0 * np.sin(2.0 * np.pi * rotation / np.deg2rad(0.25))
    curve = law_curve(rotation, shaken, 0.5)
    assert curve.energy_at(0.5) == pytest.approx(1000.0 * 0.5 - 250.0 * 0.5**2, rel=2e-3)
    assert curve.moment_at(0.25) == pytest.approx(875.0, rel=0.02)


def test_law_ends_where_the_histories_end():
    rotation = np.linspace(0.0, 0.3, 500)
    assert law_curve(rotation, np.full(500, 10.0), 0.5).rotation[-1] == pytest.approx(0.3)


def test_elastic_piece_is_refused():
    with pytest.raises(InputError, match="did not turn plastically"):
        law_curve(np.linspace(0.0, 1e-4, 50), np.linspace(0.0, 10.0, 50), 0.5)
