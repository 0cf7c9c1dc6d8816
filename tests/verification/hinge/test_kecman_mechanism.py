"""Folding mechanism of a rectangular tube: lengths, energies by an independent method, limits, jamming.

The mechanism is derived in docs/theory/kecman.md, so it is checked by geometry and not by a publication:
every plate keeps its lengths, hinge lines rotate by the angles between the normals of the plates, and small
rotations follow the leading terms.  Tolerances are rounding, amplified by the square root at small
rotation.  The shares of the terms and the limit of M sqrt(theta) of the 40x40x2 tube come from the same
derivation made separately; its shares are printed as whole numbers that add up to 100, its limit to three
digits, not rounded up.

Kind: invariant; independent calculation.  Source: derived here; derived here.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.hinge.bending.kecman_mechanism import FoldMechanism


def mechanisms():
    """Tubes of any proportion that a wall of less than a third of the smaller side allows."""
    return st.builds(
        lambda width, ratio, slender, weight: FoldMechanism(
            width, width * ratio, min(width, width * ratio) * slender, 300e6, weight
        ),
        st.floats(0.02, 0.2),
        st.floats(0.25, 4.0),
        st.floats(0.005, 0.3),
        st.floats(0.0, 1.0),
    )


shares_of_jamming = st.floats(0.001, 1.0)
SQUARE = FoldMechanism(0.040, 0.040, 0.002, 300e6, 0.0)
FLAT = FoldMechanism(0.050, 0.025, 0.00265, 488e6)


def points(mechanism, rotation):
    """Corners K, E, A, N and the fold corner B of one quarter of the fold."""
    c = mechanism.corners(rotation)
    h = mechanism.half_length
    up = mechanism.depth * np.cos(rotation / 2)
    return {
        "K": np.array([h, 0.0, 0.0]),
        "N": np.array([-h, 0.0, 0.0]),
        "E": np.array([c["x_E"], up, 0.0]),
        "B": np.array([0.0, c["y_B"], 0.0]),
        "A": np.array([0.0, c["y_B"], c["z_A"]]),
    }


@given(mechanisms(), shares_of_jamming)
def test_every_plate_keeps_its_lengths(mechanism, share):
    p = points(mechanism, share * mechanism.jamming_angle)
    b, h, bulge = mechanism.depth, mechanism.half_length, p["A"][2]
    lengths = {
        "EB": (np.linalg.norm(p["E"] - p["B"]), h),
        "KE": (np.linalg.norm(p["K"] - p["E"]), b),
        "EA": (np.linalg.norm(p["E"] - p["A"]), np.hypot(h, bulge)),
        "KA": (np.linalg.norm(p["K"] - p["A"]), np.hypot(h, b - bulge)),
    }
    for name, (folded, flat) in lengths.items():
        assert folded == pytest.approx(flat, rel=1e-11), name
    # the web centre line, from the bottom to the bulge and back to the fold, keeps the depth
    assert np.hypot(p["A"][1], bulge) + bulge == pytest.approx(b, rel=1e-11)


def angle_between(first, second):
    """Angle between two directions, accurate at small angles."""
    first, second = first / np.linalg.norm(first), second / np.linalg.norm(second)
    return 2 * np.arctan2(np.linalg.norm(first - second), np.linalg.norm(first + second))


@given(mechanisms(), shares_of_jamming)
def test_line_turns_are_angles_between_plate_normals(mechanism, share):
    rotation = share * mechanism.jamming_angle
    p = points(mechanism, rotation)
    b, h, bulge = mechanism.depth, mechanism.half_length, p["A"][2]
    side = np.cross(p["E"] - p["K"], p["A"] - p["K"])
    lower = np.cross(p["A"] - p["K"], p["N"] - p["K"])
    web, vertical = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])
    flange_slope = angle_between(p["E"] - p["B"], vertical)
    terms = mechanism.energy_terms(rotation)
    expected = {
        "W1": 2 * mechanism.width * (np.pi / 2 - rotation / 2 - flange_slope),
        "W2": mechanism.width * (np.pi - 2 * flange_slope),
        "W3": 2 * mechanism.width * rotation / 2,
        "W4": 4 * bulge * (np.pi / 2 - flange_slope),
        "W5": 4 * b * angle_between(side, web),
        "W6": 2 * 2 * h * angle_between(lower, web),
        "W7": 4 * np.linalg.norm(p["K"] - p["A"]) * angle_between(side, lower),
        "W8": 4 * h * bulge / ((0.07 - rotation / 70) * h),
        "W8b": mechanism.rolling_weight * 2 / 3 * 4 * bulge / (0.07 - rotation / 70),
    }
    assert terms.keys() == expected.keys()
    for name, value in expected.items():
        assert terms[name] == pytest.approx(value, rel=1e-8, abs=1e-10 * b), name


@given(mechanisms(), shares_of_jamming)
def test_moment_is_the_slope_of_the_energy(mechanism, share):
    rotation = share * mechanism.jamming_angle
    step = 1e-4 * rotation
    slope = (mechanism.energy(rotation + step) - mechanism.energy(rotation - step)) / (2 * step)
    # the difference quotient errs by about step^2/theta^2/6
    assert mechanism.moment(rotation) == pytest.approx(slope, rel=1e-7)
    # a complex step is exact to rounding, line by line
    stepped = mechanism.energy_terms(rotation + 1e-30j)
    for name, rate in mechanism.energy_rates(rotation).items():
        assert rate == pytest.approx(stepped[name].imag / 1e-30, rel=1e-10, abs=1e-13 * mechanism.depth), name
    curve = (mechanism.moment(rotation + step) - mechanism.moment(rotation - step)) / (2 * step)
    assert mechanism.slope(rotation) == pytest.approx(
        curve, rel=1e-6, abs=1e-6 * mechanism.moment(rotation) / rotation
    )


@given(mechanisms())
def test_flange_halves_touch_at_the_jamming_angle(mechanism):
    corners = mechanism.corners(mechanism.jamming_angle)
    assert corners["x_E"] == pytest.approx(mechanism.thickness / 2, rel=1e-9)


@given(mechanisms())
def test_bulge_starts_as_a_square_root_and_ends_at_the_closed_flange(mechanism):
    b, h = mechanism.depth, mechanism.half_length
    small = 1e-10
    assert mechanism.corners(small)["z_A"] == pytest.approx(np.sqrt(b * h * small), rel=1e-4)
    # flange plates vertical, b sin(rho) = h: the bulge is h cos(rho)
    closed = 2 * np.arcsin(h / b) * (1 - 1e-12)
    assert mechanism.corners(closed)["z_A"] == pytest.approx(h * np.cos(closed / 2), rel=1e-5)


@given(mechanisms())
def test_small_rotation_terms(mechanism):
    a, b, h = mechanism.width, mechanism.depth, mechanism.half_length
    small = 1e-10
    terms = mechanism.energy_terms(small)
    for name in ("W1", "W2"):
        assert terms[name] == pytest.approx(2 * a * np.sqrt(b * small / h), rel=1e-4)
    assert terms["W8"] == pytest.approx(4 * h * np.sqrt(b * h * small) / (0.07 * h), rel=1e-4)
    # W ~ theta^(1/2), so M = W/(2 theta)
    assert mechanism.moment(small) == pytest.approx(mechanism.energy(small) / (2 * small), rel=1e-3)


def test_square_tube_small_rotation_constant(record_figure):
    # plastic moment of sharp 40x40x2 in 300 MPa
    plastic = 300e6 * 0.002 * (0.040 * 0.038 + 0.036**2 / 2)
    small = 1e-12
    record_figure(
        "M sqrt(theta)/Mp, 40x40x2, one rolling line",
        SQUARE.moment(small) * small**0.5 / plastic,
        0.277,
        1e-3,
    )


@pytest.mark.parametrize(("name", "share"), [("W8", 63), ("W7", 10), ("W5", 9), ("W2", 6), ("W1", 5)])
def test_shares_of_the_square_tube_at_20_degrees(name, share, record_figure):
    terms = SQUARE.energy_terms(np.radians(20.0))
    value = 100 * terms[name] / sum(terms.values())
    record_figure(
        f"share of {name} in the energy at 20 deg, 40x40x2, one rolling line", value, share, 0.6, "%"
    )


def test_jamming_angles_of_the_tube(record_figure):
    upright = FoldMechanism(0.025, 0.050, 0.00265, 488e6)
    record_figure("jamming angle, 50x25x2.65 flat", np.degrees(FLAT.jamming_angle), 53.10, 0.005, "deg")
    record_figure("jamming angle, 50x25x2.65 upright", np.degrees(upright.jamming_angle), 25.83, 0.005, "deg")
