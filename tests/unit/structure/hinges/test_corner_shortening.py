"""Mitred corners in a plane shorten under compression where obstacles may press elastic members."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from crumple.analysis import loads, solve
from crumple.hinge import Coupling, Freedom, record_of
from crumple.structure import placed_hinges
from crumple.structure.hinges.elastic_members import with_elastic_members

RAIL = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections:
  tube: {type: square_tube, side: 50 mm, thickness: GAUGE}
nodes: {front: [0 m, 0 m, 0 m], bend: [0.3 m, 0 m, 0 m], rear: [0.6 m, 0 m, 0.15 m]}
members:
  first: {nodes: [front, bend], section: tube, material: steel}
  second: {nodes: [bend, rear], section: tube, material: steel}
hinges: HINGES
supports: {sled: {node: rear, fix: [y, z, rx, ry, rz]}}
masses: {sled: {node: rear, mass: 50 kg}}
obstacles: OBSTACLES
initial_velocity: [{translation: [-5 m/s, 0 m/s, 0 m/s]}]
analysis: {duration: 1 ms, multibody: {members: MEMBERS}}
"""
WALL = "{wall: {type: plane, point: [0 m, 0 m, 0 m], normal: [1, 0, 0]}}"


HALF = math.atan2(0.15, 0.3) / 2.0
FOLD = 0.7 - 35.0 * math.sin(HALF) * 2.0 / 48.0
"""Arm of the corner's fold over the distance of the tension flange."""


def corner(hinges="auto", obstacles=WALL, members="elastic", wall="2 mm", text=RAIL):
    text = (
        text.replace("HINGES", hinges)
        .replace("OBSTACLES", obstacles)
        .replace("MEMBERS", members)
        .replace("GAUGE", wall)
    )
    analysis = loads(text)
    structure = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
    return next(hinge for hinge in placed_hinges(structure) if hinge.name == "corner-bend")


def test_it_turns_about_its_tension_flange_when_it_is_folded_and_compressed():
    spatial = corner().spatial
    surface = spatial.surface
    assert surface.coupling is Coupling.TENSION_FLANGE
    assert {*spatial.freedoms} == {Freedom.AXIAL, Freedom.Y}
    assert surface.arm == pytest.approx(FOLD * 0.024)
    # folded, beyond the last gain; not folded, under little compression
    assert surface.arm + surface.gains[-1][0] == pytest.approx(0.024)
    assert surface.growth[1][[0, -1]] == pytest.approx([0.0, 1.0], abs=3e-3)


def test_its_gains_stand_for_an_arm_that_grows_with_compression():
    """The moment lost up to any compression: steps against the line that they replace, n/72 off at most."""
    surface, flange, full = corner().spatial.surface, 0.024, 0.157
    compression = np.linspace(0.0, 0.25, 101)
    gained = np.diff([0.0] + [gain for gain, _ in surface.gains])
    steps = sum(
        g * np.maximum(compression - share, 0.0) for g, (_, share) in zip(gained, surface.gains, strict=True)
    )
    below = np.minimum(compression, full)
    line = (1.0 - FOLD) * flange * (below**2 / (2.0 * full) + compression - below)
    np.testing.assert_allclose(steps, line, atol=(1.0 - FOLD) * full / 72.0 * flange * (1.0 + 1e-9))


def test_steep_corners_of_thick_walls_keep_a_small_arm():
    """With walls of 4 mm the formula is negative: the least that was found stays."""
    assert corner(wall="4 mm").spatial.surface.arm == pytest.approx(0.05 * 0.023)


def test_it_slips_at_right_angles_to_the_mitre():
    bent = corner()
    assert bent.axes[0] == pytest.approx([math.cos(HALF), 0.0, math.sin(HALF)])
    assert bent.axes[1] == pytest.approx(bent.direction)


@pytest.mark.parametrize(
    "case",
    [
        {"obstacles": "{}"},
        {"members": "rigid"},
        {"hinges": "{axial: false}"},
    ],
)
def test_it_only_turns_where_nothing_presses_or_the_model_or_the_input_does_not_let_it_slip(case):
    assert corner(**case).spatial is None


def test_a_regularised_fold_has_the_interaction_of_its_member():
    assert (
        corner(hinges="{law: {type: auto, form: regularised}}").spatial.surface.coupling is Coupling.SECTION
    )


def test_a_coupling_of_the_input_is_kept():
    assert corner(hinges="{axial: true, coupling: ellipsoid}").spatial.surface.coupling is Coupling.ELLIPSOID


SPACE = "{axes: [x, y, z]}"


def test_in_space_compression_takes_from_the_moment_in_the_plane_in_proportion():
    hinge = corner(SPACE)
    spatial = hinge.spatial
    surface = spatial.surface
    assert surface.coupling is Coupling.SECTION
    assert spatial.freedoms == (Freedom.AXIAL, Freedom.X, Freedom.Y, Freedom.Z)
    n, t, m, across = np.eye(4)
    for alone in (n, t, m, across):
        assert surface.gauge(alone) == pytest.approx(1.0, abs=1e-12)
    # |n| + |m|, and a circle with what lies across; the norm of the rows rounds corners by 4 %
    for share in (0.25, 0.5, 0.75):
        for sense in (-1.0, 1.0):
            both = share * n + sense * (1.0 - share) * m
            assert 0.955 < surface.gauge(both) <= 1.001
            assert surface.gauge(both + across) == pytest.approx(math.sqrt(2.0), rel=0.06)
    assert surface.gauge(0.6 * m + 0.8 * across) == pytest.approx(1.0, rel=0.06)
    assert surface.gauge(0.6 * m + 0.8 * t) == pytest.approx(1.0, rel=1e-9)


def test_a_corner_of_metal_that_hardens_folds_at_once_in_compression_and_hardens_in_tension():
    hard = "yield_stress: 350 MPa, hardening: {type: swift, prestrain: 0.01, exponent: 0.1}"
    folds = "{axes: [x, y, z], axial: {law: superfolding}}"
    hinge = corner(folds, text=RAIL.replace("yield_stress: 350 MPa", hard))
    slip = {part.freedom: part for part in hinge.spatial.components}[Freedom.AXIAL]
    assert slip.spread.shortening[0].size == 0
    assert slip.spread.lengthening[0].size > 2
    at_first = slip.spread.lengthening[1][0] * slip.record.positive.moment[0]
    assert at_first == pytest.approx(350e6 * (0.05**2 - 0.046**2), rel=1e-9)
    # the kernel takes it
    text = RAIL.replace("yield_stress: 350 MPa", hard).replace("GAUGE", "2 mm").replace("HINGES", folds)
    read = loads(text.replace("OBSTACLES", WALL).replace("MEMBERS", "elastic"))
    assert solve(read).status.ok


@pytest.mark.parametrize("hinges", ["auto", SPACE])
def test_the_force_that_a_corner_carries_falls_as_its_fold_grows(hinges):
    """By as much as if it had turned under this force: shortening does the work of the rotation at least.

    Walls that are pressed straight do not come to lie on each other.
    """
    placed = corner(hinges)
    components = {part.freedom: part for part in placed.spatial.components}
    slip = components[Freedom.AXIAL].record
    bending = record_of(replace(placed.law, jamming=0.0))
    # in a plane, where a shortening counts as rotation, those that turn do not either
    turned = components[Freedom.Y].record.positive
    grown = np.interp(0.9, turned.rotation, turned.moment) / np.interp(
        0.9, bending.positive.rotation, bending.positive.moment
    )
    assert placed.law.jamming > 0.4
    assert grown > 1.2 if hinges == SPACE else grown == pytest.approx(1.0)
    weight = components[Freedom.AXIAL].softens if hinges == SPACE else None
    moments, squash = (bending.positive, bending.negative), 350e6 * (0.05**2 - 0.046**2)
    assert moments[0].moment[0] != pytest.approx(moments[1].moment[0], rel=0.01)
    turns = np.linspace(0.0, 0.6, 601)
    # without a moment it may open or close
    moment = np.mean([np.interp(turns, one.rotation, one.moment) for one in moments], axis=0)
    arm = 0.024 * (1.0 - FOLD * np.exp(-turns / 0.023))
    force = np.minimum(squash, (moment + 0.024 * (1.0 - FOLD) * 0.157 * squash / 2.0) / arm)
    shortened = np.concatenate([[0.0], np.cumsum(np.diff(turns) * (moment / force)[1:])])
    first = float(slip.negative.moment[0])
    assert first == pytest.approx(force[0], rel=1e-9)
    for turn in (0.01, 0.03, 0.1, 0.3, 0.6):
        after = np.interp(turn, turns, shortened)
        if weight is not None:
            # rotation and shortening have one measure, which the shortening of a fold does not lead
            after = turn * moment[0] / (weight * first)
            assert after >= np.interp(turn, turns, shortened) * 0.999
        found = np.interp(after, slip.negative.rotation, slip.negative.moment)
        assert found == pytest.approx(np.interp(turn, turns, force), rel=0.01 if weight else 0.06)
    # in tension the walls yield
    assert (slip.positive.moment == squash).all()


@pytest.mark.parametrize("hinges", ["auto", SPACE])
def test_a_mirror_image_carries_the_same_in_compression(hinges):
    mirrored = corner(hinges, text=RAIL.replace("0.15 m", "-0.15 m"))
    slips = [
        {part.freedom: part.record for part in hinge.spatial.components}[Freedom.AXIAL].negative
        for hinge in (corner(hinges), mirrored)
    ]
    assert slips[0].moment[0] == pytest.approx(slips[1].moment[0], rel=1e-9)
    places = np.linspace(0.0, 0.02, 41)
    forces = [np.interp(places, slip.rotation, slip.moment) for slip in slips]
    assert forces[0] == pytest.approx(forces[1], rel=1e-9)


@pytest.mark.parametrize(
    "case",
    [
        {"obstacles": "{}"},
        {
            "obstacles": WALL.replace("normal: [1, 0, 0]", "normal: [0, 0, 1]").replace(
                "[0 m, 0 m, 0 m]", "[0 m, 0 m, -1 m]"
            )
        },
        {"members": "rigid"},
        {"hinges": "{axes: [x, y, z], axial: false}"},
    ],
)
def test_in_space_it_only_turns_where_nothing_presses_a_member_along_its_axis(case):
    spatial = corner(**({"hinges": SPACE} | case)).spatial
    assert Freedom.AXIAL not in spatial.freedoms
    assert spatial.surface.coupling is Coupling.ELLIPSOID


@pytest.mark.parametrize("hinges", ["auto", SPACE])
def test_unasked_its_walls_fold_as_those_of_a_compressed_tube(hinges):
    slip = next(part for part in corner(hinges).spatial.components if part.freedom is Freedom.AXIAL)
    asked = "{axial: true}" if hinges == "auto" else "{axes: [x, y, z], axial: true}"
    plain = next(part for part in corner(asked).spatial.components if part.freedom is Freedom.AXIAL)
    assert "superfolding" in slip.origin.lower()
    assert plain.origin != slip.origin


def test_in_a_plane_its_shortening_counts_as_the_rotation_that_does_its_work():
    """As in space, where both have one measure; so a corner that shortens loses moment, and turns then."""
    plane, space = corner().spatial, corner(SPACE).spatial
    slip = next(part for part in space.components if part.freedom is Freedom.AXIAL)
    bending = next(part.record for part in plane.components if part.freedom is Freedom.Y)
    moment = (bending.positive.moment[0] + bending.negative.moment[0]) / 2.0
    assert plane.surface.shortened_turn > 0.0
    assert plane.surface.shortened_turn * moment == pytest.approx(
        slip.softens * slip.record.negative.moment[0], rel=1e-9
    )
    # straight members keep their moment
    analysis = loads(
        RAIL.replace("HINGES", "{axial: true, coupling: tension-flange}")
        .replace("GAUGE", "2 mm")
        .replace("OBSTACLES", WALL)
        .replace("MEMBERS", "elastic")
    )
    structure = with_elastic_members(analysis.structure, analysis.multibody, analysis.time_in_motion)
    others = [one.spatial for one in placed_hinges(structure) if one.plastic and one.name != "corner-bend"]
    assert others
    assert all(one.surface.shortened_turn == 0.0 for one in others)


def test_a_corner_of_hats_does_not_slip_and_so_its_walls_jam():
    hat = "{type: closed_hat, width: 50 mm, depth: 50 mm, thickness: GAUGE, flange: 18 mm}"
    placed = corner(text=RAIL.replace("{type: square_tube, side: 50 mm, thickness: GAUGE}", hat))
    bending = {part.freedom: part.record for part in placed.spatial.components}[Freedom.Y]
    assert placed.spatial.surface.shortened_turn == 0.0
    assert placed.law.jamming > 0.3
    for record, sense in ((bending.positive, 1), (bending.negative, -1)):
        found = float(np.interp(0.9, record.rotation, record.moment))
        assert found == pytest.approx(float(placed.law.moment_capacity(0.9, sense)), rel=1e-3)
