"""Mass properties of pieces and lumps."""

import numpy as np
import pytest
from tests.support.multibody.frames import structure

from crumple.multibody.bodies.rigid import RigidMass, combined, lump_mass, piece_mass

AREA = 0.050 * 0.025 - 0.0447 * 0.0197


def test_piece_is_a_uniform_bar_with_its_sections_rotary_inertia():
    piece = piece_mass(structure(), "bar", 0.2, 0.8)
    mass = 7850.0 * AREA * 0.6
    assert piece.mass == pytest.approx(mass)
    np.testing.assert_allclose(piece.centre, (0.5, 0.0, 0.0))
    about_y = 7850.0 * 0.6 * (0.050 * 0.025**3 - 0.0447 * 0.0197**3) / 12
    about_z = 7850.0 * 0.6 * (0.025 * 0.050**3 - 0.0197 * 0.0447**3) / 12
    bar = mass * 0.6**2 / 12
    np.testing.assert_allclose(np.diag(piece.inertia), (about_y + about_z, bar + about_y, bar + about_z))
    np.testing.assert_allclose(piece.inertia, np.diag(np.diag(piece.inertia)), atol=1e-12)


def test_turned_member_turns_its_inertia():
    upright = structure({"a": (0.0, 0.0, 0.0), "b": (0.0, 0.0, 1.0)})
    along, across = piece_mass(upright, "bar", 0.0, 1.0), piece_mass(structure(), "bar", 0.0, 1.0)
    np.testing.assert_allclose(np.linalg.eigvalsh(along.inertia), np.linalg.eigvalsh(across.inertia))
    assert along.inertia[2, 2] == pytest.approx(across.inertia[0, 0])


def test_pieces_add_up_to_the_member():
    whole = structure()
    parts = [piece_mass(whole, "bar", a, b) for a, b in ((0.0, 0.13), (0.13, 0.7), (0.7, 1.0))]
    added, expected = combined(parts), piece_mass(whole, "bar", 0.0, 1.0)
    assert added.mass == pytest.approx(expected.mass)
    np.testing.assert_allclose(added.centre, expected.centre, atol=1e-15)
    np.testing.assert_allclose(added.inertia, expected.inertia, rtol=1e-12, atol=1e-15)


def test_lump_lies_at_its_offset():
    masses = {"m": {"node": "b", "mass": 3.0, "offset": (0.0, 0.1, 0.2), "rotary_inertia": (0.4, 0.5, 0.6)}}
    whole = structure(masses=masses)
    lump = lump_mass(whole, whole.masses["m"])
    np.testing.assert_allclose(lump.centre, (1.0, 0.1, 0.2))
    np.testing.assert_allclose(lump.inertia, np.diag((0.4, 0.5, 0.6)))
    # two equal lumps: the parallel axes of Steiner
    other = RigidMass(3.0, lump.centre + np.array([0.0, 0.0, 2.0]), lump.inertia)
    both = combined([lump, other])
    np.testing.assert_allclose(np.diag(both.inertia), (0.8 + 6.0, 1.0 + 6.0, 1.2))


def test_nothing_weighs_nothing():
    assert combined([]).mass == 0.0
