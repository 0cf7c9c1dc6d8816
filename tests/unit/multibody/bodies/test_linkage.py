"""From structures to bodies and connections in space, and what of them can move."""

import numpy as np
import pytest
from tests.support.multibody.frames import CLAMP, LAW, member, structure

from crumple.analysis import load
from crumple.errors import InputError
from crumple.multibody import Run, infinitesimal, link, notes, solve_multibody
from crumple.multibody.bodies.linkage import GROUND, check_inertia
from crumple.multibody.bodies.mobility import free_parts, mobility
from crumple.structure import MultibodySettings

SQUARE = {"a": (0, 0, 0), "b": (0, 0, 1), "c": (1, 0, 1), "d": (1, 0, 0)}
BOTH = CLAMP | {"other": {"node": "d", "fix": "all"}}


def bar(first, second, *hinges, **keys):
    return member(first, second, *hinges, up=(1.0, 0.0, 0.0) if first in "ac" else (0.0, 0.0, 1.0), **keys)


def portal(**parts):
    members = {
        "ab": bar("a", "b", ("foot", 0.1), ("knee", 0.9)),
        "bc": bar("b", "c"),
        "cd": bar("c", "d", ("other_knee", 0.1), ("other_foot", 0.9)),
    }
    return structure(SQUARE, members, **({"supports": BOTH} | parts))


def test_bodies_and_connections_of_a_portal():
    whole = portal()
    linkage = link(whole)
    assert [c.name for c in linkage.connections] == ["foot", "knee", "other_knee", "other_foot"]
    # each leads on from where the one before it led, from ground to ground
    chain = [GROUND, *(c.second for c in linkage.connections)]
    assert [c.first for c in linkage.connections] == chain[:-1]
    assert sorted(chain) == [GROUND, GROUND, 0, 1, 2]
    total = sum(body.mass for body in linkage.bodies) + sum(m.mass for m in linkage.part_mass.values())
    section = whole.section_of("ab")
    assert total == pytest.approx(3.0 * section.mass_per_length(7850.0))
    for connection in linkage.connections:
        hinge = connection.hinge
        np.testing.assert_allclose(connection.axes["xyz".index(hinge.axis)], hinge.direction)
        np.testing.assert_allclose(connection.axes @ connection.axes.T, np.eye(3), atol=1e-15)


def test_a_portal_moves_one_way_and_is_held_thrice_across():
    linkage = link(portal())
    free = mobility(linkage)
    assert (free.motions, free.redundant, free.stuck) == (1, 3, ())
    assert mobility(linkage, locked=True).motions == 0
    assert free_parts(linkage) == ()
    # across the plane nothing acts: nothing is to be said
    assert free.across == 3
    assert notes(linkage) == ()


def test_a_loop_in_space_that_is_held_too_often_is_named():
    """Its knee turns about the leg: six equations of which four are independent for four axes."""
    members = {
        "ab": bar("a", "b", ("foot", 0.1)),
        "bc": bar("b", "c"),
        "cd": bar("c", "d", ("other_knee", 0.1), ("other_foot", 0.9)),
    }
    knee = {"k": {"node": "b", "member": "ab", "type": "revolute", "axis": (0.0, 0.0, 1.0)}}
    linkage = link(structure(SQUARE, members, supports=BOTH, joints=knee))
    free = mobility(linkage)
    assert (free.redundant, free.across) == (2, 0)
    (note,) = (note for note in notes(linkage) if "redundant" in note)
    assert note.startswith("Closed loops through foot, other_knee, other_foot, k are held more often")
    assert "2 redundant constraints" in note


def test_constraints_that_no_hinge_is_part_of_are_told_without_names():
    """Its driven corner closes loops of supports alone."""
    structure = load("examples/14_rops.yaml").structure
    (note,) = notes(link(structure))
    assert note.startswith("Parts between supports are held more often than it takes (3 redundant constr")


def test_pinned_feet_let_a_portal_swing_sideways():
    pins = {name: {"node": node, "fix": "pin"} for name, node in (("p", "a"), ("q", "d"))}
    (note,) = free_parts(link(portal(supports=pins)))
    assert note == (
        "The supports and joints leave one way to move without rotation of any hinge (members ab, bc, cd)."
    )


def test_what_nothing_holds_floats():
    assert free_parts(link(portal(supports={}))) == (
        "The structure has no supports: it moves freely in space.",
    )


def test_hinges_in_a_stiff_triangle_cannot_turn():
    nodes = {"a": (0, 0, 0), "b": (1, 0, 0), "c": (0.5, 0, 1)}
    members = {
        "ab": member("a", "b", ("h", 0.5)),
        "bc": member("b", "c", ("i", 0.5)),
        "ca": member("c", "a", ("j", 0.5)),
    }
    linkage = link(structure(nodes, members, supports={}))
    free = mobility(linkage)
    # three hinges in one plane loop: 3 equations in the plane for 3 rates, 3 across twice held
    assert (free.motions, free.redundant) == (6, 3)
    assert {linkage.connections[i].name for i in free.stuck} == {"h", "i", "j"}
    assert any("cannot move at the start" in note for note in notes(linkage))


def test_bricards_six_bars_move_though_counted_rigid():
    # six revolute joints along the edges of a cube, axes alternating: Bricard's orthogonal case
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (1, 1, 1), (0, 1, 1), (0, 0, 1)]
    nodes = {f"n{i}": corner for i, corner in enumerate(corners)}
    axes = [(0, 1, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 0)]
    members = {f"m{i}": member(f"n{i}", f"n{(i + 1) % 6}") for i in range(6)}
    joints = {
        f"j{i}": {"node": f"n{i}", "member": f"m{i}", "type": "revolute", "axis": axes[i]} for i in range(6)
    }
    linkage = link(structure(nodes, members, supports={}, joints=joints))
    free = mobility(linkage)
    assert len(linkage.bodies) == 6
    assert free.motions == 6 + 1
    assert free.redundant == 1
    # held at a bar it moves on: no infinitesimal mechanism
    clamp = {"clamp": {"node": "n0", "fix": "all"}}
    held = link(structure(nodes, members, supports=clamp, joints=joints))
    assert mobility(held).motions == 1
    assert infinitesimal(held) == ""


def test_supports_that_hold_in_part_are_connections_with_the_ground():
    roller = {"roller": {"node": "b", "fix": ("z", "ry")}}
    linkage = link(structure(supports=CLAMP | roller))
    (support,) = [c for c in linkage.connections if c.kind == "support"]
    assert (support.first, support.second, support.free) == (GROUND, 0, (0, 1, 3, 5))


def test_driven_freedoms_are_held():
    driven = {"ram": {"node": "b", "motion": {"z": {"table": {"time": (0.0, 1.0), "value": (0.0, 0.1)}}}}}
    linkage = link(structure(supports=CLAMP | driven))
    (support,) = [c for c in linkage.connections if c.kind == "support"]
    assert support.held == (False, False, True, False, False, False)


def test_two_supports_that_hold_all_between_them_clamp():
    halves = {
        "u": {"node": "a", "fix": "pin"},
        "v": {"node": "a", "fix": ("rx", "ry", "rz")},
    }
    linkage = link(structure(supports=halves))
    assert linkage.node_body["a"] == GROUND
    assert [c.kind for c in linkage.connections] == ["hinge"]


def test_a_joint_between_parts_that_are_one_is_refused():
    # the square closes rigidly around the joint
    members = {name: bar(*name) for name in ("ab", "bc", "cd")} | {"da": member("d", "a")}
    joint = {"j": {"node": "a", "member": "ab", "type": "spherical"}}
    whole = structure(SQUARE, members, supports={}, joints=joint)
    with pytest.raises(InputError, match="both sides of this joint are fixed or rigidly connected elsewhere"):
        link(whole)


def test_a_body_that_nothing_resists_turning_is_refused():
    members = {"bar": member("a", "b", ("h", "b", {"offset": 0.0, "law": LAW}))}
    rolling = CLAMP | {"roller": {"node": "b", "fix": ("y", "z", "rx", "ry", "rz")}}
    linkage = link(structure(members=members, supports=rolling))
    with pytest.raises(InputError, match="the body between 1000 mm and 1000 mm of member bar has no inertia"):
        check_inertia(linkage)


@pytest.mark.parametrize("kernel", ["tree", "spatial"])
def test_a_hinge_between_two_clamps_is_refused(kernel):
    nodes = {"a": (0.0, 0.0, 0.0), "b": (1.0, 0.0, 0.0), "c": (1.0, 0.0, 1.0)}
    members = {"held": member("a", "b", ("between", 0.5)), "post": member("b", "c", ("foot", 0.1))}
    supports = CLAMP | {"other": {"node": "b", "fix": "all"}}
    thrown = [{"rotation": 5.0, "axis": (0.0, 1.0, 0.0), "about": nodes["b"], "members": ["post"]}]
    whole = structure(nodes, members, supports=supports, initial_velocity=thrown)
    with pytest.raises(InputError, match="hinge between of member held"):
        solve_multibody(whole, Run(0.05, 0.01, MultibodySettings(kernel=kernel)))
