"""From a structure to bodies and joints: cuts, welds, supports, order, refusals."""

import numpy as np
import pytest
from tests.support.multibody.frames import CLAMP, THROWN, X_LINE, member, structure

from crumple.errors import InputError
from crumple.multibody import lower
from crumple.multibody.answer.poses import piece_at
from crumple.multibody.bodies.linkage import GROUND
from crumple.section import RectangularTube, fold_distance

ABOUT_Y = {"axis": "y"}
T_NODES = {"a": (0.0, 0.0, 0.0), "b": (1.0, 0.0, 0.0), "c": (1.0, 0.0, 0.5), "d": (2.0, 0.0, 0.0)}


def test_hinge_at_a_clamp_lies_where_its_fold_turns():
    mechanism = lower(structure())
    inside = fold_distance(RectangularTube(0.050, 0.025, 0.00265), "y")
    (link,) = mechanism.links
    np.testing.assert_allclose(link.position, (inside, 0.0, 0.0))
    assert [(p.start, p.end, p.body) for p in mechanism.pieces["bar"]] == [
        (0.0, inside, GROUND),
        (inside, 1.0, 0),
    ]
    assert mechanism.node_body == {"a": GROUND, "b": 0}


def test_hinge_at_the_second_node_lies_inside_from_there():
    supports = {"clamp": {"node": "b", "fix": "all"}}
    (link,) = lower(structure(members={"bar": member("a", "b", ("h", "b"))}, supports=supports)).links
    assert 0.98 < link.position[0] < 0.99


def test_bars_cut_a_member_evenly():
    mechanism = lower(structure(members={"bar": member("a", "b", ("h", 0.1), bars={"number": 4})}))
    assert [link.hinge.name for link in mechanism.links] == ["h", "bar-1", "bar-2", "bar-3"]
    np.testing.assert_allclose([p.end for p in mechanism.pieces["bar"]], (0.1, 0.25, 0.5, 0.75, 1.0))
    assert [link.parent for link in mechanism.links] == [GROUND, 0, 1, 2]


def test_members_are_welded_at_nodes():
    """A tee: all that meets at b moves as one body, with the lump at c."""
    members = {"ab": member("a", "b", ("h", 0.4)), "bc": member("b", "c"), "bd": member("b", "d", ("k", 0.3))}
    masses = {"m": {"node": "c", "mass": 2.0}}
    mechanism = lower(structure(T_NODES, members, masses=masses))
    assert len(mechanism.bodies) == 2
    assert mechanism.node_body == {"a": GROUND, "b": 0, "c": 0, "d": 1}
    line = 7850.0 * (0.050 * 0.025 - 0.0447 * 0.0197)
    assert mechanism.bodies[0].mass == pytest.approx(line * (0.6 + 0.5 + 0.3) + 2.0)
    assert mechanism.bodies[1].mass == pytest.approx(line * 0.7)
    assert piece_at(mechanism.pieces, "ab", 0.2).body == GROUND
    assert piece_at(mechanism.pieces, "ab", 0.9).body == 0


@pytest.mark.parametrize(
    ("nodes", "place", "clamped", "sign"),
    [
        (("a", "b"), 0.3, "a", 1.0),
        (("a", "b"), 0.3, "b", -1.0),
        (("b", "a"), 0.3, "a", 1.0),
        (("b", "a"), 0.3, "b", -1.0),
    ],
)
def test_sign_is_that_of_the_joint_rotation_against_the_hinge(nodes, place, clamped, sign):
    """The joint is child against parent about +y; the hinge second side against first about local y.

    With the nodes exchanged local y points along -y and the sides are exchanged too.
    """
    members = {"bar": member(*nodes, ("h", place))}
    (link,) = lower(structure(members=members, supports={"clamp": {"node": clamped, "fix": "all"}})).links
    assert link.sign == sign


def test_pinned_part_turns_about_its_pin():
    supports = {"pin": {"node": "a", "fix": "pin"}}
    mechanism = lower(structure(members={"bar": member("a", "b", ("h", 0.5))}, supports=supports))
    assert [link.hinge and link.hinge.name for link in mechanism.links] == [None, "h"]
    np.testing.assert_allclose(mechanism.links[0].position, (0.0, 0.0, 0.0))
    assert not mechanism.links[0].free


def test_floating_part_starts_from_its_heaviest_body():
    members = {"bar": member("a", "b", ("h", 0.8))}
    mechanism = lower(structure(members=members, supports={}, initial_velocity=THROWN))
    assert [link.free for link in mechanism.links] == [True, False]
    np.testing.assert_allclose(mechanism.links[0].position, (0.4, 0.0, 0.0), atol=1e-12)
    assert [(p.end, p.body) for p in mechanism.pieces["bar"]] == [(0.8, 0), (1.0, 1)]


def test_plane_follows_the_hinges_axes():
    mechanism = lower(structure())
    np.testing.assert_allclose(np.abs(mechanism.plane.normal), (0.0, 1.0, 0.0))
    upright = lower(structure(members={"bar": member("a", "b", ("h", "a"), roll=np.pi / 2)}))
    np.testing.assert_allclose(np.abs(upright.plane.normal), (0.0, 0.0, 1.0), atol=1e-12)


def test_plane_basis_is_right_handed_and_orthonormal():
    nodes = {"a": (0.0, 0.0, 0.0), "b": (1.0, 2.0, -0.7)}
    plane = lower(structure(nodes)).plane
    basis = np.array([plane.first, plane.second, plane.normal])
    np.testing.assert_allclose(basis @ basis.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(basis) == pytest.approx(1.0)
    vector = np.array([0.3, -0.4])
    np.testing.assert_allclose(plane.flat(plane.raised(vector)), vector)


def refused(text, *args, **keys):
    with pytest.raises(InputError, match=text):
        lower(structure(*args, **keys))


def triangle(**keys):
    members = {
        "ab": member("a", "b", ("h", 0.4), bars={"number": 2}),
        "bc": member("b", "c", ("k", 0.2), up=(1.0, 0.0, 0.0)),
        "ca": member("c", "a", ("l", 0.3)),
    }
    return structure({name: T_NODES[name] for name in "abc"}, members, **keys)


def test_body_that_closes_a_loop_is_cut_in_equal_parts():
    """Four hinges and the ground: three bodies in a ring, of which one hangs on two joints and is welded."""
    mechanism = lower(triangle())
    assert len(mechanism.links) == 4
    ((part, whole),) = mechanism.welds
    assert mechanism.parts_of(whole) == 2
    assert mechanism.bodies[part].mass == pytest.approx(mechanism.bodies[whole].mass)
    line = 7850.0 * (0.050 * 0.025 - 0.0447 * 0.0197)
    held = min(piece.end - piece.start for piece in mechanism.pieces["ab"] if piece.body == GROUND)
    held += sum(piece.end - piece.start for piece in mechanism.pieces["ca"] if piece.body == GROUND)
    moving = line * (1.0 + 0.5 + np.hypot(1.0, 0.5) - held)
    assert sum(body.mass for body in mechanism.bodies) == pytest.approx(moving)


def test_hinge_between_rigidly_joined_sides_is_refused():
    supports = {"one": {"node": "a", "fix": "all"}, "two": {"node": "b", "fix": "all"}}
    refused("cannot rotate", members={"bar": member("a", "b", ("h", 0.4))}, supports=supports)


def test_pin_of_a_clamped_part_is_no_joint():
    """A second support closes a loop; its pin stays a constraint."""
    supports = CLAMP | {"pin": {"node": "b", "fix": "pin"}}
    mechanism = lower(structure(members={"bar": member("a", "b", ("h", 0.4), ("k", 0.7))}, supports=supports))
    assert mechanism.pin_joints == frozenset()
    assert len(mechanism.links) == 2


def test_axes_that_are_not_parallel_are_refused():
    nodes = {"a": (0.0, 0.0, 0.0), "b": (1.0, 0.0, 0.0), "c": (1.0, 1.0, 0.0)}
    members = {"ab": member("a", "b", ("h", 0.4, ABOUT_Y)), "bc": member("b", "c", ("k", 0.4, ABOUT_Y))}
    refused("different axes", nodes, members)


def test_body_without_inertia_is_refused():
    """A hinge at the free end is refused when the structure is made."""
    with pytest.raises(InputError, match="zero inertia"):
        structure(X_LINE, {"bar": member("a", "b", ("h", "b"))})


def test_lump_on_the_axis_of_a_pin_is_refused():
    """A pinned node with a point mass alone has no inertia about the pin's axis."""
    nodes = X_LINE | {"p": (0.0, 0.0, 1.0)}
    supports = {"pin": {"node": "p", "fix": "pin"}} | CLAMP
    with pytest.raises(InputError):
        lower(structure(nodes, supports=supports, masses={"m": {"node": "p", "mass": 1.0}}))


def test_a_massless_node_between_a_pin_and_a_hinge_is_refused_by_its_place():
    nodes = X_LINE | {"c": (0.0, 0.0, 1.0)}
    ends = {end: member("a", end, (f"h{end}", "a", {"offset": 0.0})) for end in "bc"}
    with pytest.raises(InputError, match=r"held by the pin at \(0, 0, 0\) m has no inertia") as refusal:
        lower(structure(nodes, ends, supports={"pin": {"node": "a", "fix": "pin"}}))
    assert refusal.value.problems[0].where == "supports"
