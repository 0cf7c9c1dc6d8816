"""Which members automatic hinges let stretch: straight runs that supports hold at both ends."""

import numpy as np
import pytest
from tests.support.multibody.frames import member, structure

from crumple.hinge import Freedom
from crumple.structure import plastic_hinges
from crumple.structure.hinges.lengthening.held_runs import held_runs, pushed_runs

LINE = {"a": (0.0, 0.0, 0.0), "b": (0.4, 0.0, 0.0), "c": (1.2, 0.0, 0.0)}
RUN = {"ab": member("a", "b"), "bc": member("b", "c")}
PUSH = [{"nodes": ["b"], "translation": (0.0, 0.0, -3.0)}]


def line(members=None, far="all", nodes=None, **parts):
    supports = {"near": {"node": "a", "fix": "all"}} | ({"far": {"node": "c", "fix": far}} if far else {})
    return structure(
        nodes=nodes or LINE, members=members or RUN, supports=supports, initial_velocity=PUSH, **parts
    )


def pressed_falls(hinge):
    """Whether the force of a hinge falls when it is shortened, as that of a fold does."""
    (axial,) = (one.record for one in hinge.spatial.components if one.freedom == Freedom.AXIAL)
    force = axial.negative.moment
    return force.min() < 0.9 * force.max()


@pytest.mark.parametrize("far", ["all", ["x", "y", "z"], ["x"]])
def test_members_in_line_between_supports_that_hold_them_along_are_a_run(far):
    assert held_runs(line(far=far)) == {"ab", "bc"}


@pytest.mark.parametrize("far", [None, ["y", "z"], ["z", "rx", "ry", "rz"]])
def test_a_run_that_can_move_along_itself_at_one_end_is_none(far):
    assert held_runs(line(far=far)) == frozenset()


def test_a_run_whose_end_is_driven_may_be_pressed_and_then_folds_or_buckles():
    supports = {"near": {"node": "a", "fix": "all"}, "far": {"node": "c", "fix": ["y", "z"]}}
    pushed = {"x": {"table": {"time": (0.0, 1.0), "value": (0.0, -0.05)}}}
    held = structure(LINE, RUN, hinges="auto", supports=supports | {"far": {"node": "c", "fix": "all"}})
    driven = structure(
        LINE, RUN, hinges="auto", supports=supports | {"far": supports["far"] | {"motion": pushed}}
    )
    assert held_runs(held) == held_runs(driven) == pushed_runs(driven) == {"ab", "bc"}
    assert pushed_runs(held) == frozenset()
    middle = {hinge.name for hinge in plastic_hinges(driven)} - {hinge.name for hinge in plastic_hinges(held)}
    assert len(middle) == 1
    assert not any(pressed_falls(hinge) for hinge in plastic_hinges(held))
    assert all(pressed_falls(hinge) for hinge in plastic_hinges(driven))


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
    bent = LINE | {"b": (0.4, 0.0, 0.05)}
    assert held_runs(line(nodes=bent)) == frozenset()
    slide = {"slide": {"node": "b", "member": "ab", "type": "prismatic", "axis": (1.0, 0.0, 0.0)}}
    pin = {"pin": {"node": "b", "member": "ab", "type": "revolute", "axis": (0.0, 1.0, 0.0)}}
    assert held_runs(line(joints=slide)) == frozenset()
    assert held_runs(line(joints=pin)) == {"ab", "bc"}


@pytest.mark.parametrize("aside", [1e-6, 1e-5, 1e-3, 0.02])
@pytest.mark.parametrize("axis", [1, 2])
def test_a_run_is_straight_whose_length_exceeds_the_way_by_less_than_its_walls_stretch(aside, axis):
    """0.02 m over 0.4 and 0.8 m: 0.06 % longer than the way; the walls yield at 0.1 % or more."""
    bent = np.array(LINE["b"])
    bent[axis] = aside
    assert held_runs(line(nodes=LINE | {"b": tuple(bent)})) == {"ab", "bc"}
    assert held_runs(line(nodes=LINE | {"b": tuple(bent)}, far=["x"])) == {"ab", "bc"}


def test_an_arch_of_small_kinks_is_no_run_in_whatever_order_its_members_are_named():
    turns = np.radians([-6.0, -2.0, 2.0, 6.0])
    points = np.concatenate([[[0.0, 0.0]], np.cumsum(0.3 * np.stack([np.cos(turns), np.sin(turns)], 1), 0)])
    nodes = {name: (float(x), 0.0, float(z)) for name, (x, z) in zip("abdec", points, strict=True)}
    members = {"ab": member("a", "b"), "bd": member("b", "d"), "de": member("d", "e"), "ec": member("e", "c")}
    for order in (list(members), list(members)[::-1], ["bd", "ec", "ab", "de"]):
        assert held_runs(line({name: members[name] for name in order}, nodes=nodes)) == frozenset()


def test_a_branch_beside_a_run_does_not_end_it_and_is_none():
    nodes = LINE | {"d": (0.4, 0.0, 0.5)}
    assert held_runs(line({**RUN, "bd": member("b", "d")}, nodes=nodes)) == {"ab", "bc"}


@pytest.mark.parametrize(("asked", "stretches"), [("auto", True), ({"axial": False}, False)])
def test_automatic_hinges_of_a_run_stretch_unless_the_input_says_no(asked, stretches):
    plain = {"section": "tube", "material": "steel"}
    members = {"ab": {"nodes": ("a", "b"), **plain}, "bc": {"nodes": ("b", "c"), **plain}}
    hinges = plastic_hinges(line(members, hinges=asked))
    assert len(hinges) == 2
    found = [
        h.spatial is not None and "AXIAL" in [c.freedom.name for c in h.spatial.components] for h in hinges
    ]
    assert found == [stretches] * 2
