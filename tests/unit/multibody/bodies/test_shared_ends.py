"""Ends of capsules at one place: which of them an obstacle meets."""

import math
from collections import Counter

import numpy as np
import pytest
from tests.support.multibody.frames import member, structure

from crumple.multibody.bodies.capsules import member_capsules, row_shifts
from crumple.multibody.bodies.linkage import link
from crumple.multibody.bodies.shared_ends import (
    BOTH,
    FIRST,
    SECOND,
    bodies_together,
    covered_by_folds,
    ends_met,
)

SQUARE = {"type": "square_tube", "side": 0.05, "thickness": 0.002}
THIN = {"type": "square_tube", "side": 0.03, "thickness": 0.002}
LINE = {"a": (0.0, 0.0, 0.0), "b": (0.5, 0.0, 0.0), "c": (0.5, 0.5, 0.0)}


def met(whole, touching=None, *, plane=True, normal=None):
    """How often an obstacle meets every place [mm], and the capsules with the ends it meets.

    `normal`: of a plane towards which members may fold.
    """
    linkage = link(whole)
    capsules, owners = member_capsules(whole, linkage.pieces)
    covered = () if normal is None else covered_by_folds(whole, linkage, capsules, owners, np.array(normal))
    chosen = tuple(range(len(capsules))) if touching is None else touching
    rows = {name: row_shifts(whole, name) for name in whole.members}
    ends = ends_met(bodies_together(linkage, rows, folding=plane), capsules, chosen, covered)
    places = Counter()
    for index, of in zip(chosen, ends, strict=True):
        for side, place in ((FIRST, capsules[index].first), (SECOND, capsules[index].second)):
            if of & side:
                places[tuple(np.rint(1e3 * place).astype(int).tolist())] += 1
    return places, capsules, ends


def frame(section=SQUARE, other=None, hinges=(("h", 0.2),), **parts):
    members = {"ab": member("a", "b", *hinges), "bc": member("b", "c", section="other")}
    sections = {"tube": section, "other": other or section}
    return structure(nodes=LINE, members=members, sections=sections, supports={}, **parts)


def test_pieces_on_both_sides_of_a_hinge_and_members_at_a_node_are_met_once():
    places, capsules, _ = met(frame())
    assert len(capsules) == 3
    assert places == {(25, 0, 0): 1, (200, 0, 0): 1, (500, 0, 0): 1, (500, 475, 0): 1}


def test_the_largest_ball_counts():
    _, capsules, ends = met(frame(other=THIN))
    thin = next(k for k, capsule in enumerate(capsules) if capsule.radius == pytest.approx(0.015))
    assert ends[thin] == SECOND
    _, capsules, ends = met(frame(section=THIN, other=SQUARE))
    assert [ends[k] for k, capsule in enumerate(capsules) if capsule.radius == pytest.approx(0.025)] == [BOTH]


def test_capsules_that_an_obstacle_does_not_touch_take_no_end_away():
    whole = frame()
    _, capsules, _ = met(whole)
    for k in range(len(capsules)):
        _, _, ends = met(whole, (k,))
        assert ends == (BOTH,)


def test_capsules_beside_the_axis_part_when_the_hinge_turns():
    """Rows of a flat section have ends at the same places, but only a rotation along the row keeps them."""
    flat = {"type": "rectangular_tube", "width": 0.06, "depth": 0.03, "thickness": 0.002}
    places, _, _ = met(frame(section=flat))
    at_hinge = [count for (x, _, _), count in places.items() if x == 200]
    assert at_hinge == [2, 2]


def test_capsules_beside_the_axis_are_met_once_at_an_elastic_joint():
    flat = {"type": "rectangular_tube", "width": 0.06, "depth": 0.03, "thickness": 0.002}
    members = {"ab": member("a", "b", ("h", 0.2), elastic=4), "bc": member("b", "c", section="other")}
    sections = {"tube": flat, "other": SQUARE}
    places, capsules, _ = met(structure(nodes=LINE, members=members, sections=sections, supports={}))
    rows = [(x, count) for (x, y, _), count in places.items() if abs(y) == 15 and 0 < x < 500]
    assert len(capsules) == 2 * 6 + 1
    hinges = (200, 465)
    assert sorted(rows) == sorted((x, 1 + (x in hinges)) for x in {x for x, _ in rows} for _ in range(2))


@pytest.mark.parametrize(
    ("joint", "count"), [({"type": "spherical"}, 1), ({"type": "prismatic", "axis": (1, 0, 0)}, 2)]
)
def test_a_joint_that_slides_has_two_ends(joint, count):
    whole = frame(hinges=(), joints={"j": {"node": "b", "member": "bc", **joint}})
    places, _, _ = met(whole)
    assert places[(500, 0, 0)] == count


@pytest.mark.parametrize(("at", "plane", "count"), [(0.2, True, 1), (0.2, False, 2), (0.5, True, 2)])
def test_pieces_beside_a_fold_part_but_a_plane_meets_one(at, plane, count):
    """Within a member what one piece leaves the other covers; at a node the other member stays behind."""
    whole = frame(hinges=(("h", at, {"axes": ("y", "z"), "axial": True}),))
    places, _, _ = met(whole, plane=plane)
    assert places[(round(1e3 * at), 0, 0)] == count


def test_a_plane_meets_no_cut_within_a_member_that_folds_towards_it():
    """The walls fold in front of the cuts of an elastic member, and what is behind it stops the plane."""

    def places(normal, **hinge):
        bar = member("a", "b", ("h", 0.2, hinge), elastic=4)
        members = {"ab": bar, "bc": member("b", "c", section="other")}
        sections = {"tube": SQUARE, "other": SQUARE}
        whole = structure(nodes=LINE, members=members, sections=sections, supports={})
        return {x for x, y, _ in met(whole, normal=normal)[0] if y == 0}

    folds = {"axes": ("y", "z"), "axial": True}
    beside = places((0.0, 0.0, 1.0), **folds)
    assert {25, 200, 500} < beside
    assert places((-1.0, 0.0, 0.0), **folds) == {25, 500}
    assert places((-0.9, 0.0, math.sqrt(0.19)), **folds) == {25, 500}
    assert places((-0.8, 0.0, 0.6), **folds) == beside
    # one that keeps its length is met at its cuts
    assert places((-1.0, 0.0, 0.0)) == places((0.0, 0.0, 1.0))


@pytest.mark.parametrize("hinge", [0.2, 0.35])
def test_the_end_of_the_longer_piece_is_met_whichever_end_of_the_member_is_named_first(hinge):
    line = {"a": (0.0, 0.0, 0.0), "b": (0.5, 0.0, 0.0)}
    for ab in (member("a", "b", ("h", hinge)), member("b", "a", ("h", 0.5 - hinge))):
        whole = structure(nodes=line, members={"ab": ab}, sections={"tube": SQUARE}, supports={})
        _, capsules, ends = met(whole)
        lengths = [np.linalg.norm(capsule.second - capsule.first) for capsule in capsules]
        shorter, longer = np.argsort(lengths)
        assert ends[longer] == BOTH
        assert ends[shorter] in (FIRST, SECOND)
