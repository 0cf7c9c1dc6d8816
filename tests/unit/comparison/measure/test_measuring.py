"""Sections, folds and hinges measured in shapes whose truth is known."""

from dataclasses import replace

import numpy as np
import pytest
from tests.support.result.folded_tube import MOMENT, analysis, angle_over_time, folded_result, folded_states

from crumple.comparison.measure.fold_moment import conjugate_moment
from crumple.comparison.measure.folds import find_folds
from crumple.comparison.measure.motion import far_rotation, matched, measured
from crumple.comparison.measure.sections import sections_of
from crumple.structure import placed_hinges

TIMES = np.linspace(0.0, 0.1, 101)
MINUS_Y = np.array([0.0, -1.0, 0.0])


def one_fold(largest=0.6, **options):
    return folded_states(TIMES, [(0.01, 0.04, angle_over_time(TIMES, largest))], **options)


def test_a_section_turns_as_its_ring_does():
    own = sections_of(one_fold(), "tube")
    turned = own.rotation(MINUS_Y)
    assert np.allclose(turned[:, -1], angle_over_time(TIMES), atol=1e-12)
    assert np.allclose(turned[:, 0], 0.0, atol=1e-12)
    assert np.allclose(own.rotation(-MINUS_Y), -turned)


def test_the_rotation_does_not_depend_on_the_frame():
    turn = np.linalg.qr(np.random.default_rng(3).standard_normal((3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    own = sections_of(one_fold(turned=turn), "tube")
    assert np.allclose(own.rotation(turn @ MINUS_Y)[:, -1], angle_over_time(TIMES), atol=1e-10)


def tumbling(states, axis, largest=2.0):
    """The same shapes on a frame that turns about an axis while they fold."""
    axis = np.asarray(axis) / np.linalg.norm(axis)
    cross = np.cross(np.eye(3), -axis)
    angles = largest * states.times / states.times[-1]
    turns = [np.eye(3) + np.sin(a) * cross + (1.0 - np.cos(a)) * cross @ cross for a in angles]
    places = [(states.points + u) @ r.T for u, r in zip(states.displacement, turns, strict=True)]
    return replace(states, displacement=np.array(places) - states.points)


@pytest.mark.parametrize("axis", [[0.0, 0.6, 0.8], [0.8, 0.0, 0.6]])
def test_a_relative_rotation_moves_with_the_section_that_carries_it(axis):
    still = sections_of(one_fold(0.5), "tube")
    moving = sections_of(tumbling(one_fold(0.5), axis), "tube")
    last = len(still.stations) - 1
    assert np.allclose(
        still.relative_rotation(MINUS_Y, 0, last), still.rotation(MINUS_Y)[:, -1], rtol=0.0, atol=1e-9
    )
    assert np.allclose(moving.relative_rotation(MINUS_Y, 0, last), angle_over_time(TIMES, 0.5), atol=1e-9)
    assert np.allclose(
        far_rotation(moving, 0.02, MINUS_Y), far_rotation(still, 0.02, MINUS_Y), rtol=0.0, atol=1e-9
    )
    # an axis fixed in space sees something else
    turned = moving.rotation(MINUS_Y)
    assert not np.allclose(turned[:, last] - turned[:, 0], angle_over_time(TIMES, 0.5), atol=1e-2)


def mitred(states, slope=1.0):
    """The same shapes with the last ring oblique, as at a corner of 90 degrees."""
    points = states.points.copy()
    end = states.station == states.station.max()
    points[end, 0] += slope * (points[end, 2] - points[end, 2].mean())
    return replace(states, points=points)


def test_a_member_with_an_oblique_end_that_moves_as_one_does_not_bend():
    """A turn about one normal moves another that is not parallel to it: here by up to 40 degrees."""
    states = tumbling(mitred(folded_states(TIMES, [(0.01, 0.04, 0.0 * TIMES)])), [1.0, 0.2, 0.0], 1.0)
    own = sections_of(states, "tube")
    last = len(own.stations) - 1
    for first, second in ((0, last), (last, 0)):
        assert np.allclose(own.bend(first, second), 0.0, atol=1e-7)
        assert np.allclose(own.relative_rotation(MINUS_Y, first, second), 0.0, atol=1e-7)


def test_more_than_half_a_turn_is_counted_on():
    own = sections_of(one_fold(largest=4.0), "tube")
    assert own.rotation(MINUS_Y)[-1, -1] == pytest.approx(4.0)


def test_the_axis_of_a_bend_at_an_oblique_end_is_that_of_the_bend():
    still = mitred(folded_states(TIMES, [(0.01, 0.04, angle_over_time(TIMES, 0.5))]))
    own = sections_of(still, "tube")
    last = len(own.stations) - 1
    assert own.bend(0, last)[-1] == pytest.approx(own.rotation(MINUS_Y)[-1, last], rel=1e-3)
    np.testing.assert_allclose(own.bend_axes(0, last)[-1], MINUS_Y, atol=1e-6)


def test_the_chord_lags_behind_the_section_by_the_place_of_the_fold():
    own = sections_of(one_fold(0.5), "tube")
    # the fold's middle lies 25 mm inside: the far end is seen under a smaller angle from the clamp
    expected = np.arctan2(0.975 * np.sin(0.5), 0.025 + 0.975 * np.cos(0.5))
    assert own.chord_rotation(MINUS_Y)[-1] == pytest.approx(expected, rel=2e-3)
    assert far_rotation(own, 0.02, MINUS_Y)[-1] == pytest.approx(expected, rel=2e-3)


def test_a_member_without_shape_has_no_sections():
    assert sections_of(one_fold(), "beam") is None


def test_the_fold_is_found_where_it_is():
    states = one_fold()
    (fold,) = find_folds(states, {"tube": sections_of(states, "tube")}, {"tube": 0.0475})
    assert fold.station == pytest.approx(0.025, abs=1e-9)
    assert (fold.start, fold.end) == pytest.approx((0.01, 0.04))
    assert fold.planes[0] == 0
    assert 0.04 + 0.0475 / 2 <= states.station.reshape(-1, 4)[fold.planes[1], 0] < 0.075
    assert fold.share[-1] == pytest.approx(1.0)


def test_two_folds_are_two_and_share_the_plastic_strain():
    angles = angle_over_time(TIMES)
    states = folded_states(TIMES, [(0.01, 0.04, angles), (0.60, 0.63, 0.5 * angles)])
    folds = find_folds(states, {"tube": sections_of(states, "tube")}, {"tube": 0.0475})
    assert [fold.station for fold in folds] == pytest.approx([0.025, 0.615])
    assert [fold.share[-1] for fold in folds] == pytest.approx([2 / 3, 1 / 3])


def test_a_stretch_that_yields_without_turning_is_no_fold():
    states = folded_states(TIMES, [(0.3, 0.4, np.full_like(TIMES, 0.01))])
    assert find_folds(states, {"tube": sections_of(states, "tube")}, {"tube": 0.0475}) == []


def test_without_plastic_strain_the_bending_shows_the_fold():
    from dataclasses import replace

    states = replace(one_fold(), cell_data={})
    (fold,) = find_folds(states, {"tube": sections_of(states, "tube")}, {"tube": 0.0475})
    assert fold.station == pytest.approx(0.025, abs=1e-3)


def test_the_hinge_is_measured_across_its_fold():
    case = analysis()
    seen = measured(folded_result(moment_channel=True), case.structure, placed_hinges(case.structure))
    (motion,) = seen.hinges
    assert seen.extra == ()
    # right-handed about +y the tip moves down: this one moves up
    assert np.allclose(motion.rotation, -angle_over_time(TIMES), atol=1e-12)
    assert motion.sense == -1.0
    assert motion.extent == pytest.approx((0.01, 0.04))
    assert motion.plastic_work[-1] == pytest.approx(0.6 * MOMENT)
    section, material = case.structure.section_of("tube"), case.structure.material_of("tube")
    a, b = motion.planes
    stiffness = material.youngs_modulus * section.second_moment("y") / (b - a)
    assert motion.plastic_rotation[-1] == pytest.approx(-(0.6 - MOMENT / stiffness))


def test_the_moment_of_a_hinge_that_also_twists_is_that_about_its_bending_axis():
    case, own = analysis(), folded_result(moment_channel=True)
    bends = own.channels["hinge.root.moment"]
    twisted = replace(bends, values=np.hypot(bends.values, 0.5 * MOMENT))
    channels = {**own.channels, "hinge.root.moment": twisted}
    channels["hinge.root.moment.y"] = replace(bends, name="hinge.root.moment.y")
    hinges = placed_hinges(case.structure)
    seen = measured(replace(own, channels=channels), case.structure, hinges).hinges[0]
    np.testing.assert_array_equal(seen.moment, measured(own, case.structure, hinges).hinges[0].moment)


def test_the_moment_comes_from_plastic_work_where_the_result_has_none():
    case = analysis()
    seen = measured(folded_result(), case.structure, placed_hinges(case.structure))
    moment = seen.hinges[0].moment
    assert "conjugate" in seen.hinges[0].how
    assert np.allclose(moment[10:], -MOMENT, rtol=0.02)


def test_the_conjugate_moment_is_the_slope_of_work_over_rotation():
    rotation = np.linspace(0.0, 0.5, 200)
    work = 1500 * rotation - 800 * rotation**2
    moment = conjugate_moment(rotation, work, 1e9)
    middle = (rotation > 0.05) & (rotation < 0.45)
    assert np.allclose(moment[middle], 1500 - 1600 * rotation[middle], rtol=0.02)
    assert np.allclose(conjugate_moment(-rotation, work, 1e9), -moment)


def test_a_fold_far_from_any_hinge_belongs_to_none():
    case = analysis()
    folds = [(0.01, 0.04, angle_over_time(TIMES)), (0.60, 0.63, 0.5 * angle_over_time(TIMES))]
    seen = measured(folded_result(folds), case.structure, placed_hinges(case.structure))
    (extra,) = seen.extra
    assert extra.name == "tube at 615 mm"
    assert abs(extra.rotation[-1]) == pytest.approx(0.3)
    assert seen.hinges[0].rotation[-1] == pytest.approx(-0.6)
    assert matched(seen.folds, placed_hinges(case.structure), {"tube": 0.0475}) == {0: "root"}


def test_states_are_taken_at_the_nearest_times():
    states = one_fold().at_times(np.array([0.0, 0.0504]))
    assert states.times == pytest.approx([0.0, 0.05])
    assert len(states.displacement) == len(states.cell_data["plastic_strain"]) == 2
