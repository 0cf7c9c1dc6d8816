"""Spot welds in a description: where the spots lie, and what is refused."""

import numpy as np
import pytest
from tests.support.multibody.frames import STEEL, TUBE, member

from crumple.analysis import Analysis
from crumple.errors import InputError
from crumple.structure import ShellSettings, SpotWelds, Structure
from crumple.structure.weld_room import widest_spot

HAT = {"type": "closed_hat", "width": 0.06, "depth": 0.04, "thickness": 1.5e-3, "flange": 0.02}
STACK = {"up": {"members": ("low", "top"), "at": (0.0, 0.0125), "pitch": 0.1}}


def welded(welds=STACK, **more):
    """Two tubes, one on top of the other, and a closed hat beside them."""
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE, "hat": HAT},
        nodes={
            "a": (0, 0, 0), "b": (1, 0, 0), "c": (0.5, 0, 0.025), "d": (1.5, 0, 0.025),
            "e": (0, 1, 0), "f": (1, 1, 0),
        },
        members={"low": member("a", "b"), "top": member("c", "d"), "hat": member("e", "f", section="hat")},
        supports={"clamp": {"node": "a", "fix": "all"}},
        spot_welds=welds,
        **more,
    )  # fmt: skip


def test_spots_of_a_line_lie_a_pitch_apart_half_a_pitch_from_its_ends():
    welds = SpotWelds(members=("low", "top"), at=(0.01, 0.0125), start=0.5, end=0.9, pitch=0.1)
    whole = welded({"up": welds})
    places = welds.places(whole.frame_of("low"))
    assert places[:, 0] == pytest.approx([0.55, 0.65, 0.75, 0.85])
    # local y of a member along x is global y
    assert places[:, 1:] == pytest.approx(np.tile([0.01, 0.0125], (4, 1)))
    assert SpotWelds(members=("hat",), pitch=0.3).stations(1.0) == pytest.approx([1 / 6, 0.5, 5 / 6])
    # a pitch longer than the line leaves one spot in its middle
    assert SpotWelds(members=("hat",), pitch=3.0).stations(1.0) == pytest.approx([0.5])


def test_points_are_taken_as_they_are():
    welds = SpotWelds(members=("low", "top"), points=[(0.6, 0.0, 0.0125)])
    assert welds.places(welded().frame_of("low")) == pytest.approx(np.array([[0.6, 0.0, 0.0125]]))
    assert not welds.fails
    assert SpotWelds(members=("low", "top"), points=[(0, 0, 0)], shear_strength="5 kN").fails


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"members": ("low", "top"), "at": (0, 0)}, "the distance of the spots is missing"),
        ({"members": ("low", "top"), "pitch": 0.1}, "the positions of the spots are missing"),
        ({"members": ("low", "low"), "at": (0, 0), "pitch": 0.1}, "both members are the same"),
        ({"members": ("hat",), "at": (0, 0), "pitch": 0.1}, "lie on the weld lines of its section"),
        ({"members": ("hat",), "points": [(0, 0, 0)]}, "lie on the weld lines of its section"),
        ({"members": ("low", "top"), "points": [(0, 0, 0)], "pitch": 0.1}, "as points and as a line"),
        ({"members": ("low", "top"), "points": [(0, 0, 0)], "from": 0.1}, "as points and as a line"),
        ({"members": ("hat",), "pitch": 0.1, "from": 0.3, "to": 0.2}, "ends before it begins"),
        ({"members": ("hat",), "pitch": 0.1, "shear_strength": 0.0}, "out of range"),
        ({"members": ("hut",), "pitch": 0.1}, "there is no member 'hut'"),
        ({"members": ("hat",), "pitch": 0.1, "to": 1.2}, "outside the member"),
        ({"members": ("hat",), "pitch": 0.1, "from": 1.0}, "outside the member"),
        ({"members": ("hat",), "pitch": 1e-5}, "too many spot welds"),
        (
            {"members": ("low", "top"), "points": [(0.6, 0, 0.0125), (0.7, 0, 0.0125), (0.6, 0, 0.013)]},
            "distance of the spot welds",
        ),
        (
            {"members": ("low", "top"), "at": (0, 0.0125), "pitch": 2e-3},
            "distance of the spot welds is too small",
        ),
        ({"members": ("hat",), "pitch": 1e-3}, "distance of the spot welds is too small"),
        ({"members": ("low",), "pitch": 0.1}, "the section of member 'low' has no lines of spot welds"),
    ],
)
def test_welds_that_cannot_be_are_refused(keys, words):
    with pytest.raises(InputError) as caught:
        welded({"up": keys})
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("keys", "member", "widest"),
    [
        # flange of 20 mm: flat from the web's mid-line, 30 - 0.75 mm, or the bend, to 50 mm
        ({"members": ("hat",), "pitch": 0.1}, "hat", 20.0),
        # in the middle of walls 25 mm deep and 50 mm wide, and 10 mm beside it
        ({"members": ("low", "top"), "at": (0.0, 0.0125), "pitch": 0.1}, "low", 47.35),
        ({"members": ("low", "top"), "at": (0.01, 0.0125), "pitch": 0.1}, "low", 27.35),
        ({"members": ("low", "top"), "points": [(0.6, 0.0, 0.0125), (0.7, 0.02, 0.0125)]}, "low", 7.35),
    ],
)
def test_a_spot_cannot_be_wider_than_its_wall(keys, member, widest):
    structure = welded({"up": {**keys, "diameter": 1e-3 * widest}})
    found, least = widest_spot(structure, "up")
    assert 1e3 * found == pytest.approx(widest, abs=0.8)
    assert least == member
    with pytest.raises(InputError, match="diameter of the spot welds is larger than the wall") as caught:
        welded({"up": {**keys, "diameter": 0.5}})
    (problem,) = caught.value.problems
    assert (problem.came, problem.where) == ("500 mm", "spot_welds.up.diameter")


def test_a_round_tube_has_room_as_far_as_it_is_flat():
    tube = {"type": "circular_tube", "diameter": 0.1, "thickness": 2e-3}
    keys = {"members": ("low", "top"), "at": (0.0, 0.05), "pitch": 0.1}
    nodes = {"a": (0, 0, 0), "b": (1, 0, 0), "c": (0, 0, 0.1), "d": (1, 0, 0.1)}
    structure = Structure(
        materials={"steel": STEEL},
        sections={"tube": tube},
        nodes=nodes,
        members={"low": member("a", "b"), "top": member("c", "d")},
        supports={"clamp": {"node": "a", "fix": "all"}},
        spot_welds={"up": keys},
    )
    # 30 deg to both sides of a mid-line of 49 mm, to a side of the polygon
    assert widest_spot(structure, "up")[0] == pytest.approx(2 * 0.049 * np.radians(30.0), rel=0.2)


def test_two_entries_cannot_tie_one_place_twice():
    more = {**STACK, "again": {"members": ("top", "low"), "points": [(0.30, 0.0, 0.0125), (0.55, 0, 0.0125)]}}
    with pytest.raises(InputError) as caught:
        welded(more)
    (problem,) = caught.value.problems
    assert problem.what == "1 of its 2 spots lie where spots of 'up' tie the same members already"
    assert problem.came == "0 mm apart at (550, 0, 12.5) mm"
    assert problem.where == "spot_welds.again"
    # the same line twice in a section; and its two halves
    half = {"members": ("hat",), "pitch": 0.1, "to": 0.5}
    with pytest.raises(InputError, match="10 of its 10 spots lie"):
        welded({"left": half, "right": half})
    welded({"left": half, "right": {"members": ("hat",), "pitch": 0.1, "from": 0.5}})


@pytest.mark.parametrize("entry", [{}, {"own": {"members": ("hat",), "pitch": 0.1}}])
def test_a_pitch_of_the_shell_settings_needs_a_line_that_takes_it(entry):
    settings = ShellSettings(weld_pitch=0.05)
    if not entry:
        Analysis(structure=welded(), duration=1e-3, shell=settings)
        plain = welded({}).members["low"].model_copy(update={"nodes": ("e", "f")})
        given = welded().model_copy(update={"members": {**welded().members, "hat": plain}})
    else:
        given = welded(entry)
    with pytest.raises(InputError, match="no line of spot welds for this pitch"):
        Analysis(structure=given, duration=1e-3, shell=settings)


def test_a_point_that_is_too_near_to_another_is_named():
    points = [(0.6, 0, 0.0125), (0.7, 0, 0.0125), (0.6, 0, 0.013)]
    with pytest.raises(InputError) as caught:
        welded({"up": {"members": ("low", "top"), "points": points}})
    (problem,) = caught.value.problems
    assert problem.where == "spot_welds.up.points[2]"
    assert problem.came == "0.5 mm"
