"""Capsules of members that touch obstacles."""

import numpy as np
import pytest
from tests.support.multibody.frames import member, structure

from crumple.multibody.bodies.capsules import end_corners, member_capsules
from crumple.multibody.bodies.linkage import link


@pytest.mark.parametrize("segments", [None, 4, 32])
def test_capsules_of_a_free_member_end_at_its_ends_however_it_is_cut(segments):
    keys = {} if segments is None else {"elastic": segments}
    nodes = {"a": (0.0, 0.0, 0.0), "b": (0.2, 0.0, 0.0)}
    whole = structure(nodes=nodes, members={"ab": member("a", "b", ("h", 0.1), **keys)}, supports={})
    frame = whole.frame_of("ab")
    capsules, owner = member_capsules(whole, link(whole).pieces)
    along = np.array(
        [[(end - frame.origin) @ frame.axes[0] for end in (c.first, c.second)] for c in capsules]
    )
    radius = capsules[0].radius
    assert set(owner) == {"ab"}
    assert along.min() == pytest.approx(1.001 * radius)
    assert along.max() == pytest.approx(frame.length - 1.001 * radius)
    assert np.all(np.diff(along, axis=1) >= 0.0)
    rows = 2  # beside each other in a flat section
    assert np.sum(np.diff(along, axis=1)) == pytest.approx(rows * (frame.length - 2.002 * radius))


CORNER = {"a": (0.0, 0.0, 0.0), "b": (0.3, 0.0, 0.0), "c": (0.3, 0.0, 0.3)}


def at_corner(**parts):
    """Tips of a mitred corner at b, by body, in a structure of two members of a square tube."""
    square = {"type": "square_tube", "side": 0.05, "thickness": 0.002}
    members = {"ab": member("a", "b", *parts.pop("hinges", ())), "bc": member("b", "c")}
    whole = structure(nodes=CORNER, members=members, sections={"tube": square}, supports={}, **parts)
    found = {}
    for ball, of, _ in end_corners(whole, link(whole).pieces):
        place = ball.first - np.array(CORNER["b"])
        if np.linalg.norm(place) < 0.1:
            found.setdefault(ball.body, []).append((place, of))
    return found


def test_members_that_move_as_one_share_the_tips_of_their_mitre():
    (tips,) = at_corner().values()
    assert [of for _, of in tips] == [{"ab", "bc"}] * 2
    inner = 0.025 * (1.0 - 1e-3)
    for place, side in zip(
        sorted((place for place, _ in tips), key=lambda x: x[1]), (-1.0, 1.0), strict=True
    ):
        assert place == pytest.approx([inner, side * inner, -inner])


@pytest.mark.parametrize("at", ["b", 0.28])
def test_every_half_of_a_mitre_moves_with_its_own_member(at):
    found = at_corner(hinges=[("h", at)])
    owners = sorted(sorted(name for _, of in tips for name in of) for tips in found.values())
    # the hinge within the first member leaves the whole mitre on one body
    assert owners == ([["ab", "ab"], ["bc", "bc"]] if at == "b" else [["ab", "ab", "bc", "bc"]])


SQUARE = {"type": "square_tube", "side": 0.05, "thickness": 0.002}
ROUND = {"type": "circular_tube", "diameter": 0.05, "thickness": 0.002}


def tips_of_three(directions, section=SQUARE, normal=(1.0, 1.0, 1.0)):
    """Tips at the origin of three members that lead away from it, before a plane."""
    nodes = {"o": (0.0, 0.0, 0.0)} | {f"n{i}": direction for i, direction in enumerate(directions)}
    members = {f"m{i}": member("o", f"n{i}") for i in range(3)}
    wall = {"wall": {"type": "plane", "point": (-1.0, -1.0, -1.0), "normal": normal}}
    whole = structure(nodes=nodes, members=members, sections={"tube": section}, supports={}, obstacles=wall)
    found = end_corners(whole, link(whole).pieces)
    return [(ball.first, of) for ball, of, node in found if node is None]


def test_three_square_tubes_make_the_corner_of_a_cube():
    axes = [(0.3, 0.0, 0.0), (0.0, 0.3, 0.0), (0.0, 0.0, 0.3)]
    ((place, owners),) = tips_of_three(axes)
    assert place == pytest.approx(np.full(3, -0.025 * (1.0 - 1e-3)))
    assert owners == {"m0", "m1", "m2"}
    # a plane along a face meets the capsules as early
    assert tips_of_three(axes, normal=(1.0, 0.0, 0.0)) == []
    # round tubes meet in edges that are nearly flat, which points do not describe
    assert tips_of_three(axes, ROUND) == []


def test_a_branch_at_right_angles_has_no_tips():
    assert tips_of_three([(0.3, 0.0, 0.0), (-0.3, 0.0, 0.0), (0.0, 0.0, 0.3)]) == []


def test_members_with_a_joint_at_their_node_have_no_tips():
    pin = {"pin": {"type": "revolute", "node": "b", "member": "ab", "axis": (0.0, 1.0, 0.0)}}
    assert not at_corner(joints=pin)


def test_tips_of_mirror_images_are_mirror_images():
    """Lips of a hat end nearly in the mitre plane: which of their corners were used was left to rounding."""
    hat = {"type": "closed_hat", "width": 0.05, "depth": 0.05, "flange": 0.015, "thickness": 0.0015}
    nodes = {"a": (0.0, -0.35, 0.0), "b": (0.0, 0.35, 0.0), "c": (0.55, -0.3, 0.06), "d": (0.55, 0.3, 0.06)}
    members = {"ab": member("a", "b")} | {
        first + second: member(first, second, section="hat") for first, second in ("ac", "bd")
    }
    sections = {"tube": {"type": "rectangular_tube", "width": 0.05, "depth": 0.04, "thickness": 0.002}}
    whole = structure(nodes=nodes, members=members, sections=sections | {"hat": hat}, supports={})
    places = np.array(
        [ball.first for ball, _, free in end_corners(whole, link(whole).pieces) if free is None]
    )
    left, right = (places[side * places[:, 1] > 0.0] for side in (-1.0, 1.0))
    assert len(left) > 3
    apart = np.linalg.norm(left[:, None] * [1.0, -1.0, 1.0] - right, axis=2)
    assert apart.min(axis=1).max() < 1e-12
    assert apart.min(axis=0).max() < 1e-12
