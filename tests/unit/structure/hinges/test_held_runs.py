"""Which members automatic hinges let stretch: straight runs that supports hold at both ends."""

import pytest
from tests.support.multibody.frames import member, structure

from crumple.structure import plastic_hinges
from crumple.structure.hinges.lengthening.held_runs import held_runs

LINE = {"a": (0.0, 0.0, 0.0), "b": (0.4, 0.0, 0.0), "c": (1.2, 0.0, 0.0)}
RUN = {"ab": member("a", "b"), "bc": member("b", "c")}
PUSH = [{"nodes": ["b"], "translation": (0.0, 0.0, -3.0)}]


def line(members=None, far="all", nodes=None, **parts):
    supports = {"near": {"node": "a", "fix": "all"}} | ({"far": {"node": "c", "fix": far}} if far else {})
    return structure(
        nodes=nodes or LINE, members=members or RUN, supports=supports, initial_velocity=PUSH, **parts
    )


@pytest.mark.parametrize("far", ["all", ["x", "y", "z"], ["x"]])
def test_members_in_line_between_supports_that_hold_them_along_are_a_run(far):
    assert held_runs(line(far=far)) == {"ab", "bc"}


@pytest.mark.parametrize("far", [None, ["y", "z"], ["z", "rx", "ry", "rz"]])
def test_a_run_that_can_move_along_itself_at_one_end_is_none(far):
    assert held_runs(line(far=far)) == frozenset()


def test_a_support_within_a_run_holds_only_what_lies_between_supports():
    whole = structure(
        nodes=LINE,
        members=RUN,
        supports={"near": {"node": "a", "fix": "all"}, "middle": {"node": "b", "fix": ["x", "z"]}},
    )
    assert held_runs(whole) == {"ab"}


def test_an_oblique_run_needs_supports_that_hold_all_of_its_directions():
    nodes = LINE | {"b": (0.3, 0.0, 0.4), "c": (0.9, 0.0, 1.2)}
    assert held_runs(line(nodes=nodes)) == {"ab", "bc"}
    assert held_runs(line(nodes=nodes, far=["x"])) == frozenset()


def test_a_bend_or_a_sliding_joint_ends_a_run():
    bent = LINE | {"b": (0.4, 0.0, 0.01)}
    assert held_runs(line(nodes=bent)) == frozenset()
    slide = {"slide": {"node": "b", "member": "ab", "type": "prismatic", "axis": (1.0, 0.0, 0.0)}}
    pin = {"pin": {"node": "b", "member": "ab", "type": "revolute", "axis": (0.0, 1.0, 0.0)}}
    assert held_runs(line(joints=slide)) == frozenset()
    assert held_runs(line(joints=pin)) == {"ab", "bc"}


def test_a_branch_beside_a_run_does_not_end_it_and_is_none():
    nodes = LINE | {"d": (0.4, 0.0, 0.5)}
    assert held_runs(line({**RUN, "bd": member("b", "d")}, nodes=nodes)) == {"ab", "bc"}


@pytest.mark.parametrize(("asked", "stretches"), [("auto", True), ({"axial": False}, False)])
def test_automatic_hinges_of_a_run_stretch_unless_the_input_says_no(asked, stretches):
    plain = {"section": "tube", "material": "steel"}
    members = {"ab": {"nodes": ("a", "b"), **plain}, "bc": {"nodes": ("b", "c"), **plain}}
    hinges = plastic_hinges(line(members, hinges=asked))
    assert len(hinges) == 3
    found = [
        h.spatial is not None and "AXIAL" in [c.freedom.name for c in h.spatial.components] for h in hinges
    ]
    assert found == [stretches] * 3
