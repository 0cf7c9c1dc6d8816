"""Channels and hats: the tube is a limit case, and the folding of free edges satisfies its geometry.

The mechanisms are derived, and nothing is published.  Checked are the lengths of the plates of the free
edge, its fold angles from the normals of the planes, the moment as a difference of the work, the best half
length, and that a profile with all its faces is the tube of the Kecman-type law.  The compressed plate of a
closed hat starts at the plastic moment and ends at that of crown and webs.  A closed hat, a hat and a channel
that no constant was fitted to take the work of their laws in shells.

Kind: independent calculation; invariant; closed form.  Source: derived here; derived here; derived here.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from crumple.characterisation.combined import Combined
from crumple.characterisation.resolution import Resolution
from crumple.characterisation.solving import solve
from crumple.errors import InputError
from crumple.hinge import build_law
from crumple.hinge.bending.kecman_mechanism import FoldMechanism
from crumple.hinge.bending.profiles.compressed_plate import CompressedPlate
from crumple.hinge.bending.profiles.free_edge import FreeEdgeMechanism
from crumple.hinge.bending.profiles.profile_mechanism import ProfileMechanism
from crumple.material import Material
from crumple.section import Channel, ClosedHat, Hat, RectangularTube, moment_capacity

STEEL = Material("steel", 210e9, 0.3, 7850.0, 300e6)
COARSE, MEDIUM = Resolution(3.0, 6.0), Resolution(4.0, 6.0)
END = math.radians(20.0)
CLOSED, OPEN = ClosedHat(0.065, 0.050, 0.0013, 0.015), Hat(0.065, 0.055, 0.0017, 0.016)
LIPPED = Channel(0.040, 0.100, 0.0022, lip=0.014)
EDGE = FreeEdgeMechanism(0.040, 0.002, 300e6, 0.080, 0.01)
shares = st.floats(1e-3, 0.99)


def steel(yields):
    return replace(STEEL, yield_stress=yields)


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
    lipped = FreeEdgeMechanism(0.04, 0.002, 300e6, 0.08, share * 1e-3, plain.weight)
    assert isinstance(plain, FreeEdgeMechanism)
    rotation = 0.3
    expected = (
        plain.weight
        * 2
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


def test_a_thicker_plate_that_is_stretched_counts_by_its_own_plastic_moment():
    thin, thick = (ClosedHat(0.05, 0.04, 0.0015, 0.015, plate_thickness=t) for t in (0.0015, 0.003))
    a, b = (build_law("folded_profile", hat, STEEL).negative.mechanism for hat in (thin, thick))
    assert b.stretched_face - a.stretched_face == pytest.approx(3.0 * 0.08)


def compressed(hat, material=STEEL):
    return build_law("folded_profile", hat, material).positive.mechanism


def test_a_stout_plate_starts_at_the_plastic_moment_of_the_hat(record_figure):
    # b/t = 20 at 300 MPa: no wall buckles
    hat = ClosedHat(0.050, 0.045, 0.0025, 0.015)
    plastic = moment_capacity(hat, STEEL, "y", sense=1).plastic_moment
    # the walls overlap at the corners: t/b of the moment at most
    record_figure(
        "closed hat, stout plate compressed", compressed(hat).peak, plastic, 0.02, "N m", relative=True
    )


def test_a_buckled_plate_is_the_plastic_moment_without_what_it_lost(record_figure):
    """Crown and webs above y against webs below, flanges and the rest of the plate."""
    w, d, t, f, metal = 0.080, 0.060, 0.0012, 0.018, 300e6
    slender = math.sqrt(metal / (4 * math.pi**2 * 210e9 / (12 * 0.91) * (t / w) ** 2))
    left = (1 - 0.22 / slender) / slender
    high, under = d - t, w * left * t + 2 * f * t
    y = (w * t + 2 * t * high - under - 2 * f * t) / (4 * t)
    expected = metal * (w * t * high + t * (high**2 - 2 * y**2) + under * t)
    record_figure(
        "closed hat, buckled plate",
        compressed(ClosedHat(w, d, t, f)).peak,
        expected,
        1e-9,
        "N m",
        relative=True,
    )


def test_folded_sheets_leave_crown_and_webs(record_figure):
    folded = CompressedPlate(
        tuple(
            sheet._replace(slender=1e12) for sheet in compressed(ClosedHat(0.05, 0.05, 0.001, 0.01)).sheets
        ),
        crown=15e3,
        depth=0.049,
        web=6e5,
        web_slender=0.0,
        jamming_angle=1.0,
    )
    # crown and webs above y against the webs below: y = (crown/web + depth)/2
    y = (15e3 / 6e5 + 0.049) / 2.0
    expected = 15e3 * 0.049 + 6e5 * (0.049**2 - 2.0 * y**2) / 2.0
    record_figure("crown and webs alone", float(folded.moment(0.5)), expected, 1e-5, "N m", relative=True)


@given(st.floats(0.02, 0.99), st.floats(0.03, 0.1), st.floats(0.4, 1.3), st.floats(0.012, 0.05))
def test_compressed_plate_softens_and_its_work_is_that_of_its_moment(share, width, ratio, slender):
    hat = ClosedHat(width, width * ratio, width * slender * min(1.0, ratio), 0.3 * width)
    fold = compressed(hat)
    turns = np.linspace(0.0, share * fold.jamming_angle, 2001)
    moment = fold.moment(turns)
    assert (np.diff(moment) <= 1e-9 * fold.peak).all()
    assert (moment > 0.0).all()
    # the moment has a kink where the neutral axis reaches the crown
    assert float(fold.energy(turns[-1])) == pytest.approx(float(np.trapezoid(moment, turns)), rel=1e-3)


@given(st.floats(0.5, 3.0))
def test_compressed_plate_scales_with_the_size(size):
    hat, larger = (ClosedHat(0.06 * s, 0.05 * s, 0.0015 * s, 0.02 * s) for s in (1.0, size))
    assert float(compressed(larger).moment(0.2)) == pytest.approx(
        size**3 * float(compressed(hat).moment(0.2)), rel=1e-9
    )


def test_a_plate_stronger_than_all_the_rest_is_balanced():
    hat = ClosedHat(0.05, 0.04, 0.001, 0.02, plate_thickness=0.006)
    rest = 300e6 * (0.05 * 0.001 * 0.039 + 0.039**2 * 0.001)
    # crown and webs at yield, the rest between the flange of the hat and the plate
    arm = 300e6 * (0.05 + 2 * 0.039) * 0.001 * 0.0035
    assert rest < compressed(hat).peak < rest + arm


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "model", "tolerance"),
    [
        ("closed hat, plate", Combined(CLOSED, steel(350e6), 0.0, largest=END, resolution=COARSE), 0.12),
        ("closed hat, crown", Combined(CLOSED, steel(350e6), math.pi, largest=END, resolution=COARSE), 0.2),
        ("channel, lips", Combined(LIPPED, steel(350e6), math.pi / 2, largest=END, resolution=MEDIUM), 0.1),
        ("hat, flanges", Combined(OPEN, steel(300e6), 0.0, largest=END, resolution=MEDIUM), 0.2),
    ],
)
def test_profiles_in_shells_take_the_work_of_their_laws(name, model, tolerance, record_figure):
    """None of those that the constants were fitted to; the side that is named is compressed."""
    work = model.curve(solve(model.analysis(), "shell")).energy_at(END)
    axis = "z" if model.section is LIPPED else "y"
    law = build_law("folded_profile", model.section, model.material, axis)
    turns = np.linspace(0.0, END, 1001)
    moment = law.moment_capacity(turns, -1 if model.angle == math.pi else 1)
    expected = float(np.trapezoid(moment, turns))
    record_figure(f"{name} compressed, work up to 20 deg", expected, work, tolerance, "J", relative=True)


def test_band_and_warnings_are_stated():
    law = build_law("folded_profile", Channel(0.04, 0.08, 0.002), STEEL, "z")
    assert law.validity.uncertainty == 0.35
    assert "not with tests" in law.validity.warnings[0]
    hat = build_law("folded_profile", ClosedHat(0.06, 0.05, 0.0015, 0.02), STEEL)
    assert hat.validity.uncertainty == 0.2
    for other, words in (
        (ClosedHat(0.06, 0.05, 0.0030, 0.02), "width/thickness 25 to 90"),
        (ClosedHat(0.06, 0.05, 0.0015, 0.02, plate_thickness=0.002), "plate like the hat"),
        (ClosedHat(0.06, 0.05, 0.0015, 0.02, corner_radius=0.004), "sharp corners"),
    ):
        law = build_law("folded_profile", other, STEEL)
        assert law.validity.uncertainty == 0.35
        assert any(words in sentence for sentence in law.validity.warnings)


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
