"""Members in line that are one tube fold as one: with a candidate at a kink between them, none elsewhere."""

import math
from itertools import pairwise

import pytest
from tests.support.multibody.frames import CLAMP, member, structure
from tests.support.multibody.frames import TUBE as TUBE_KEYS

from crumple.section import RectangularTube, fold_distance, half_fold_length
from crumple.structure import hinge_places
from crumple.structure.hinges.runs.candidates import ASIDE
from crumple.structure.hinges.runs.straight_runs import straight_run

NODES = {"a": (0.0, 0.0, 0.0), "b": (0.4, 0.0, 0.0), "c": (1.0, 0.0, 0.0), "d": (1.0, 0.0, 0.5)}
TUBE = RectangularTube(0.050, 0.025, 0.00265)
INSIDE, HALF = fold_distance(TUBE, "y"), half_fold_length(TUBE, "y")
KINKED = NODES | {"b": (0.4, 0.0, 0.01)}
"""2.4 degrees at b."""
LINE = {"ab": member("a", "b") | {"hinges": ()}, "bc": member("b", "c") | {"hinges": ()}}
HELD = CLAMP | {"far": {"node": "c", "fix": "all"}}


def line(members=LINE, nodes=("a", "b", "c"), places=NODES, **parts):
    parts = {"supports": HELD, "hinges": "auto"} | parts
    return structure({name: places[name] for name in nodes}, members, **parts)


def stations(whole):
    return {place.name: pytest.approx(place.station) for place in hinge_places(whole)}


def test_a_node_in_a_straight_tube_changes_no_candidate():
    assert stations(line()) == {"ab-a": INSIDE, "bc-c": 0.6 - INSIDE}


def test_a_kink_in_a_tube_has_one_candidate_just_before_it():
    length = math.hypot(0.4, 0.01)
    found = stations(line(places=KINKED, supports=CLAMP))
    assert found == {"ab-a": INSIDE, "ab-b": length - ASIDE * HALF}


def test_a_struck_node_in_a_tube_has_one_candidate_just_before_it():
    pole = {"type": "sphere", "point": (0.4, 0.0, 0.3), "radius": 0.1, "mass": 10.0, "guide": (0.0, 0.0, 1.0)}
    struck = line(obstacles={"pole": pole | {"velocity": (0.0, 0.0, -5.0)}})
    assert stations(struck)["ab-b"] == pytest.approx(0.4 - ASIDE * HALF)


def test_members_may_lead_either_way():
    turned = LINE | {"bc": member("c", "b") | {"hinges": ()}}
    assert stations(line(turned)) == {"ab-a": INSIDE, "bc-c": INSIDE}
    run = straight_run(line(turned), "bc")
    assert list(run.stretches) == ["ab", "bc"]
    assert run.nodes == ("a", "c")
    assert run.stretches["bc"].station(1.0) == pytest.approx(0.0)


def test_kinks_within_one_fold_of_each_other_share_a_candidate():
    nodes = NODES | {f"n{i}": (0.4 + 0.01 * i, 0.0, 0.0002 * (i % 2)) for i in range(1, 4)}
    names = ("b", "n1", "n2", "n3")
    short = {first + second: member(first, second) for first, second in pairwise(names)}
    members = {"ab": member("a", "b"), **short, "nc": member("n3", "c")}
    whole = structure(
        {name: at for name, at in nodes.items() if name != "d"},
        {name: parts | {"hinges": ()} for name, parts in members.items()},
        hinges="auto",
        supports=HELD,
    )
    assert list(stations(whole)) == ["ab-a", "ab-b", "nc-c"]


OTHER = {"tube": TUBE_KEYS, "other": TUBE_KEYS | {"thickness": 0.002}}
ENDED = {
    "a mass": {"masses": {"m": {"node": "b", "mass": 5.0}}},
    "a support": {"supports": HELD | {"b": {"node": "b", "fix": ("y",)}}},
    "a further member": {
        "nodes": ("a", "b", "c", "d"),
        "members": LINE | {"bd": member("b", "d") | {"hinges": ()}},
    },
    "other candidates": {"members": LINE | {"bc": LINE["bc"] | {"hinges": {"spacing": 0.3}}}},
    "hinges of its own": {"members": LINE | {"bc": member("b", "c", ("h", 0.3))}},
    "a rigid part": {"members": LINE | {"bc": LINE["bc"] | {"rigid": [{"from": 0.0, "to": 0.05}]}}},
    "another section": {"sections": OTHER, "members": LINE | {"bc": LINE["bc"] | {"section": "other"}}},
    "another position": {"members": LINE | {"bc": LINE["bc"] | {"up": (0.0, 1.0, 0.0)}}},
    "a corner": {
        "nodes": ("a", "b", "d"),
        "members": {"ab": LINE["ab"], "bd": LINE["ab"] | {"nodes": ("b", "d")}},
    },
}


@pytest.mark.parametrize("case", ENDED)
def test_what_else_is_at_a_node_ends_the_run(case):
    parts = ENDED[case] | ({"supports": CLAMP} if case == "a corner" else {})
    assert list(straight_run(line(**parts), "ab").stretches) == ["ab"]


def test_a_ring_of_small_kinks_is_one_run():
    number = 90
    turns = [2.0 * math.pi * i / number for i in range(number)]
    nodes = {f"n{i}": (math.cos(turn), 0.0, math.sin(turn)) for i, turn in enumerate(turns)}
    members = {f"m{i}": member(f"n{i}", f"n{(i + 1) % number}") | {"hinges": ()} for i in range(number)}
    whole = structure(nodes, members, hinges="auto", supports={})
    run = straight_run(whole, "m7")
    assert set(run.stretches) == set(members)
    assert run.length == pytest.approx(2.0 * number * math.sin(math.pi / number))
    assert all(0.0 < place.station < 0.07 for place in hinge_places(whole))
