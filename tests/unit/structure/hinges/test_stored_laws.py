"""Laws of a store in a structure: in members, at corners numbered either way, and what is reported."""

import math

import numpy as np
import pytest
from tests.support.multibody.frames import STEEL, TUBE, member
from tests.support.stored_laws import law_text, store_of

from crumple.errors import InputError
from crumple.hinge.bending.pressed import PressedLaw
from crumple.hinge.measured.place_hash import place_hash
from crumple.material import Material
from crumple.multibody import solve_multibody
from crumple.multibody.run import Run
from crumple.section import CircularTube, RectangularTube, fold_distance
from crumple.structure import (
    Structure,
    corners_without_law,
    law_uses,
    placed_hinges,
    used_texts,
    with_used_laws,
)
from crumple.structure.hinges.corners import corners, untreated

METAL = Material("any name", 210e9, 0.3, 7850.0, 488e6)
SECTION = RectangularTube(0.050, 0.025, 0.00265)
MEMBER, CORNER = place_hash(SECTION, METAL), place_hash(SECTION, METAL, "y", math.pi / 2)
STRAIGHT = law_text(MEMBER, 900.0, 800.0)
CLOSING, OPENING = 400.0, 300.0
MITRE = law_text(CORNER, CLOSING, OPENING, corner="90 deg", stiffness=6e4)
NODES = {"a": (0.0, 0.0, 0.0), "b": (0.0, 0.0, 0.5), "c": (0.5, 0.0, 0.5)}
CLAMP = {"clamp": {"node": "a", "fix": "all"}}
INSIDE = fold_distance(SECTION, "y")
PLAIN = {"section": "tube", "material": "steel"}
DOWN = [{"nodes": ["c"], "translation": (0.0, 0.0, -3.0)}]


def frame(members=None, **parts):
    given = {
        "materials": {"steel": STEEL},
        "sections": {"tube": TUBE},
        "nodes": NODES,
        "members": members or {"post": {"nodes": ("a", "b"), **PLAIN}, "arm": {"nodes": ("b", "c"), **PLAIN}},
        "supports": CLAMP,
        "hinges": "auto",
        "initial_velocity": DOWN,
        "masses": {"tip": {"node": "c", "mass": 10.0}},
    }
    return Structure(**given | parts)


def stored(tmp_path, *texts):
    return str(store_of(tmp_path / "laws", *texts))


def test_without_a_store_nothing_changes(tmp_path):
    plain = frame()
    empty = frame(laws=stored(tmp_path))
    assert [h.name for h in placed_hinges(plain)] == [h.name for h in placed_hinges(empty)]
    assert {h.law.name for h in placed_hinges(empty)} == {"kecman", "mitred_corner"}
    assert {use.origin for use in law_uses(plain).values()} == {"formula"}


@pytest.mark.parametrize(("key", "kind"), [("material", "material"), ("section", "section")])
def test_a_store_does_not_hide_that_a_member_at_a_corner_names_nothing(key, kind, tmp_path):
    arm = {"nodes": ("b", "c"), **PLAIN, key: "no"}
    with pytest.raises(InputError, match=f"there is no {kind} 'no'"):
        frame({"post": {"nodes": ("a", "b"), **PLAIN}, "arm": arm}, laws=stored(tmp_path, MITRE))


@pytest.mark.parametrize(("depth", "kind"), [(0.025, "file"), (0.070, "clamped_tube")])
def test_a_stored_law_of_a_member_is_no_law_of_a_fold_beside_a_clamp(depth, kind, tmp_path):
    tube = {"type": "rectangular_tube", "width": 0.050, "depth": depth, "thickness": 0.00265}
    own = law_text(place_hash(RectangularTube(0.050, depth, 0.00265), METAL, "y"), 900.0, 800.0)
    # a fold beside a clamp has its own table where the tube is deep; others fold as between two pieces
    whole = frame(sections={"tube": tube}, laws=stored(tmp_path, own))
    foot = placed_hinges(whole)[0]
    assert (foot.name, foot.law.name) == ("post-a", kind)
    use = law_uses(whole)["post-a"]
    assert use.origin == ("stored" if kind == "file" else "library")
    assert bool(use.command) == (kind == "file")


def test_members_use_the_law_of_their_section_and_a_corner_its_own(tmp_path):
    whole = frame(laws=stored(tmp_path, STRAIGHT, MITRE))
    foot, corner = placed_hinges(whole)
    assert (foot.name, foot.station) == ("post-a", pytest.approx(INSIDE))
    assert float(foot.law.moment_capacity(0.1)) == 900.0
    assert (corner.name, corner.member, corner.station) == ("corner-b", "post", 0.5)
    assert corner.record.form.value == "elastic-plastic"
    assert corner.record.elastic_stiffness == 6e4
    uses = law_uses(whole)
    assert [uses[name].origin for name in ("post-a", "corner-b")] == ["stored", "stored"]
    assert uses["corner-b"].command.endswith("--angle '90 deg' --converge")


def test_a_fold_under_a_pole_has_the_stored_law_inside(tmp_path):
    pole = {"type": "cylinder", "point": (-0.05, 0.0, 0.25), "axis": (0.0, 1.0, 0.0), "radius": 0.02}
    pole |= {"mass": 20.0, "velocity": (5.0, 0.0, 0.0)}
    held = CLAMP | {"top": {"node": "b", "fix": "all"}}
    post = {"post": {"nodes": ("a", "b"), **PLAIN}}
    parts = {"obstacles": {"pole": pole}, "supports": held, "initial_velocity": [], "masses": {}}
    nodes = {name: NODES[name] for name in "ab"}
    whole = frame(post, laws=stored(tmp_path, STRAIGHT), nodes=nodes, **parts)
    (fold,) = (hinge for hinge in placed_hinges(whole) if hinge.name == "post-pole")
    assert isinstance(fold.law, PressedLaw)
    assert law_uses(whole)["post-pole"].origin == "stored"


@pytest.mark.parametrize("turned", [(), ("post",), ("arm",), ("post", "arm")])
@pytest.mark.parametrize("first", ["post", "arm"])
def test_the_corner_closes_with_its_closing_moment_however_members_are_numbered(tmp_path, turned, first):
    """The arm pushed down closes the corner: seen from the hinge, either sense of its axis may do so."""
    ends = {"post": ("a", "b"), "arm": ("b", "c")}
    names = sorted(ends, key=lambda name: name != first)
    members = {name: {"nodes": ends[name][:: -1 if name in turned else 1], **PLAIN} for name in names}
    whole = frame(members, laws=stored(tmp_path, MITRE))
    corner = next(h for h in placed_hinges(whole) if h.name == "corner-b")
    assert corner.member == first
    # rotation of the arm relative to the post about global y closes; the hinge turns its second side
    second_is_arm = (first == "post") == (members[first]["nodes"][1] == "b")
    if first == "arm":
        second_is_arm = members["arm"]["nodes"][0] == "b"
    sense = int(np.sign(corner.direction[1])) * (1 if second_is_arm else -1)
    assert float(corner.law.moment_capacity(0.1, sense)) == CLOSING
    assert float(corner.law.moment_capacity(0.1, -sense)) == OPENING


def test_candidates_outside_the_zone_of_the_corner_stay(tmp_path):
    whole = frame(laws=stored(tmp_path, MITRE), hinges={"spacing": 0.05})
    zone = 0.050 + INSIDE
    stations = [h.station for h in placed_hinges(whole) if h.member == "arm"]
    assert stations
    assert min(stations) > zone
    without = [h.station for h in placed_hinges(frame(hinges={"spacing": 0.05})) if h.member == "arm"]
    assert stations == [station for station in without if station > zone]


def test_hinges_with_laws_of_their_own_keep_them(tmp_path):
    whole = frame(laws=stored(tmp_path, STRAIGHT, MITRE), hinges={"law": "kecman"})
    assert {h.law.name for h in placed_hinges(whole)} == {"kecman"}
    assert {use.origin for use in law_uses(whole).values()} == {"user"}
    assert used_texts(whole) == ()


def test_in_space_the_corner_law_acts_in_its_plane_and_estimates_out_of_it(tmp_path):
    aside = [{"nodes": ["c"], "translation": (0.0, 1.0, -3.0)}]
    whole = frame(laws=stored(tmp_path, MITRE), initial_velocity=aside)
    corner = next(h for h in placed_hinges(whole) if h.name == "corner-b")
    moments = {c.freedom.name: float(c.record.positive.moment[0]) for c in corner.spatial.components}
    assert moments["Y"] in (CLOSING, OPENING)
    # what distorts the section is at the start 0.55 of what it becomes
    assert 450.0 < moments["Z"] < 550.0
    assert all(c.record.form.value == "set-valued" for c in corner.spatial.components)


def test_in_space_twist_has_its_stored_law_unless_the_input_names_one(tmp_path):
    aside = [{"nodes": ["c"], "translation": (0.0, 1.0, -3.0)}]
    torsion = law_text(place_hash(SECTION, METAL, load="torsion"), 1200.0, 1200.0)
    store = stored(tmp_path, STRAIGHT, torsion)

    def torques(**parts):
        whole = frame(laws=store, initial_velocity=aside, **parts)
        straight = [hinge for hinge in placed_hinges(whole) if not hinge.name.startswith("corner")]
        twists = [c for hinge in straight for c in hinge.spatial.components if c.freedom.name == "X"]
        return {float(c.record.positive.moment[0]) for c in twists}, torsion in used_texts(whole)

    assert torques() == ({1200.0}, True)
    own, used = torques(hinges={"axes": ("x", "y", "z"), "twist": {"law": "plastic", "torque": 900.0}})
    assert own == {900.0}
    assert not used


@pytest.mark.parametrize("height", [0.5, 0.8])
def test_in_space_laws_about_the_bisector_and_the_tangent_act_at_a_corner_of_any_angle(tmp_path, height):
    aside = [{"nodes": ["c"], "translation": (0.0, 1.0, -3.0)}]
    angle = math.atan2(0.5, height - 0.5)

    def place(**about):
        return place_hash(SECTION, METAL, "y", angle, load="out-of-plane", **about)

    mitre = law_text(place_hash(SECTION, METAL, "y", angle), corner="some")
    bisector = law_text(place(about="bisector"), 700.0, 700.0, corner="some", stiffness=5e4)
    tangent = law_text(place(about="tangent"), 1100.0, 1100.0, corner="some")
    former = law_text(place(), 1.0, 1.0, corner="some")
    torsion = law_text(place_hash(SECTION, METAL, load="torsion"), 1200.0, 1200.0)
    nodes = NODES | {"c": (0.5, 0.0, height)}
    texts = (mitre, bisector, tangent, former, torsion)
    whole = frame(nodes=nodes, laws=stored(tmp_path, *texts), initial_velocity=aside)
    moments = {
        h.name: {c.freedom.name: float(c.record.positive.moment[0]) for c in h.spatial.components}
        for h in placed_hinges(whole)
    }
    assert (moments["corner-b"]["X"], moments["corner-b"]["Z"]) == (1100.0, 700.0)
    assert moments["post-a"]["X"] == 1200.0
    # laws from before there were two directions are not used
    assert set(used_texts(whole)) == {mitre, bisector, tangent, torsion}


def test_the_hinge_of_a_corner_of_round_tubes_lies_in_the_plane_of_the_corner(tmp_path):
    """About any axis a round section is the same: the law in the plane acts about the plane's normal."""
    aside = [{"nodes": ["c"], "translation": (0.0, 1.0, -3.0)}]
    section, metal = CircularTube(0.050, 0.002), METAL
    parts = {"sections": {"tube": {"type": "circular_tube", "diameter": 0.050, "thickness": 0.002}}}
    mitre = law_text(place_hash(section, metal, "y", math.pi / 2), corner="90 deg")
    place = place_hash(section, metal, "y", math.pi / 2, load="out-of-plane", about="bisector")
    bisector = law_text(place, 700.0, 700.0, corner="90 deg")
    for roll in (0.0, math.pi / 4.0):
        members = {
            "post": {"nodes": ("a", "b"), "roll": roll, **PLAIN},
            "arm": {"nodes": ("b", "c"), **PLAIN},
        }
        laws = stored(tmp_path / str(roll), mitre, bisector)
        whole = frame(members, laws=laws, initial_velocity=aside, **parts)
        corner = next(h for h in placed_hinges(whole) if h.name == "corner-b")
        np.testing.assert_allclose(np.abs(corner.direction), [0.0, 1.0, 0.0], atol=1e-12)
        assert {c.freedom.name: float(c.record.positive.moment[0]) for c in corner.spatial.components}[
            "Z"
        ] == 700.0


def test_the_spring_of_a_corner_adds_to_the_flexibility_of_its_members(tmp_path):
    """Elastic members share their own length among their own hinges, with or without the corner."""
    elastic = {"law": {"type": "auto", "form": "elastic-plastic"}}
    whole = frame(laws=stored(tmp_path, MITRE), hinges=elastic)
    post = [h for h in placed_hinges(whole) if h.member == "post" and h.name != "corner-b"]
    rigidity = whole.flexural_rigidity("post", "y")
    flexibility = sum(rigidity / h.record.elastic_stiffness for h in post)
    assert flexibility == pytest.approx(0.5)


def test_only_used_laws_are_part_of_the_input(tmp_path):
    other = law_text(place_hash(SECTION, METAL, "z"))
    whole = frame(laws=stored(tmp_path, STRAIGHT, MITRE, other))
    kept = with_used_laws(whole)
    assert kept.laws.texts == tuple(sorted((STRAIGHT, MITRE)))
    assert [h.name for h in placed_hinges(kept)] == [h.name for h in placed_hinges(whole)]


def test_laws_of_the_folds_of_elastic_members_are_part_of_the_input(tmp_path):
    """A comparison also solves the model with elastic members, which fold where rigid ones have no hinge."""
    whole = frame(laws=stored(tmp_path, STRAIGHT, MITRE), hinges=None)
    assert not placed_hinges(whole)
    assert with_used_laws(whole).laws.texts == tuple(sorted((STRAIGHT, MITRE)))


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (
            {"sections": {"tube": TUBE, "other": TUBE | {"thickness": 0.002}}, "arm": {"section": "other"}},
            "differ",
        ),
        ({"arm": {"roll": math.pi / 2}}, "does not lie in the same way"),
        ({"arm": {"roll": 0.5}}, "does not lie in the same way"),
        ({"post": {"roll": 0.5}}, "out of plane"),
        ({"nodes": NODES | {"c": (0.4, 0.0, 0.05)}}, "above 100 deg"),
        ({"supports": CLAMP | {"stay": {"node": "b", "fix": ["y", "rx", "rz"]}}}, "a support holds"),
        ({"arm": {"rigid": True}}, "rigid there"),
    ],
)
def test_corners_without_a_sub_model_are_named_with_the_reason(change, reason):
    members = {
        "post": {"nodes": ("a", "b"), **PLAIN} | change.get("post", {}),
        "arm": {"nodes": ("b", "c"), **PLAIN} | change.get("arm", {}),
    }
    rest = {key: value for key, value in change.items() if key not in members}
    whole = frame(members, **rest)
    assert not corners(whole)
    assert reason in untreated(whole)["b"]


HAT = {"type": "hat", "width": 0.05, "depth": 0.04, "thickness": 0.0016, "flange": 0.016}
CLOSED_HAT = HAT | {"type": "closed_hat"}
DOWNWARDS = {"a": (0.0, 0.0, 0.0), "b": (0.0, 0.0, -0.36), "c": (0.28, 0.0, -0.4)}
ROUND = {"type": "circular_tube", "diameter": 0.05, "thickness": 0.002}
HATS = {"sections": {"tube": HAT}, "nodes": DOWNWARDS}


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            {"sections": {"tube": TUBE, "other": TUBE | {"thickness": 0.002}}, "arm": {"section": "other"}},
            "Corner b has no law of its own, since the sections of the members differ: members are joined "
            "rigidly there, as in shells whose walls do not meet, and fold outside",
        ),
        (
            {"nodes": NODES | {"c": (0.4, 0.0, 0.05)}},
            "since the angle is above 100 deg: members are joined rigidly there, as in shells, and fold",
        ),
        (
            {"arm": {"roll": 0.5}},
            "does not lie in the same way to the corner's plane in both members: members",
        ),
        (
            {**HATS, "roll": math.pi},
            "no formula has mitres of hat sections: hinges there have the law",
        ),
        (
            {
                "hinges": {"axes": ["y", "z"]},
                "sections": {"tube": ROUND},
                "nodes": NODES | {"c": (0.3, 0.3, 0.55)},
            },
            "hinges do not turn about all axes ('axes: [y, z, x]'): hinges",
        ),
        (HATS, "recognised with 'roll' larger by 180 deg in both members: another structure): members"),
        (HATS | {"sections": {"tube": CLOSED_HAT}}, None),
        (HATS | {"sections": {"tube": CLOSED_HAT}, "roll": math.pi}, None),
        ({}, None),
        ({"hinges": None, "arm": {"hinges": [{"name": "h", "at": 0.1, "law": "kecman"}], "roll": 0.5}}, None),
        ({"masses": {"m": {"node": "b", "mass": 1.0}}, "nodes": NODES | {"c": (0.4, 0.0, 0.05)}}, None),
    ],
)
def test_corners_without_a_law_of_their_own_are_told(change, said):
    roll = {"roll": change.get("roll", 0.0)}
    members = {
        "post": {"nodes": ("a", "b"), **PLAIN, **roll} | change.get("post", {}),
        "arm": {"nodes": ("b", "c"), **PLAIN, **roll} | change.get("arm", {}),
    }
    whole = frame(members, **{key: value for key, value in change.items() if key not in {*members, "roll"}})
    found = corners_without_law(whole)
    assert len(found) == (said is not None)
    assert all(said in one for one in found)
    shortly = solve_multibody(whole, Run(1e-5, 1e-5, checks=False))
    assert set(found) <= set(shortly.assumptions)


def test_alike_corners_without_a_law_have_one_sentence():
    nodes = {"a": (0.0, 0.0, 0.0), "b": (0.0, 0.0, 0.5), "c": (0.5, 0.0, 0.5), "d": (0.5, 0.0, 0.0)}
    members = {
        "left": {"nodes": ("a", "b"), **PLAIN},
        "roof": {"nodes": ("b", "c"), **PLAIN, "section": "other"},
        "right": {"nodes": ("d", "c"), **PLAIN},
    }
    supports = CLAMP | {"far": {"node": "d", "fix": "all"}}
    sections = {"tube": TUBE, "other": TUBE | {"thickness": 0.002}}
    whole = frame(members, nodes=nodes, sections=sections, supports=supports, masses={}, initial_velocity=[])
    (said,) = corners_without_law(whole)
    assert said.startswith(
        "Corners b, c have no laws of their own, since the sections of the members differ: "
    )


@pytest.mark.parametrize("across", [1e-6, 1e-5, 1e-3])
def test_rounded_coordinates_leave_a_corner_what_it_is(across):
    """1 mm in 0.5 m turns the arm's section by 0.1 deg; by 1 deg it lies in another way."""
    near = frame(nodes=NODES | {"c": (0.5, across, 0.5)})
    assert corners(near)["b"].angle == pytest.approx(math.pi / 2, abs=1e-9)
    assert corners(near)["b"].axis == corners(frame())["b"].axis
    aside = frame(nodes=NODES | {"c": (0.5, 0.01, 0.5)})
    assert not corners(aside)


@pytest.mark.parametrize("roll", [0.0, 0.3, 1.0])
def test_round_tubes_lie_alike_in_a_corner_however_their_axes_are_turned(roll):
    parts = {"sections": {"tube": {"type": "circular_tube", "diameter": 0.050, "thickness": 0.002}}}
    members = {"post": {"nodes": ("a", "b"), "roll": roll, **PLAIN}, "arm": {"nodes": ("b", "c"), **PLAIN}}
    for across in (0.0, 1e-6, 0.2):
        whole = frame(members, nodes=NODES | {"c": (0.5, across, 0.5)}, **parts)
        assert list(corners(whole)) == ["b"], across


def test_members_in_line_and_three_members_are_no_corner():
    line = frame(nodes=NODES | {"c": (0.0, 0.0, 1.0)})
    assert not corners(line)
    assert not untreated(line)
    third = {"stay": member("b", "d")}
    members = {"post": {"nodes": ("a", "b"), **PLAIN}, "arm": {"nodes": ("b", "c"), **PLAIN}, **third}
    joined = frame(members, nodes=NODES | {"d": (-0.5, 0.0, 0.5)})
    assert untreated(joined) == {"b": "3 members meet"}
