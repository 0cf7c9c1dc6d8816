"""Laws of profiles take the work of shells: `Combined` sub-models of docs/theory/folded_profile.md."""

import math

import numpy as np
import pytest

from crumple.hinge import absorbed_energy, build_law
from crumple.material import Material
from crumple.section import Channel, ClosedHat, Hat

# width, depth, wall, flange [mm], yield stress [MPa], work up to 5, 10 and 20 deg in shells [J]
PLATES = [
    ((50, 50, 2, 20, 400), (315.6, 605.8, 1088.6)),
    ((50, 60, 1.2, 15, 300), (165.4, 285.9, 484.1)),
    ((60, 30, 1.6, 15, 500), (170.6, 330.6, 593.8)),
    ((60, 45, 1.4, 16, 600), (297.0, 537.5, 815.4)),
    ((70, 40, 1, 16, 500), (147.5, 245.9, 386.7)),
    ((70, 60, 1.6, 18, 400), (364.6, 651.1, 1092.5)),
    ((80, 60, 1.2, 18, 350), (217.0, 361.4, 583.6)),
    ((90, 50, 1, 20, 280), (113.7, 181.0, 279.6)),
    # not used for the constants
    ((100, 60, 1.5, 20, 500), (456.7, 741.1, 1145.9)),
    ((60, 60, 1.8, 20, 300), (302.4, 559.6, 936.3)),
    ((65, 50, 1.3, 15, 350), (185.3, 324.5, 540.8)),
    ((75, 55, 1.5, 17, 450), (339.7, 598.2, 1000.0)),
    ((60, 40, 1.1, 14, 320), (103.2, 181.6, 301.5)),
]
# channels: flange, web, wall, lip; hats: width, depth, wall, flange
EDGES = [
    (Channel, (40, 80, 1.5, 10, 350), (72.6, 107.7, 149.9)),
    (Channel, (45, 60, 1.2, 12, 500), (94.7, 143.7, 201.4)),
    (Channel, (50, 70, 1.6, 15, 400), (152.4, 239.6, 342.5)),
    (Channel, (50, 70, 2.5, 12, 300), (178.9, 301.3, 433.7)),
    (Channel, (60, 90, 2, 15, 300), (190.9, 289.1, 400.4)),
    (Channel, (40, 80, 2.5, 0, 300), (73.5, 111.5, 162.5)),
    (Hat, (60, 30, 1.6, 15, 500), (98.6, 180.6, 285.2)),
    (Hat, (70, 60, 1.6, 18, 400), (204.3, 309.9, 433.8)),
    # neither these nor any hat were used for the factor
    (Channel, (45, 75, 1.8, 11, 420), (134.7, 202.6, 283.0)),
    (Channel, (40, 100, 2.2, 14, 350), (139.0, 240.1, 356.8)),
    (Hat, (65, 55, 1.7, 16, 300), (149.8, 235.4, 330.8)),
    (Hat, (100, 60, 1.6, 22, 450), (238.6, 394.1, 620.0)),
]


def profile(kind, sizes):
    first, second, wall, edge = (1e-3 * size for size in sizes[:4])
    return kind(first, second, wall, **{"lip" if kind is Channel else "flange": edge})


def differences(section, stress, work):
    """Work of the law in the positive sense over that of shells less 1, up to 5, 10 and 20 degrees."""
    metal = Material("steel", 210e9, 0.3, 7850.0, 1e6 * stress)
    law = build_law("folded_profile", section, metal, "z" if isinstance(section, Channel) else "y")
    turns = [np.linspace(0.0, math.radians(end), 801) for end in (5.0, 10.0, 20.0)]
    return np.array([np.trapezoid(law.moment_capacity(at), at) for at in turns]) / work - 1.0


@pytest.mark.parametrize(("sizes", "work"), PLATES)
def test_closed_hats_with_a_compressed_plate(sizes, work):
    assert np.abs(differences(profile(ClosedHat, sizes), sizes[4], work)).max() < 0.13


def test_constants_of_the_compressed_plate_are_not_biased():
    """The mean over all hats, those of the fit and the others."""
    found = [differences(profile(ClosedHat, sizes), sizes[4], work) for sizes, work in PLATES]
    assert np.abs(np.mean(found, axis=0)).max() < 0.03


@pytest.mark.parametrize(("kind", "sizes", "work"), EDGES)
def test_channels_and_hats_with_a_compressed_open_side(kind, sizes, work):
    assert np.abs(differences(profile(kind, sizes), sizes[4], work)).max() < 0.2


def test_the_factor_of_free_edges_is_not_too_high():
    found = [differences(profile(kind, sizes), sizes[4], work) for kind, sizes, work in EDGES]
    assert np.all(np.mean(found, axis=0) < 0.02)
    assert np.all(np.mean(found, axis=0) > -0.09)


def test_the_kink_where_the_neutral_axis_of_a_compressed_plate_reaches_the_crown_is_known():
    steel = Material("steel", 210e9, 0.3, 7850.0, 355e6)
    law = build_law("folded_profile", ClosedHat(0.125, 0.125, 0.00195, 0.0375), steel, "y")
    (kink,) = (at for at in law.kinks(1) if 0.1 < at < 0.99 * law.jamming_angle)
    beside = [float(law.moment_capacity(kink + offset)) for offset in (-2e-4, 0.0, 2e-4)]
    before, after = np.diff(beside)
    assert abs(before / after - 1.0) > 0.2
    # without it the energy is not the integral of the moment
    at, step = 1.4 * kink, 1e-5
    slope = (absorbed_energy(law, at + step) - absorbed_energy(law, at - step)) / (2.0 * step)
    assert slope == pytest.approx(float(law.moment_capacity(at)), rel=1e-5)
