"""Design of the library of tubes: the shipped tables contain its points, and no held-out tube is fitted."""

import pytest
from tools.law_clamped import design, fold_rotation
from tools.law_design import COARSE, LEAST_HARDENED, NOMINAL, TRAINING, points
from tools.law_library import HELD_OUT, NOMINAL_ROLES, PLACE, ROLES

from crumple.hinge.tube_library.clamped import TABLES
from crumple.hinge.tube_library.table import tube_table

KINDS = tuple(TRAINING)


def entries(kind, roles):
    """Points of a shipped table by name."""
    return {one["name"]: one for one in tube_table(kind).facts["points"] if one["role"] in roles}


@pytest.mark.parametrize("kind", KINDS)
def test_the_shipped_points_are_those_of_the_design(kind):
    designed = {one.name: one for one in points() if one.kind == kind}
    for name, entry in entries(kind, (*ROLES, *HELD_OUT)).items():
        assert {key: getattr(designed[name], key) for key in PLACE} == {key: entry[key] for key in PLACE}
    nominal = {name for name, one in designed.items() if one.elements == NOMINAL}
    assert nominal == entries(kind, (*NOMINAL_ROLES, *HELD_OUT)).keys()


@pytest.mark.parametrize("kind", KINDS)
def test_no_held_out_tube_is_fitted(kind):
    held_out, fitted = entries(kind, HELD_OUT), entries(kind, ROLES)
    assert len(tube_table(kind).centres) == len(fitted)
    places = [{tuple(one[key] for key in PLACE) for one in each.values()} for each in (held_out, fitted)]
    assert places[0]
    assert not places[0] & places[1]
    assert not any("left_out" in one for one in held_out.values())


@pytest.mark.parametrize("kind", KINDS)
def test_the_clamped_tubes_of_the_table_are_those_of_its_design(kind):
    table = tube_table(TABLES[kind])
    designed = {one.name: one for one in design(kind)}
    assert {one["name"] for one in table.facts["points"]} <= designed.keys()
    for entry in table.facts["points"]:
        point = designed[entry["name"]]
        assert {key: getattr(point, key) for key in PLACE} == {key: entry[key] for key in PLACE}
    assert len(table.centres) == sum(one["role"] not in HELD_OUT for one in table.facts["points"])
    held_out = {one.name for one in designed.values() if one.role in HELD_OUT}
    assert held_out == {one["name"] for one in table.facts["points"] if one["role"] in HELD_OUT}


def test_hardened_round_tubes_have_their_hardening_on_the_nominal_mesh():
    hardened = [one for one in points() if one.role == "hardened"]
    assert {one.kind for one in hardened} == {"circular_tube"}
    assert all(one.hardening >= LEAST_HARDENED and one.elements == NOMINAL for one in hardened)


def test_strong_points_reach_beyond_the_others():
    strong = [one for one in points() if one.role == "strong"]
    others = [one for one in points() if one.role not in {"strong", "held-out"}]
    assert {one.kind for one in strong} == set(KINDS)
    assert all(one.elements == COARSE and 1.7 <= one.hardening <= 2.4 for one in strong)
    assert max(one.hardening for one in others) <= 1.8
    assert min(one.slenderness for one in strong) < 12.1 < 15.0 <= min(one.slenderness for one in others)


def test_from_its_largest_moment_on_a_cantilever_folds_by_as_much_as_its_tip_turns():
    """Before, the gauge beside the clamp turns by less than the tip: the member yields beyond it, too."""
    own = {
        "fold": [0.0, 0.01, 0.02, 0.021, 0.022],
        "tip": [0.0, 0.02, 0.05, 0.15, 0.25],
        "moment": [0.9, 1.0, 1.2, 0.8, 0.5],
    }
    assert fold_rotation(own).tolist() == pytest.approx([0.0, 0.01, 0.02, 0.12, 0.22])
