"""Members bend by default where any hinges are automatic, in short runs, unless a member says otherwise."""

import pickle

import pytest
from tests.support.multibody.frames import CLAMP, member, structure

from crumple.analysis import load
from crumple.multibody import Run, solve_multibody
from crumple.structure import (
    AutomaticHinges,
    MultibodySettings,
    Stage,
    placed_hinges,
    rigid_for_long,
    with_elastic_members,
)
from crumple.structure.parts import OF_ANY_STIFFNESS
from crumple.structure.remembered import forget

SHORT, LONG = 0.1, 2.0
NODES = {"a": (0.0, 0.0, 0.0), "b": (1.0, 0.0, 0.0), "c": (1.0, 0.0, 1.0)}


def frame(**keys):
    """Two members with automatic hinges, or with one hinge in the first."""
    members = {"ab": member("a", "b", ("h", "a")), "bc": member("b", "c")}
    if "hinges" in keys:
        members["ab"]["hinges"] = members["bc"]["hinges"] = "auto"
    return structure(NODES, members, supports=CLAMP, **keys)


def bending(whole, duration, **settings):
    found = with_elastic_members(whole, MultibodySettings(**settings), duration)
    return sorted(name for name, spec in found.members.items() if spec.elastic)


@pytest.mark.parametrize(
    ("keys", "duration", "settings", "expected"),
    [
        ({"hinges": "auto"}, SHORT, {}, ["ab", "bc"]),
        ({"hinges": "auto"}, LONG, {}, []),
        ({"hinges": "auto"}, LONG, {"members": "elastic"}, ["ab", "bc"]),
        ({"hinges": "auto"}, SHORT, {"members": "rigid"}, []),
        ({}, SHORT, {}, []),
        ({}, SHORT, {"members": "elastic"}, ["ab", "bc"]),
    ],
)
def test_which_members_bend(keys, duration, settings, expected):
    assert bending(frame(**keys), duration, **settings) == expected


def test_members_bend_although_all_have_lists_besides_the_automatic_hinges_of_the_structure():
    members = {"ab": member("a", "b", ("h", "a")), "bc": member("b", "c", ("k", "b"))}
    listed = structure(NODES, members, supports=CLAMP)
    assert bending(listed, SHORT) == []
    assert bending(listed.model_copy(update={"hinges": AutomaticHinges()}), SHORT) == ["ab", "bc"]


def test_a_rigid_member_does_not_bend():
    whole = frame(hinges="auto")
    members = whole.members | {"bc": whole.members["bc"].model_copy(update={"rigid": True})}
    assert bending(whole.model_copy(update={"members": members}), SHORT) == ["ab"]


@pytest.mark.parametrize(
    ("kinds", "moving"), [((), 2.0), (("dynamic", "dynamic"), 2.0), (("dynamic", "quasi-static"), 1.5)]
)
def test_the_time_of_quasi_static_stages_does_not_count(kinds, moving):
    lasting = dict(zip("ab", (1.5, 0.5), strict=True))
    stages = [
        {"name": name, "kind": kind, "duration": lasting[name]}
        for name, kind in zip("ab", kinds, strict=False)
    ]
    run = Run(2.0, 0.1, stages=tuple(Stage.model_validate(stage) for stage in stages))
    assert run.time_in_motion == moving


def test_rigid_bars_of_a_long_motion_say_why():
    whole = frame(hinges="auto", initial_velocity=[{"rotation": 5.0, "axis": (0, 1, 0)}])
    said = "since the motion is longer than 500 ms; analysis.multibody.members: elastic lets them bend"
    for duration, settings, expected in ((0.51, {}, True), (0.51, {"members": "rigid"}, False)):
        run = Run(duration, 0.05, MultibodySettings(**settings), checks=False)
        (rigid,) = (text for text in solve_multibody(whole, run).assumptions if "Members are rigid" in text)
        assert (said in rigid) == expected


def test_members_that_say_nothing_are_named_beside_others_that_bend():
    whole = frame(hinges="auto")
    names = list(whole.members)
    settings = MultibodySettings()
    assert rigid_for_long(whole, settings, 0.49) == ""
    assert rigid_for_long(whole, MultibodySettings(members="rigid"), 0.51) == ""
    bends = whole.members[names[0]].model_copy(update={"elastic": 4})
    partly = whole.with_elastic({**whole.members, names[0]: bends})
    said = rigid_for_long(partly, settings, 0.51)
    assert names[0] not in said
    assert said.startswith(f"Member{'s' if len(names) > 2 else ''} {', '.join(names[1:])} ")
    assert "since the motion is longer than 500 ms; analysis.multibody.members: elastic lets" in said
    result = solve_multibody(partly, Run(0.51, 0.05, checks=False))
    assert said in result.assumptions


@pytest.mark.parametrize(("kind", "rigid"), [("quasi-static", False), ("dynamic", True)])
def test_members_of_a_long_quasi_static_stage_bend(kind, rigid):
    pushed = {"x": {"table": {"time": (0.0, 0.6), "value": (0.0, 1e-3)}}}
    far = {"far": {"node": "c", "motion": pushed}}
    whole = structure(
        NODES, {"ab": member("a", "b"), "bc": member("b", "c")}, hinges="auto", supports=CLAMP | far
    )
    stage = Stage.model_validate({"name": "push", "kind": kind, "duration": 0.6})
    result = solve_multibody(whole, Run(0.6, 0.1, stages=(stage,), checks=False))
    assert result.status.ok, result.reason
    assert any("Members are rigid between their hinges" in text for text in result.assumptions) == rigid


def test_the_result_says_so():
    whole = frame(hinges="auto", initial_velocity=[{"rotation": 5.0, "axis": (0, 1, 0)}])
    bends, rigid = (
        " ".join(solve_multibody(whole, Run(1e-3, 1e-3, MultibodySettings(members=members))).assumptions)
        for members in ("auto", "rigid")
    )
    assert "joint(s) between the hinges" in bends
    assert "Members are rigid between their hinges" not in bends
    assert "Members are rigid between their hinges" in rigid


def test_solver_range_and_modes_share_one_elastic_copy_with_its_hinges():
    whole = frame(hinges="auto")
    elastic, again = (with_elastic_members(whole, MultibodySettings(), SHORT) for _ in range(2))
    assert again is elastic
    assert placed_hinges(again) is placed_hinges(elastic)
    finer = with_elastic_members(whole, MultibodySettings(segments=6), SHORT)
    assert {spec.elastic for spec in finer.members.values()} == {6}
    forget()
    assert with_elastic_members(whole, MultibodySettings(), SHORT) is not elastic


@pytest.mark.parametrize("name", ["box_frame", "l_oblique", "chain_beam", "buggy", "hat_pillar"])
def test_what_the_elastic_copy_keeps_is_what_it_would_find_itself(name):
    whole = load(f"tests/concordance/structures/{name}.yaml").structure
    placed_hinges(whole)
    elastic = with_elastic_members(whole, MultibodySettings(members="elastic"), SHORT)
    assert elastic.kept
    anew = whole.model_copy(update={"members": elastic.members})
    assert elastic is not whole
    found, expected = placed_hinges(elastic), placed_hinges(anew)
    assert [(hinge.name, hinge.station, hinge.axis) for hinge in found] == [
        (hinge.name, hinge.station, hinge.axis) for hinge in expected
    ]
    for one, other in zip(found, expected, strict=True):
        assert pickle.dumps((one.record, one.spatial)) == pickle.dumps((other.record, other.spatial))
    # what was taken over equals what the other one has found by now
    shared = {key for key in elastic.kept if key[0] in OF_ANY_STIFFNESS and key in anew.kept}
    assert shared
    assert all(repr(elastic.kept[key]) == repr(anew.kept[key]) for key in shared)
