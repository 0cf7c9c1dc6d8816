"""Hinges of mitred corners whose set is shifted and worn: which ones, in which sense, and what follows."""

import math
from dataclasses import replace

import numpy as np
import pytest

import crumple
from crumple.hinge import Form
from crumple.hinge.corner.shift import corner_shift, worn_by_bisector
from crumple.section import Channel, CircularTube, RectangularTube
from crumple.structure import placed_hinges
from crumple.structure.hinges.corner.shift import with_corner_shift
from crumple.structure.hinges.corner_laws import turned_corner

FRAME = """
crumple: 1
title: L-frame
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 350 MPa}
sections: {tube: {type: square_tube, side: 50 mm, thickness: 2 mm}}
nodes: {foot: [0 m, 0 m, 0 m], knee: [0 m, 0 m, 0.5 m], tip: [0.5 m, 0 m, 0.5 m]}
members:
  post: {nodes: [foot, knee], section: tube, material: steel}
  arm: {nodes: [knee, tip], section: tube, material: steel}
hinges: auto
supports: {clamp: {node: foot, fix: all}}
masses: {payload: {node: tip, mass: 20 kg}}
initial_velocity: [{nodes: [tip], translation: [0 m/s, 10 m/s, 0 m/s]}]
analysis: {duration: 80 ms, multibody: {members: MEMBERS}}
outputs: {every: 1 ms, nodes: [tip]}
"""
TUBE = RectangularTube(0.05, 0.05, 0.002)


def framed(text=FRAME, members="rigid"):
    return crumple.loads(text.replace("MEMBERS", members))


def corner_hinge(source):
    structure = source.structure
    hinge = next(one for one in placed_hinges(structure) if one.name == "corner-knee")
    return structure, hinge, turned_corner(structure, "corner-knee", ("x", "y", "z"))


def test_the_centre_moves_in_the_sense_of_opening_whichever_way_the_members_point():
    backwards = FRAME.replace("nodes: [foot, knee]", "nodes: [knee, foot]").replace(
        "nodes: [knee, tip]", "nodes: [tip, knee]"
    )
    swapped = FRAME.replace("  post: {", "  zpost: {")
    for text in (FRAME, backwards, swapped):
        _, hinge, corner = corner_hinge(framed(text))
        (part,) = (one for one in hinge.spatial.components if one.shift is not None)
        assert part.freedom.label == corner.axis
        assert part.shift.driver.label == corner.across
        closing = part.record.positive if corner.sense > 0 else part.record.negative
        opening = part.record.negative if corner.sense > 0 else part.record.positive
        assert closing.moment[-1] < opening.moment[-1]
        # away from the sense in which the corner is weaker
        assert np.all(corner.sense * part.shift.share[1:] < 0.0)
        expected = corner_shift(TUBE, math.pi / 2.0)(part.shift.rotation)
        np.testing.assert_allclose(np.abs(part.shift.share), expected)


def test_the_share_grows_to_its_limit_and_vanishes_for_members_in_line():
    share = corner_shift(TUBE, math.pi / 2.0)
    found = share(np.radians([0.0, 5.0, 10.0, 90.0]))
    assert found[0] == 0.0
    assert np.all(np.diff(found) > 0.0)
    assert found[-1] == pytest.approx(0.63, abs=1e-4)
    thick = corner_shift(RectangularTube(0.05, 0.05, 0.0032), math.pi / 2.0)
    assert thick(0.1) < share(0.1)
    assert corner_shift(TUBE, math.radians(5.0))(1.0) < 0.06
    side = math.pi * 0.024 / 2.0 + 0.002
    ring, square = (
        corner_shift(one, 1.0)(0.1) for one in (CircularTube(0.05, 0.002), RectangularTube(side, side, 0.002))
    )
    assert ring == pytest.approx(square)
    assert corner_shift(Channel(0.05, 0.05, 0.002), math.pi / 2.0) is None
    assert corner_shift(TUBE, math.radians(101.0)) is None


def test_a_fold_about_the_bisector_takes_a_fifth_of_the_moment_about_the_tangent():
    _, hinge, corner = corner_hinge(framed())
    (part,) = (one for one in hinge.spatial.components if one.worn is not None)
    assert part.freedom.label not in (corner.axis, corner.across)
    assert part.shift is None
    assert part.worn.driver.label == corner.across
    np.testing.assert_allclose(part.worn.share, worn_by_bisector(part.worn.rotation))
    found = worn_by_bisector([0.0, 0.03, 10.0])
    np.testing.assert_allclose(found, [0.0, 0.2 * (1.0 - math.exp(-1.0)), 0.2], rtol=1e-12)


def test_only_three_rotations_on_an_ellipsoid_are_shifted():
    structure, hinge, corner = corner_hinge(framed())
    record, section = hinge.spatial, structure.section_of("post")
    plain = crumple.hinge.spatial_record(
        [crumple.hinge.HingeComponent(part.freedom, part.record) for part in record.components[:2]],
        coupling=crumple.hinge.Coupling.ELLIPSOID,
    )
    assert with_corner_shift(plain, corner, section) is plain
    other = framed(FRAME.replace("hinges: auto", "hinges: {axes: [x, y, z], coupling: none}"))
    assert all(part.shift is part.worn is None for part in corner_hinge(other)[1].spatial.components)
    ramped = [
        replace(part, record=replace(part.record, form=Form.REGULARISED), shift=None, worn=None)
        for part in record.components
    ]
    ramped = replace(record, components=tuple(ramped))
    assert with_corner_shift(ramped, corner, section) is ramped


@pytest.mark.parametrize("members", ["rigid", "elastic"])
def test_a_corner_struck_across_its_plane_also_closes(members):
    result = crumple.solve(framed(members=members))
    corner = corner_hinge(framed(members=members))[2]
    turned = np.array([result[f"node.tip.rotation.{axis}"][-1] for axis in "xyz"])
    # a rotation of the arm about this normal increases the angle between the members; -8 deg without shift
    assert math.degrees(turned @ np.array(corner.normal)) > 1.0
    assert abs(result.energy_residual) < 1e-4
