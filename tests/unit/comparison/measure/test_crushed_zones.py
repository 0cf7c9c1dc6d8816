"""Zones of members that fold along their axis, and where elastic members dissipate."""

import pytest
from tests.support.multibody.frames import CLAMP, structure

from crumple.comparison.measure.crushed_zones import joined_zones, with_joined_zones
from crumple.comparison.measure.measures import Measures, measure
from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, Outputs

NODES = {"a": (0.0, 0.0, 0.0), "b": (1.0, 0.0, 0.0), "c": (2.0, 0.0, 0.0), "d": (2.0, 1.0, 0.0)}
FOLDS = {"peak": 9e4, "mean": 3e4, "stroke": 0.5}


def member(first, second, axial=None, **keys):
    own = {"name": f"h{first}", "at": 0.5, "axes": ("y", "z"), "axial": axial}
    hinges = [own] if axial is not None else ()
    return {"nodes": (first, second), "section": "tube", "material": "steel", "hinges": hinges} | keys


def chain(first, second, third=None):
    members = {"ab": member("a", "b", first), "bc": member("b", "c", second), "cd": member("c", "d", third)}
    return structure(NODES, members, supports=CLAMP)


def test_the_zones_of_a_member_that_folds_along_its_axis_are_one():
    assert joined_zones(chain(None, None), {}) == {}
    # walls that yield along the member without folding do so where the hinge is
    assert joined_zones(chain(True, None), {}) == {}
    assert joined_zones(chain(FOLDS, None), {}) == dict.fromkeys(("a", "b", "span of ab"), "all of ab")


def test_members_that_share_a_node_are_one_zone_and_others_are_not():
    both = dict.fromkeys(("a", "b", "c", "span of ab", "span of bc"), "all of ab and bc")
    assert joined_zones(chain(FOLDS, FOLDS), {}) == both
    ends = joined_zones(chain(FOLDS, None, FOLDS), {})
    assert set(ends.values()) == {"all of ab", "all of cd"}


def test_energies_are_added_and_joining_twice_changes_nothing():
    measures = Measures(
        "complete", zones={"a": 1.0, "span of ab": 2.0, "b": 4.0, "span of bc": 8.0, "c": 16.0}
    )
    once = with_joined_zones(measures, chain(FOLDS, None), measures)
    assert once.zones == {"all of ab": 7.0, "span of bc": 8.0, "c": 16.0}
    assert with_joined_zones(once, chain(FOLDS, None), measures) == once


def test_braced_members_are_one_zone_only_if_the_reference_shortens_them():
    nodes = {"a": (1.0, 0.0, 0.0), "b": (-0.5, 0.9, 0.0), "c": (-0.5, -0.9, 0.0), "m": (0.0, 0.0, 0.1)}
    members = {n: {"nodes": (n, "m"), "section": "tube", "material": "steel"} for n in "abc"}
    supports = {n: {"node": n, "fix": "all"} for n in "abc"}
    tripod = structure(nodes, members, supports=supports, hinges="auto")
    # what was not measured counts as folded
    assert set(joined_zones(tripod, {}).values()) == {"all of a and b and c"}
    assert joined_zones(tripod, dict.fromkeys("abc", 0.002)) == {}
    folded = joined_zones(tripod, {"a": 0.1, "b": 0.002, "c": 0.002})
    assert folded == dict.fromkeys(("a", "m", "span of a"), "all of a")


@pytest.mark.parametrize("kernel", ["tree", "spatial"])
def test_what_an_elastic_member_dissipates_by_yielding_is_counted_where_it_yields(kernel):
    bar = member("a", "b", elastic=12)
    thrown = [{"nodes": ["b"], "translation": (0.0, 0.0, 6.0)}]
    masses = {"tip": {"node": "b", "mass": 20.0}}
    ends = {k: NODES[k] for k in "ab"}
    whole = structure(ends, {"bar": bar}, supports=CLAMP, masses=masses, initial_velocity=thrown)
    settings = MultibodySettings(kernel=kernel)
    result = solve_multibody(whole, Run(0.06, 0.001, settings, Outputs(pictures=(0.0, 0.06))))
    places = result.yielded["bar"]
    assert [station for station, _ in places] == sorted(station for station, _ in places)
    together = sum(energy for _, energy in places)
    assert together == pytest.approx(float(result["member.bar.energy"][-1]))
    zones = measure(result, whole).zones
    # joints at 0, 83 mm, ...: the second one stands for 42 to 125 mm, the zone ends at 100 mm
    (_, first), (_, second) = places[:2]
    assert zones["a"] == pytest.approx(first + 0.7 * second, rel=0.03)
    assert zones["a"] > 0.7 * together
    assert sum(zones.values()) == pytest.approx(together)
