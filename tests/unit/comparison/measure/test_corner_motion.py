"""Rotation of a hinge at a corner in shapes: folds of both members, with the sense of the axes."""

import math

import numpy as np
import pytest
from tests.support.multibody.frames import STEEL, TUBE
from tests.support.stored_laws import law_text, store_of

from crumple.comparison.measure.corner_motion import with_corners
from crumple.comparison.measure.motion import HingeMotion, Measured
from crumple.hinge.measured.place_hash import place_hash
from crumple.material import Material
from crumple.section import RectangularTube
from crumple.structure import Structure, plastic_hinges

PLACE = place_hash(
    RectangularTube(0.050, 0.025, 0.00265), Material("", 210e9, 0.3, 7850.0, 488e6), "y", math.pi / 2
)
TIME = np.linspace(0.0, 1.0, 5)
FALLS = {"mass": 10.0, "velocity": (0.0, 0.0, -3.0), "guide": (0.0, 0.0, 1.0)}


def frame(tmp_path, arm, thrown=(0.0, 0.0, -3.0)):
    store = store_of(tmp_path / "laws", law_text(PLACE, corner="90 deg", stiffness=6e4))
    member = {"section": "tube", "material": "steel"}
    return Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"a": (0.0, 0.0, 0.0), "b": (0.0, 0.0, 0.5), "c": (0.5, 0.0, 0.5)},
        members={"post": {"nodes": ("a", "b"), **member}, "arm": {"nodes": arm, **member}},
        supports={"clamp": {"node": "a", "fix": "all"}},
        hinges="auto",
        initial_velocity=[{"nodes": ["c"], "translation": thrown}],
        laws=str(store),
    )


def motion(name, member, station, turned):
    return HingeMotion(name, member, station, TIME, *(turned * TIME for _ in range(4)), TIME, "Measured.")


@pytest.mark.parametrize(("arm", "station"), [(("b", "c"), 0.01), (("c", "b"), 0.49)])
def test_folds_of_both_legs_that_close_the_corner_add_up(tmp_path, arm, station):
    whole = frame(tmp_path, arm)
    hinges = plastic_hinges(whole)
    corner = next(hinge for hinge in hinges if hinge.name == "corner-b")
    # the part of each member beyond its fold turns about global y, relative to the part before it
    closing = float(np.sign(corner.direction[1]))
    frame_y = whole.frame_of("arm").y[1]
    beyond = 1.0 if arm[0] == "b" else -1.0
    post = motion("corner-b", "post", 0.49, 0.2 * closing)
    leg = motion("arm at 10 mm", "arm", station, 0.3 * beyond * float(np.sign(frame_y)))
    far = motion("arm at 250 mm", "arm", 0.25, 0.1)
    seen = with_corners(Measured({}, (), (post,), (leg, far)), whole, hinges)
    (both,) = seen.hinges
    assert both.rotation[-1] == pytest.approx(0.5 * closing)
    assert both.plastic_work[-1] == pytest.approx(2.0)
    assert seen.extra == (far,)


@pytest.mark.parametrize("turned", [0.3, -0.3])
def test_the_angles_of_both_legs_of_a_corner_in_space_add_up(tmp_path, turned):
    """The angle of a hinge that bends about both axes has no sense; that of the other leg's fold has one."""
    whole = frame(tmp_path, ("b", "c"), (0.0, 1.0, -3.0))
    post, leg = motion("corner-b", "post", 0.49, 0.2), motion("arm at 10 mm", "arm", 0.01, turned)
    (both,) = with_corners(Measured({}, (), (post,), (leg,)), whole, plastic_hinges(whole)).hinges
    assert both.rotation[-1] == pytest.approx(0.5)
    assert both.plastic_rotation[-1] == pytest.approx(0.5)


def test_hinges_away_from_corners_stay_as_they_are(tmp_path):
    whole = frame(tmp_path, ("b", "c"))
    foot = motion("post-a", "post", 0.02, 0.2)
    seen = Measured({}, (), (foot,), (motion("post at 250 mm", "post", 0.25, 0.1),))
    assert with_corners(seen, whole, plastic_hinges(whole)).hinges == (foot,)


@pytest.mark.parametrize(
    ("second", "station", "turned"), [(("b", "c"), 0.008, 0.3), (("c", "b"), 0.492, -0.3)]
)
def test_a_fold_at_a_struck_node_in_a_tube_is_that_of_both_members(second, station, turned):
    member = {"section": "tube", "material": "steel"}
    whole = Structure(
        materials={"steel": STEEL},
        sections={"tube": TUBE},
        nodes={"a": (0.0, 0.0, 0.0), "b": (0.5, 0.0, 0.0), "c": (1.0, 0.0, 0.0)},
        members={"first": {"nodes": ("a", "b"), **member}, "second": {"nodes": second, **member}},
        supports={"clamp": {"node": "a", "fix": "all"}},
        hinges="auto",
        obstacles={"ball": {"type": "sphere", "point": (0.5, 0.0, 0.2), "radius": 0.1} | FALLS},
    )
    hinges = plastic_hinges(whole)
    # members that lead towards each other have opposite y axes, and each is seen from its own start
    same = float(np.sign(whole.frame_of("second").y @ whole.frame_of("first").y))
    near = motion("first-b", "first", 0.49, 0.2)
    beyond = motion("second there", "second", station, turned * same)
    far = motion("second at 250 mm", "second", 0.25, 0.1)
    seen = with_corners(Measured({}, (), (near,), (beyond, far)), whole, hinges)
    assert "first-b" in {hinge.name for hinge in hinges}
    assert seen.hinges[0].rotation[-1] == pytest.approx(0.5)
    assert seen.hinges[0].plastic_work[-1] == pytest.approx(2.0)
    assert seen.extra == (far,)
