"""Where `hinges: auto` puts its candidates."""

import pytest
from tests.support.multibody.frames import CLAMP, LAW, member, structure

from crumple.errors import InputError
from crumple.hinge import Freedom
from crumple.section import RectangularTube, fold_distance, half_fold_length
from crumple.structure import any_automatic, hinge_places, placed_hinges, planar
from crumple.structure.hinges.automatic import automatic_stations

NODES = {"a": (0.0, 0.0, 0.0), "b": (1.0, 0.0, 0.0), "c": (1.0, 0.0, 1.0), "d": (1.02, 0.0, 0.0)}
FRAME = {"ab": member("a", "b") | {"hinges": ()}, "bc": member("b", "c") | {"hinges": ()}}
INSIDE = fold_distance(RectangularTube(0.050, 0.025, 0.00265), "y")
FOLD = 2.0 * half_fold_length(RectangularTube(0.050, 0.025, 0.00265), "y")


def stations(whole):
    return {place.name: pytest.approx(place.station) for place in hinge_places(whole)}


def frame(hinges="auto", **parts):
    parts = {"supports": CLAMP} | parts
    return structure({k: v for k, v in NODES.items() if k != "d"}, FRAME, hinges=hinges, **parts)


def test_candidates_lie_inside_every_end_that_can_carry_a_moment():
    # nothing is joined to node c: no moment there
    assert stations(frame(hinges={"law": "kecman"})) == {"ab-a": INSIDE, "ab-b": 1.0 - INSIDE, "bc-b": INSIDE}


def test_a_mitred_corner_has_one_hinge_at_its_node():
    assert stations(frame()) == {"ab-a": INSIDE, "corner-b": pytest.approx(1.0)}


def test_a_mass_with_inertia_or_off_its_node_carries_a_moment_a_point_does_not():
    point = {"m": {"node": "c", "mass": 5.0}}
    block = {"m": {"node": "c", "mass": 5.0, "rotary_inertia": (0.1, 0.1, 0.1)}}
    aside = {"m": {"node": "c", "mass": 5.0, "offset": (0.1, 0.0, 0.0)}}
    assert "bc-c" not in stations(frame(masses=point))
    assert "bc-c" in stations(frame(masses=block))
    assert "bc-c" in stations(frame(masses=aside))


def test_spacing_divides_the_way_between_the_ends_evenly():
    found = list(stations(frame({"spacing": 0.3, "law": LAW})).values())[:5]
    reach = 1.0 - 2 * INSIDE
    assert found == [INSIDE, INSIDE + reach / 4, INSIDE + reach / 2, INSIDE + 3 * reach / 4, 1.0 - INSIDE]


def test_a_member_too_short_for_two_folds_gets_one_in_its_middle():
    nodes = {"a": NODES["a"], "d": (0.06, 0.0, 0.0)}
    whole = structure(nodes, {"ad": member("a", "d") | {"hinges": "auto"}}, supports=CLAMP)
    assert 4 * INSIDE > 0.06
    assert stations(whole) == {"ad-1": 0.03}


def test_members_with_hinges_of_their_own_keep_them():
    members = {"ab": member("a", "b", ("mine", 0.5)), "bc": FRAME["bc"]}
    whole = structure({k: NODES[k] for k in "abc"}, members, supports=CLAMP, hinges="auto")
    assert set(stations(whole)) == {"mine", "bc-b"}
    assert any_automatic(whole)
    assert not any_automatic(whole.model_copy(update={"hinges": None}))


def test_a_spherical_joint_frees_the_end_from_moments():
    ball = {"j": {"node": "b", "member": "bc", "type": "spherical"}}
    # neither the jointed member nor the one that it hangs on feels a moment there
    assert set(stations(frame(joints=ball))) == {"ab-a"}


def test_candidates_bend_across_the_plane_of_motion():
    upright = {"ab": FRAME["ab"] | {"roll": 1.5707963267948966}, "bc": FRAME["bc"]}
    whole = structure({k: NODES[k] for k in "abc"}, upright, supports=CLAMP, hinges="auto")
    assert planar(whole)
    assert {place.member: place.axis for place in hinge_places(whole)} == {"ab": "z", "bc": "y"}


def test_motion_across_the_plane_of_the_nodes_is_not_planar():
    assert planar(frame(initial_velocity=[{"translation": (1.0, 0.0, 2.0)}]))
    assert not planar(frame(initial_velocity=[{"translation": (1.0, 0.1, 2.0)}]))
    assert not planar(frame(initial_velocity=[{"rotation": 1.0, "axis": (0.0, 1.0, 0.5)}]))
    assert not planar(frame(gravity=(0.0, 9.81, 0.0)))
    assert not planar(frame(masses={"m": {"node": "c", "mass": 1.0, "offset": (0.0, 0.1, 0.0)}}))


@pytest.mark.parametrize(
    ("section", "axes"),
    [
        ({"type": "square_tube", "side": 0.04, "thickness": 0.002}, ("y", "z", "x")),
        ({"type": "channel", "width": 0.03, "depth": 0.05, "thickness": 0.002}, ("y", "z", "x")),
    ],
)
def test_candidates_in_space_bend_about_both_axes_and_twist(section, axes):
    whole = frame(sections={"tube": section}, gravity=(0.0, 9.81, 0.0))
    assert {hinge.keys.axes for hinge in hinge_places(whole)} == {axes}


@pytest.mark.parametrize(("elastic", "axes"), [(6, ("y", "z", "x")), (0, ("y", "z"))])
def test_elastic_members_twist_whatever_axes_their_folds_were_asked_for(elastic, axes):
    members = {name: parts | {"elastic": elastic} for name, parts in FRAME.items()}
    nodes = {name: NODES[name] for name in "abc"}
    whole = structure(nodes, members, hinges={"axes": ("y", "z"), "law": LAW}, supports=CLAMP)
    assert {hinge.keys.axes for hinge in hinge_places(whole)} == {axes}


def test_folds_about_their_tension_flange_get_no_twist_that_their_coupling_would_refuse():
    members = {name: parts | {"elastic": 6} for name, parts in FRAME.items()}
    asked = {"axes": ("y",), "axial": True, "coupling": "tension-flange"}
    nodes = {name: NODES[name] for name in "abc"}
    whole = structure(nodes, members, hinges=asked, supports=CLAMP)
    found = [hinge for hinge in placed_hinges(whole) if hinge.plastic]
    assert found
    assert {hinge.keys.axes for hinge in hinge_places(whole)} == {("y",)}
    assert all(set(hinge.spatial.freedoms) == {Freedom.AXIAL, Freedom.Y} for hinge in found)


def test_a_coupling_that_does_not_fit_automatic_hinges_in_space_says_which_axes_they_have():
    members = {name: parts | {"elastic": 6} for name, parts in FRAME.items()}
    members["ce"] = member("c", "e") | {"hinges": (), "elastic": 6}
    nodes = {name: NODES[name] for name in "abc"} | {"e": (1.0, 0.7, 1.2)}
    asked = {"axial": True, "coupling": "tension-flange"}
    with pytest.raises(InputError) as refusal:
        placed_hinges(structure(nodes, members, hinges=asked, supports=CLAMP))
    problem = refusal.value.problems[0]
    assert (
        problem.came == "axial, x, y, z (automatic hinges of a spatial frame bend about both axes and twist)"
    )
    assert "axes: [y] or axes: [z]" in problem.todo


def test_the_law_of_candidates_is_the_one_given():
    (first, *_) = placed_hinges(frame({"law": LAW}))
    assert first.record.positive.moment[0] == pytest.approx(LAW["moment"])


def test_names_of_stations_increase_along_the_member():
    places = automatic_stations(frame(), "ab", ("y",), 0.2)
    assert list(places.values()) == sorted(places.values())


@pytest.mark.parametrize("hinges", ["always", {"spacing": 0.0}, {"axes": ()}, {"axes": ("x",)}])
def test_what_is_not_a_way_of_placing_them_is_refused(hinges):
    with pytest.raises(InputError):
        frame(hinges)


MISTAKES = {
    "unknown law": ({"law": "nix"}, "no hinge law 'nix'"),
    "law that does not fit": (
        {"law": {"type": "table", "rotation": (0.0, 1.0), "moment": (1.0, -1.0)}},
        "capacities must be positive",
    ),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_for_all_members_is_reported_once(name):
    wish, expected = MISTAKES[name]
    with pytest.raises(InputError, match=expected) as refused:
        frame(hinges=wish)
    (problem,) = refused.value.problems
    assert problem.where == "hinges.law"


def elastic(first, second, **keys):
    return {"nodes": (first, second), "section": "tube", "material": "steel", "elastic": True} | keys


def test_an_elastic_member_folds_at_its_ends_unless_its_list_of_hinges_is_empty():
    nodes = {k: NODES[k] for k in "abc"}

    def found(**keys):
        members = {"ab": elastic("a", "b", **keys), "bc": FRAME["bc"]}
        return structure(nodes, members, supports=CLAMP)

    assert stations(found()) == {"ab-a": INSIDE, "ab-b": 1.0 - INSIDE}
    assert any_automatic(found())
    assert stations(found(hinges=())) == {}
    assert stations(found(elastic=False)) == {}


def test_two_elastic_members_that_are_asked_for_nothing_have_the_hinge_of_their_corner():
    members = {"ab": elastic("a", "b"), "bc": elastic("b", "c")}
    whole = structure({k: NODES[k] for k in "abc"}, members, supports=CLAMP)
    assert stations(whole) == {"ab-a": INSIDE, "corner-b": pytest.approx(1.0)}


@pytest.mark.parametrize(
    ("given", "left"),
    [
        ({"at": 0.5}, {"ab-a", "ab-b"}),
        ({"at": "a"}, {"ab-b"}),
        ({"at": "b", "offset": 0.1}, {"ab-a", "ab-b"}),
        ({"at": 1.0 - INSIDE - 0.95 * FOLD}, {"ab-a"}),
        ({"at": 1.0 - INSIDE - 1.05 * FOLD}, {"ab-a", "ab-b"}),
    ],
)
def test_an_elastic_member_with_a_list_of_hinges_folds_at_the_ends_that_it_leaves_out(given, left):
    own = {"name": "mine", "law": LAW} | given
    members = {"ab": elastic("a", "b", hinges=[own]), "bc": FRAME["bc"]}
    whole = structure({k: NODES[k] for k in "abc"}, members, supports=CLAMP)
    assert set(stations(whole)) == {"mine", *left}
    rigid = {"ab": elastic("a", "b", hinges=[own], elastic=False), "bc": FRAME["bc"]}
    assert set(stations(structure({k: NODES[k] for k in "abc"}, rigid, supports=CLAMP))) == {"mine"}


def test_a_name_that_a_list_has_taken_is_not_given_twice():
    own = {"name": "ab-b", "at": 0.5, "law": LAW}
    members = {"ab": elastic("a", "b", hinges=[own]), "bc": FRAME["bc"]}
    whole = structure({k: NODES[k] for k in "abc"}, members, supports=CLAMP)
    assert set(stations(whole)) == {"ab-b", "ab-a", "ab-b-fold"}


def test_an_elastic_member_that_shortens_at_one_hinge_shortens_at_all_of_them_over_its_whole_length():
    slip = {"peak": 9e4, "mean": 3e4, "stroke": 0.5}
    own = {"name": "mine", "at": 0.5, "axes": ("y", "z"), "axial": slip}
    members = {"ab": elastic("a", "b", hinges=[own]), "bc": FRAME["bc"]}
    whole = structure({k: NODES[k] for k in "abc"}, members, supports=CLAMP)
    assert {place.keys.axial.peak for place in hinge_places(whole)} == {9e4}
    square = {"type": "square_tube", "side": 0.05, "thickness": 0.002}
    own |= {"axial": {"law": "square"}}
    members["ab"] |= {"hinges": [own]}
    whole = structure({k: NODES[k] for k in "abc"}, members, supports=CLAMP, sections={"tube": square})
    stops = [
        part.record.stop_negative.rotation
        for hinge in placed_hinges(whole)
        if hinge.plastic
        for part in hinge.spatial.components
        if part.freedom.name == "AXIAL"
    ]
    assert stops == pytest.approx([0.9 * 1.0] * 3)


def test_joints_between_an_end_and_the_fold_there_do_not_yield():
    """They would carry the largest moment for ever, and the fold beside them would never soften."""
    short = {"a": (0.0, 0.0, 0.0), "b": (0.3, 0.0, 0.0), "c": (0.3, 0.0, 1.0)}
    fine = {"elastic": 32}
    members = {"ab": elastic("a", "b") | fine, "bc": FRAME["bc"]}
    law = {"ab": elastic("a", "b", hinges={"law": "kecman"}) | fine, "bc": FRAME["bc"]}
    for given in (members, law):
        whole = structure(short, given, supports=CLAMP)
        folds = [hinge for hinge in placed_hinges(whole) if hinge.plastic and hinge.member == "ab"]
        joints = [hinge for hinge in placed_hinges(whole) if not hinge.plastic]
        strongest = max(float(hinge.record.positive.moment[0]) for hinge in folds)
        ends = [joint for joint in joints if not folds[0].station < joint.station < folds[-1].station]
        assert ends
        assert all(float(joint.record.positive.moment[0]) > 10.0 * strongest for joint in ends)
        # beside a fold, within the length that it takes, they do not either
        beyond = folds[0].station + FOLD, folds[-1].station - FOLD
        inside = [joint for joint in joints if beyond[0] < joint.station < beyond[1]]
        assert inside
        assert all(float(joint.record.positive.moment[0]) <= strongest for joint in inside)


@pytest.mark.parametrize(("sides", "share"), [(4.0, 1.0), (3.0, 1.0), (2.0, 0.5), (1.2, 0.2)])
def test_folds_beside_clamps_move_to_them_in_short_spans(sides, share):
    """A span is half of a member between clamps: from 3 sides down to 1.4 the distance falls to a fifth."""
    side = 0.050
    nodes = {"a": (0.0, 0.0, 0.0), "b": (2.0 * sides * side, 0.0, 0.0)}
    tube = {"sections": {"tube": {"type": "square_tube", "side": side, "thickness": 0.002}}}
    clamps = {name: {"node": name, "fix": "all"} for name in "ab"}
    whole = structure(nodes, {"ab": member("a", "b") | {"hinges": "auto"}}, supports=clamps, **tube)
    first, *_, last = (place.station for place in hinge_places(whole))
    assert first == pytest.approx(share * fold_distance(whole.section_of("ab"), "y"))
    assert last == pytest.approx(nodes["b"][0] - first)


@pytest.mark.parametrize(
    ("fix", "pole", "shares"),
    [("all", None, (0.9, 0.9)), ("pin", None, (1.0,)), ("all", 0.08, (0.2, 0.6)), ("all", 0.20, (0.5, 0.2))],
)
def test_spans_reach_to_where_a_member_carries_no_moment(fix, pole, shares):
    """Half of it between clamps, all of it to a pin, and half the way to what strikes it first."""
    long = 0.28 if pole is None else 0.28 + 0.02
    nodes = {"a": (0.0, 0.0, 0.0), "b": (long, 0.0, 0.0)}
    tube = {"sections": {"tube": {"type": "square_tube", "side": 0.050, "thickness": 0.002}}}
    supports = {"a": {"node": "a", "fix": "all"}, "b": {"node": "b", "fix": fix}}
    down = {"type": "cylinder", "axis": (0, 1, 0), "radius": 0.02, "mass": 5.0, "velocity": (0, 0, -5.0)}
    obstacles = {} if pole is None else {"pole": down | {"point": (pole, 0.0, 0.05)}}
    beam = {"ab": member("a", "b") | {"hinges": "auto"}}
    whole = structure(nodes, beam, supports=supports, obstacles=obstacles, **tube)
    inside = fold_distance(whole.section_of("ab"), "y")
    ends = {place.name: place.station for place in hinge_places(whole) if place.name in {"ab-a", "ab-b"}}
    found = [ends["ab-a"], long - ends["ab-b"]] if "ab-b" in ends else [ends["ab-a"]]
    assert found == pytest.approx([share * inside for share in shares])


@pytest.mark.parametrize("ends", ["ab", "ba"])
def test_joints_between_a_fold_and_a_free_end_yield_however_near_the_fold(ends):
    """There the moment is smaller than at the fold; what lies within a fold of it had been left out."""
    arm = {ends: member(*ends) | {"hinges": "auto", "elastic": 24}}
    whole = structure({k: NODES[k] for k in "ab"}, arm, supports=CLAMP)
    (fold,) = [hinge for hinge in placed_hinges(whole) if hinge.plastic]
    joints = [hinge for hinge in placed_hinges(whole) if not hinge.plastic]
    strongest = float(fold.record.positive.moment.max())
    beyond = [joint for joint in joints if joint.position[0] > fold.position[0]]
    length = 2.0 * half_fold_length(whole.section_of(ends), "y")
    assert min(joint.position[0] for joint in beyond) < fold.position[0] + length
    assert all(float(joint.record.positive.moment[0]) <= strongest for joint in beyond)
