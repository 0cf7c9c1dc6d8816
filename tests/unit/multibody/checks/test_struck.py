"""A member with hinges of its own that lies in the path of an obstacle, with none of them there."""

import pytest
from tests.support.multibody.frames import LAW, structure

from crumple.multibody import Run, solve_multibody, struck_cautions
from crumple.structure import MultibodySettings

POLE = {"type": "cylinder", "point": (0.4, 0.0, 0.11), "axis": (0.0, 1.0, 0.0), "radius": 0.05}
DOWN = {"mass": 5.0, "velocity": (0.0, 0.0, -2.0)}
SUPPORTS = {
    "left": {"node": "a", "fix": ("x", "y", "z", "rx", "rz")},
    "right": {"node": "b", "fix": ("y", "z", "rx", "rz")},
}


def beam(*places, hinges=None, obstacle=None, **keys):
    """A beam on two supports with hinges at some places, and a pole above it that comes down."""
    own = [{"name": f"h{i}", "at": at, "axis": "y", "law": LAW} for i, at in enumerate(places)]
    members = {"beam": {"nodes": ("a", "b"), "section": "tube", "material": "steel", "hinges": own or None}}
    members["beam"] |= keys
    obstacle = POLE | DOWN if obstacle is None else obstacle
    return structure(members=members, supports=SUPPORTS, obstacles={"pole": obstacle}, hinges=hinges)


def found(whole):
    return [(caution.code, caution.place, caution.value) for caution in struck_cautions(whole)]


def test_a_place_without_a_hinge_is_named():
    (caution,) = struck_cautions(beam(0.2, 0.55))
    assert (caution.code, caution.place) == ("struck_between_hinges", "member beam")
    assert caution.value == pytest.approx(0.15)
    assert "Member beam is in the path of obstacle pole, 400 mm from node a" in caution.text
    assert "Give it a hinge at 400 mm" in caution.text


@pytest.mark.parametrize(
    "whole",
    [
        beam(0.2, 0.41),
        beam(),
        beam(hinges="auto"),
        beam(0.2, elastic=True),
        beam(0.2, rigid=[{"from": 0.3, "to": 0.5}]),
        beam(0.2, obstacle=POLE | {"velocity": (0.0, 0.0, 2.0)}),
        beam(0.2, obstacle=POLE | DOWN | {"point": (0.02, 0.0, 0.11)}),
    ],
)
def test_nothing_is_said(whole):
    assert not found(whole)


@pytest.mark.parametrize(("height", "cautions"), [(0.11, 1), (0.2, 0)])
def test_the_result_says_so_if_the_obstacle_came_that_far(height, cautions):
    whole = beam(0.2, 0.55, obstacle=POLE | DOWN | {"point": (0.4, 0.0, height)})
    result = solve_multibody(whole, Run(0.03, 0.001, MultibodySettings(members="rigid")))
    assert result.status.ok, result.reason
    assert [one.code for one in result.cautions].count("struck_between_hinges") == cautions
    assert sum("is in the path of obstacle pole" in text for text in result.warnings) == cautions
