"""Braced members: their hinges cannot open unless some member changes its length."""

import numpy as np
import pytest
from tests.support.multibody.frames import structure

from crumple.structure import plastic_hinges
from crumple.structure.hinges.automatic import lengthens
from crumple.structure.hinges.lengthening import framework
from crumple.structure.hinges.lengthening.braced import braced

PLAIN = {"section": "tube", "material": "steel"}
FLAT = {
    "a": (0.0, 0.0, 0.0),
    "b": (0.0, 0.0, 0.6),
    "c": (0.8, 0.0, 0.6),
    "d": (0.8, 0.0, 0.0),
    "m": (0.4, 0.0, 0.6),
    "k": (0.0, 0.0, 0.4),
    "n": (0.2, 0.0, 0.6),
    "e": (0.0, 0.0, 1.2),
    "f": (0.8, 0.0, 1.2),
}
TRIPOD = {
    "a": (0.4, 0.0, 0.0),
    "b": (-0.2, 0.35, 0.0),
    "c": (-0.2, -0.35, 0.0),
    "t": (0.0, 0.0, 0.55),
    "h": (0.05, 0.02, 0.9),
    "m": (0.2, 0.0, 0.275),
}
POSTS = {f"{i}{j}": (x, y, z) for i, z in ((0, 0.0), (1, 1.0)) for j, x, y in
         ((0, 0.0, 0.0), (1, 0.9, 0.0), (2, 0.9, 0.7), (3, 0.0, 0.7))}  # fmt: skip
ROPS = "00-10 01-11 02-12 03-13 10-11 11-12 12-13 13-10"
BOXED = f"{ROPS} 00-11 01-12 02-13 03-10"
THROWN = [{"translation": (1.0, 0.0, -3.0)}]
TRIANGLE = {"a": (0.0, 0.0, 0.0), "b": (-0.35, 0.0, 0.5), "c": (0.3, 0.0, 0.55), "d": (0.9, 0.0, 0.55)}


def frame(nodes, bars, clamps="", *, own=None, **parts):
    """Members "a-b" between their nodes, with keys of their own, and clamps at nodes."""
    members = {
        bar: {"nodes": tuple(bar.split("-")), **PLAIN, **(own or {}).get(bar, {})} for bar in bars.split()
    }
    used = {node for bar in bars.split() for node in bar.split("-")}
    supports = parts.pop("supports", {}) | {
        f"clamp_{node}": {"node": node, "fix": "all"} for node in clamps.split()
    }
    return structure(
        nodes={node: at for node, at in nodes.items() if node in used},
        members=members,
        supports=supports,
        **({"hinges": "auto", "initial_velocity": THROWN} | parts),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("nodes", "bars", "clamps", "expected"),
    [
        pytest.param(FLAT, "a-b b-c c-d", "a d", "", id="portal"),
        pytest.param(FLAT, "a-b b-c c-d a-c", "a d", "a-b b-c c-d a-c", id="portal with diagonal"),
        # the beam can kink, which moves no other node to first order
        pytest.param(FLAT, "a-b b-m m-c c-d a-c", "a d", "a-b c-d a-c", id="and a node in its beam"),
        pytest.param(FLAT, "a-k k-b b-n n-c c-d k-n", "a d", "", id="knee-braced portal"),
        pytest.param(FLAT, "a-b b-c c-d b-e e-f f-c", "a d", "", id="two storeys"),
        # the upper storey sways on the lower one, which stands
        pytest.param(FLAT, "a-b b-c c-d a-c b-e e-f f-c", "a d", "a-b b-c c-d a-c", id="lower one braced"),
        pytest.param(FLAT, "a-b b-c", "a", "", id="L-frame"),
        pytest.param(FLAT, "a-b b-c", "a c", "a-b b-c", id="clamped L-frame, in its plane"),
        pytest.param(TRIPOD, "a-t b-t c-t", "a b c", "a-t b-t c-t", id="tripod"),
        pytest.param(TRIPOD, "a-t b-t c-t t-h", "a b c", "a-t b-t c-t", id="tripod with a mast"),
        pytest.param(TRIPOD, "a-t b-t", "a b", "", id="two legs in space"),
        pytest.param(TRIPOD, "a-m m-t b-t c-t", "a b c", "b-t c-t", id="tripod with a node in a leg"),
        pytest.param(TRIANGLE, "a-b b-c a-c", "", "a-b b-c a-c", id="free triangle"),
        pytest.param(TRIANGLE, "a-b b-c a-c c-d", "", "a-b", id="and a fourth member"),
        pytest.param(POSTS, ROPS, "00 01 02 03", "", id="four posts"),
        pytest.param(POSTS, BOXED, "00 01 02 03", BOXED, id="and diagonals in all walls"),
        pytest.param(POSTS, ROPS, "", "", id="free four posts"),
    ],
)  # fmt: skip
def test_members_of_frames(nodes, bars, clamps, expected):
    still = frame(nodes, bars, clamps, initial_velocity=())
    assert {name for name in still.members if lengthens(still, name)} == set(expected.split())


@pytest.mark.parametrize(("thrown", "all_of_them"), [((1.0, 0.0, 0.0), False), ((0.3, 0.0, -3.0), True)])
def test_members_that_an_impact_would_stop_lengthen_in_rigid_models_too(thrown, all_of_them):
    """A portal may sway; thrown on its clamps it would stop at once."""
    portal = frame(FLAT, "a-b b-c c-d", "a d", initial_velocity=[{"translation": thrown}])
    assert [lengthens(portal, name) for name in portal.members] == [all_of_them] * 3


def test_in_space_a_clamped_l_frame_turns_about_the_line_between_its_clamps():
    across = [{"translation": (0.0, 2.0, -3.0)}]
    assert not braced(frame(FLAT, "a-b b-c", "a c", initial_velocity=across))


def test_what_the_input_lets_change_its_length_holds_nothing():
    whole = frame(TRIPOD, "a-t b-t c-t", "a b c", own={"a-t": {"hinges": {"axial": True}}})
    assert not braced(whole)


def test_a_sliding_joint_passes_no_length_on_and_a_spherical_one_no_turn():
    joint = {"node": "t", "member": "a-t"}
    slide = {"j": joint | {"type": "prismatic", "axis": (-0.4, 0.0, 0.55)}}
    assert not braced(frame(TRIPOD, "a-t b-t c-t", "a b c", joints=slide))
    ball = {"j": joint | {"type": "spherical"}}
    assert braced(frame(TRIPOD, "a-t b-t c-t", "a b c", joints=ball)) == {"a-t", "b-t", "c-t"}
    # the mast on a ball turns, and no hinge opens
    mast = {"j": {"node": "c", "member": "c-d", "type": "spherical"}}
    assert braced(frame(TRIANGLE, "a-b b-c a-c c-d", joints=mast)) == {"a-b", "b-c", "a-c"}


def test_a_pin_lets_a_triangle_turn_as_one_body_and_a_clamp_does_not():
    bars = "a-b b-c a-c"
    assert braced(frame(TRIANGLE, bars, supports={"pin": {"node": "a", "fix": "pin"}})) == set(bars.split())
    held = {"pin": {"node": "a", "fix": "pin"}, "still": {"node": "a", "fix": ["ry"]}}
    assert braced(frame(TRIANGLE, bars, supports=held)) == {"b-c"}


def test_a_wishbone_is_braced_though_its_pivots_are_a_little_out_of_line():
    def turned(degrees):
        nodes = {"a": (0.0, 0.2, 0.0), "b": (0.0, -0.2, 0.0), "c": (0.35, 0.05, -0.05)}
        tilt = np.radians(degrees)
        nodes["b"] = (0.0, 0.2 - 0.4 * np.cos(tilt), 0.4 * np.sin(tilt))
        pivots = {f"pivot_{node}": {"node": node, "fix": ["x", "y", "z", "rx", "rz"]} for node in "ab"}
        return braced(frame(nodes, "a-c b-c", supports=pivots))

    for degrees in (0.0, 0.014, 3.2, 12.0):
        assert turned(degrees) == {"a-c", "b-c"}
    assert turned(30.0) == set()


def test_what_a_support_drives_can_move():
    driven = {"ram": {"node": "b", "motion": {"x": {"table": {"time": (0.0, 0.1), "value": (0.0, 0.1)}}}}}
    assert not braced(frame(FLAT, "a-b b-c c-d", "a d", supports=driven, initial_velocity=()))


def test_the_sparse_equations_have_the_same_answer(monkeypatch):
    cases = [
        (FLAT, "a-b b-c c-d a-c b-e e-f f-c", "a d"),
        (TRIPOD, "a-t b-t c-t t-h", "a b c"),
        (POSTS, ROPS, ""),
    ]
    full = [braced(frame(*case)) for case in cases]
    monkeypatch.setattr(framework, "DENSE", 0)
    assert [braced(frame(*case)) for case in cases] == full
    assert any(full)


@pytest.mark.parametrize("elastic", [None, 4])
@pytest.mark.parametrize(("asked", "lengthen"), [("auto", True), ({"axial": False}, False)])
def test_automatic_hinges_of_braced_members_lengthen_unless_the_input_says_no(elastic, asked, lengthen):
    bars = "a-t b-t c-t"
    own = {bar: {"elastic": elastic} for bar in bars.split() if elastic}
    hinges = plastic_hinges(frame(TRIPOD, bars, "a b c", own=own, hinges=asked))
    found = ["AXIAL" in [c.freedom.name for c in h.spatial.components] for h in hinges if h.spatial]
    assert found
    assert all(one is lengthen for one in found)


def places(whole, member):
    return {h.name: h.station for h in plastic_hinges(whole) if h.member == member}


def test_a_braced_member_can_buckle_in_its_middle():
    whole = frame(TRIPOD, "a-t b-t c-t", "a b c")
    first, middle, last = places(whole, "a-t").values()
    assert middle == pytest.approx((first + last) / 2.0)
    swaying = frame(FLAT, "a-b b-c c-d", "a d")
    assert list(places(swaying, "a-b")) == ["a-b-a", "corner-b"]
    # candidates that the input asks for in between do as well
    asked = frame(TRIPOD, "a-t b-t c-t", "a b c", hinges={"spacing": 0.25})
    assert list(places(asked, "a-t")) == ["a-t-a", "a-t-1", "a-t-2", "a-t-t"]


def test_braced_members_fold_as_columns_where_there_is_a_law():
    def force(section, **parts):
        whole = frame(TRIPOD, "a-t b-t c-t", "a b c", sections={"tube": section}, **parts)
        first = next(h for h in plastic_hinges(whole) if h.member == "a-t")
        (slip,) = (c.record for c in first.spatial.components if c.freedom.name == "AXIAL")
        return slip.negative.moment

    square = {"type": "square_tube", "side": 0.05, "thickness": 0.002}
    for section in (square, {"type": "circular_tube", "diameter": 0.05, "thickness": 0.002}):
        assert force(section).min() < 0.7 * force(section)[0]
    hat = {"type": "channel", "width": 0.05, "depth": 0.04, "thickness": 0.002}
    assert np.ptp(force(hat)) == 0.0
    # what the input says is kept
    assert np.ptp(force(square, hinges={"axes": ("y", "z"), "axial": True})) == 0.0


def test_a_strut_between_balls_buckles_too():
    balls = {f"j{n}": {"node": n, "member": "a-c", "type": "spherical"} for n in "ac"}
    assert list(places(frame(FLAT, "a-b b-c c-d a-c", "a d", joints=balls), "a-c")) == ["a-c-1"]
