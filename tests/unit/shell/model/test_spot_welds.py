"""Described spot welds in shells: positions, refusals, what a run reports, threads and restart."""

import numpy as np
import pytest
from tests.support.shell.welded_parts import (
    SETTINGS,
    THICKNESS,
    closed_hat,
    driven,
    hat_and_plate,
    lap,
    strips,
)

from crumple.errors import InputError, Status
from crumple.shell import LongRun, ShellRun, lower, solve_shell
from crumple.structure import Outputs, ShellSettings

COARSE = ShellSettings(element_size=10e-3)
CLAMPED = {"clamp": {"node": "root", "fix": "all"}}
BOTH_CLAMPED = CLAMPED | {"clamp-2": {"node": "plate-root", "fix": "all"}}


def means(case, spot):
    """Weighted means of both patches [m]."""
    at = case.mesh.position
    return [patch.weights @ at[patch.nodes] for patch in (spot.first, spot.second)]


@pytest.mark.parametrize("point", [(0.0575, 0.0025), (0.06, 0.0), (0.0611, -0.0133), (0.0599, 0.0)])
def test_a_spot_lies_where_it_is_asked_for_whatever_the_mesh(point):
    case = lower(lap(1e-3, 1e-3, points=[(*point, THICKNESS / 2)]), SETTINGS)
    (spot,) = case.welds
    low, up = means(case, spot)
    assert low == pytest.approx([*point, 0.0], abs=1e-12)
    assert up == pytest.approx([*point, THICKNESS], abs=1e-12)
    assert spot.place == pytest.approx([*point, THICKNESS / 2])
    # each sheet by its own nodes, evenly
    nodes = case.mesh.tubes["up"].nodes
    assert np.isin(spot.second.nodes, nodes).all()
    assert not np.isin(spot.first.nodes, nodes).any()
    assert 0.0 < len(spot.first.nodes) <= 9
    assert np.abs(spot.first.weights).max() < 0.6


def test_a_diameter_takes_every_node_within():
    few, many = (
        lower(lap(1e-3, 1e-3, points=[(0.06, 0.0, THICKNESS / 2)], diameter=d), SETTINGS).welds[0].first
        for d in (6e-3, 21e-3)
    )
    assert len(few.nodes) == 9
    # a circle of radius two sides, and a little, around a node
    assert len(many.nodes) == 13
    assert many.weights == pytest.approx(1 / 13)


def test_lines_of_a_section_and_spots_between_members_lie_alike():
    one = closed_hat(0.4, supports=CLAMPED, spot_welds={"own": {"members": ("hat",), "pitch": 0.05}})
    two = hat_and_plate(0.4, spots={"pitch": 0.05}, supports=BOTH_CLAMPED)
    first, second = lower(one, COARSE), lower(two, COARSE)
    # the lines of one section have its pairs of nodes no more
    assert not [body for body in first.bodies if not body.lumps]
    places = [np.array([spot.place for spot in case.welds]) for case in (first, second)]
    assert len(places[0]) == len(places[1]) == 16
    # axes at the centroid of the closed section, or its coordinates
    shift = one.section_of("hat").properties.centroid[1]
    assert np.array(sorted(map(tuple, (places[0] + [0, 0, shift]).round(9)))) == pytest.approx(
        np.array(sorted(map(tuple, places[1].round(9)))), abs=1e-9
    )
    for spot in first.welds:
        low, up = means(first, spot)
        assert up - low == pytest.approx([0.0, 0.0, -THICKNESS], abs=1e-12)


def crossing(**welds):
    """Strips whose walls are parallel, at right angles, or apart, by the second's nodes."""
    up = welds.pop("up", ((0.04, 0.0, THICKNESS), (0.12, 0.0, THICKNESS)))
    supports = {"held": {"node": "a", "fix": "all"}}
    whole = strips({"a": (0, 0, 0), "b": (0.08, 0, 0), "c": up[0], "d": up[1]}, supports, points=[(0, 0, 0)])
    entry = whole.spot_welds["spot"].model_copy(update={"points": ((0.06, 0.0, THICKNESS / 2),), **welds})
    return whole.model_copy(update={"spot_welds": {"spot": entry}})


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"points": ((0.06, 0.0, 0.02),)}, "there is no wall of member 'low' at the spot (60, 0, 20) mm"),
        ({"points": ((0.02, 0.0, 0.0),)}, "no wall of member 'up' touches that of 'low'"),
        ({"up": ((0.04, 0.0, 0.01), (0.12, 0.0, 0.01))}, "no wall of member 'up' touches that of 'low'"),
        ({"up": ((0.04, 0.0, 2e-5), (0.12, 0.0, 2e-5))}, "the walls penetrate each other"),
        ({"up": ((0.06, 0.0, 1e-3), (0.06, 0.0, 0.08))}, "the walls are not parallel"),
        ({"points": ((0.0394, 0.0, THICKNESS / 2),)}, "one wall ends"),
        (
            {"points": ((0.001, 0.0, 0.0),), "up": ((-0.04, 0.0, THICKNESS), (0.05, 0.0, THICKNESS))},
            "too few",
        ),
    ],
)
def test_a_spot_that_finds_no_two_walls_is_refused_by_its_place(given, words):
    with pytest.raises(InputError) as caught:
        lower(crossing(**given), SETTINGS)
    assert words in str(caught.value)
    assert caught.value.problems[0].where == "spot_welds.spot"


def test_of_many_spots_that_are_refused_the_first_are_described_and_the_others_counted():
    points = tuple((0.06 + 0.002 * i, 0.0, 0.02) for i in range(8))
    with pytest.raises(InputError) as caught:
        lower(crossing(points=points), SETTINGS)
    assert len(caught.value.problems) == 6
    last = caught.value.problems[-1]
    assert (last.what, last.where) == ("and 3 more spots cannot be tied", "spot_welds.spot")


def test_nodes_of_a_clamp_take_no_part():
    """A spot one element from a clamp, whose circle reaches it."""
    case = lower(
        crossing(points=((0.007, 0.0, 0.0),), up=((-0.04, 0.0, THICKNESS), (0.05, 0.0, THICKNESS))), SETTINGS
    )
    low, _ = means(case, case.welds[0])
    assert low == pytest.approx([0.007, 0.0, 0.0], abs=1e-12)
    assert case.mesh.position[case.welds[0].first.nodes][:, 0].min() > 1e-9


WEAK = {"normal_strength": 800.0, "shear_strength": 900.0, "pitch": 0.05}


def peeled():
    supports = BOTH_CLAMPED | {
        "hat": {"node": "tip", "fix": "all"},
        "plate": driven("plate-tip", "z", -0.02, 3e-3),
    }
    return hat_and_plate(0.2, spots=WEAK, supports=supports)


def peel_run(**more):
    return ShellRun(3e-3, 1e-4, COARSE, Outputs(pictures=(3e-3,)), **more)


@pytest.fixture(scope="module")
def result():
    return solve_shell(peeled(), peel_run())


def test_a_run_reports_which_spots_failed_when_and_where(result):
    assert result.status is Status.COMPLETE
    assert result["weld.left.failed"][0] == 0.0
    assert result["weld.left.failed"][-1] > 0.0
    assert result["weld.left.use"][-1] >= 1.0
    assert result.channels["weld.left.normal_force"].unit == "N"
    (text,) = [text for text in result.warnings if "spot welds left failed" in text]
    # from the tip inwards
    places = [float(part.split(",")[0]) for part in text.split("the one at (")[1:]]
    assert places[0] == 175.0
    assert places == sorted(places, reverse=True)
    assert " ms the one at" in text or " µs the one at" in text
    assert any(
        "4 spot welds left connect the sheets rigidly and fail at 800 N across" in t
        for t in result.assumptions
    )


def test_threads_and_restart_change_no_bit(result, tmp_path):
    asked, file = iter(range(1000)), tmp_path / "restart.npz"
    stopped = solve_shell(
        peeled(), peel_run(), cancel=lambda: next(asked) > 8, long_run=LongRun(restart_to=file)
    )
    assert stopped.status is Status.CANCELLED
    assert 0 < len(stopped.time) < len(result.time)
    resumed = solve_shell(peeled(), peel_run(threads=2), long_run=LongRun(restart_from=file))
    assert all(np.array_equal(resumed[name], result[name]) for name in result.channels)
    assert resumed.warnings == result.warnings
    assert np.array_equal(resumed.states.displacement, result.states.displacement)
