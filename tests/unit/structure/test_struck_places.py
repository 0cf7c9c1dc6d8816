"""Where obstacles strike members between their nodes, and the candidate hinges there."""

from __future__ import annotations

import math

import pytest
from tests.support.multibody.frames import structure

from crumple.hinge.bending.dented import DentedLaw
from crumple.hinge.bending.pressed import PressedLaw
from crumple.section import RectangularTube, fold_distance, half_fold_length
from crumple.structure import hinge_places, plastic_hinges
from crumple.structure.struck_places import struck_places

SIDE, RADIUS, HEIGHT = 0.04, 0.05, 0.3
NODES = {
    "a": (0.0, 0.0, 0.0),
    "b": (1.0, 0.0, 0.0),
    "c": (0.0, 0.0, -0.4),
    "d": (1.0, 0.0, -0.4),
    "e": (1.0, 0.0, 0.8),
}
DOWN = (0.0, 0.0, -5.0)
FREE = {"section": "tube", "material": "steel"}


def pole(at=0.4, **keys):
    """A pole across the beam, above it, that moves down."""
    moving = {} if "motion" in keys or "turning" in keys else {"velocity": DOWN}
    whole = {"type": "cylinder", "point": (at, 0.0, HEIGHT), "axis": (0.0, 1.0, 0.0), "radius": RADIUS}
    return whole | moving | keys


def ball(at=(0.4, 0.0, HEIGHT), velocity=DOWN, **keys):
    return {"type": "sphere", "point": at, "radius": RADIUS, "velocity": velocity} | keys


def beam(obstacles, *, members=None, **keys):
    members = {"ab": {**FREE, "nodes": ("a", "b")}} if members is None else members
    nodes = {node: NODES[node] for one in members.values() for node in one["nodes"]}
    sections = {"tube": {"type": "square_tube", "side": SIDE, "thickness": 0.002}}
    return structure(nodes, members, sections=sections, obstacles=obstacles, **({"hinges": "auto"} | keys))


def station(obstacle, **keys):
    """Where an obstacle strikes the beam; None if it does not."""
    found = struck_places(beam({"one": obstacle}, **keys), "ab")
    assert len(found) <= 1
    return found[0].station if found else None


def test_a_pole_that_moves_straight_at_a_member_strikes_it_in_front():
    assert station(pole(0.4)) == pytest.approx(0.4)


def test_a_path_that_is_oblique_ends_where_the_walls_touch():
    # the axis of the pole stops one radius and half a side above the member's line
    travel = HEIGHT - RADIUS - SIDE / 2.0
    assert station(pole(0.2, velocity=(3.0, 0.0, -3.0))) == pytest.approx(0.2 + travel)
    assert station(ball((0.2, 0.0, HEIGHT), (3.0, 0.0, -3.0))) == pytest.approx(0.2 + travel)


def test_an_oblique_pole_strikes_where_the_common_normal_is():
    # turned by 45 degrees about the vertical, and aside: it crosses the line 0.1 m further
    axis = (1.0, 1.0, 0.0)
    assert station(pole(point=(0.4, -0.1, HEIGHT), axis=axis)) == pytest.approx(0.5)


@pytest.mark.parametrize(
    "obstacle",
    [
        pole(1.2),
        pole(velocity=(0.0, 0.0, 5.0)),
        pole(velocity=(0.0, 5.0, 0.0)),
        pole(velocity=(5.0, 0.0, -0.5)),
        pole(axis=(1.0, 0.0, 0.0)),
        pole(axis=(1.0, 0.1, 0.0)),
        pole(length=0.2, point=(0.4, 0.1, HEIGHT)),
        ball((0.4, 0.1, HEIGHT)),
        ball((-0.3, 0.0, 0.0), (5.0, 0.0, 0.0)),
        pole(members=("other",)),
        {"type": "plane", "point": (0.0, 0.0, HEIGHT), "normal": (0.0, 0.0, -1.0), "velocity": DOWN},
    ],
)
def test_what_misses_or_lies_along_the_member_strikes_no_place(obstacle):
    members = {"ab": {**FREE, "nodes": ("a", "b")}, "other": {**FREE, "nodes": ("a", "c")}}
    assert station(obstacle, members=members) is None


def test_round_ends_and_balls_reach_their_radius_and_half_the_section_aside():
    reach = RADIUS + SIDE / 2.0
    assert station(pole(length=0.2, point=(0.4, reach - 1e-3, HEIGHT))) == pytest.approx(0.4)
    assert station(pole(length=0.2, point=(0.4, reach + 1e-3, HEIGHT))) is None
    assert station(ball((0.4, reach - 1e-3, HEIGHT))) == pytest.approx(0.4)
    assert station(ball((0.4, reach + 1e-3, HEIGHT))) is None
    # a pole that moves along its axis strikes with its end
    assert station(pole(length=0.5, axis=(0.0, 0.0, 1.0))) == pytest.approx(0.4)


def test_the_edge_of_a_table_strikes_a_member_that_lies_across_it():
    table = {
        "type": "plane",
        "point": (0.4, 0.0, -0.1),
        "normal": (0.0, 0.0, 1.0),
        "velocity": (0.0, 0.0, 5.0),
    }
    for out in (1.0, -1.0):
        assert station(table | {"edge": (out, 0.0, 0.0)}) == pytest.approx(0.4)
    # the lower end of one that leans over the table strikes its face first
    leaning = {"ab": {**FREE, "nodes": ("a", "e")}}
    assert station(table | {"edge": (1.0, 0.0, 0.0)}, members=leaning) is None
    assert station(table | {"edge": (-1.0, 0.0, 0.0)}, members=leaning) > 0.4


def test_the_motion_of_the_structure_counts():
    still = {"velocity": (0.0, 0.0, 0.0)}
    thrown = [{"translation": (-2.0, 0.0, 2.0)}]
    travel = HEIGHT - RADIUS - SIDE / 2.0
    assert station(pole(0.2, **still), initial_velocity=thrown) == pytest.approx(0.2 + travel)
    # both move alike: no direction is left, and the nearest place counts
    assert station(pole(0.2, velocity=(-2.0, 0.0, 2.0)), initial_velocity=thrown) == pytest.approx(0.2)


def test_a_prescribed_motion_gives_the_direction():
    ramp = {"step": {"x0": 0.1, "h0": 0.0, "x1": 0.2, "h1": -0.5}}
    motion = {"x": {"step": {"x0": 0.1, "h0": 0.0, "x1": 0.2, "h1": 0.5}}, "z": ramp}
    travel = HEIGHT - RADIUS - SIDE / 2.0
    assert station(pole(0.2, motion=motion)) == pytest.approx(0.2 + travel, abs=1e-6)


def test_without_a_direction_the_nearest_members_count():
    parallel = {"ab": {**FREE, "nodes": ("a", "b")}, "cd": {**FREE, "nodes": ("c", "d")}}
    moving = beam({"pole": pole()}, members=parallel)
    resting = beam({"pole": pole(velocity=(0.0, 0.0, 0.0))}, members=parallel)
    turning = [{"rotation": 1.0, "axis": (0.0, 1.0, 0.0)}]
    turned = beam({"pole": pole(velocity=(0.0, 0.0, 0.0))}, members=parallel, initial_velocity=turning)
    between = beam({"pole": pole(0.4, point=(0.4, 0.0, -0.2), velocity=(0, 0, 0))}, members=parallel)
    for whole, low in ((moving, 1), (resting, 0), (turned, 0), (between, 1)):
        assert [one.station for one in struck_places(whole, "ab")] == pytest.approx([0.4])
        assert len(struck_places(whole, "cd")) == low


FOLD = 2.0 * half_fold_length(RectangularTube(SIDE, SIDE, 0.002), "y")


def stations(obstacles, **keys):
    return {place.name: round(place.station, 6) for place in hinge_places(beam(obstacles, **keys))}


def test_each_pole_gives_a_candidate_with_the_axes_of_the_others_and_the_law_of_a_free_fold():
    whole = beam({"left": pole(0.3), "right": pole(0.7)})
    placed = {hinge.name: hinge for hinge in plastic_hinges(whole)}
    assert list(placed) == ["ab-a", "ab-left", "ab-right"]
    first, struck = placed["ab-a"], placed["ab-left"]
    assert struck.station == pytest.approx(0.3)
    # a dent lowers the law of the section, which beside joints and clamps is the formula
    assert isinstance(struck.law, PressedLaw)
    assert isinstance(struck.law.law, DentedLaw)
    assert (struck.law.name, first.law.name) == ("library", "kecman")
    assert struck.spatial.freedoms == first.spatial.freedoms


def test_a_candidate_within_one_fold_of_another_or_half_a_fold_of_that_at_an_end_is_left_out():
    inside = fold_distance(RectangularTube(SIDE, SIDE, 0.002), "y")
    assert "ab-pole" not in stations({"pole": pole(inside + 0.49 * FOLD)})
    assert "ab-pole" in stations({"pole": pole(inside + 0.51 * FOLD)})
    both = {"first": pole(0.4), "second": pole(0.4 + 0.99 * FOLD)}
    assert set(stations(both)) == {"ab-a", "ab-first"}
    assert len(stations(both | {"second": pole(0.4 + 1.01 * FOLD)})) == 3
    assert "ab-pole" not in stations({"pole": pole(0.5)}, hinges={"spacing": 0.5})


def test_names_of_obstacles_and_nodes_do_not_collide():
    assert stations({"a": pole(0.4)})["ab-a-struck"] == 0.4


def test_rigid_members_and_parts_have_none():
    for rigid in (True, [{"from": 0.3, "to": 0.5}]):
        members = {"ab": {**FREE, "nodes": ("a", "b"), "rigid": rigid}}
        assert "ab-pole" not in stations({"pole": pole(0.4)}, members=members)


def test_an_elastic_member_has_one_besides_its_list():
    far, near = ([{"name": "own", "at": at, "axes": ("y", "z")}] for at in (0.7, 0.4))
    for own, expected in ((far, {"ab-a", "own", "ab-pole"}), (near, {"ab-a", "own"})):
        members = {"ab": {**FREE, "nodes": ("a", "b"), "elastic": True, "hinges": own}}
        assert set(stations({"pole": pole(0.4)}, members=members, hinges=None)) == expected


def test_the_angle_below_which_a_pole_lies_along_a_member():
    for angle, strikes in ((9.0, False), (11.0, True)):
        axis = (math.cos(math.radians(angle)), math.sin(math.radians(angle)), 0.0)
        assert (station(pole(axis=axis)) is not None) is strikes
