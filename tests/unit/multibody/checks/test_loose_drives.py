"""Supports that drive a node along some axes leave it free in the others; who means them to hold is told."""

import pytest
from tests.support.multibody.frames import member, structure

from crumple.analysis import load
from crumple.multibody import Run, link, loose_drives, solve_multibody
from crumple.structure.checks.partly_driven import driven_assumptions

STEP = {"step": {"x0": 0.0, "h0": 0.0, "x1": 0.05, "h1": 0.01}}
BAR = {"bar": member("a", "b")}


def bar(*, members=BAR, **supports):
    return structure(members=members, supports=supports)


def loose(whole):
    return loose_drives(whole, link(whole))


def test_a_node_that_nothing_else_holds_is_named_with_what_to_write():
    """A free bar in the plane of x and z: pushed along z it may still slide along x and turn about y."""
    whole = bar(push={"node": "a", "motion": {"z": STEP}})
    (text,) = loose(whole)
    assert text == (
        "Support push drives node a along z and holds nothing else, and nothing else holds it along x and "
        "about y. Where it is not to move freely, add 'fix: [x, ry]' to supports.push."
    )
    assert text in solve_multibody(whole, Run(0.05, 0.005)).warnings
    assert loose(bar(push={"node": "a", "fix": ["x", "ry"], "motion": {"z": STEP}})) == ()


@pytest.mark.parametrize(
    "supports",
    [
        # a cantilever whose tip is pushed
        {"clamp": {"node": "a", "fix": "all"}, "push": {"node": "b", "motion": {"z": STEP}}},
        # a pivot that is moved: free about y on purpose
        {"pivot": {"node": "a", "fix": ["x", "y"], "motion": {"z": STEP}}},
        # two supports of one node
        {"push": {"node": "a", "motion": {"z": STEP}}, "rail": {"node": "a", "fix": ["x", "y", "rx"]}},
    ],
)
def test_nodes_that_are_held_elsewhere_or_free_on_purpose_are_silent(supports):
    hinged = {"bar": member("a", "b", ("h", 0.3))}
    assert loose(bar(members=hinged, **supports)) == ()


def test_what_a_drive_leaves_free_is_an_assumption():
    whole = bar(
        members={"bar": member("a", "b", ("h", 0.3))},
        clamp={"node": "a", "fix": "all"},
        push={"node": "b", "motion": {"z": STEP}},
    )
    told = (
        "Support push drives node b along z only and holds nothing along x and y and about x, y and z; "
        "'fix: [x, y, rx, ry, rz]' beside 'motion' would."
    )
    assert tuple(driven_assumptions(whole)) == (told,)
    assert told in solve_multibody(whole, Run(0.05, 0.005)).assumptions
    assert tuple(driven_assumptions(bar(hub={"node": "a", "fix": "all", "motion": {"z": STEP}}))) == ()


def test_drives_that_leave_alike_have_one_sentence(run_command):
    file = "tests/concordance/structures/rops_load.yaml"
    (text,) = driven_assumptions(load(file).structure)
    assert text.startswith(
        "Supports ram_front, ram_rear drive their nodes along y only and hold nothing along x"
    )
    code, said, _ = run_command("check", file)
    assert code == 0
    assert text in said
    # the frame stands on its feet
    assert "nothing else holds" not in said
