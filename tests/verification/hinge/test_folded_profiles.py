"""Channels and hats: the tube is a limit case, and the folding of free edges satisfies its geometry.

The mechanisms are derived, and nothing is published.  Checked are the lengths of the plates of the free
edge, its fold angles from the normals of the planes, the moment as a difference of the work, the best half
length, and that a profile with all its faces is the tube of the Kecman-type law.

Kind: independent calculation; invariant.  Source: derived here; derived here.
"""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.errors import InputError
from crumple.hinge import build_law
from crumple.hinge.bending.free_edge import FreeEdgeMechanism
from crumple.hinge.bending.kecman_mechanism import FoldMechanism
from crumple.hinge.bending.profile_mechanism import ProfileMechanism
from crumple.material import Material
from crumple.section import Channel, ClosedHat, Hat, RectangularTube, moment_capacity

STEEL = Material("steel", 210e9, 0.3, 7850.0, 300e6)
EDGE = FreeEdgeMechanism(0.040, 0.002, 300e6, 0.080, 0.01)
shares = st.floats(1e-3, 0.99)


def points(mechanism, rotation):
    at = mechanism.corners(rotation)
    return (
        np.zeros(3),
        np.array([float(at["x_P"]), float(at["y_P"]), 0.0]),
        np.array([0.0, float(at["y_A"]), float(at["z_A"])]),
    )


@given(shares)
def test_free_edge_keeps_every_length(share):
    root, end, middle = points(EDGE, share * EDGE.jamming_angle)
    h, b = EDGE.half_length, EDGE.depth
    assert np.linalg.norm(middle - root) == pytest.approx(b, rel=1e-11)
    assert np.linalg.norm(end - middle) == pytest.approx(h, rel=1e-9)
    assert np.linalg.norm(end - root) == pytest.approx(math.hypot(h, b), rel=1e-11)


def test_fold_angles_by_normals(record_figure):
    rotation = 0.5
    root, end, middle = points(EDGE, rotation)
    normal = np.cross(middle - root, end - root)
    normal /= np.linalg.norm(normal)
    mirrored = normal * [-1.0, 1.0, 1.0]
    at_middle = math.acos(normal @ mirrored)
    inclined = math.acos(abs(normal[2]))
    length = math.hypot(EDGE.half_length, EDGE.depth)
    moment = 300e6 * 0.002**2 / 4
    edge = 2 * 300e6 * 0.002 * 0.01**2 * math.asin(middle[2] / EDGE.half_length)
    work = moment * (2 * (0.040 * at_middle + 2 * length * inclined) + 0.080 * rotation) + edge
    record_figure("free edge, work at 0.5 rad", float(EDGE.energy(rotation)), work, 1e-9, "J", relative=True)


@given(shares)
def test_moment_is_the_slope_of_the_work(share):
    rotation = share * EDGE.jamming_angle
    step = 1e-6 * rotation
    slope = (EDGE.energy(rotation + step) - EDGE.energy(rotation - step)) / (2 * step)
    assert float(EDGE.moment(rotation)) == pytest.approx(float(slope), rel=1e-5)
    assert float(EDGE.moment(rotation)) > 0.0


def test_half_length_needs_least_work(record_figure):
    # small rotations: W/(m_p sqrt(b theta)) = sqrt(h) (4 b/h + 2 h/b) per wall
    h = np.linspace(0.3, 2.0, 170001)
    work = np.sqrt(h) * (4.0 / h + 2.0 * h)
    record_figure(
        "half length of a free fold over its depth", h[np.argmin(work)], EDGE.half_length / 0.040, 1e-4
    )
    plain = FreeEdgeMechanism(0.040, 0.002, 300e6, 0.0)
    small = 1e-8
    leading = (
        2
        * 300e6
        * 0.002**2
        / 4
        * math.sqrt(0.04 * plain.half_length * small)
        * (4 / 0.81649658 + 2 * 0.81649658)
    )
    record_figure("work at 1e-8 rad over its leading term", float(plain.energy(small)) / leading, 1.0, 1e-3)


def test_free_edge_closes_at_its_jamming_angle():
    assert float(EDGE.corners(EDGE.jamming_angle)["x_P"]) == pytest.approx(0.001, rel=1e-9)


@given(st.floats(0.02, 0.2), st.floats(0.4, 2.5), st.floats(0.01, 0.08), shares)
def test_profile_with_both_faces_is_the_tube(width, ratio, slender, share):
    sizes = (width, width * ratio, width * min(ratio, 1.0) * slender, 300e6)
    tube = FoldMechanism(*sizes)
    profile = ProfileMechanism(*sizes, compressed_face=width, stretched_face=width)
    rotation = share * tube.jamming_angle
    assert float(profile.moment(rotation)) == pytest.approx(float(tube.moment(rotation)), rel=1e-12)
    # every line that is missing makes it weaker
    less = ProfileMechanism(*sizes, compressed_face=width / 2, stretched_face=width / 2)
    assert float(less.energy(rotation)) < float(tube.energy(rotation))


@given(st.floats(0.0, 0.2))
def test_short_lips_lead_to_the_plain_channel(share):
    plain = build_law("folded_profile", Channel(0.04, 0.08, 0.002), STEEL, "z").positive.mechanism
    lipped = FreeEdgeMechanism(0.04, 0.002, 300e6, 0.08, share * 1e-3)
    assert isinstance(plain, FreeEdgeMechanism)
    rotation = 0.3
    expected = (
        2
        * 0.002
        * 300e6
        * (share * 1e-3) ** 2
        * math.asin(float(plain.corners(rotation)["z_A"]) / plain.half_length)
    )
    assert float(lipped.energy(rotation) - plain.energy(rotation)) == pytest.approx(
        expected, rel=1e-6, abs=1e-9
    )


def test_each_sense_compresses_the_documented_side():
    # crown up: positive rotation about y compresses the open side, whose face are the two flanges
    hat = build_law("folded_profile", Hat(0.05, 0.04, 0.001, 0.02), STEEL, "y")
    assert hat.positive.mechanism.compressed_face == pytest.approx(0.04)
    assert hat.negative.mechanism.compressed_face == pytest.approx(0.05)
    channel = build_law("folded_profile", Channel(0.04, 0.08, 0.002), STEEL, "z")
    assert isinstance(channel.positive.mechanism, FreeEdgeMechanism)
    for law, section, axis in (
        (hat, Hat(0.05, 0.04, 0.001, 0.02), "y"),
        (channel, Channel(0.04, 0.08, 0.002), "z"),
    ):
        for sense in (1, -1):
            expected = moment_capacity(section, STEEL, axis, sense=sense).moment
            assert float(law.moment_capacity(0.0, sense)) == pytest.approx(expected, rel=1e-12)


def test_a_thicker_plate_counts_by_its_own_plastic_moment():
    thin, thick = (ClosedHat(0.05, 0.04, 0.0015, 0.015, plate_thickness=t) for t in (0.0015, 0.003))
    a, b = (build_law("folded_profile", hat, STEEL).positive.mechanism for hat in (thin, thick))
    assert b.compressed_face - a.compressed_face == pytest.approx(3.0 * 0.08)


def test_band_and_warnings_are_stated():
    law = build_law("folded_profile", Channel(0.04, 0.08, 0.002), STEEL, "z")
    assert law.validity.uncertainty == 0.35
    assert "validated neither by tests" in law.validity.warnings[0]


@pytest.mark.parametrize(
    ("section", "axis"),
    [
        (Channel(0.04, 0.08, 0.002), "y"),
        (Hat(0.05, 0.04, 0.001, 0.02), "z"),
        (RectangularTube(0.05, 0.04, 0.002), "y"),
    ],
)
def test_what_does_not_fit_is_refused(section, axis):
    with pytest.raises(InputError, match="no folding mechanism"):
        build_law("folded_profile", section, STEEL, axis)
