"""Where members that are thrown strike others, and the candidates there."""

import numpy as np
import pytest

from crumple.structure import Structure, placed_hinges
from crumple.structure.struck_members import places_struck_by_members

STEEL = {"youngs_modulus": 210e9, "poissons_ratio": 0.3, "density": 7850.0, "yield_stress": 300e6}
TUBES = {
    "low": {"type": "square_tube", "side": 0.04, "thickness": 0.002},
    "high": {"type": "rectangular_tube", "width": 0.03, "depth": 0.06, "thickness": 0.003},
}
DOWN = ({"translation": (0.0, 0.0, -5.0), "members": ("beam",)},)


def crossing(nodes=None, fields=DOWN, ends=("c", "d"), **changed):
    """A beam along y, 0.3 m above a bar along x, 0.3 m from its first node."""
    places = {
        "a": (0.0, 0.0, 0.0),
        "b": (1.0, 0.0, 0.0),
        "c": (0.3, -0.4, 0.3),
        "d": (0.3, 0.5, 0.3),
        **(nodes or {}),
    }
    members = {
        "bar": {"nodes": ("a", "b"), "section": "low", "material": "steel"},
        "beam": {"nodes": ends, "section": "high", "material": "steel", "up": (0.0, 0.0, 1.0)},
    }
    return Structure(
        materials={"steel": STEEL},
        nodes={name: places[name] for name in ("a", "b", *ends)},
        members=members,
        hinges="auto",
        supports={name: {"node": name, "fix": "all"} for name in ("a", "b")},
        initial_velocity=fields,
        **{"member_contact": {"friction": 0.0}, "sections": TUBES, **changed},
    )


def test_both_have_a_place_where_they_touch():
    structure = crossing()
    (bar,) = places_struck_by_members(structure, "bar")
    assert (bar.obstacle, bar.station) == ("beam", pytest.approx(0.3))
    # between the outlines: half of 40 and of 60 mm
    assert bar.travel == pytest.approx(0.25)
    np.testing.assert_allclose(bar.outwards, (0.0, 0.0, 1.0), atol=1e-12)
    (beam,) = places_struck_by_members(structure, "beam")
    assert (beam.obstacle, beam.station) == ("bar", pytest.approx(0.4))
    np.testing.assert_allclose(beam.outwards, (0.0, 0.0, -1.0), atol=1e-12)


def test_a_beam_that_flies_obliquely_meets_another_place():
    (place,) = places_struck_by_members(
        crossing(fields=({"translation": (2.0, 0.0, -5.0), "members": ("beam",)},)), "bar"
    )
    assert place.station == pytest.approx(0.3 + 0.25 * 2.0 / 5.0)


def test_only_the_difference_of_velocities_counts():
    both = (*DOWN, {"translation": (0.0, 0.0, 3.0), "members": ("bar", "beam")})
    assert places_struck_by_members(crossing(fields=both), "bar") == places_struck_by_members(
        crossing(), "bar"
    )
    away = ({"translation": (0.0, 0.0, -9.0), "members": ("bar",)}, *DOWN)
    assert not places_struck_by_members(crossing(fields=away), "bar")


def test_a_boom_that_turns_is_faster_further_from_its_pivot():
    """Turned about the y axis of its own line at x = -0.7 m: its points move along z and x, as they lie."""
    turning = ({"rotation": 10.0, "axis": (0.0, 1.0, 0.0), "about": (-0.7, 0.0, 0.3), "members": ("beam",)},)
    (place,) = places_struck_by_members(crossing(fields=turning), "bar")
    # where it touches, at x = 0.3 + d and z = 0.05, its velocity is 10 (z - 0.3, 0, -(x + 0.7)) in x and z
    apart = place.station - 0.3
    at = np.array([place.station + 0.7, -0.3])
    slope = at[1] / at[0]
    assert apart == pytest.approx(0.25 * slope, rel=1e-3)


@pytest.mark.parametrize(
    "changed",
    [
        {"fields": ()},
        {"fields": ({"translation": (0.0, 0.0, -5.0)},)},
        {"nodes": {"c": (1.2, -0.4, 0.3), "d": (1.2, 0.5, 0.3)}},
        {"nodes": {"c": (0.1, 0.0, 0.3), "d": (0.9, 0.0, 0.3)}},
        {"nodes": {"c": (0.3, 0.1, 0.3), "d": (0.3, 0.5, 0.3)}},
    ],
    ids=["at rest", "all alike", "beyond the end", "along it", "beside it"],
)
def test_no_place(changed):
    assert not places_struck_by_members(crossing(**changed), "bar")


def test_members_without_contact_and_those_with_a_common_node_strike_nothing():
    assert not places_struck_by_members(crossing(member_contact=None), "bar")
    assert not places_struck_by_members(crossing({"d": (0.3, 0.0, 0.3)}, ends=("a", "d")), "bar")


@pytest.mark.parametrize("friction", [0.0, 0.2])
def test_there_is_a_candidate_beside_which_they_rub(friction):
    hinges = {one.name: one.station for one in placed_hinges(crossing(member_contact={"friction": friction}))}
    assert "bar-beam" in hinges
    aside = abs(hinges["bar-beam"] - 0.3)
    assert aside < 1e-4
    assert (aside > 1e-6) == (friction > 0.0)
    without = {one.name for one in placed_hinges(crossing(fields=()))}
    assert "bar-beam" not in without


def test_a_far_stronger_member_has_none():
    """Plastic moments of 40x2 and 60x30x3 mm are 1 to 2; with a wall of 10 mm, 1 to 5."""
    strong = TUBES | {"high": TUBES["high"] | {"thickness": 0.01}}
    structure = crossing(sections=strong)
    assert places_struck_by_members(structure, "bar")
    assert not places_struck_by_members(structure, "beam")


def test_a_number_as_a_name_hides_no_other_candidate():
    """Candidates between are numbered: a beam, or a pole, of the name 1 would take the name of the first."""
    whole = crossing().model_dump(exclude_none=True)
    whole["members"]["bar"]["hinges"] = {"spacing": 0.5}
    named = {one.name: one.station for one in placed_hinges(Structure(**whole))}
    whole["members"]["1"] = whole["members"].pop("beam")
    whole["initial_velocity"] = [{"translation": (0.0, 0.0, -5.0), "members": ("1",)}]
    renamed = {one.name: one.station for one in placed_hinges(Structure(**whole))}
    along = [sorted(at for name, at in some.items() if name.startswith("bar-")) for some in (named, renamed)]
    assert along[0] == along[1]
    assert "bar-1-struck" in renamed
    assert {"bar-1", "bar-beam"} <= set(named)
