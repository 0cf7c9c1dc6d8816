"""Hinges and joints of members of open sections: where they lie, and what they carry in twist."""

import pytest
from tests.support.multibody.frames import CLAMP, structure

from crumple.hinge import Freedom, build_torsion_law
from crumple.structure import hinge_places, placed_hinges
from crumple.structure.hinges.runs.bars import bar_of
from crumple.structure.hinges.shares import warping_span

CHANNEL = {"type": "channel", "width": 0.04, "depth": 0.08, "thickness": 0.003}
TUBE = {"type": "square_tube", "side": 0.05, "thickness": 0.003}
SPAN = 0.6 - 0.025
"""Length of the channel up to the face of the arm [m]."""
NODES = {"a": (0.0, 0.0, 0.0), "b": (0.6, 0.0, 0.0), "c": (0.6, 0.4, 0.0)}


def crank(elastic=6, **parts):
    """A clamped channel along x with an arm across its end, in space."""
    alike = {"material": "steel", "elastic": elastic}
    post = alike | {"nodes": ("a", "b"), "section": "post", "up": (0.0, 0.0, 1.0)}
    arm = alike | {"nodes": ("b", "c"), "section": "tube"}
    given = {
        "sections": {"post": CHANNEL, "tube": TUBE},
        "masses": {"m": {"node": "c", "mass": 20.0}},
        "hinges": "auto",
        "gravity": (0.0, 9.81, 9.81),
        "supports": CLAMP,
    } | parts
    return structure(NODES, {"post": post, "arm": arm}, **given)


def twisting(whole):
    return [
        hinge
        for hinge in placed_hinges(whole)
        if hinge.member == "post" and hinge.spatial is not None and Freedom.X in hinge.spatial.freedoms
    ]


@pytest.mark.parametrize("elastic", [0, 6])
def test_points_that_twist_lie_on_the_shear_centre(elastic):
    whole = crank(elastic)
    centre, frame = whole.section_of("post").shear_centre, whole.frame_of("post")
    hinges = twisting(whole)
    assert len(hinges) == (3 if elastic else 2)
    assert {len(hinge.spatial.freedoms) for hinge in hinges} == {1 if elastic else 3}
    for hinge in hinges:
        beside = hinge.position - frame.position(hinge.station)
        assert beside @ frame.y == pytest.approx(centre[0], abs=1e-12)
        assert beside @ frame.z == pytest.approx(centre[1], abs=1e-12)
    assert abs(centre[0]) > 0.02


def test_hinges_that_change_their_length_stay_on_the_line_of_the_member():
    whole = crank(0, hinges={"axial": True})
    assert twisting(whole)
    for hinge in twisting(whole):
        assert hinge.position == pytest.approx(whole.frame_of("post").position(hinge.station))


@pytest.mark.parametrize("elastic", [0, 6])
def test_together_they_have_the_stiffness_and_the_torque_of_the_member(elastic):
    whole = crank(elastic)
    metal = whole.section_of("post"), whole.material_of("post")
    span = warping_span(whole, bar_of(whole, "post"))[0]
    law = build_torsion_law("warping", *metal, span)
    records = [
        component.record
        for hinge in twisting(whole)
        for component in hinge.spatial.components
        if component.freedom is Freedom.X
    ]
    if elastic:
        springs = [one.elastic_stiffness for one in records]
        assert 1.0 / sum(1.0 / spring for spring in springs) == pytest.approx(law.elastic_stiffness)
    assert [one.positive.moment.max() for one in records] == [pytest.approx(law.steady_torque)] * len(records)
    twists = [one.positive.rotation[one.positive.moment.argmax()] for one in records]
    assert sum(twists) == pytest.approx(law.twist[1], rel=0.01)


@pytest.mark.parametrize(
    ("parts", "held"),
    [
        ({}, "both"),
        ({"supports": {}}, "one"),
        ({"supports": {}, "masses": {"m": {"node": "a", "mass": 1.0}}}, "both"),
    ],
)
def test_ends_hold_warping_where_anything_is_at_their_node(parts, held):
    whole = crank(**parts)
    assert warping_span(whole, bar_of(whole, "post")) == (pytest.approx(SPAN), held)


def test_members_that_spot_welds_join_do_not_twist_on_their_own():
    post = {"nodes": ("a", "b"), "section": "post", "material": "steel", "up": (0.0, 0.0, 1.0)}
    other = post | {"nodes": ("d", "e")}
    nodes = NODES | {"d": (0.0, -0.04, 0.0), "e": (0.6, -0.04, 0.0)}
    parts = {
        "sections": {"post": CHANNEL, "tube": TUBE},
        "hinges": "auto",
        "gravity": (0.0, 9.81, 9.81),
        "supports": CLAMP,
    }
    del nodes["c"]
    alone = structure(nodes, {"post": post, "other": other}, **parts)
    welds = {"line": {"members": ("post", "other"), "at": (0.0, 0.04), "pitch": 0.1}}
    welded = structure(nodes, {"post": post, "other": other}, spot_welds=welds, **parts)
    assert {place.keys.axes for place in hinge_places(alone)} == {("y", "z", "x")}
    assert {place.keys.axes for place in hinge_places(welded)} == {("y", "z")}
