"""Twist of open members on which something acts between their ends, and the caution where they twist far."""

import math

import pytest
from tests.support.multibody.frames import structure

from crumple.hinge import Freedom, build_torsion_law
from crumple.multibody import Run, solve_multibody
from crumple.structure import MultibodySettings, placed_hinges, with_elastic_members
from crumple.structure.hinges.joints.twisting_stretches import twisting_stretches
from crumple.structure.hinges.runs.bars import bar_of

CHANNEL = {"type": "channel", "width": 0.04, "depth": 0.08, "thickness": 0.003}
POLE = {
    "type": "cylinder",
    "point": (0.4, -0.005, 0.3),
    "axis": (0.0, 1.0, 0.0),
    "length": 0.01,
    "radius": 0.05,
    "velocity": (0.0, 0.0, -5.0),
    "mass": 20.0,
}


def struck_channel(**changed):
    """A channel between clamps, in two members, that a short pole strikes at two fifths of its length."""
    post = {"section": "post", "material": "steel", "up": (0.0, 0.0, 1.0)}
    nodes = {"a": (0.0, 0.0, 0.0), "m": (0.6, 0.0, 0.0), "b": (1.0, 0.0, 0.0)}
    parts = {
        "sections": {"post": CHANNEL},
        "hinges": "auto",
        "obstacles": {"pole": POLE},
        "supports": {"a": {"node": "a", "fix": "all"}, "b": {"node": "b", "fix": "all"}},
    }
    members = {"am": post | {"nodes": ("a", "m")}, "mb": post | {"nodes": ("m", "b")}}
    return structure(nodes, members, **parts | changed)


def elastic(whole):
    return with_elastic_members(whole, MultibodySettings(), 0.02)


def stretches(whole, joints=(0.1, 0.3, 0.5, 0.7, 0.9)):
    return twisting_stretches(whole, bar_of(whole, "am"), joints)


def test_what_strikes_between_the_ends_divides_the_twist():
    whole = elastic(struck_channel())
    bar = bar_of(whole, "am")
    first, second = stretches(whole)
    assert (first.start, first.end, second.start, second.end) == pytest.approx((0.0, 0.4, 0.4, 1.0))
    metal = whole.section_of("am"), whole.material_of("am")
    for stretch in (first, second):
        assert stretch.held_ends == "both"
        law = build_torsion_law("warping", *metal, stretch.span)
        own = [
            next(one.record for one in hinge.spatial.components if one.freedom is Freedom.X)
            for hinge in placed_hinges(whole)
            if hinge.only_twists
            and stretch.start < bar.stretches[hinge.member].along(hinge.station) < stretch.end
        ]
        assert own
        assert 1.0 / sum(1.0 / one.elastic_stiffness for one in own) == pytest.approx(law.elastic_stiffness)
        for one in own:
            assert float(one.positive.moment.max()) == pytest.approx(law.steady_torque)


def test_a_mass_ends_the_bar_and_nothing_else_divides_it():
    loaded = elastic(struck_channel(obstacles={}, masses={"m": {"node": "m", "mass": 5.0}}))
    assert [one.end for one in stretches(loaded)] == pytest.approx([0.6])
    plain = elastic(struck_channel(obstacles={}))
    (whole,) = stretches(plain)
    assert (whole.span, whole.held_ends) == (pytest.approx(1.0), "both")


def test_a_place_within_a_fold_of_an_end_divides_nothing():
    near = elastic(struck_channel(obstacles={"pole": POLE | {"point": (0.02, -0.005, 0.3)}}))
    assert len(stretches(near)) == 1


def test_a_part_in_which_nothing_can_twist_divides_nothing():
    whole = elastic(struck_channel())
    assert len(stretches(whole)) == 2
    assert len(stretches(whole, (0.5, 0.9))) == len(stretches(whole, (0.1, 0.3))) == 1


def test_an_end_that_may_warp_stays_so():
    parts = {"supports": {"a": {"node": "a", "fix": "all"}}}
    first, second = stretches(elastic(struck_channel(**parts)))
    assert (first.held_ends, second.held_ends) == ("both", "one")


@pytest.mark.parametrize("far", [True, False])
def test_a_channel_that_is_struck_beside_its_shear_centre_twists_and_a_caution_says_so(far):
    """Struck on its flange it twists; on its web, from the side, it bends about its other axis."""
    side = {"point": (0.4, -0.3, 0.0), "axis": (0.0, 0.0, 1.0), "velocity": (0.0, 6.0, 0.0)}
    pole = POLE | {"point": (0.4, 0.0, 0.091)} if far else POLE | side | {"point": (0.4, -0.07, -0.005)}
    result = solve_multibody(
        struck_channel(obstacles={"pole": pole | {"mass": 40.0}}),
        Run(0.02, 0.0002, MultibodySettings(members="elastic")),
    )
    assert result.status.ok
    cautions = [one for one in result.cautions if one.code == "open_member_twists"]
    assert bool(cautions) == far
    for one in cautions:
        assert one.value > one.limit == pytest.approx(math.radians(16.0))
        assert "which an obstacle strikes" in one.text


def test_a_channel_that_twists_as_far_without_an_obstacle_has_no_such_caution():
    """A flywheel in the middle turns both halves by some 40 degrees; nothing presses on a flange."""
    wheel = {"node": "m", "mass": 1.0, "rotary_inertia": (0.05, 0.05, 0.05)}
    spin = {"nodes": ["m"], "rotation": 120.0, "axis": (1.0, 0.0, 0.0), "about": (0.6, 0.0, 0.0)}
    whole = struck_channel(obstacles={}, masses={"wheel": wheel}, initial_velocity=[spin])
    result = solve_multibody(whole, Run(0.03, 0.0003, MultibodySettings(members="elastic")))
    assert result.status.ok
    assert result["member.am.energy"][-1] > 80.0
    assert not [one for one in result.cautions if one.code == "open_member_twists"]
