"""Warnings about the energy of a shell result."""

from __future__ import annotations

import numpy as np
import pytest

from crumple.shell.checks.trust import given_by_contact


@pytest.mark.parametrize(("lowest", "said"), [(-51.0, True), (-9.0, False), (20.0, False)])
def test_energy_that_contact_forces_gave_the_walls_is_told_from_one_percent_on(lowest, said):
    found = given_by_contact(np.array([0.0, 3.0, lowest, 0.5 * lowest]), 1000.0)
    assert len(found) == said
    if said:
        assert "51 J (5.1% of the internal energy)" in found[0]


def test_where_nothing_is_stored_nothing_is_said():
    assert given_by_contact(np.array([-1.0]), 0.0) == []
